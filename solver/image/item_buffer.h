#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "solver/image/camera.h"

namespace afterglow {

/// A triangle as it stands in the world at the time of a picture.
struct PlacedTriangle {
    Vec3 a{0}, b{0}, c{0};
};

/// What stands nearest at every pixel's centre.
struct ItemBuffer {
    int width = 0, height = 0;
    std::vector<Index> item;    ///< by pixel, row by row from the top left: into the triangles, or no_index
    std::vector<double> depth;  ///< along the camera's axis, metres; infinite where there is nothing
    /// How often a pixel took a new item: what shading would have had to interpolate while drawing. Front to
    /// back this is little more than the pixels covered; back to front it is the depth complexity.
    std::uint64_t interpolations = 0;

    [[nodiscard]] Index at(int x, int y) const {
        return item[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                    static_cast<std::size_t>(x)];
    }
};

/// Draws triangles in the given order with a Z-buffer; both sides show. Any order gives the same picture,
/// except between items of equal depth, of which the first drawn stays. Nothing is clipped: edges are tested
/// in homogeneous form. Source: Olano and Greer 1997; the report's section 3. Thread-safety: pure.
ItemBuffer draw(const CameraView& view, std::span<const PlacedTriangle> triangles);

}  // namespace afterglow
