#pragma once

#include <string>
#include <string_view>

namespace afterglow {

/// Frames of a job, both included, 0 ≤ first ≤ last.
struct FrameRange {
    int first = 0;
    int last = 0;
    bool operator==(const FrameRange&) const = default;
};

/// Reads "A-B", or "A" for a single frame; up to frame 9,999,999. Errors: invalid_input at `place` (an option
/// or a field). Thread-safety: pure.
FrameRange frame_range(const std::string& place, std::string_view text);

}  // namespace afterglow
