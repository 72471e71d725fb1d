#include "solver/mesh/lift.h"

namespace afterglow {

namespace {

constexpr float lift_per_extent = 1e-5F;

}  // namespace

float lift_for(const World& world) {
    Box box;
    for (const Body& body : world.bodies)
        for (const Vec3& p : body.positions) box.add(body.path.at(0).point(p));
    return box.empty() ? 0 : lift_per_extent * glm::length(box.extent());
}

}  // namespace afterglow
