#include "tests/support/worlds.h"

#include <array>
#include <cmath>

namespace afterglow::testing {

void add_triangle(Body& body, const Vec3& a, const Vec3& b, const Vec3& c, Index material) {
    const auto first = static_cast<Index>(body.positions.size());
    for (const Vec3& p : {a, b, c}) {
        body.positions.push_back(p);
        body.texture_coordinates.emplace_back(0);
    }
    body.triangles.push_back({{first, first + 1, first + 2}, material});
}

namespace {

void add_ball_part(Body& body, const Vec3& centre, float radius, const std::array<Vec3, 3>& corners,
                   int levels, Index material) {
    const auto& [a, b, c] = corners;
    if (levels == 0) {
        add_triangle(body, centre + radius * a, centre + radius * b, centre + radius * c, material);
        return;
    }
    const Vec3 ab = glm::normalize(a + b), bc = glm::normalize(b + c), ca = glm::normalize(c + a);
    for (const auto& part :
         {std::array{a, ab, ca}, std::array{ab, b, bc}, std::array{ca, bc, c}, std::array{ab, bc, ca}})
        add_ball_part(body, centre, radius, part, levels - 1, material);
}

}  // namespace

Material diffuse(const std::string& name, Rgb reflectance, Rgb emission) {
    Material material;
    material.name = name;
    material.reflectance = reflectance;
    material.emission = emission;
    return material;
}

void add_quad(Body& body, const Vec3& corner, const Vec3& edge_u, const Vec3& edge_v, Index material) {
    const auto first = static_cast<Index>(body.positions.size());
    for (const Vec3& p : {corner, corner + edge_u, corner + edge_u + edge_v, corner + edge_v}) {
        body.positions.push_back(p);
        body.texture_coordinates.emplace_back(0);
    }
    body.triangles.push_back({{first, first + 1, first + 2}, material});
    body.triangles.push_back({{first, first + 2, first + 3}, material});
}

void add_box(Body& body, const Vec3& low, const Vec3& high, Index material, Facing facing) {
    const Vec3 x(high.x - low.x, 0, 0), y(0, high.y - low.y, 0), z(0, 0, high.z - low.z);
    const auto face = [&](const Vec3& corner, const Vec3& u, const Vec3& v) {
        if (facing == Facing::outwards)
            add_quad(body, corner, u, v, material);
        else
            add_quad(body, corner, v, u, material);
    };
    face(low, y, x);
    face(low + z, x, y);
    face(low, x, z);
    face(low + y, z, x);
    face(low, z, y);
    face(low + x, y, z);
}

void add_ball(Body& body, const Vec3& centre, float radius, int levels, Index material) {
    const float t = (1 + std::sqrt(5.0F)) / 2;
    const std::array<Vec3, 12> v{Vec3(-1, t, 0), Vec3(1, t, 0), Vec3(-1, -t, 0), Vec3(1, -t, 0),
                                 Vec3(0, -1, t), Vec3(0, 1, t), Vec3(0, -1, -t), Vec3(0, 1, -t),
                                 Vec3(t, 0, -1), Vec3(t, 0, 1), Vec3(-t, 0, -1), Vec3(-t, 0, 1)};
    constexpr std::array<std::array<int, 3>, 20> faces{
        {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
         {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
         {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}}};
    for (const auto& f : faces) {
        const auto corner = [&](std::size_t k) { return glm::normalize(v[static_cast<std::size_t>(f[k])]); };
        add_ball_part(body, centre, radius, {corner(0), corner(1), corner(2)}, levels, material);
    }
}

World empty_world(float reflectance, const Vec3& eye) {
    World world;
    world.name = "test";
    world.bodies.emplace_back().name = "furniture";
    world.materials = {diffuse("grey", Rgb(reflectance)), diffuse("lamp", Rgb(0), Rgb(1))};
    PlacedCamera camera;
    camera.camera.name = "camera";
    camera.camera.vertical_angle = 1.2F;
    camera.path.keys = {{0, {eye, Quat(1, 0, 0, 0)}}};
    world.cameras.push_back(camera);
    return world;
}

World small_room() {
    World world = empty_world(0.6F, Vec3(2, 1.5F, 4.7F));
    Body& room = world.bodies[furniture];
    add_box(room, Vec3(0), Vec3(4, 3, 5), 0, Facing::inwards);
    add_quad(room, Vec3(1.5F, 2.98F, 2), Vec3(1, 0, 0), Vec3(0, 0, 1), 1);
    add_box(room, Vec3(0.5F, 0.7F, 0.5F), Vec3(1.8F, 0.75F, 1.5F), 0);
    Path path;
    const Quat turned = glm::angleAxis(1.0F, Vec3(0, 1, 0));
    path.keys = {{0, {Vec3(0.6F, 0.9F, 3), Quat(1, 0, 0, 0)}},
                 {1, {Vec3(3.2F, 0.9F, 2.5F), turned}},
                 {2, {Vec3(3, 0.9F, 1), turned}}};
    add_actor(world, "walker", Vec3(0.25F, 0.8F, 0.15F), 0, path);
    world.duration_s = 2;
    return world;
}

Index add_actor(World& world, const std::string& name, const Vec3& half_size, Index material, Path path) {
    Body& body = world.bodies.emplace_back();
    body.name = name;
    body.path = std::move(path);
    add_box(body, -half_size, half_size, material);
    return static_cast<Index>(world.bodies.size() - 1);
}

Path random_path(std::mt19937& random, const Box& within, int segments, Turning turning) {
    std::uniform_real_distribution<float> unit(0, 1);
    Path path;
    for (int k = 0; k <= segments; ++k) {
        Pose pose;
        for (int a = 0; a < 3; ++a)
            pose.translation[a] = glm::mix(within.low[a], within.high[a], unit(random));
        if (turning == Turning::yes)
            pose.rotation = glm::angleAxis(
                2 * pi * unit(random), glm::normalize(Vec3(unit(random), unit(random), unit(random)) + 0.1F));
        path.keys.push_back({static_cast<double>(k), pose});
    }
    return path;
}

}  // namespace afterglow::testing
