#include "client/scene_files.h"

#include <algorithm>
#include <cctype>
#include <sstream>
#include <system_error>
#include <utility>
#include <vector>

#include "client/file.h"
#include "client/json.h"

namespace afterglow::client {

namespace fs = std::filesystem;

namespace {

std::string ending_of(const fs::path& path) {
    std::string ending = path.extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return ending;
}

std::string percent_decoded(const std::string& uri) {
    std::string out;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        const bool is_escape = uri[i] == '%' && i + 2 < uri.size() &&
                               std::isxdigit(static_cast<unsigned char>(uri[i + 1])) != 0 &&
                               std::isxdigit(static_cast<unsigned char>(uri[i + 2])) != 0;
        out += is_escape ? static_cast<char>(std::stoi(uri.substr(i + 1, 2), nullptr, 16)) : uri[i];
        if (is_escape) i += 2;
    }
    return out;
}

/// Every text under one of these keys, at whatever depth.
void texts_under(const Json& value, const std::vector<std::string_view>& keys,
                 std::vector<std::string>& found) {
    if (!value.is_structured()) return;
    for (const auto& [key, member] : value.items()) {
        const bool is_named =
            value.is_object() && std::find(keys.begin(), keys.end(), key) != keys.end() && member.is_string();
        if (is_named)
            found.push_back(member.get<std::string>());
        else
            texts_under(member, keys, found);
    }
}

std::vector<std::string> texts_of_json(std::string_view text, const std::vector<std::string_view>& keys) {
    std::vector<std::string> found;
    try {
        texts_under(parse_json(text, "scene"), keys, found);
    } catch (const ClientError&) {
        found.clear();  // the server says what is wrong with it
    }
    return found;
}

/// The JSON of a .glb: after the head of 12 bytes the first chunk, whose length is its first number.
std::string_view json_of_glb(std::string_view bytes) {
    constexpr std::size_t begin = 20;
    if (bytes.size() < begin) return {};
    std::size_t length = 0;
    for (std::size_t i = 4; i > 0; --i) length = length * 256 + static_cast<unsigned char>(bytes[11 + i]);
    return bytes.substr(begin, length);
}

/// What statements of an .obj or .mtl may refer to.
std::vector<std::string> texts_of_statements(const std::string& text) {
    std::vector<std::string> found;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words(line);
        std::string keyword;
        words >> keyword >> std::ws;
        if (keyword != "mtllib" && !keyword.starts_with("map_")) continue;
        std::string rest;
        std::getline(words, rest);
        rest.erase(rest.find_last_not_of(" \t\r") + 1);
        // Names may contain blanks, and options or other names may stand before them.
        for (std::size_t at = 0; at < rest.size();
             at = rest.find_first_not_of(" \t", rest.find_first_of(" \t", at))) {
            found.push_back(rest.substr(at));
            found.push_back(rest.substr(at, rest.find_first_of(" \t", at) - at));
        }
    }
    return found;
}

std::vector<std::string> references_of(const fs::path& name, const std::string& bytes) {
    const std::string ending = ending_of(name);
    if (ending == ".gltf") return texts_of_json(bytes, {"uri"});
    if (ending == ".glb") return texts_of_json(json_of_glb(bytes), {"uri"});
    if (ending == ".json") return texts_of_json(bytes, {"file", "texture"});
    if (ending == ".obj" || ending == ".mtl") return texts_of_statements(bytes);
    return {};
}

/// The file that a reference of `from` leads to, relative to the folder; empty where it is none of its files.
fs::path file_inside(const fs::path& folder, const fs::path& from, std::string reference) {
    constexpr std::size_t longest = 500;
    if (reference.empty() || reference.size() > longest) return {};
    std::replace(reference.begin(), reference.end(), '\\', '/');
    const fs::path name = (from.parent_path() / reference).lexically_normal();
    if (name.empty() || name.is_absolute() || *name.begin() == "..") return {};
    std::error_code error;
    const fs::path real = fs::canonical(folder / name, error);
    if (error || !fs::is_regular_file(real, error)) return {};
    const fs::path relative = real.lexically_relative(fs::canonical(folder, error));
    return error || relative.empty() || *relative.begin() == ".." ? fs::path() : name;
}

}  // namespace

SceneFiles collect_scene_files(const fs::path& scene, const std::string& bytes) {
    const fs::path folder = scene.has_parent_path() ? scene.parent_path() : fs::path(".");
    SceneFiles files{{scene.filename().string(), bytes}};
    std::vector<std::string> unread{scene.filename().string()};
    while (!unread.empty()) {
        const fs::path from = unread.back();
        unread.pop_back();
        for (const std::string& reference : references_of(from, files.at(from.generic_string())))
            for (const std::string& text : {reference, percent_decoded(reference)}) {
                const std::string name = file_inside(folder, from, text).generic_string();
                if (name.empty() || files.contains(name)) continue;
                files.emplace(name, read_input(folder / name));
                unread.push_back(name);
            }
    }
    return files;
}

}  // namespace afterglow::client
