#include "solver/image/item_buffer.h"

#include <gmock/gmock.h>

namespace afterglow {
namespace {

/// A camera at the origin looking along −z, one unit up and down at depth 1.
CameraView straight(int size) {
    CameraView view;
    view.width = view.height = size;
    return view;
}

TEST(ItemBuffer, ShowsTheNearestInAnyOrder) {
    const PlacedTriangle near{Vec3(-1, -1, -2), Vec3(1, -1, -2), Vec3(-1, 1, -2)},
        far{Vec3(-9, -9, -3), Vec3(9, -9, -3), Vec3(0, 20, -3)};
    const ItemBuffer one = draw(straight(8), std::vector{near, far}),
                     other = draw(straight(8), std::vector{far, near});
    std::uint64_t covered = 0;
    for (std::size_t k = 0; k < one.item.size(); ++k) {
        EXPECT_EQ(one.item[k] == 0, other.item[k] == 1);
        EXPECT_EQ(one.depth[k], other.depth[k]);
        covered += one.item[k] == 0 ? 1U : 0U;
    }
    EXPECT_GT(covered, 0U);
    EXPECT_EQ(one.interpolations, 64U);
    EXPECT_EQ(other.interpolations, 64U + covered);
    EXPECT_DOUBLE_EQ(one.depth[8 * 5 + 3], 2);
}

TEST(ItemBuffer, SharedEdgesLeaveNoHolesAndNothingBehindShows) {
    // The diagonal runs through pixel centres.
    const PlacedTriangle lower{Vec3(-1, -1, -1), Vec3(1, -1, -1), Vec3(1, 1, -1)},
        upper{Vec3(-1, -1, -1), Vec3(1, 1, -1), Vec3(-1, 1, -1)},
        behind{Vec3(-1, -1, 1), Vec3(1, -1, 1), Vec3(0, 1, 1)};
    const ItemBuffer full = draw(straight(16), std::vector{behind, lower, upper});
    for (const Index item : full.item) EXPECT_TRUE(item == 1 || item == 2);
    EXPECT_EQ(full.interpolations, 256U);
}

TEST(ItemBuffer, ATriangleThatReachesBehindTheCameraIsDrawnInFront) {
    // A floor half a metre below, from behind the camera to the horizon.
    const PlacedTriangle floor{Vec3(-100, -0.5F, 100), Vec3(100, -0.5F, 100), Vec3(0, -0.5F, -1000)};
    const ItemBuffer buffer = draw(straight(16), std::vector{floor});
    for (int x = 0; x < 16; ++x) {
        EXPECT_EQ(buffer.at(x, 15), 0U);
        EXPECT_EQ(buffer.at(x, 4), no_index);
    }
    EXPECT_NEAR(buffer.depth[15 * 16], 0.5 / (15.0 / 16), 1e-6);
}

TEST(ItemBuffer, EdgeOnAndEmptyShowNothing) {
    const PlacedTriangle edge_on{Vec3(-1, 0, -1), Vec3(1, 0, -1), Vec3(0, 0, -4)},
        empty{Vec3(0, 0, -1), Vec3(1, 1, -1), Vec3(0.5F, 0.5F, -1)};
    EXPECT_EQ(draw(straight(15), std::vector{edge_on, empty}).interpolations, 0U);
    EXPECT_EQ(draw(straight(4), {}).item, std::vector<Index>(16, no_index));
}

}  // namespace
}  // namespace afterglow
