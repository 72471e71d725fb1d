#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "solver/visibility/ray_caster.h"
#include "solver/visibility/tie.h"

namespace afterglow {

/// How the faces of a body are numbered, and from where on those of all actors are: with another actor's
/// faces it may be in a tie, see tie.h. The furniture is in none.
struct FaceNumbers {
    Index first = 0, end = no_index;
    Index actors = 0;

    [[nodiscard]] bool follow(Index other) const { return (other >= actors) & (other < first); }
    [[nodiscard]] bool precede(Index other) const { return (other >= end) & (other != no_index); }
};

/// How far off a face is while a ray meets it: `depth_m` in frame `first`, and further by `step_m` from frame
/// to frame, but always between `low_m` and `high_m` plus `along_m` for each frame since `first`.
struct FaceRun {
    Index face = 0;  ///< numbered as the user of the buffer likes
    int first = 0, last = 0;
    float depth_m = 0, step_m = 0;
    float low_m = 0, high_m = 0;
    float along_m = 0;
    FaceNumbers body = {};  ///< of the body whose face it is

    [[nodiscard]] float depth_at(int frames_on) const {
        const auto steps = static_cast<float>(frames_on);
        return std::min(std::max(depth_m + steps * step_m, low_m), high_m) + steps * along_m;
    }
};

/// The faces that sixteen fixed rays meet over some consecutive frames: for each ray a depth buffer whose
/// pixels are the frames. Faces are put in one by one, in any order; the nearest stays, and of two at the
/// same depth the one of the lower number, where "the same" is wider between two actors. This is the lower
/// envelope of the faces' cuts in the plane of time and distance, taken where frames are. Frames count from
/// 0.
class TimeBuffer {
  public:
    /// `frames` 1 or more.
    explicit TimeBuffer(int frames)
        : frames_(static_cast<std::size_t>(frames)),
          depth_m_(16 * frames_ + at_once),
          face_(16 * frames_ + at_once) {
        clear({});
    }

    /// Empties the buffer; what lies at `rays.far` or beyond is not seen.
    void clear(const RayPacket& rays) {
        first_.fill(0);
        last_.fill(-1);
        far_m_ = rays.far;
    }

    /// Puts in a face that a lane meets; frames in which it is not before the ray's end count for nothing.
    void put(std::size_t lane, const FaceRun& run) {
        if (run.last < run.first) return;
        open(lane, run.first, run.last);
        float* const depth = &depth_m_[index(lane, run.first)];
        Index* const face = &face_[index(lane, run.first)];
        const int count = run.last - run.first + 1;
        // So many at once, without branches, that it becomes vector code; what follows the run stays.
        for (int k = 0; k < count; k += at_once) {
            for (int j = k; j < k + at_once; ++j) {
                const float at = run.depth_at(j);
                const bool same = (at == depth[j]) & (face[j] != no_index);
                const float nearest = run.body.follow(face[j])    ? before_tie(depth[j])
                                      : run.body.precede(face[j]) ? after_tie(depth[j])
                                                                  : depth[j];
                const bool nearer = (j < count) & (at > 0) & ((at < nearest) | (same & (run.face < face[j])));
                depth[j] = nearer ? at : depth[j];
                face[j] = nearer ? run.face : face[j];
            }
        }
    }

    /// The frames in which a lane may meet a face: first … last, none if last < first.
    [[nodiscard]] int first(std::size_t lane) const { return first_[lane]; }
    [[nodiscard]] int last(std::size_t lane) const { return last_[lane]; }

    /// What a lane meets, by frame, from first to last; no_index where nothing.
    [[nodiscard]] std::span<const Index> faces(std::size_t lane) const {
        return {&face_[index(lane, 0)], frames_};
    }
    [[nodiscard]] std::span<const float> depths_m(std::size_t lane) const {
        return {&depth_m_[index(lane, 0)], frames_};
    }

  private:
    static constexpr int at_once = 8;

    [[nodiscard]] std::size_t index(std::size_t lane, int frame) const {
        return lane * frames_ + static_cast<std::size_t>(frame);
    }

    /// Makes sure that a run lies between first and last; frames that come in between are emptied.
    void open(std::size_t lane, int first, int last) {
        if (last_[lane] < first_[lane]) {
            empty(lane, first, last);
            first_[lane] = first;
            last_[lane] = last;
            return;
        }
        if (first < first_[lane]) {
            empty(lane, first, first_[lane] - 1);
            first_[lane] = first;
        }
        if (last > last_[lane]) {
            empty(lane, last_[lane] + 1, last);
            last_[lane] = last;
        }
    }
    void empty(std::size_t lane, int first, int last) {
        const auto begin = static_cast<std::ptrdiff_t>(index(lane, first));
        std::fill_n(depth_m_.begin() + begin, last - first + 1, far_m_[lane]);
        std::fill_n(face_.begin() + begin, last - first + 1, no_index);
    }

    std::size_t frames_;
    std::array<int, 16> first_{}, last_{};
    std::array<float, 16> far_m_{};
    std::vector<float> depth_m_;
    std::vector<Index> face_;
};

}  // namespace afterglow
