#include "solver/scene/default_camera.h"

#include <cmath>

#include "solver/scene/enclosure.h"

namespace afterglow {

namespace {

Box bounds_of(const World& world) {
    Box box;
    for (const Body& body : world.bodies) {
        const Pose pose = body.path.at(0);
        for (const Triangle& triangle : body.triangles)
            for (const Index vertex : triangle.vertices) box.add(pose.point(body.positions[vertex]));
    }
    return box;
}

}  // namespace

Quat looking_at(const Vec3& from, const Vec3& to, const Vec3& up) {
    const Vec3 z = glm::normalize(from - to);
    Vec3 x = glm::cross(up, z);
    // Looking straight along `up`: any direction across will do, but always the same one.
    if (!(glm::length(x) > 1e-6F * glm::length(up))) x = Frame(z).x;
    x = glm::normalize(x);
    return glm::normalize(glm::quat_cast(glm::mat3(x, glm::cross(z, x), z)));
}

void add_default_camera(Scene& scene, const World& world) {
    const Box box = bounds_of(world);
    const Vec3 centre = box.centre();
    Camera camera{"default", 1.0F};
    Node node;
    node.name = camera.name;
    if (is_enclosed(world, centre)) {
        node.local.translation = centre + 0.45F * box.extent() * Vec3(1, 0.6F, 1);
        camera.vertical_angle = 1.2F;
    } else {
        const float radius = 0.5F * glm::length(box.extent());
        const Vec3 towards = glm::normalize(Vec3(0.35F, 0.3F, 1));
        node.local.translation = centre + towards * (1.05F * radius / std::sin(camera.vertical_angle / 2));
    }
    node.local.rotation = looking_at(node.local.translation, centre);
    node.camera = static_cast<Index>(scene.cameras.size());
    scene.cameras.push_back(camera);
    scene.nodes.push_back(node);
}

}  // namespace afterglow
