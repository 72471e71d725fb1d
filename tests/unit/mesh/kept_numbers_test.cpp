#include "solver/mesh/kept_numbers.h"

#include <random>

#include <gmock/gmock.h>

#include "tests/support/worlds.h"

namespace afterglow {
namespace {

PatchMesh mesh_of(const World& world) {
    Surfaces surfaces = find_surfaces(world);
    const SideMask all(surfaces.list.size(), {true, true});
    return make_patches(world, std::move(surfaces), all, {.patch_size_m = 0.4F});
}

/// Room and walker, and boxes here and there.
World with_boxes(const std::vector<Vec3>& places) {
    World world = testing::small_room();
    for (const Vec3& low : places)
        testing::add_box(world.bodies[furniture], low, low + Vec3(0.45F, 0.3F, 0.6F), 0);
    return world;
}

bool same_patch(const PatchMesh& a, Index p, const PatchMesh& b, Index q) {
    return a.centre[p] == b.centre[q] && a.normal[p] == b.normal[q] && a.area_m2[p] == b.area_m2[q] &&
           a.point_on(p, 0.3F, 0.6F).position == b.point_on(q, 0.3F, 0.6F).position;
}

/// Every patch is found where its points lie.
void expect_found(const World& world, const PatchMesh& mesh, const PatchMesh& fresh) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> unit(0, 1);
    for (Index b = 0; b < world.bodies.size(); ++b)
        for (Index t = 0; t < world.bodies[b].triangles.size(); ++t) {
            float u = unit(random), v = unit(random);
            if (u + v > 1) {
                u = 1 - u;
                v = 1 - v;
            }
            const auto& corners = world.bodies[b].triangles[t].vertices;
            const auto& at = world.bodies[b].positions;
            const Vec3 place = (1 - u - v) * at[corners[0]] + u * at[corners[1]] + v * at[corners[2]];
            for (const Side side : {Side::front, Side::back}) {
                const Index p = mesh.patch_at(b, t, side, place), q = fresh.patch_at(b, t, side, place);
                ASSERT_EQ(p == no_index, q == no_index);
                ASSERT_TRUE(p == no_index || same_patch(mesh, p, fresh, q));
            }
        }
}

TEST(KeptNumbers, StayWhereNothingChanges) {
    const PatchMesh before = mesh_of(with_boxes({Vec3(3, 0, 1)}));
    PatchMesh mesh = mesh_of(with_boxes({Vec3(3, 0, 1)}));
    const auto kept = keep_numbers(before, mesh);
    EXPECT_THAT(kept, ::testing::Each(1));
    EXPECT_EQ(mesh.centre, before.centre);
}

TEST(KeptNumbers, OutliveWhatComesAndGoes) {
    const std::vector<std::vector<Vec3>> scenes{
        {},
        {Vec3(3, 0, 1)},
        {Vec3(1, 0, 3), Vec3(3, 0, 1)},
        {Vec3(1, 0, 3)},
        {Vec3(1, 1, 3), Vec3(2, 0.02F, 1.7F), Vec3(3, 2, 1)},
        {},
    };
    PatchMesh before = mesh_of(with_boxes(scenes[0]));
    for (const auto& places : scenes) {
        const World world = with_boxes(places);
        const PatchMesh fresh = mesh_of(world);
        PatchMesh mesh = fresh;
        const auto kept = keep_numbers(before, mesh);
        ASSERT_EQ(kept.size(), fresh.static_size());
        ASSERT_EQ(mesh.size(), fresh.size());
        std::size_t stay = 0;
        for (Index p = 0; p < kept.size(); ++p) {
            stay += kept[p];
            EXPECT_TRUE(kept[p] == 0 || same_patch(mesh, p, before, p));
        }
        EXPECT_GT(stay, 0.6 * static_cast<double>(kept.size()));
        for (Index p = mesh.static_size(); p < mesh.size(); ++p) EXPECT_TRUE(same_patch(mesh, p, fresh, p));
        expect_found(world, mesh, fresh);
        before = mesh;
    }
}

TEST(KeptNumbers, OfPatchesThatAreOneAndTheSameAreNotTold) {
    // Two boxes in one place: which of the two is meant nobody knows.
    const PatchMesh before = mesh_of(with_boxes({Vec3(2, 1, 2), Vec3(2, 1, 2)}));
    PatchMesh mesh = before;
    const auto kept = keep_numbers(before, mesh);
    EXPECT_THAT(kept, ::testing::Contains(0));
    EXPECT_THAT(kept, ::testing::Contains(1));
}

}  // namespace
}  // namespace afterglow
