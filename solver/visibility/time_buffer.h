#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "solver/visibility/ray_caster.h"

namespace afterglow {

/// The actor faces that sixteen fixed rays meet over some consecutive frames: for each ray a depth buffer
/// whose pixels are the frames. Faces are put in one by one, in any order; the nearest stays. Frames count
/// from 0 here. Source: DESIGN of the exact intervals as lower envelopes in the plane of time and distance,
/// sampled where frames are.
class TimeBuffer {
  public:
    /// A face: which actor, which triangle.
    struct Face {
        Index body = no_index;
        Index triangle = no_index;
        bool operator==(const Face&) const = default;
    };

    /// `frames` 1 or more.
    explicit TimeBuffer(int frames) : frames_(frames), depth_m_(16 * size(frames)), face_(16 * size(frames)) {
        clear({});
    }

    [[nodiscard]] int frames() const { return frames_; }

    /// Empties the buffer; what lies at `rays.far` or beyond is not seen.
    void clear(const RayPacket& rays) {
        first_.fill(0);
        last_.fill(-1);
        far_m_ = rays.far;
    }

    /// Puts in a face that a lane meets at `depth_m` in one frame.
    void put(std::size_t lane, int frame, float depth_m, const Face& face) {
        if (!(depth_m > 0) || !(depth_m < far_m_[lane])) return;
        open(lane, frame);
        const std::size_t at = index(lane, frame);
        // Of two faces at one depth the earlier numbered stays, whatever the order they come in.
        const bool nearer = depth_m < depth_m_[at] || (depth_m == depth_m_[at] && before(face, face_[at]));
        if (!nearer) return;
        depth_m_[at] = depth_m;
        face_[at] = face;
    }

    /// The frames in which a lane may meet a face: first … last, none if last < first.
    [[nodiscard]] int first(std::size_t lane) const { return first_[lane]; }
    [[nodiscard]] int last(std::size_t lane) const { return last_[lane]; }

    /// What a lane meets in a frame from first to last; body no_index where nothing.
    [[nodiscard]] const Face& face(std::size_t lane, int frame) const { return face_[index(lane, frame)]; }
    [[nodiscard]] float depth_m(std::size_t lane, int frame) const { return depth_m_[index(lane, frame)]; }

  private:
    static std::size_t size(int frames) { return static_cast<std::size_t>(frames); }
    static bool before(const Face& a, const Face& b) {
        return a.body != b.body ? a.body < b.body : a.triangle < b.triangle;
    }
    [[nodiscard]] std::size_t index(std::size_t lane, int frame) const {
        return lane * size(frames_) + size(frame);
    }

    /// Makes sure that a frame lies between first and last; frames that come in between are emptied.
    void open(std::size_t lane, int frame) {
        if (last_[lane] < first_[lane]) {
            empty(lane, frame, frame);
            first_[lane] = last_[lane] = frame;
        }
        if (frame < first_[lane]) {
            empty(lane, frame, first_[lane] - 1);
            first_[lane] = frame;
        }
        if (frame > last_[lane]) {
            empty(lane, last_[lane] + 1, frame);
            last_[lane] = frame;
        }
    }
    void empty(std::size_t lane, int first, int last) {
        for (int frame = first; frame <= last; ++frame) {
            depth_m_[index(lane, frame)] = far_m_[lane];
            face_[index(lane, frame)] = {};
        }
    }

    int frames_;
    std::array<int, 16> first_{}, last_{};
    std::array<float, 16> far_m_{};
    std::vector<float> depth_m_;
    std::vector<Face> face_;
};

}  // namespace afterglow
