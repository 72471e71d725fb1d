#include "solver/image/camera.h"

#include <cmath>

namespace afterglow {

Ray CameraView::ray(float x, float y) const {
    const float pixel = 2 * half_height / static_cast<float>(height);
    const float across = (x - 0.5F * static_cast<float>(width)) * pixel;
    const float upwards = (0.5F * static_cast<float>(height) - y) * pixel;
    return {position, glm::normalize(forward + across * right + upwards * up)};
}

CameraView view_at(const PlacedCamera& camera, double time_s, int width, int height) {
    const Pose pose = camera.path.at(time_s);
    CameraView view;
    view.position = pose.translation;
    view.right = pose.direction(Vec3(1, 0, 0));
    view.up = pose.direction(Vec3(0, 1, 0));
    view.forward = pose.direction(Vec3(0, 0, -1));
    view.half_height = std::tan(0.5F * camera.camera.vertical_angle);
    view.width = width;
    view.height = height;
    return view;
}

}  // namespace afterglow
