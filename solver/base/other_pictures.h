#pragma once

// Pictures of any format that textures come in. PNG and JPEG, which most have, are read by pixels; TIFF, BMP,
// TGA, WebP and GIF by OpenImageIO. That library brings 250 others, which take longer to load than a draft
// takes to compute; so it stands in a module of its own, loaded with the first such texture.

#include <string>
#include <string_view>

#include "solver/base/pixels.h"

namespace afterglow {

/// Decodes a picture of any of these formats. Errors: as decode_picture; unsupported where the module is
/// needed and missing. Thread-safety: any number of threads.
Bytes8 decode_texture(std::string_view bytes, const std::string& place);

/// Why a module's decoder gave no picture.
enum class DecodeFailure { none, unreadable, too_large, damaged };

/// What the module exports under the name `afterglow_decode_other_picture`. It throws nothing.
using DecodeOtherPicture = DecodeFailure(std::string_view bytes, Bytes8& out);

}  // namespace afterglow
