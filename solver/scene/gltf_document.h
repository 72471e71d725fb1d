#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "solver/base/json.h"
#include "solver/scene/load.h"
#include "solver/scene/resources.h"

namespace afterglow::gltf {

/// Ceilings on what a file may ask for, so that a small file cannot exhaust the memory by referring to the
/// same bytes over and over.
inline constexpr std::size_t max_vertices = std::size_t{16} << 20U;      ///< in all meshes
inline constexpr std::size_t max_triangles = std::size_t{16} << 20U;     ///< in all meshes
inline constexpr std::size_t max_keys = std::size_t{16} << 20U;          ///< in all tracks
inline constexpr std::size_t max_texels = std::size_t{128} << 20U;       ///< in all textures
inline constexpr std::size_t max_buffer_bytes = std::size_t{1} << 31U;   ///< decoded or external, in all
inline constexpr std::size_t max_zero_elements = std::size_t{1} << 20U;  ///< of an accessor without data

/// A parsed file with its buffers fetched: the top-level arrays as views, each element knowing its place.
/// Neither copied nor moved, since views point into it.
struct Document {
    std::string name;  ///< stands for the file in errors
    Json json;
    std::vector<JsonView> accessors, animations, buffer_views, cameras, images, materials, meshes, nodes,
        samplers, scenes, textures;
    std::vector<std::string_view> buffers;  ///< content, exactly byteLength long
    std::vector<std::string> owned_bytes;   ///< what `buffers` points to, where it is not the file itself
    ResourceReader read_resource;

    Document() = default;
    Document(const Document&) = delete;
    Document& operator=(const Document&) = delete;

    [[nodiscard]] JsonView root() const { return {json, name}; }
};

/// Parses a file and fetches its buffers. `bytes` must outlive the document.
/// Errors: as split_glb, parse_json and resources; unsupported for another asset version or for an unknown
/// required extension (all of them named); invalid_input for missing or short buffers.
std::unique_ptr<const Document> open_document(std::string_view bytes, SceneFormat format,
                                              const std::string& name, const ResourceReader& read_resource);

/// Content behind a "uri" field: of a data URI, or of a file beside the scene. Errors name the field.
std::string resolve_uri(const Document& document, const JsonView& uri);

/// The element's "name", or `kind` and its position ("node 3").
std::string name_of(const JsonView& element, std::string_view kind, std::size_t position);
/// extensions.`name` of an element.
std::optional<JsonView> extension_of(const JsonView& element, std::string_view name);
/// The number in a field, or a default.
double number_or(const JsonView& element, std::string_view key, double otherwise);
/// A finite single-precision number, or an error at the value's place.
float to_float(const JsonView& place, double number);

}  // namespace afterglow::gltf
