#include "solver/mesh/split_cell.h"

#include <gmock/gmock.h>

namespace afterglow {
namespace {

constexpr float tolerance = 1e-5F;

ClipPolygon square() {
    ClipPolygon polygon;
    for (const Vec2 c : {Vec2(0, 0), Vec2(1, 0), Vec2(1, 1), Vec2(0, 1)}) polygon.add({c, Vec3(1, 0, 0)});
    return polygon;
}

CellCut cut(const Vec2& from, const Vec2& to) {
    return {{from, to}, line_through(from, to, Vec2(1)), 2 * tolerance};
}

SplitCell split(const std::vector<CellCut>& cuts) {
    return split_cell({square()}, cuts, {Vec2(0), 1, Vec2(1), tolerance});
}

float area(const ClipPolygon& p) {
    float doubled = 0;
    for (int i = 0; i < p.count; ++i) {
        const Vec2 &a = p[i].cell, &b = p[(i + 1) % p.count].cell;
        doubled += a.x * b.y - a.y * b.x;
    }
    return 0.5F * doubled;
}

std::vector<float> areas(const SplitCell& cell) {
    std::vector<float> out;
    for (const CellPart& part : cell.parts) {
        out.push_back(0);
        for (const ClipPolygon& piece : part.pieces) out.back() += area(piece);
    }
    return out;
}

MATCHER_P(IsNear, expected, "") {
    return std::abs(arg - expected) < 1e-4F;
}
using ::testing::UnorderedElementsAre;

TEST(SplitCell, ACutThroughMakesTwoParts) {
    EXPECT_THAT(areas(split({cut({0.25F, -1}, {0.25F, 2})})),
                UnorderedElementsAre(IsNear(0.25F), IsNear(0.75F)));
}

TEST(SplitCell, ACutThatEndsWithinIsDrawnOn) {
    EXPECT_THAT(areas(split({cut({0.25F, -1}, {0.25F, 0.5F})})),
                UnorderedElementsAre(IsNear(0.25F), IsNear(0.75F)));
}

TEST(SplitCell, ACornerWithinMakesThreePartsThoughItsCutsStickOut) {
    const float out = 5 * tolerance;
    EXPECT_THAT(areas(split({cut({0.25F, -1}, {0.25F, 0.5F + out}), cut({0.25F - out, 0.5F}, {2, 0.5F})})),
                ::testing::SizeIs(3));
}

TEST(SplitCell, CutsAlongOneLineSplitOnce) {
    EXPECT_THAT(areas(split({cut({0.5F, -1}, {0.5F, 0.4F}), cut({0.5F, 0.4F}, {0.5F, 2}),
                             cut({0.5F, 0.3F}, {0.5F, 0.6F})})),
                UnorderedElementsAre(IsNear(0.5F), IsNear(0.5F)));
}

TEST(SplitCell, ACutOnTheBorderSplitsNothingButIsKeptOff) {
    const SplitCell cell = split({cut({0, 0}, {0, 1})});
    ASSERT_EQ(cell.parts.size(), 1U);
    ASSERT_EQ(cell.parts[0].bounds.size(), 1U);
    const PartBound& bound = cell.parts[0].bounds[0];
    EXPECT_EQ(bound.line.distance(Vec2(0.5F)) > 0, bound.keep == Keep::above);
}

TEST(SplitCell, ManyCutsEndSomewhere) {
    // Facets of a round column: each is a side of the part within.
    std::vector<CellCut> cuts;
    for (int k = 0; k < 40; ++k) {
        const auto corner = [](int i) {
            const float angle = 2 * pi * static_cast<float>(i) / 40;
            return Vec2(0.5F) + 0.3F * Vec2(std::cos(angle), std::sin(angle));
        };
        cuts.push_back(cut(corner(k), corner(k + 1)));
    }
    float sum = 0;
    for (const float a : areas(split(cuts))) sum += a;
    EXPECT_NEAR(sum, 1, 1e-4);
}

}  // namespace
}  // namespace afterglow
