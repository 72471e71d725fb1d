#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace afterglow::gltf {

/// The two parts of a binary glTF file; views of its bytes.
struct Container {
    std::string_view json;
    std::optional<std::string_view> binary;
};

/// Takes a binary glTF 2.0 file apart. Unknown chunks and bytes past the stated length are skipped.
/// Errors: invalid_input naming `name` for a wrong magic number, a truncated file, or a chunk that ends past
/// the file; unsupported for another version. Source: glTF 2.0 specification, section 4.4 (GLB).
Container split_glb(std::string_view bytes, const std::string& name);

/// Whether a URI carries its own content ("data:...").
bool is_data_uri(std::string_view uri);

/// The content of a base64 data URI. `place` names it in errors.
/// Errors: unsupported without ";base64,"; invalid_input for characters that are no base64 (RFC 4648).
std::string decode_data_uri(std::string_view uri, const std::string& place);

}  // namespace afterglow::gltf
