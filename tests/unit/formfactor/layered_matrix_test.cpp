#include "solver/formfactor/layered_matrix.h"

#include <algorithm>
#include <numeric>

#include <gmock/gmock.h>

#include "tests/support/actors.h"
#include "tests/support/layered_world.h"

namespace afterglow {
namespace {

using testing::dense_row;
using testing::LayeredWorld;
using testing::Movements;

void expect_compiled(const LayeredWorld& world) {
    const FormFactors compiled = world.compiled();
    const LayeredMatrix& matrix = world.matrix;
    for (std::size_t row = 0; row < matrix.rows(); ++row) {
        std::vector<double> difference = dense_row(matrix, row);
        difference.pop_back();
        const double sum = std::accumulate(difference.begin(), difference.end(), 0.0);
        ASSERT_NEAR(matrix.row_sum[row], sum, 1e-5);
        for (auto e = compiled.matrix.row_begin[row]; e < compiled.matrix.row_begin[row + 1]; ++e)
            difference[compiled.matrix.column[e]] -= static_cast<double>(compiled.matrix.value[e]);
        const auto [low, high] = std::minmax_element(difference.begin(), difference.end());
        ASSERT_LE(std::max(-*low, *high), 2e-6) << "row " << row;
        ASSERT_NEAR(matrix.sky[row], compiled.sky[row], 1e-5F);
        ASSERT_EQ(matrix.valid_share[row], compiled.valid_share[row]);
    }
}

TEST(LayeredMatrix, IsTheCompiledOneWhateverTimeItIsBroughtTo) {
    for (const unsigned seed : {1U, 2U, 3U}) {
        LayeredWorld world(testing::random_world(seed, 5, Movements::turning), 0.4F, 32);
        for (const double time : {0.0, 0.2, 0.25, 3.0, 1.1, 9.0, 0.0}) {
            world.show_at(time);
            SCOPED_TRACE(::testing::Message() << "seed " << seed << " time " << time);
            expect_compiled(world);
        }
    }
}

std::size_t count(std::span<const RowChanges> changes, std::vector<RowChange> RowChanges::*list) {
    std::size_t sum = 0;
    for (const RowChanges& part : changes) sum += (part.*list).size();
    return sum;
}

TEST(LayeredMatrix, FollowsListedChangesAsItDoesComparedOnes) {
    LayeredWorld compared(testing::random_world(4, 6, Movements::turning), 0.4F, 32);
    LayeredWorld listed(testing::random_world(4, 6, Movements::turning), 0.4F, 32);
    compared.show_at(0);
    listed.show_at(0);
    for (const double time : {0.1, 0.6, 2.0, 0.3}) {
        const VisibleLines before = listed.visible;
        listed.look(time);
        LineChanges changes;
        for (Index line = 0; line < listed.lined.mesh.static_size() * 32; ++line)
            if (before.patch[line] != listed.visible.patch[line])
                changes.sight.push_back({line, before.patch[line], listed.visible.patch[line]});
        for (Index line = 0; line < listed.lined.mesh.static_size() * 16; ++line)
            if (before.light_contribution[line] != listed.visible.light_contribution[line])
                changes.light.insert(changes.light.end(), 2, line);
        const auto by_list = show(listed.matrix, listed.scene(), listed.visible, changes, Context(2));
        const auto by_comparison = compared.show_at(time);
        EXPECT_EQ(lines_changed(by_list), changes.sight.size());
        EXPECT_EQ(lines_changed(by_list), lines_changed(by_comparison));
        EXPECT_EQ(count(by_list, &RowChanges::sight), count(by_comparison, &RowChanges::sight));
        EXPECT_EQ(count(by_list, &RowChanges::light), count(by_comparison, &RowChanges::light));
        EXPECT_EQ(listed.matrix.sight.scale, compared.matrix.sight.scale);
        expect_compiled(listed);
    }
}

TEST(LayeredMatrix, ChangesSayWhatTheLayersDid) {
    LayeredWorld world(testing::random_world(5, 5, Movements::straight), 0.4F, 32);
    world.show_at(0);
    const auto unscaled = [&](std::size_t row) {
        std::vector<double> sum(world.matrix.rows() + 1, 0);
        if (row >= world.lined.mesh.static_size()) return sum;
        for_covered(world.matrix.sight, row / block_size, [&](std::size_t of, Index base, Index now, float) {
            if (of != row) return;
            sum[base] -= 1;
            sum[now] += 1;
        });
        return sum;
    };
    std::vector<std::vector<double>> rows;
    for (std::size_t row = 0; row < world.matrix.rows(); ++row) rows.push_back(unscaled(row));
    const auto changes = world.show_at(1.3);
    EXPECT_GT(count(changes, &RowChanges::sight), 0U);
    for (const RowChanges& part : changes)
        for (const RowChange& change : part.sight) {
            rows[change.row][change.from] -= static_cast<double>(change.value);
            rows[change.row][change.to] += static_cast<double>(change.value);
        }
    for (std::size_t row = 0; row < rows.size(); ++row) EXPECT_EQ(rows[row], unscaled(row)) << row;
}

TEST(LayeredMatrix, AtRestNothingChanges) {
    LayeredWorld world(testing::random_world(6, 4, Movements::turning), 0.4F, 32);
    world.show_at(1);
    const auto changes = world.show_at(1);
    EXPECT_EQ(count(changes, &RowChanges::sight) + count(changes, &RowChanges::light), 0U);
    EXPECT_EQ(lines_changed(changes), 0U);
}

/// The small room, its lamp hanging on an actor that walks.
World with_moving_lamp() {
    World world = testing::small_room();
    std::mt19937 random(7);
    Box within;
    within.add(Vec3(0.5F, 0.5F, 0.5F));
    within.add(Vec3(3.5F, 2.5F, 4.5F));
    // Material 1 of these worlds shines.
    testing::add_actor(world, "lamp", Vec3(0.1F), 1,
                       testing::random_path(random, within, 3, testing::Turning::yes));
    return world;
}

TEST(LayeredMatrix, ALampThatMovesMakesAllRowsWhole) {
    LayeredWorld world(with_moving_lamp(), 0.4F, 32);
    for (const double time : {0.0, 0.5}) {
        world.show_at(time);
        EXPECT_EQ(world.matrix.whole_rows.size(), world.matrix.rows());
        expect_compiled(world);
    }
}

TEST(LayeredMatrix, LampsGiveWhatTheirColumnsGive) {
    for (const World& scene : {testing::random_world(8, 5, Movements::turning), with_moving_lamp()}) {
        LayeredWorld world(scene, 0.4F, 32);
        world.show_at(0.7);
        std::vector<Rgb> emission;
        for (Index p = 0; p < world.matrix.rows(); ++p)
            emission.push_back(pi * world.lined.world.materials[world.lined.mesh.material(p)].emission);
        const auto irradiance = lamp_irradiance(world.matrix, world.lined.lamps, emission, Context(2));
        double lit = 0;
        for (std::size_t row = 0; row < world.matrix.rows(); ++row) {
            const std::vector<double> factors = dense_row(world.matrix, row);
            double expected = 0;
            for (const Index lamp : world.lined.lamps.patches)
                expected += factors[lamp] * static_cast<double>(emission[lamp].r);
            EXPECT_NEAR(irradiance[row].r, expected, 1e-5) << row;
            lit += expected;
        }
        EXPECT_GT(lit, 0);
    }
}

TEST(LayeredMatrix, IsTheSameForAnyNumberOfThreads) {
    const World scene = testing::random_world(9, 5, Movements::turning);
    LayeredWorld one(scene, 0.4F, 32, 16, 1);
    one.show_at(0.9, 1);
    for (const int threads : {2, 4}) {
        LayeredWorld many(scene, 0.4F, 32, 16, threads);
        many.show_at(0.9, threads);
        EXPECT_EQ(many.matrix.sight.base.value, one.matrix.sight.base.value);
        EXPECT_EQ(many.matrix.light.base.value, one.matrix.light.base.value);
        EXPECT_EQ(many.matrix.sight.scale, one.matrix.sight.scale);
        EXPECT_EQ(many.matrix.whole.value, one.matrix.whole.value);
    }
}

}  // namespace
}  // namespace afterglow
