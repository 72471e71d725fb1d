#include "solver/visibility/light_lines.h"

#include <gmock/gmock.h>

#include "tests/support/lined_world.h"

namespace afterglow {
namespace {

using testing::add_box;
using testing::add_quad;
using testing::LinedWorld;

/// Mean over patches of the form factor to the lamp above that light lines give.
double mean_factor(const LinedWorld& lined, Scope scope) {
    std::vector<float> contribution(std::size_t{lined.mesh.size()} * lined.light.lines_per_patch(), 0);
    trace_light_lines(lined.light, lined.sight, lined.caster, scope, contribution, Context(2));
    double sum = 0, area = 0;
    for (const PatchBlock& block : lined.sight.blocks()) {
        for (Index lane = 0; lane < block.count; ++lane) {
            const Index patch = block.first + lane;
            if (lined.mesh.material(patch) != 0 || lined.mesh.side[patch] != Side::front) continue;
            double row = 0;
            for (Index k = 0; k < lined.light.lines_per_patch(); ++k)
                row += contribution[lined.light.line(block, k, lane)];
            sum += row * lined.mesh.area_m2[patch];
            area += lined.mesh.area_m2[patch];
        }
    }
    return sum / area;
}

/// A unit square facing up and a lamp of the same size `gap` above it, far from a large wall that keeps the
/// lamp small.
World facing_squares(float gap) {
    World world = testing::empty_world(0.5F);
    Body& body = world.bodies[furniture];
    add_quad(body, Vec3(0), Vec3(0, 0, 1), Vec3(1, 0, 0), 0);
    add_quad(body, Vec3(0, gap, 0), Vec3(1, 0, 0), Vec3(0, 0, 1), 1);
    add_quad(body, Vec3(-50, -30, -50), Vec3(100, 0, 0), Vec3(0, 0, 100), 0);
    world.materials.push_back(testing::diffuse("wall", Rgb(0.5F)));
    for (std::size_t t = 4; t < body.triangles.size(); ++t) body.triangles[t].material = 2;
    return world;
}

TEST(LightLines, ParallelSquaresHaveTheirClosedForm) {
    // Closed form 1 of the design: form factors of parallel unit squares.
    for (const auto& [gap, factor] :
         {std::pair(1.0F, 0.199824895698), std::pair(2.0F, 0.068589589), std::pair(0.5F, 0.415253284)}) {
        const LinedWorld lined(facing_squares(gap), 0.125F * 4, 16, 256);
        EXPECT_NEAR(mean_factor(lined, Scope::static_geometry), factor, 0.01 * factor) << "gap " << gap;
    }
}

TEST(LightLines, AnActorCastsItsShadow) {
    World world = facing_squares(1);
    Path rest;
    rest.keys = {{0, {Vec3(0.5F, 0.5F, 0.5F), Quat(1, 0, 0, 0)}}};
    testing::add_actor(world, "lid", Vec3(2, 0.01F, 2), 0, rest);
    const LinedWorld lined(std::move(world), 0.5F, 16, 64);
    std::vector<float> contribution(std::size_t{lined.mesh.size()} * 64, 0);
    trace_light_lines(lined.light, lined.sight, lined.caster, Scope::everything, contribution, Context(1));
    const PatchBlock& first = lined.sight.blocks().front();
    ASSERT_EQ(lined.mesh.surface[first.first], 0U);
    for (Index k = 0; k < 64; ++k) EXPECT_EQ(contribution[lined.light.line(first, k, 0)], 0);
}

TEST(LightLines, OfMovingPatchesRepeatAndStillSampleAllOfTheLamp) {
    World world = testing::empty_world(0.5F);
    add_quad(world.bodies[furniture], Vec3(0, 1, 0), Vec3(1, 0, 0), Vec3(0, 0, 1), 1);
    add_quad(world.bodies[furniture], Vec3(-20, -30, -20), Vec3(40, 0, 0), Vec3(0, 0, 40), 0);
    Path rest;
    rest.keys = {{0, {Vec3(0.5F, -0.01F, 0.5F), Quat(1, 0, 0, 0)}}};
    testing::add_actor(world, "receiver", Vec3(0.5F, 0.01F, 0.5F), 0, rest);
    const LinedWorld lined(std::move(world), 0.5F, 16);
    const LightLines light(lined.mesh, lined.sight, lined.lamps, 256, 5, {4, 1});
    std::vector<float> contribution(std::size_t{lined.mesh.size()} * 256, 0);
    trace_light_lines(light, lined.sight, lined.caster, Scope::everything, contribution, Context(1));
    // The outside of its top; the inside of its bottom faces up, too.
    const auto is_top = [&](Index patch) {
        return lined.mesh.body[patch] != furniture && lined.mesh.normal[patch].y > 0.9F &&
               lined.mesh.side[patch] == Side::front;
    };
    double sum = 0, area = 0;
    for (const PatchBlock& block : lined.sight.blocks()) {
        for (Index lane = 0; lane < block.count; ++lane) {
            const float patch_area = lined.mesh.area_m2[block.first + lane];
            if (is_top(block.first + lane)) area += patch_area;
            for (Index k = 0; k < 256; ++k) {
                const Index same = light.first_same(block, k);
                ASSERT_EQ(same, block.body == furniture ? k : k / 4 * 4);
                const float value = contribution[light.line(block, k, lane)];
                ASSERT_EQ(value, contribution[light.line(block, same, lane)]);
                if (is_top(block.first + lane)) sum += double{value} * patch_area;
            }
        }
    }
    // Closed form 1 of the design.
    EXPECT_NEAR(sum / area, 0.199824895698, 0.01 * 0.199824895698);
}

TEST(LightLines, NoLampsNoLines) {
    World world = testing::empty_world();
    add_box(world.bodies[furniture], Vec3(0), Vec3(1), 0, testing::Facing::inwards);
    const LinedWorld lined(std::move(world), 0.5F, 16);
    EXPECT_EQ(lined.light.lines_per_patch(), 0U);
}

}  // namespace
}  // namespace afterglow
