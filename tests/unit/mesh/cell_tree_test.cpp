#include "solver/mesh/cell_tree.h"

#include <map>
#include <random>

#include <gmock/gmock.h>

namespace afterglow {
namespace {

/// A 3 × 2 grid divided at random, up to four times; some leaves hold nothing.
class RandomTree {
  public:
    explicit RandomTree(unsigned seed) : random_(seed) {
        tree.cells_u = 3;
        tree.cells_v = 2;
        for (int cell = 0; cell < 6; ++cell) tree.cells.push_back(entry(0));
    }
    CellTree tree;
    Index items = 0;

  private:
    Index entry(int depth) {
        const auto dice = random_() % 10;
        if (depth < 4 && dice < 5) {
            const auto quarter = static_cast<Index>(tree.quarters.size());
            tree.quarters.emplace_back();
            for (std::size_t q = 0; q < 4; ++q) {
                const Index below = entry(depth + 1);
                tree.quarters[quarter][q] = below;
            }
            return CellTree::divided | quarter;
        }
        return dice == 9 ? no_index : items++;
    }
    std::mt19937 random_;
};

TEST(CellTree, OverlapsAreTheAreasOfTheLeavesWithinARectangle) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> unit(0, 1);
    for (unsigned seed = 0; seed < 20; ++seed) {
        const RandomTree made(seed);
        const Vec2 low(2.5F * unit(random), 1.5F * unit(random));
        const Vec2 high = low + Vec2(0.5F * unit(random), 0.5F * unit(random)) + 0.01F;
        std::map<Index, float> area;
        made.tree.for_overlaps(low, high, [&](Index item, float a, const Vec2&) { area[item] += a; });
        // The same by looking up a fine raster of points.
        constexpr int raster = 64;
        std::map<Index, float> looked_up;
        const Vec2 step = (high - low) / static_cast<float>(raster);
        for (int y = 0; y < raster; ++y) {
            for (int x = 0; x < raster; ++x) {
                const auto leaf = made.tree.leaf_at(low + step * (Vec2(x, y) + 0.5F));
                if (leaf.item != no_index) looked_up[leaf.item] += step.x * step.y;
            }
        }
        // A leaf's border can pass between raster points, over its whole length.
        const float tolerance = (high.x - low.x) * step.y + (high.y - low.y) * step.x;
        for (const auto& [item, a] : looked_up) EXPECT_NEAR(area[item], a, tolerance);
        for (const auto& [item, a] : area) EXPECT_NEAR(a, looked_up[item], tolerance);
    }
}

TEST(CellTree, ALeafHoldsThePlaceThatLedToIt) {
    std::mt19937 random(6);
    std::uniform_real_distribution<float> unit(0, 1);
    const RandomTree made(1);
    for (int i = 0; i < 1000; ++i) {
        const Vec2 at(3 * unit(random), 2 * unit(random));
        const auto leaf = made.tree.leaf_at(at);
        EXPECT_GE(at.x, leaf.low.x);
        EXPECT_GE(at.y, leaf.low.y);
        EXPECT_LE(at.x, leaf.low.x + leaf.size);
        EXPECT_LE(at.y, leaf.low.y + leaf.size);
    }
}

TEST(CellTree, PlacesOutsideBelongToTheBorder) {
    const RandomTree made(2);
    EXPECT_EQ(made.tree.leaf_at(Vec2(-7, 0.3F)).item, made.tree.leaf_at(Vec2(0, 0.3F)).item);
    EXPECT_EQ(made.tree.leaf_at(Vec2(1e9F, 1.2F)).item, made.tree.leaf_at(Vec2(2.9999F, 1.2F)).item);
}

/// One cell that is split in three, with a divider along the first of its two lines.
CellTree split_tree() {
    CellTree tree;
    tree.cells_u = tree.cells_v = 1;
    tree.cells = {CellTree::split | 0};
    tree.splits = {{line_through(Vec2(0.5F, 1), Vec2(0.5F, 0), Vec2(1)), {0, CellTree::split | 1}},
                   {line_through(Vec2(0, 0.25F), Vec2(1, 0.25F), Vec2(1)), {1, 2}}};
    tree.dividers = {{Vec2(0.5F, 0), Vec2(0.5F, 0.6F)}};
    tree.first_divider = {0, 1};
    return tree;
}

TEST(CellTree, SplitLeavesHoldWhatIsOnEitherSideOfTheirLines) {
    const CellTree tree = split_tree();
    EXPECT_EQ(tree.leaf_at(Vec2(0.2F, 0.9F)).item, 0U);
    EXPECT_EQ(tree.leaf_at(Vec2(0.7F, 0.1F)).item, 1U);
    EXPECT_EQ(tree.leaf_at(Vec2(0.7F, 0.9F)).item, 2U);
    std::array<float, 3> area{};
    tree.for_overlaps(Vec2(0.25F, 0), Vec2(1, 0.5F), [&](Index item, float a, const Vec2& centre) {
        area[item] += a;
        EXPECT_EQ(tree.leaf_at(centre).item, item);
    });
    EXPECT_THAT(area, ::testing::Pointwise(::testing::FloatNear(1e-6F), {0.125F, 0.125F, 0.125F}));
}

TEST(CellTree, DividersStandBetweenPlacesAsFarAsTheyGo) {
    const CellTree tree = split_tree();
    EXPECT_TRUE(tree.is_divided_between(Vec2(0.4F, 0.3F), Vec2(0.6F, 0.3F)));
    EXPECT_FALSE(tree.is_divided_between(Vec2(0.4F, 0.8F), Vec2(0.6F, 0.8F)));
    EXPECT_FALSE(tree.is_divided_between(Vec2(0.1F, 0.1F), Vec2(0.4F, 0.3F)));
}

}  // namespace
}  // namespace afterglow
