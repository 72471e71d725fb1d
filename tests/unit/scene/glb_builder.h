#pragma once

// Builds glTF files in memory for tests, and reads them.

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "solver/base/json.h"
#include "solver/scene/gltf_reader.h"

namespace afterglow {

inline void append_little_endian(std::string& out, std::uint32_t value) {
    for (unsigned shift = 0; shift < 32; shift += 8) out += static_cast<char>((value >> shift) & 0xFFU);
}

/// A binary glTF file of a JSON chunk and, where there are bytes, a binary chunk.
inline std::string glb_of(std::string json_text, std::string binary) {
    json_text.resize((json_text.size() + 3) / 4 * 4, ' ');
    binary.resize((binary.size() + 3) / 4 * 4, '\0');
    const std::size_t total = 12 + 8 + json_text.size() + (binary.empty() ? 0 : 8 + binary.size());
    std::string out = "glTF";
    append_little_endian(out, 2);
    append_little_endian(out, static_cast<std::uint32_t>(total));
    append_little_endian(out, static_cast<std::uint32_t>(json_text.size()));
    out += "JSON" + json_text;
    if (!binary.empty()) {
        append_little_endian(out, static_cast<std::uint32_t>(binary.size()));
        out += std::string("BIN\0", 4) + binary;
    }
    return out;
}

/// A file under construction: fill in `json`, add data, then call `read`.
struct GlbBuilder {
    Json json = {{"asset", {{"version", "2.0"}}}};
    std::string binary;

    int add_view(const std::string& bytes) {
        binary.resize((binary.size() + 3) / 4 * 4, '\0');
        json["bufferViews"].push_back(
            {{"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", bytes.size()}});
        binary += bytes;
        return static_cast<int>(json["bufferViews"].size()) - 1;
    }
    template <class T>
    static std::string bytes_of(const std::vector<T>& values) {
        std::string bytes(values.size() * sizeof(T), '\0');
        if (!values.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
        return bytes;
    }
    int add_accessor(const Json& accessor) {
        json["accessors"].push_back(accessor);
        return static_cast<int>(json["accessors"].size()) - 1;
    }
    template <class T>
    int add(const std::vector<T>& values, int component_type, const char* type, std::size_t components) {
        return add_accessor({{"bufferView", add_view(bytes_of(values))},
                             {"componentType", component_type},
                             {"type", type},
                             {"count", values.size() / components}});
    }
    int add_scalars(const std::vector<float>& values) { return add(values, 5126, "SCALAR", 1); }
    int add_vec2(const std::vector<float>& values) { return add(values, 5126, "VEC2", 2); }
    int add_vec3(const std::vector<float>& values) { return add(values, 5126, "VEC3", 3); }
    int add_vec4(const std::vector<float>& values) { return add(values, 5126, "VEC4", 4); }
    int add_indices(const std::vector<std::uint16_t>& values) { return add(values, 5123, "SCALAR", 1); }

    /// Adds a mesh of one primitive and a node that shows it.
    void add_mesh(const Json& primitive, const std::string& name = "thing") {
        json["meshes"].push_back({{"name", name}, {"primitives", Json::array({primitive})}});
        json["nodes"].push_back({{"name", name}, {"mesh", json["meshes"].size() - 1}});
    }
    /// A triangle (0,0,0), (1,0,0), (0,1,0) and a node that shows it; `material` below 0 for none.
    void add_triangle(int material = -1) {
        Json primitive = {{"attributes", {{"POSITION", add_vec3({0, 0, 0, 1, 0, 0, 0, 1, 0})}}}};
        if (material >= 0) primitive["material"] = material;
        add_mesh(primitive);
    }

    [[nodiscard]] std::string glb() const {
        Json whole = json;
        if (!binary.empty() && !whole.contains("buffers"))
            whole["buffers"] = Json::array({{{"byteLength", binary.size()}}});
        return glb_of(whole.dump(), binary);
    }
    Scene read(const LoadConfig& config = {}) const {
        return read_gltf(glb(), SceneFormat::glb, "test.glb", {}, config);
    }
};

/// The error that a call ends with; fails the test where it does not.
template <class Call>
Error error_of(const Call& call) {
    try {
        call();
    } catch (const Error& error) {
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos)
            << "not one line: " << error.what();
        return error;
    }
    ADD_FAILURE() << "no error was thrown";
    return {ErrorKind::io, "", ""};
}

/// How many warnings contain a text.
inline int warnings_with(const Scene& scene, const std::string& text) {
    return static_cast<int>(
        std::count_if(scene.warnings.begin(), scene.warnings.end(),
                      [&](const Warning& w) { return w.message.find(text) != std::string::npos; }));
}

}  // namespace afterglow
