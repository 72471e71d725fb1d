#include "solver/image/visible_surfaces.h"

#include <algorithm>

#include <gmock/gmock.h>

#include "tests/support/actors.h"
#include "tests/support/brute_force.h"

namespace afterglow {
namespace {

using testing::Movements;

enum class Observer { fixed, moving };

World watched_world(unsigned seed, Observer observer) {
    World world = testing::random_world(seed, 2 + static_cast<int>(seed % 6), Movements::turning);
    Path& camera = world.cameras.front().path;
    camera.keys.front().value.translation = Vec3(2, 1.5F, 4.7F);
    if (observer == Observer::moving)
        camera.keys.push_back({3, {Vec3(1, 2, 3), glm::angleAxis(0.5F, Vec3(0, 1, 0))}});
    return world;
}

struct Shown {
    std::vector<SortedFace> faces;
    ItemBuffer buffer;
    CameraView view;
};

Shown show(const World& world, const ObserverSight& sight, double time_s, int size) {
    Shown shown;
    shown.faces = sorted_faces(sight);
    shown.view = view_at(world.cameras.front(), time_s, size, size);
    shown.buffer = draw(shown.view, placed(world, shown.faces, time_s));
    return shown;
}

/// Pixels that show another body or another place than a ray does.
int differences(const World& world, const Shown& shown, double time_s) {
    const std::vector<Pose> poses = poses_at(world, time_s);
    int different = 0;
    for (int y = 0; y < shown.view.height; ++y) {
        for (int x = 0; x < shown.view.width; ++x) {
            const Ray ray = shown.view.ray(static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F);
            const Hit hit = testing::nearest_by_brute_force(world, poses, ray, Scope::everything);
            const Index item = shown.buffer.at(x, y);
            if (item == no_index || hit.body == no_index)
                different += item == no_index && hit.body == no_index ? 0 : 1;
            else
                different +=
                    shown.faces[item].body == hit.body && shown.faces[item].triangle == hit.triangle ? 0 : 1;
        }
    }
    return different;
}

class VisibleSurfacesFor : public ::testing::TestWithParam<Observer> {};

TEST_P(VisibleSurfacesFor, TheObserverAreWhatRaysMeet) {
    constexpr int size = 48;
    int different = 0, pixels = 0;
    std::uint64_t front_to_back = 0, back_to_front = 0;
    for (unsigned seed = 1; seed <= 6; ++seed) {
        const World world = watched_world(seed, GetParam());
        ObserverSight sight = make_observer_sight(world, find_surfaces(world), world.cameras.front().path);
        for (const double time : {0.0, 0.4, 0.9, 1.0, 1.7, 2.6, 3.4, 0.2}) {
            update(sight, time);
            const Shown shown = show(world, sight, time, size);
            different += differences(world, shown, time);
            pixels += size * size;
            front_to_back += shown.buffer.interpolations;
            std::vector<SortedFace> reversed = shown.faces;
            std::reverse(reversed.begin(), reversed.end());
            const ItemBuffer painted = draw(shown.view, placed(world, reversed, time));
            back_to_front += painted.interpolations;

            const std::vector<SortedFace> visible = visible_faces(shown.faces, shown.buffer);
            EXPECT_LE(visible.size(), shown.faces.size());
            EXPECT_FALSE(visible.empty());
        }
    }
    // Pixels whose centres lie on an edge are ties.
    EXPECT_LE(different, pixels / 10000);
    EXPECT_LT(front_to_back, back_to_front);
    EXPECT_GE(front_to_back, static_cast<std::uint64_t>(pixels) * 9 / 10);
    RecordProperty("different", different);
    RecordProperty("pixels", pixels);
    RecordProperty("front_to_back", std::to_string(front_to_back));
    RecordProperty("back_to_front", std::to_string(back_to_front));
}

TEST_P(VisibleSurfacesFor, TheObserverAreSortedAsIfAnew) {
    const World world = watched_world(4, GetParam());
    const Surfaces surfaces = find_surfaces(world);
    const Path& camera = world.cameras.front().path;
    ObserverSight sight = make_observer_sight(world, surfaces, camera);
    for (const double time : {0.3, 0.31, 1.0, 2.2, 4.0, 1.5}) {
        update(sight, time);
        ObserverSight fresh = make_observer_sight(world, surfaces, camera);
        update(fresh, time);
        EXPECT_EQ(sight.graph.levels, fresh.graph.levels);
        const auto a = sorted_faces(sight), b = sorted_faces(fresh);
        ASSERT_EQ(a.size(), b.size());
        for (std::size_t k = 0; k < a.size(); ++k) {
            EXPECT_EQ(a[k].body, b[k].body);
            EXPECT_EQ(a[k].triangle, b[k].triangle);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Observers, VisibleSurfacesFor, ::testing::Values(Observer::fixed, Observer::moving));

TEST(VisibleSurfaces, OfAChainAreDrawnOnceEach) {
    // Three boards behind each other: front to back every pixel is interpolated once.
    World world = testing::empty_world();
    for (int k = 0; k < 3; ++k) {
        Path path;
        path.keys = {{0, {Vec3(0, 0, -2.0F - static_cast<float>(2 - k)), Quat(1, 0, 0, 0)}}};
        Body& body = world.bodies.emplace_back();
        body.path = path;
        testing::add_quad(body, Vec3(-9, -9, 0), Vec3(18, 0, 0), Vec3(0, 18, 0), 0);
    }
    const ObserverSight sight = make_observer_sight(world, find_surfaces(world), world.cameras.front().path);
    const auto faces = sorted_faces(sight);
    ASSERT_EQ(faces.size(), 6U);
    EXPECT_EQ(faces.front().body, 3U);
    EXPECT_EQ(faces.back().body, 1U);
    const CameraView view = view_at(world.cameras.front(), 0, 17, 17);
    EXPECT_EQ(draw(view, placed(world, faces, 0)).interpolations, 17U * 17U);
    std::vector<SortedFace> reversed(faces.rbegin(), faces.rend());
    EXPECT_EQ(draw(view, placed(world, reversed, 0)).interpolations, 3U * 17U * 17U);
    EXPECT_EQ(visible_faces(faces, draw(view, placed(world, faces, 0))).size(), 2U);
}

TEST(VisibleSurfaces, AtRestNothingIsDone) {
    const World world = watched_world(3, Observer::fixed);
    ObserverSight sight = make_observer_sight(world, find_surfaces(world), world.cameras.front().path);
    update(sight, 50);
    const ObserverWork work = update(sight, 60);
    EXPECT_EQ(work.graph.events, 0U);
    EXPECT_EQ(work.trees.nodes_visited, 0U);
}

}  // namespace
}  // namespace afterglow
