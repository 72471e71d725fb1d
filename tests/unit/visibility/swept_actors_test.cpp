#include "solver/visibility/swept_actors.h"

#include <random>

#include <gmock/gmock.h>

#include "tests/support/worlds.h"

namespace afterglow {
namespace {

using testing::Turning;

struct Differences {
    std::size_t line_frames = 0;
    std::size_t met = 0;
    std::size_t other_face = 0;  // and not at the same depth
};

RayPacket random_packet(std::mt19937& random, float spread, Index count) {
    std::uniform_real_distribution<float> place(0, 5), unit(0, 1);
    RayPacket rays;
    rays.count = count;
    const Vec3 from(place(random), place(random), place(random));
    const Vec3 to(place(random), place(random), place(random));
    for (std::size_t l = 0; l < count; ++l) {
        const Vec3 origin = from + spread * Vec3(unit(random), unit(random), unit(random));
        const Vec3 end = to + spread * Vec3(unit(random), unit(random), unit(random));
        rays.set(l, {origin, glm::normalize(end - origin), l % 5 == 4 ? 1.5F : 1e30F});
    }
    return rays;
}

bool shows(const ConvexFace& face, const Hit& hit) {
    return face.triangle == hit.triangle || face.second_triangle == hit.triangle;
}

void compare_frame(const RayCaster& caster, const SweptActors& swept, const RayPacket& rays,
                   const TimeBuffer& buffer, int f, Differences& out) {
    for (std::size_t l = 0; l < rays.count; ++l) {
        const Hit hit = caster.nearest(rays.ray(l), Scope::actors);
        const bool open = buffer.first(l) <= f && f <= buffer.last(l);
        const Index number = open ? buffer.faces(l)[static_cast<std::size_t>(f)] : no_index;
        const Index body = number == no_index ? no_index : swept.face(number).body;
        ++out.line_frames;
        out.met += hit.body != no_index ? 1U : 0U;
        if (body == hit.body && (body == no_index || shows(swept.face(number).shape, hit))) continue;
        const bool both = body != no_index && hit.body != no_index;
        if (both && std::abs(buffer.depths_m(l)[static_cast<std::size_t>(f)] - hit.distance) < 1e-4F)
            continue;
        ++out.other_face;
    }
}

/// Every lane in every frame against the ray caster.
Differences compare(const World& world, const FrameClock& clock, const FrameSpan& frames, unsigned seed,
                    int packets) {
    const ActorTrees trees = make_actor_trees(world);
    const SweptActors swept(world, trees, clock, frames);
    RayCaster caster(world);
    std::mt19937 random(seed);
    std::vector<RayPacket> rays;
    std::vector<TimeBuffer> buffers;
    for (int p = 0; p < packets; ++p) {
        rays.push_back(random_packet(random, 0.3F * static_cast<float>(p % 4), 16 - p % 3));
        buffers.emplace_back(frames.count());
        buffers.back().clear(rays.back());
        swept.trace(rays.back(), buffers.back());
    }
    Differences out;
    for (int f = 0; f < frames.count(); ++f) {
        caster.set_poses(poses_at(world, clock.time_of(frames.first + f)));
        for (std::size_t p = 0; p < rays.size(); ++p)
            compare_frame(caster, swept, rays[p], buffers[p], f, out);
    }
    return out;
}

World crowd(unsigned seed, int actors, Turning turning) {
    World world = testing::empty_world();
    std::mt19937 random(seed);
    Box box;
    box.add(Vec3(0));
    box.add(Vec3(5));
    std::uniform_real_distribution<float> size(0.02F, 0.8F);
    for (int k = 0; k < actors; ++k)
        testing::add_actor(world, "actor", Vec3(size(random), size(random), size(random)), 0,
                           testing::random_path(random, box, 1 + k % 3, turning));
    testing::add_ball(world.bodies.back(), Vec3(0), 0.9F, 2, 0);
    return world;
}

TEST(SweptActors, MeetWhatTheRayCasterMeetsInEveryFrame) {
    for (const Turning turning : {Turning::no, Turning::yes}) {
        for (unsigned seed = 1; seed <= 4; ++seed) {
            const World world = crowd(seed, static_cast<int>(3 * seed), turning);
            const Differences found = compare(world, {10}, {0, 40}, seed, 60);
            EXPECT_GT(found.met, found.line_frames / 100);
            EXPECT_LE(found.other_face, found.line_frames / 100'000) << "of " << found.line_frames;
        }
    }
}

TEST(SweptActors, MeetTheSameInAnyWindow) {
    const World world = crowd(9, 5, Turning::no);
    EXPECT_EQ(compare(world, {10}, {7, 7}, 1, 40).other_face, 0U);
    EXPECT_EQ(compare(world, {10}, {13, 19}, 2, 40).other_face, 0U);
    EXPECT_EQ(compare(world, {10}, {1000, 1003}, 3, 40).other_face, 0U);
}

/// A wall 0.2 m thick that runs along x past the lines x = 0, z > 0.
World sliding_wall(const Vec3& velocity) {
    World world = testing::empty_world();
    Path path;
    path.keys = {{0, {Vec3(0, 0, 2) - velocity, {1, 0, 0, 0}}},
                 {2, {Vec3(0, 0, 2) + velocity, {1, 0, 0, 0}}}};
    testing::add_actor(world, "wall", Vec3(0.25F, 1, 0.1F), 0, path);
    return world;
}

std::vector<float> depths_along_z(const World& world, int frames, const Vec3& direction = Vec3(0, 0, 1)) {
    const ActorTrees trees = make_actor_trees(world);
    const SweptActors swept(world, trees, {8}, {0, frames - 1});
    TimeBuffer buffer(frames);
    RayPacket rays;
    rays.count = 1;
    rays.set(0, {Vec3(0), direction, 100});
    buffer.clear(rays);
    swept.trace(rays, buffer);
    std::vector<float> depths;
    for (int f = 0; f < frames; ++f) {
        const bool met = buffer.first(0) <= f && f <= buffer.last(0) &&
                         buffer.faces(0)[static_cast<std::size_t>(f)] != no_index;
        depths.push_back(met ? buffer.depths_m(0)[static_cast<std::size_t>(f)] : 0);
    }
    return depths;
}

TEST(SweptActors, AreSeenExactlyWhileTheyCover) {
    // The wall's middle is at x = (f - 8) / 8: it covers x = 0 while |x| <= 1/4, its edges on frames 6
    // and 10.
    const auto depths = depths_along_z(sliding_wall(Vec3(1, 0, 0)), 17);
    for (int f = 0; f < 17; ++f)
        EXPECT_NEAR(depths[static_cast<std::size_t>(f)], std::abs(f - 8) <= 2 ? 1.9F : 0.0F, 1e-5F) << f;
}

TEST(SweptActors, ThatComeAlongTheRayChangeDepthOnly) {
    const auto depths = depths_along_z(sliding_wall(Vec3(0, 0, 1)), 17);
    for (int f = 0; f < 17; ++f)
        EXPECT_NEAR(depths[static_cast<std::size_t>(f)], 0.9F + 0.125F * static_cast<float>(f), 1e-5F) << f;
}

TEST(SweptActors, InWhosePlaneTheRayLiesAreDefined) {
    // The ray runs within the wall's side x = 1/4 when that passes 0: seen or not, but no nonsense.
    const auto depths = depths_along_z(sliding_wall(Vec3(0, 1, 0)), 17);
    for (const float depth : depths) EXPECT_TRUE(depth == 0 || std::abs(depth - 1.9F) < 1e-5F) << depth;
}

TEST(SweptActors, ThatJumpPastARayLeaveNoTrace) {
    World world = testing::empty_world();
    Path path;
    const Quat level(1, 0, 0, 0);
    path.keys = {
        {0, {Vec3(-3, 0, 2), level}}, {0.55, {Vec3(-3, 0, 2), level}}, {0.56, {Vec3(3, 0, 2), level}}};
    testing::add_actor(world, "fast", Vec3(0.25F, 1, 0.1F), 0, path);
    for (const float depth : depths_along_z(world, 17)) EXPECT_EQ(depth, 0);
}

TEST(SweptActors, OfNoFacesAreNeverMet) {
    World world = testing::empty_world();
    Path path;
    path.keys = {{0, {Vec3(0), {1, 0, 0, 0}}}, {1, {Vec3(1), glm::angleAxis(1.0F, Vec3(0, 1, 0))}}};
    Body empty;
    empty.name = "empty";
    empty.path = path;
    world.bodies.push_back(empty);
    for (const float depth : depths_along_z(world, 17)) EXPECT_EQ(depth, 0);
}

}  // namespace
}  // namespace afterglow
