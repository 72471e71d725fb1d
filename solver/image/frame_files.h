#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "solver/base/pixels.h"

namespace afterglow {

/// The name of a frame's file without its ending: "frame_0007"; more digits past frame 9999.
/// `frame`: 0 or more. Thread-safety: pure.
std::string frame_stem(int frame);

/// Writes a finished frame into `folder`, which is made where it does not exist: linear radiance as
/// frame_NNNN.exr and the displayed picture (`srgb`, width × height × 3) as frame_NNNN.png. Readers see a
/// whole file or none, and where there is a .png there is its .exr. Errors: io. Thread-safety: different
/// frames may be written at once.
void write_frame(const std::filesystem::path& folder, int frame, const Picture& radiance,
                 const std::vector<std::uint8_t>& srgb);

}  // namespace afterglow
