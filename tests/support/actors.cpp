#include "tests/support/actors.h"

namespace afterglow::testing {

namespace {

Body& add_body(World& world, const std::string& name, Path path) {
    Body& body = world.bodies.emplace_back();
    body.name = name;
    body.path = std::move(path);
    return body;
}

Path carried(const Vec3& from, const Vec3& to, const Quat& rotation = Quat(1, 0, 0, 0)) {
    Path path;
    path.keys = {{0, {from, rotation}}, {2, {to, rotation}}};
    return path;
}

}  // namespace

void add_tetrahedron(Body& body, const Vec3& centre, float size, Index material) {
    const Vec3 a = centre + size * Vec3(1, 1, 1), b = centre + size * Vec3(1, -1, -1),
               c = centre + size * Vec3(-1, 1, -1), d = centre + size * Vec3(-1, -1, 1);
    add_triangle(body, a, b, c, material);
    add_triangle(body, a, c, d, material);
    add_triangle(body, a, d, b, material);
    add_triangle(body, b, d, c, material);
}

void add_ring(Body& body, const Vec3& centre, float radius, float thickness, Index material) {
    const float h = 0.5F * thickness;
    const auto corner = [&](int k, float half_edge, float z) {
        return centre + Vec3((k & 3) == 0 || (k & 3) == 3 ? half_edge : -half_edge,
                             (k & 3) < 2 ? half_edge : -half_edge, z);
    };
    const auto quad = [&](const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
        add_triangle(body, a, b, c, material);
        add_triangle(body, a, c, d, material);
    };
    const float inner = radius - thickness;
    for (int k = 0; k < 4; ++k) {
        quad(corner(k, inner, h), corner(k, radius, h), corner(k + 1, radius, h), corner(k + 1, inner, h));
        quad(corner(k, radius, -h), corner(k, inner, -h), corner(k + 1, inner, -h),
             corner(k + 1, radius, -h));
        quad(corner(k, radius, h), corner(k, radius, -h), corner(k + 1, radius, -h),
             corner(k + 1, radius, h));
        quad(corner(k, inner, -h), corner(k, inner, h), corner(k + 1, inner, h), corner(k + 1, inner, -h));
    }
}

World random_world(unsigned seed, int actors, Movements movements) {
    World world = small_room();
    world.bodies.pop_back();
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit(0, 1);
    Box near_room;
    near_room.add(Vec3(-0.7F));
    near_room.add(Vec3(4.7F, 3.5F, 5.7F));
    for (int k = 0; k < actors; ++k) {
        const Turning turning = movements == Movements::turning && k % 2 == 0 ? Turning::yes : Turning::no;
        Path path = random_path(random, near_room, 1 + static_cast<int>(4 * unit(random)), turning);
        // Rests and jumps.
        if (k % 4 == 1) path.keys.back().value = path.keys[path.keys.size() - 2].value;
        if (k % 5 == 2) path.keys[1].time_s = path.keys[0].time_s;
        Body& body = add_body(world, "actor", std::move(path));
        const float size = 0.1F + 0.25F * unit(random);
        switch (static_cast<int>(5 * unit(random))) {
            case 0:
                add_tetrahedron(body, Vec3(0), size, 0);
                break;
            case 1:
                add_ring(body, Vec3(0), 2 * size, 0.5F * size, 0);
                break;
            case 2:
                add_ball(body, Vec3(0), size, 1, 0);
                break;
            case 3:
                add_box(body, -Vec3(2 * size, size, 0.01F), Vec3(2 * size, size, 0.01F), 0);
                break;
            default:
                add_box(body, -Vec3(size, 2 * size, size), Vec3(size, 2 * size, size), 0);
                break;
        }
        // Some stand a long way off their origin: their turning sweeps far.
        if (k % 6 == 5)
            for (Vec3& p : body.positions) p += Vec3(0.6F, 0, 0);
    }
    world.duration_s = 4;
    return world;
}

World interlocked_rings() {
    World world = small_room();
    world.bodies.pop_back();
    const Vec3 way(1.5F, 0.2F, -1);
    Body& first = add_body(world, "ring", carried(Vec3(1, 1.4F, 3), Vec3(1, 1.4F, 3) + way));
    add_ring(first, Vec3(0), 0.5F, 0.1F, 0);
    const Quat upright = glm::angleAxis(pi / 2, Vec3(1, 0, 0));
    Body& second =
        add_body(world, "ring", carried(Vec3(1.45F, 1.4F, 3), Vec3(1.45F, 1.4F, 3) + way, upright));
    add_ring(second, Vec3(0), 0.5F, 0.1F, 0);
    world.duration_s = 2;
    return world;
}

World overlapping_bars() {
    World world = small_room();
    world.bodies.pop_back();
    const Vec3 way(0.3F, 0.4F, 0.5F);
    // Each bar passes over the next and under the one before, seen from above.
    for (int k = 0; k < 3; ++k) {
        const Quat turned = glm::angleAxis(2 * pi / 3 * static_cast<float>(k), Vec3(0, 1, 0)) *
                            glm::angleAxis(0.25F, Vec3(0, 0, 1));
        const Vec3 at = Vec3(2, 1.2F, 2.5F) + turned * Vec3(0, 0, 0.25F);
        Body& body = add_body(world, "bar", carried(at, at + way, turned));
        add_box(body, Vec3(-0.8F, -0.03F, -0.06F), Vec3(0.8F, 0.03F, 0.06F), 0);
    }
    world.duration_s = 2;
    return world;
}

}  // namespace afterglow::testing
