#include "solver/scene/keys.h"
#include "solver/scene/world.h"

namespace afterglow {

Mat4 Pose::matrix() const {
    return Transform{translation, rotation, Vec3(1)}.matrix();
}

Pose Path::at(double time_s) const {
    return keys.empty() ? Pose{} : value_in<Pose>(keys, time_s);
}

Material material_at(const World& world, Index material, double time_s) {
    Material out = world.materials.at(material);
    for (const auto& track : world.material_emission)
        if (track.target == material) out.emission *= value_at(track, time_s);
    for (const auto& track : world.material_reflectance)
        if (track.target == material) out.reflectance = value_at(track, time_s);
    return out;
}

}  // namespace afterglow
