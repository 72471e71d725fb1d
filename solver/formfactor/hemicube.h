#pragma once

#include <array>
#include <span>
#include <vector>

#include "solver/formfactor/polygon.h"

namespace afterglow {

struct HemicubeConfig {
    int resolution = 256;  ///< pixels along an edge of the top face, even, 2 … 8192; sides are half as high
    double near_m = 1e-9;  ///< what is nearer than this along a face's axis is cut away; > 0
};

/// Where a hemicube stands. It is turned about the normal as Frame is.
struct HemicubeEye {
    Vec3d point{0};         ///< metres
    Vec3d normal{0, 0, 1};  ///< unit: the hemisphere it sees
};

/// Something to be seen from either side: planar, convex, three corners or more, in either order. Where
/// several are equally near, the first in the list is seen.
struct HemicubePolygon {
    std::span<const Vec3d> corners;  ///< metres; the caller's storage
    /// Several polygons may make one item. With no_index a polygon only hides what is behind it.
    Index item = 0;
};

/// What a hemicube sees. All factors, the sky and the hidden share sum to 1.
struct HemicubeView {
    std::vector<double> factor;  ///< form factor from the point to what is visible of each item, by item
    double sky = 0;              ///< share that sees nothing
    double hidden = 0;           ///< share that sees a polygon without item
};

/// Form factors of a point by projecting everything onto five faces of pixels, the nearest polygon at each
/// pixel's centre standing for the whole pixel. Pixels count by their exact form factors, so that all sum to
/// 1 to rounding. Whole pixels appear and vanish as things move: the error falls with the resolution (the
/// room's notes have figures) but each is a step. Source: Cohen and Greenberg 1985, "The hemi-cube"; depth is
/// linear in its inverse along a row, and polygons are cut to each face's pyramid before the projection.
/// Cost: O(polygons + pixels). Thread-safety: const after construction.
class Hemicube {
  public:
    /// Errors: invalid_input where the options are out of range.
    explicit Hemicube(const HemicubeConfig& config);

    /// `items` is one more than the largest item there may be. Polygons edge-on to the point are not seen.
    /// Errors: invalid_input where an item is too large or a polygon has fewer than three corners.
    [[nodiscard]] HemicubeView look(const HemicubeEye& eye, std::span<const HemicubePolygon> polygons,
                                    std::size_t items) const;

    /// The form factor of pixel (column, row) of the top face, and of a side face with row 0 at the horizon.
    [[nodiscard]] double top_delta(int column, int row) const { return top_[index(column, row)]; }
    [[nodiscard]] double side_delta(int column, int row) const { return side_[index(column, row)]; }
    [[nodiscard]] int resolution() const { return config_.resolution; }

  private:
    [[nodiscard]] std::size_t index(int column, int row) const {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(config_.resolution) +
               static_cast<std::size_t>(column);
    }

    HemicubeConfig config_;
    std::vector<double> top_, side_;  ///< by pixel, rows of `resolution`
};

}  // namespace afterglow
