#include "tests/support/rooms.h"

namespace afterglow::testing {

namespace {

constexpr float length_m = 5, height_m = 2.6F, width_m = 4, wall_m = 0.1F;
constexpr float door_low_m = 2.7F, door_high_m = 3.6F, door_height_m = 2;

/// Where room r begins along x.
float start_of(int room) {
    return static_cast<float>(room) * (length_m + wall_m);
}

/// Floor, ceiling and the two long walls of one room or doorway, open at its ends.
void add_tube(Body& body, const Vec3& low, const Vec3& high) {
    const Vec3 x(high.x - low.x, 0, 0), y(0, high.y - low.y, 0), z(0, 0, high.z - low.z);
    add_quad(body, low, z, x, 0);
    add_quad(body, low + y, x, z, 0);
    add_quad(body, low, x, y, 0);
    add_quad(body, low + z, y, x, 0);
}

/// A wall across at one x, seen from +x or from −x, whole or with the door's hole.
void add_end(Body& body, float x, bool faces_positive_x, bool has_door) {
    const auto part = [&](float low_z, float high_z, float low_y, float high_y) {
        const Vec3 corner(x, low_y, low_z), y(0, high_y - low_y, 0), z(0, 0, high_z - low_z);
        if (faces_positive_x)
            add_quad(body, corner, y, z, 0);
        else
            add_quad(body, corner, z, y, 0);
    };
    if (!has_door) return part(0, width_m, 0, height_m);
    part(0, door_low_m, 0, height_m);
    part(door_high_m, width_m, 0, height_m);
    part(door_low_m, door_high_m, door_height_m, height_m);
}

/// From where it stands to where it looks.
Pose looking(const Vec3& from, const Vec3& to) {
    const Vec3 forward = glm::normalize(to - from);
    const Vec3 right = glm::normalize(glm::cross(forward, Vec3(0, 1, 0)));
    return {from, glm::quat_cast(glm::mat3(right, glm::cross(right, forward), -forward))};
}

Path walk(const RoomsConfig& config) {
    const float door_z = 0.5F * (door_low_m + door_high_m), eye = 1.6F;
    Path path;
    path.keys.push_back({0, looking(Vec3(3, eye, 1.5F), Vec3(0, 1.2F, 0.5F))});
    const double turn_s = 0.5 * config.seconds_a_room;
    path.keys.push_back({turn_s, looking(Vec3(3, eye, 1.5F), Vec3(0, 1.2F, 2.5F))});
    path.keys.push_back(
        {config.seconds_a_room, looking(Vec3(3.5F, eye, door_z), Vec3(length_m, 1.4F, door_z))});
    const float end = start_of(config.rooms - 1);
    path.keys.push_back({config.seconds_a_room * config.rooms,
                         looking(Vec3(end + 2, eye, door_z), Vec3(end + length_m, 1.4F, 2))});
    return path;
}

}  // namespace

World rooms_in_a_row(const RoomsConfig& config) {
    World world = empty_world(0.6F);
    world.materials.front().name = "wall";
    std::mt19937 random(config.seed);
    std::uniform_real_distribution<float> unit(0, 1);
    Body& body = world.bodies[furniture];
    for (int r = 0; r < config.rooms; ++r) {
        const float x = start_of(r);
        const bool is_last = r + 1 == config.rooms;
        add_tube(body, Vec3(x, 0, 0), Vec3(x + length_m, height_m, width_m));
        add_end(body, x, true, r > 0);
        add_end(body, x + length_m, false, !is_last);
        if (!is_last)
            add_tube(body, Vec3(x + length_m, 0, door_low_m),
                     Vec3(x + length_m + wall_m, door_height_m, door_high_m));
        add_box(body, Vec3(x + 2, height_m - 0.05F, 1.5F), Vec3(x + 3, height_m - 0.01F, 2.5F), 1);
        for (int k = 0; k < 4; ++k) {
            const auto material = static_cast<Index>(world.materials.size());
            world.materials.push_back(diffuse("box", Rgb(0.2F + 0.6F * unit(random))));
            // Out of the way of who walks through.
            const Vec3 low(x + 0.3F + 3.6F * unit(random), 0.01F, 0.2F + 1.2F * unit(random));
            add_box(body, low, low + Vec3(0.3F, 0.2F, 0.3F) + Vec3(0.4F, 1, 0.4F) * unit(random), material);
        }
    }
    world.cameras.front().path = walk(config);
    world.frames_per_second = 24;
    world.duration_s = config.seconds_a_room * config.rooms;
    return world;
}

}  // namespace afterglow::testing
