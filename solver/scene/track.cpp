#include "solver/scene/keys.h"
#include "solver/scene/scene.h"

namespace afterglow {

Vec3 value_at(const Track<Vec3>& track, double time_s) {
    return value_in<Vec3>(track.keys, time_s);
}

Quat value_at(const Track<Quat>& track, double time_s) {
    return value_in<Quat>(track.keys, time_s);
}

float value_at(const Track<float>& track, double time_s) {
    return value_in<float>(track.keys, time_s);
}

Mat4 Transform::matrix() const {
    Mat4 m = glm::mat4_cast(rotation);
    for (int axis = 0; axis < 3; ++axis) m[axis] *= scale[axis];
    m[3] = glm::vec4(translation, 1);
    return m;
}

}  // namespace afterglow
