#pragma once

#include <array>
#include <cstdint>

#include "solver/visibility/sight_lines.h"

namespace afterglow {

/// The rays of one block's sight lines, for whoever makes many directions of it: its patches are looked up
/// once, and sixteen rays are made together. The same bits as SightLines::rays, which is made of it.
/// Thread-safety: const after construction; `lines` and its mesh must outlive it.
class BlockLines {
  public:
    /// `pose`: of the block's body.
    BlockLines(const SightLines& lines, std::size_t block, const Pose& pose);

    /// The rays of one direction, in world coordinates; far is infinite.
    void rays(Index direction, RayPacket& out) const;

  private:
    /// A vector for each patch.
    struct Vectors {
        alignas(64) std::array<float, 16> x{}, y{}, z{};
        void set(std::size_t lane, const Vec3& v) {
            x[lane] = v.x;
            y[lane] = v.y;
            z[lane] = v.z;
        }
    };
    [[nodiscard]] Ray ray_of_part(Index lane, const Sample4& sample, const Vec3& local) const;

    const SightLines* lines_;
    std::size_t block_;
    PatchBlock patches_;
    Pose pose_;
    Vectors origin_, edge_u_, edge_v_, lift_;  // of whole patches
    Vectors frame_x_, frame_y_, normal_;
    std::uint32_t parts_ = 0;  // bit k: patch k is no whole rectangle
};

}  // namespace afterglow
