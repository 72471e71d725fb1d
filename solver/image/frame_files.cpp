#include "solver/image/frame_files.h"

#include <system_error>

#include "solver/base/error.h"
#include "solver/base/file.h"

namespace afterglow {

std::string frame_stem(int frame) {
    std::string digits = std::to_string(frame);
    if (digits.size() < 4) digits.insert(0, 4 - digits.size(), '0');
    return "frame_" + digits;
}

void write_frame(const std::filesystem::path& folder, int frame, const Picture& radiance,
                 const std::vector<std::uint8_t>& srgb) {
    // Both are encoded before either is written, so that a failure to encode leaves nothing.
    const std::string exr = encode_exr(radiance);
    const std::string png = encode_png(radiance.width, radiance.height, srgb);
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) throw Error(ErrorKind::io, folder.string(), "cannot be made: " + error.message());
    const std::string stem = frame_stem(frame);
    write_file(folder / (stem + ".exr"), exr);
    write_file(folder / (stem + ".png"), png);
}

}  // namespace afterglow
