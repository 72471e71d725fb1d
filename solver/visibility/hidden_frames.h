#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "solver/visibility/time_buffer.h"

namespace afterglow {

/// In which of some consecutive frames each of sixteen fixed rays is blocked before its end: one bit a frame,
/// where it does not matter by what. Frames count from 0.
class HiddenFrames {
  public:
    /// `frames` 1 or more.
    explicit HiddenFrames(int frames)
        : frames_(frames), words_((static_cast<std::size_t>(frames) + 63) / 64), bits_(16 * words_, 0) {}

    /// Empties it; what lies at `rays.far` or beyond blocks nothing.
    void clear(const RayPacket& rays) {
        for (std::size_t lane = 0; lane < 16; ++lane)
            if (hidden_[lane]) std::fill_n(&bits_[lane * words_], words_, 0);
        hidden_.fill(false);
        far_m_ = rays.far;
    }

    /// Puts in a face that a lane meets; frames in which it is not before the ray's end count for nothing.
    void put(std::size_t lane, const FaceRun& run) {
        if (run.last < run.first) return;
        const float moved = static_cast<float>(run.last - run.first) * run.along_m;
        hidden_[lane] = true;
        if (run.low_m + std::min(0.0F, moved) > 0 && run.high_m + std::max(0.0F, moved) < far_m_[lane]) {
            set(lane, run.first, run.last);
            return;
        }
        for (int f = run.first; f <= run.last; ++f) {
            const float at = run.depth_at(f - run.first);
            if (at > 0 && at < far_m_[lane]) set(lane, f, f);
        }
    }

    /// False only where a lane is blocked in no frame.
    [[nodiscard]] bool any(std::size_t lane) const { return hidden_[lane]; }

    /// Calls `change(frame, hidden)` for each frame in which a lane is blocked and was not before, or the
    /// other way round. Before the first frame it is open.
    template <class Change>
    void for_changes(std::size_t lane, const Change& change) const {
        std::uint64_t before = 0;
        for (std::size_t w = 0; w < words_; ++w) {
            const std::uint64_t word = bits_[lane * words_ + w];
            std::uint64_t changes = word ^ (word << 1U | before);
            for (; changes != 0; changes &= changes - 1) {
                const auto bit = static_cast<unsigned>(std::countr_zero(changes));
                const int frame = static_cast<int>(64 * w + bit);
                if (frame < frames_) change(frame, ((word >> bit) & 1U) != 0);
            }
            before = word >> 63U;
        }
    }

  private:
    void set(std::size_t lane, int first, int last) {
        std::uint64_t* const bits = &bits_[lane * words_];
        const auto a = static_cast<std::size_t>(first), b = static_cast<std::size_t>(last);
        for (std::size_t w = a / 64; w <= b / 64; ++w) {
            const std::uint64_t from = w == a / 64 ? ~std::uint64_t{0} << (a % 64) : ~std::uint64_t{0};
            const std::uint64_t to = w == b / 64 ? ~std::uint64_t{0} >> (63 - b % 64) : ~std::uint64_t{0};
            bits[w] |= from & to;
        }
    }

    int frames_;
    std::size_t words_;
    std::array<bool, 16> hidden_{};
    std::array<float, 16> far_m_{};
    std::vector<std::uint64_t> bits_;
};

}  // namespace afterglow
