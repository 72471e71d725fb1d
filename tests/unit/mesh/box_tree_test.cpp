#include "solver/mesh/box_tree.h"

#include <random>

#include <gmock/gmock.h>

namespace afterglow {
namespace {

Box random_box(std::mt19937& random, float size) {
    std::uniform_real_distribution<float> place(0, 10), extent(0, size);
    Box box;
    const Vec3 low(place(random), place(random), place(random));
    box.add(low);
    box.add(low + Vec3(extent(random), extent(random), extent(random)));
    return box;
}

bool overlap(const Box& a, const Box& b) {
    const Vec3 low = glm::max(a.low, b.low), high = glm::min(a.high, b.high);
    return low.x <= high.x && low.y <= high.y && low.z <= high.z;
}

TEST(BoxTree, FindsWhatALookAtEveryBoxFinds) {
    std::mt19937 random(1);
    for (const std::size_t count : {0U, 1U, 4U, 5U, 500U}) {
        std::vector<Box> boxes;
        for (std::size_t k = 0; k < count; ++k) boxes.push_back(random_box(random, k % 9 == 0 ? 8 : 0.5F));
        const BoxTree tree(boxes);
        for (int k = 0; k < 50; ++k) {
            const Box region = random_box(random, 3);
            std::vector<Index> found, expected;
            tree.for_overlaps(region, [&](Index i) { found.push_back(i); });
            for (Index i = 0; i < boxes.size(); ++i)
                if (overlap(boxes[i], region)) expected.push_back(i);
            EXPECT_THAT(found, ::testing::UnorderedElementsAreArray(expected));
        }
    }
}

TEST(BoxTree, ManyEqualBoxesAreAllFound) {
    Box box;
    box.add(Vec3(1));
    const BoxTree tree(std::vector<Box>(1000, box));
    int found = 0;
    tree.for_overlaps(box, [&](Index) { ++found; });
    EXPECT_EQ(found, 1000);
}

}  // namespace
}  // namespace afterglow
