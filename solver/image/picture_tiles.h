#pragma once

#include <vector>

#include "solver/image/camera.h"

namespace afterglow {

/// A picture in squares of pixels, numbered row by row; those at the right and the bottom may be cut off.
struct PictureTiles {
    static constexpr int edge = 4;  ///< pixels; a tile's pixels fill one packet of rays
    int across = 0, down = 0;

    PictureTiles() = default;
    PictureTiles(int width, int height)
        : across((width + edge - 1) / edge), down((height + edge - 1) / edge) {}
    [[nodiscard]] Index count() const { return static_cast<Index>(across * down); }
    [[nodiscard]] int left(Index tile) const { return static_cast<int>(tile) % across * edge; }
    [[nodiscard]] int top(Index tile) const { return static_cast<int>(tile) / across * edge; }
};

/// The tiles through which camera rays may meet a body that stands at a pose: those that its projected
/// triangles touch, rising. All tiles where a triangle reaches past the camera. Thread-safety:
/// pure.
std::vector<Index> tiles_covered(const CameraView& view, const PictureTiles& tiles, const Body& body,
                                 const Pose& pose);

}  // namespace afterglow
