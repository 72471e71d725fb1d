#include "solver/radiosity/shooting_order.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "solver/base/error.h"
#include "tests/unit/radiosity/problems.h"

namespace afterglow {
namespace {

using test::OwnedProblem;
using testing::ElementsAre;
using testing::IsEmpty;

constexpr ShootingOrder all_orders[] = {ShootingOrder::threshold_scan, ShootingOrder::largest_first,
                                        ShootingOrder::estimated, ShootingOrder::report};

/// Six unit squares; what they shoot is given.
std::vector<Index> next(ShootingOrder order, const std::vector<Rgb>& unshot, const PatchRoles& roles = {},
                        const std::vector<std::uint8_t>& active = {}) {
    const OwnedProblem cube = test::unit_cube(0.5F);
    return ShooterChoice(order, cube.view(), roles).next(unshot, active);
}

TEST(ShootingOrder, TakesAllWithinAFactorOfTwoOrTheFirstLargest) {
    const std::vector<Rgb> unshot{Rgb(1), Rgb(0, 1.9F, 0), Rgb(.9F), Rgb(-2), Rgb(0), Rgb(2)};
    EXPECT_THAT(next(ShootingOrder::threshold_scan, unshot), ElementsAre(0, 1, 3, 5));
    EXPECT_THAT(next(ShootingOrder::report, unshot), ElementsAre(0, 1, 3, 5));
    EXPECT_THAT(next(ShootingOrder::largest_first, unshot), ElementsAre(3));
}

TEST(ShootingOrder, LeavesOutWhoTakesNoPart) {
    const std::vector<Rgb> unshot{Rgb(1), Rgb(4), Rgb(2), Rgb(0), Rgb(0), Rgb(1)};
    const std::vector<std::uint8_t> active{1, 0, 1, 1, 1, 1};
    EXPECT_THAT(next(ShootingOrder::threshold_scan, unshot, {}, active), ElementsAre(0, 2, 5));
    EXPECT_THAT(next(ShootingOrder::largest_first, unshot, {}, active), ElementsAre(2));
}

TEST(ShootingOrder, LeavesOutWhoHasTooLittle) {
    const OwnedProblem cube = test::unit_cube(0.5F);
    const ShooterChoice choice(ShootingOrder::threshold_scan, cube.view(), {});
    const std::vector<Rgb> unshot{Rgb(1), Rgb(-1.5F), Rgb(.9F), Rgb(1.1F), Rgb(0), Rgb(0)};
    EXPECT_THAT(choice.next(unshot, {}, 1), ElementsAre(1, 3));
    EXPECT_THAT(choice.next(unshot, {}, 2), IsEmpty());
    EXPECT_THAT(choice.next(unshot, {}, 0, 0.7), ElementsAre(1, 3));
}

TEST(ShootingOrder, IsEmptyOnlyWhereNothingIsLeft) {
    const std::vector<std::uint8_t> hidden(6, 0);
    for (const ShootingOrder order : all_orders) {
        EXPECT_THAT(next(order, std::vector<Rgb>(6)), IsEmpty());
        EXPECT_THAT(next(order, std::vector<Rgb>(6, Rgb(0, 0, -1e-30F)), {hidden, {}, {}, {}}),
                    testing::Not(IsEmpty()));
    }
}

TEST(ShootingOrder, OfTheReportTakesMovingThenVisibleThenHidden) {
    const std::vector<std::uint8_t> seen{0, 1, 1, 0, 1, 1};
    const std::vector<std::uint8_t> moving{1, 0, 0, 0, 1, 0};
    const PatchRoles roles{seen, moving, {}, {}};
    EXPECT_THAT(next(ShootingOrder::report, std::vector<Rgb>(6, Rgb(1)), roles), ElementsAre(4));
    const std::vector<Rgb> without_mover{Rgb(1), Rgb(1), Rgb(1), Rgb(1), Rgb(.1F), Rgb(1)};
    EXPECT_THAT(next(ShootingOrder::report, without_mover, roles), ElementsAre(1, 2, 5));
    // Contribution comes first: a bright hidden patch is before a dim visible one.
    const std::vector<Rgb> hidden_bright{Rgb(4), Rgb(1), Rgb(1), Rgb(3), Rgb(1), Rgb(1)};
    EXPECT_THAT(next(ShootingOrder::report, hidden_bright, roles), ElementsAre(0, 3));
}

TEST(ShootingOrder, DarkMoversAreNoBetterThanOthers) {
    OwnedProblem cube = test::unit_cube(0.5F);
    cube.reflectance[2] = Rgb(.4F);
    const std::vector<std::uint8_t> moving{0, 0, 1, 0, 0, 0};
    const ShooterChoice choice(ShootingOrder::report, cube.view(), {{}, moving, {}, {}});
    EXPECT_EQ(choice.next(std::vector<Rgb>(6, Rgb(1)), {}).size(), 6U);
}

TEST(ShootingOrder, EstimateWeighsChannelsByWhatThePictureReflects) {
    OwnedProblem cube = test::unit_cube(0.5F);
    cube.reflectance.assign(6, Rgb(.8F, .1F, 0));
    std::vector<std::uint8_t> seen(6, 1);
    const std::vector<Rgb> unshot{Rgb(1, 0, 0), Rgb(0, 3, 0), Rgb(0, 0, 30), Rgb(0), Rgb(0), Rgb(0)};
    const ShooterChoice choice(ShootingOrder::estimated, cube.view(), {seen, {}, {}, {}});
    // By power the blue patch would be first, but blue counts a hundredth of red: .008 × 30 against (.8 −
    // .8/6) × 1.
    EXPECT_THAT(choice.next(unshot, {}), ElementsAre(0));
}

TEST(ShootingOrder, EstimateLeavesOutAPatchsOwnLight) {
    // A large visible wall and a small hidden one, the same power: only the hidden one lights the large wall.
    OwnedProblem plates{
        test::matrix_of({{0, .2}, {.6, 0}}), {3, 1}, {Rgb(1), Rgb(3)}, {Rgb(.5F), Rgb(.5F)}, {}};
    const std::vector<std::uint8_t> seen{1, 0};
    const ShooterChoice choice(ShootingOrder::estimated, plates.view(), {seen, {}, {}, {}});
    EXPECT_THAT(choice.next(plates.emission, {}), ElementsAre(1));
    EXPECT_THAT(next(ShootingOrder::estimated, std::vector<Rgb>(6, Rgb(1))), ElementsAre(0, 1, 2, 3, 4, 5));
}

TEST(Roles, MustFitTheProblem) {
    const std::vector<std::uint8_t> five(5, 1);
    const std::vector<Index> numbers{0, 1, 2, 3, 4, 6};
    const std::pair<PatchRoles, const char*> bad[] = {
        {{five, {}, {}, {}}, "seen patches"},
        {{{}, five, {}, {}}, "moving patches"},
        {{{}, {}, numbers, {}}, "objects of patches"},
        {{{}, {}, {}, numbers}, "surfaces of patches"},
    };
    const OwnedProblem cube = test::unit_cube(0.5F);
    for (const auto& [roles, field] : bad) {
        ProgressiveConfig config;
        config.roles = roles;
        try {
            solve_progressive(cube.view(), cube.columns(), config, Context(1));
            ADD_FAILURE() << field;
        } catch (const Error& error) {
            EXPECT_EQ(error.place(), field);
        }
    }
}

}  // namespace
}  // namespace afterglow
