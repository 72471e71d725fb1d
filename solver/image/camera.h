#pragma once

#include "solver/scene/world.h"
#include "solver/visibility/ray_caster.h"

namespace afterglow {

/// A camera at one time, ready to make rays. Pixel (x, y) covers [x, x+1) × [y, y+1), y downwards.
struct CameraView {
    Vec3 position{0};
    Vec3 right{1, 0, 0}, up{0, 1, 0}, forward{0, 0, -1};  ///< unit
    float half_height = 1;                                ///< tangent of half the vertical angle
    int width = 1, height = 1;

    /// The ray through a point of the picture, in pixels from the top left.
    [[nodiscard]] Ray ray(float x, float y) const;
};

CameraView view_at(const PlacedCamera& camera, double time_s, int width, int height);

}  // namespace afterglow
