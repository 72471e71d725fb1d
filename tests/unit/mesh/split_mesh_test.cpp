#include <random>

#include <gmock/gmock.h>

#include "solver/mesh/interpolation.h"
#include "solver/mesh/patch_mesh.h"
#include "tests/support/worlds.h"

// Meshes of floors on which something stands: patches and interpolation keep to one side of it.

namespace afterglow {
namespace {

using testing::add_quad;
using testing::empty_world;

constexpr float edge_m = 4;

/// A floor, turned somehow, and sheets that stand on it or pierce it.
struct Floor {
    World world = empty_world();
    Vec3 corner{1, 2, 3}, x, y, up;
    std::vector<std::pair<Vec3, Vec3>> across;  ///< sheets from border to border: a place and the normal

    explicit Floor(std::mt19937& random) {
        std::normal_distribution<float> normal;
        const Frame frame(glm::normalize(Vec3(normal(random), normal(random), normal(random))));
        x = frame.x;
        y = frame.y;
        up = frame.z;
        add_quad(world.bodies[furniture], corner, edge_m * x, edge_m * y, 0);
    }
    [[nodiscard]] Vec3 at(float u, float v) const { return corner + edge_m * (u * x + v * y); }
    void add_sheet(const Vec3& from, const Vec3& to, float depth) {
        add_quad(world.bodies[furniture], from - depth * up, to - from, (1 + depth) * up, 0);
    }
    /// From border to border, and a little beyond.
    void add_divider(std::mt19937& random) {
        std::uniform_real_distribution<float> some(0.1F, 0.9F);
        const bool turned = random() % 2 == 0;
        const float a = some(random), b = some(random);
        const Vec3 from = turned ? at(a, 0) : at(0, a), to = turned ? at(b, 1) : at(1, b);
        const Vec3 beyond = 0.01F * (to - from);
        add_sheet(from - beyond, to + beyond, random() % 2 == 0 ? 0 : 0.3F);
        across.emplace_back(from, glm::normalize(glm::cross(to - from, up)));
    }
    void add_screen(std::mt19937& random) {
        std::uniform_real_distribution<float> some(0.1F, 0.9F);
        const float a = some(random), b = some(random), c = some(random), d = some(random);
        add_sheet(at(a, b), at(c, d), 0);
    }
    /// On which side of each divider a place lies.
    [[nodiscard]] std::vector<bool> sides_of(const Vec3& p) const {
        std::vector<bool> sides;
        for (const auto& [place, normal] : across) sides.push_back(glm::dot(p - place, normal) > 0);
        return sides;
    }
    [[nodiscard]] std::string distances_of(const Vec3& p) const {
        std::string text;
        for (const auto& [place, normal] : across) text += std::to_string(glm::dot(p - place, normal)) + " ";
        return text;
    }
};

PatchMesh mesh_of(const Floor& floor, float size, const CoarsenessTest& test = {}) {
    Surfaces surfaces = find_surfaces(floor.world);
    SideMask mask(surfaces.list.size(), {false, false});
    mask[0][0] = true;
    return make_patches(floor.world, std::move(surfaces), mask, {size, 0.049F, test});
}

Floor random_floor(std::mt19937& random) {
    Floor floor(random);
    const auto dividers = random() % 4, screens = random() % 4;
    for (unsigned k = 0; k < dividers; ++k) floor.add_divider(random);
    for (unsigned k = 0; k < screens; ++k) floor.add_screen(random);
    return floor;
}

/// Some cells are halved, whatever stands there.
bool is_coarse_here(const PatchShape& part, Index, Side) {
    return std::sin(5 * part.centre.x) + std::sin(7 * part.centre.y + part.centre.z) > 0.9F;
}

constexpr int floors = 60;

TEST(SplitMesh, PatchesStillCoverTheFloor) {
    std::mt19937 random(1);
    for (int k = 0; k < floors; ++k) {
        const Floor floor = random_floor(random);
        const PatchMesh mesh = mesh_of(floor, 0.37F, is_coarse_here);
        double area = 0;
        for (const float a : mesh.area_m2) area += static_cast<double>(a);
        EXPECT_NEAR(area, edge_m * edge_m, 1e-5 * edge_m * edge_m) << "floor " << k;
    }
}

TEST(SplitMesh, NoPatchLiesOnBothSidesOfADivider) {
    std::mt19937 random(2);
    int split = 0;
    for (int k = 0; k < floors; ++k) {
        const Floor floor = random_floor(random);
        const PatchMesh mesh = mesh_of(floor, 0.37F, is_coarse_here);
        for (Index p = 0; p < mesh.size(); ++p) {
            const auto sides = floor.sides_of(mesh.centre[p]);
            for (int i = 0; i < 64; ++i) {
                const float s = (static_cast<float>(i % 8) + 0.01F) / 7.1F;
                const float t = (static_cast<float>(i / 8) + 0.01F) / 7.1F;
                const Vec3 at = mesh.point_on(p, s, t).position;
                ASSERT_EQ(floor.sides_of(at), sides)
                    << "floor " << k << ", patch " << p << " of " << mesh.area_m2[p] << " m2, lift "
                    << mesh.lift_m << ", distances " << floor.distances_of(at) << " and "
                    << floor.distances_of(mesh.centre[p]);
            }
            split += mesh.first_fragment[p] != mesh.first_fragment[p + 1] ? 1 : 0;
        }
    }
    EXPECT_GT(split, 1000);
}

TEST(SplitMesh, PointsOfAPatchLeadBackToIt) {
    std::mt19937 random(3);
    int lost = 0, all = 0;
    for (int k = 0; k < floors; ++k) {
        const Floor floor = random_floor(random);
        const PatchMesh mesh = mesh_of(floor, 0.37F, is_coarse_here);
        for (Index p = 0; p < mesh.size(); ++p, ++all)
            if (mesh.patch_at(furniture, 0, Side::front, mesh.point_on(p, 0.37F, 0.61F).position) != p)
                ++lost;
    }
    EXPECT_LE(lost, all / 1000) << "but for rounding at the borders of cells";
}

TEST(SplitMesh, InterpolationStaysOnItsSide) {
    std::mt19937 random(4);
    std::uniform_real_distribution<float> some(0, 1);
    int answered = 0;
    for (int k = 0; k < floors; ++k) {
        const Floor floor = random_floor(random);
        const PatchMesh mesh = mesh_of(floor, 0.37F, is_coarse_here);
        const Interpolation interpolation(floor.world, mesh);
        for (int i = 0; i < 300; ++i) {
            const Vec3 at = floor.at(some(random), some(random));
            const Stencil stencil = interpolation.at(furniture, 0, Side::front, at);
            EXPECT_LT(stencil.count, Stencil::most) << "some neighbours may have been left out";
            for (const PatchWeight& entry : stencil.patches())
                ASSERT_EQ(floor.sides_of(mesh.centre[entry.patch]), floor.sides_of(at)) << "floor " << k;
            answered += stencil.count > 0 ? 1 : 0;
        }
    }
    EXPECT_EQ(answered, 300 * floors);
}

TEST(SplitMesh, ARayThatSlipsUnderADividerHasNoPatch) {
    std::mt19937 random(5);
    Floor floor(random);
    floor.add_sheet(floor.at(0.43F, -0.1F), floor.at(0.43F, 1.1F), 0);
    const PatchMesh mesh = mesh_of(floor, 0.4F);
    const Vec3 foot = floor.at(0.43F, 0.4F), down = glm::normalize(floor.x - floor.up);
    EXPECT_TRUE(mesh.slipped(0, Side::front, foot + 0.5F * mesh.lift_m * floor.x, down));
    EXPECT_FALSE(mesh.slipped(0, Side::front, foot + 5 * mesh.lift_m * floor.x, down));
    EXPECT_FALSE(mesh.slipped(0, Side::front, foot - 0.5F * mesh.lift_m * floor.x, down));
}

TEST(SplitMesh, AScreenThatEndsMidFloorIsSeenPastItsEnd) {
    std::mt19937 random(6);
    Floor floor(random);
    floor.add_sheet(floor.at(0.5125F, 0), floor.at(0.5125F, 0.51F), 0);
    const PatchMesh mesh = mesh_of(floor, 0.4F);
    const Interpolation interpolation(floor.world, mesh);
    const auto reaches_across = [&](float v) {
        const Stencil stencil = interpolation.at(furniture, 0, Side::front, floor.at(0.5F, v));
        for (const PatchWeight& entry : stencil.patches())
            if (glm::dot(mesh.centre[entry.patch] - floor.at(0.5125F, 0), floor.x) > 0) return true;
        return false;
    };
    EXPECT_FALSE(reaches_across(0.3F));
    EXPECT_TRUE(reaches_across(0.7F));
    EXPECT_LT(mesh.size(), 110U) << "100 cells, five or six of which are split";
}

}  // namespace
}  // namespace afterglow
