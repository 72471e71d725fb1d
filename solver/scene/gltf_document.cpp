#include "solver/scene/gltf_document.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "solver/scene/gltf_container.h"

namespace afterglow::gltf {

namespace {

/// Extensions that we honour, or that may be left out without changing geometry or diffuse colour.
constexpr std::array<std::string_view, 17> known_extensions{
    "KHR_lights_punctual",
    "KHR_materials_anisotropy",
    "KHR_materials_clearcoat",
    "KHR_materials_dispersion",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_iridescence",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_sheen",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_materials_variants",
    "KHR_materials_volume",
    "KHR_mesh_quantization",
    "KHR_texture_transform",
    "KHR_xmp_json_ld",
};

std::vector<JsonView> list(const JsonView& root, std::string_view key) {
    const auto member = root.find(key);
    return member ? member->elements() : std::vector<JsonView>{};
}

void check_version(const JsonView& root) {
    const JsonView asset = root.at("asset");
    // Every 2.x file is readable by a 2.0 reader unless minVersion says otherwise.
    const auto minimum = asset.find("minVersion");
    const JsonView version = minimum ? *minimum : asset.at("version");
    const std::string text = version.as_string();
    const bool readable = minimum ? text == "2.0" : text.starts_with("2.");
    if (!readable)
        throw Error(ErrorKind::unsupported, version.place(),
                    "glTF version " + in_quotes(text) + "; only version 2.0 is read");
}

void check_extensions(const JsonView& root) {
    const auto required = root.find("extensionsRequired");
    if (!required) return;
    std::string unknown;
    for (const JsonView& item : required->elements()) {
        const std::string extension = item.as_string();
        if (std::find(known_extensions.begin(), known_extensions.end(), extension) != known_extensions.end())
            continue;
        unknown += (unknown.empty() ? "" : ", ") + in_quotes(extension);
    }
    if (!unknown.empty())
        throw Error(ErrorKind::unsupported, required->place(),
                    "the file needs extensions that are not read: " + unknown);
}

void open_lists(Document& document) {
    const JsonView root = document.root();
    document.accessors = list(root, "accessors");
    document.animations = list(root, "animations");
    document.buffer_views = list(root, "bufferViews");
    document.cameras = list(root, "cameras");
    document.images = list(root, "images");
    document.materials = list(root, "materials");
    document.meshes = list(root, "meshes");
    document.nodes = list(root, "nodes");
    document.samplers = list(root, "samplers");
    document.scenes = list(root, "scenes");
    document.textures = list(root, "textures");
}

void fetch_buffers(Document& document, const std::optional<std::string_view>& binary_chunk) {
    const std::vector<JsonView> buffers = list(document.root(), "buffers");
    // Views into the strings are kept, so the strings must not move.
    document.owned_bytes.reserve(buffers.size());
    std::size_t total = 0;
    for (std::size_t i = 0; i < buffers.size(); ++i) {
        const JsonView& buffer = buffers[i];
        const auto length = static_cast<std::size_t>(
            buffer.at("byteLength").as_integer_in(0, static_cast<std::int64_t>(max_buffer_bytes)));
        std::string_view content;
        if (const auto uri = buffer.find("uri")) {
            document.owned_bytes.push_back(resolve_uri(document, *uri));
            content = document.owned_bytes.back();
            total += content.size();
        } else if (i == 0 && binary_chunk) {
            content = *binary_chunk;
        } else {
            buffer.fail("the buffer has no content: neither a \"uri\" nor a binary chunk");
        }
        if (total > max_buffer_bytes)
            throw Error(ErrorKind::too_large, buffer.place(), "the buffers have more than 2 GiB in all");
        if (length > content.size())
            buffer.fail("the buffer should have " + std::to_string(length) + " bytes, there are " +
                        std::to_string(content.size()));
        document.buffers.push_back(content.substr(0, length));
    }
}

}  // namespace

std::unique_ptr<const Document> open_document(std::string_view bytes, SceneFormat format,
                                              const std::string& name, const ResourceReader& read_resource) {
    Container container{bytes, std::nullopt};
    if (format == SceneFormat::glb) container = split_glb(bytes, name);
    auto document = std::make_unique<Document>();
    document->name = name;
    document->read_resource = read_resource;
    document->json = parse_json(container.json, name);
    check_version(document->root());
    check_extensions(document->root());
    open_lists(*document);
    fetch_buffers(*document, container.binary);
    return document;
}

std::string resolve_uri(const Document& document, const JsonView& uri) {
    const std::string text = uri.as_string();
    if (is_data_uri(text)) return decode_data_uri(text, uri.place());
    if (!document.read_resource)
        uri.fail("refers to the file " + in_quotes(text) +
                 "; a scene sent by itself must contain everything");
    try {
        return document.read_resource(text);
    } catch (const Error& e) {
        throw Error(e.kind(), uri.place(), e.what());
    }
}

std::string name_of(const JsonView& element, std::string_view kind, std::size_t position) {
    if (const auto name = element.find("name")) {
        std::string text = name->as_string();
        if (!text.empty()) return text;
    }
    return std::string(kind) + " " + std::to_string(position);
}

std::optional<JsonView> extension_of(const JsonView& element, std::string_view name) {
    const auto extensions = element.find("extensions");
    return extensions ? extensions->find(name) : std::nullopt;
}

double number_or(const JsonView& element, std::string_view key, double otherwise) {
    const auto member = element.find(key);
    return member ? member->as_number() : otherwise;
}

float to_float(const JsonView& place, double number) {
    const auto value = static_cast<float>(number);
    if (!std::isfinite(value)) place.fail("a number is too large for single precision");
    return value;
}

}  // namespace afterglow::gltf
