#include "solver/sequence/furniture_edits.h"

#include <random>

#include <gmock/gmock.h>

#include "solver/base/error.h"
#include "solver/scene/furniture.h"
#include "solver/sequence/parts.h"
#include "tests/unit/sequence/quick_sequences.h"

namespace afterglow {
namespace {

/// An object of one box.
Body box_named(const std::string& name, const Vec3& low, const Vec3& high, Index material) {
    Body object;
    object.name = name;
    testing::add_box(object, low, high, material);
    return object;
}

/// The small room with a chest on its floor, a shelf that touches a wall and a box in the air.
World furnished_room() {
    World world = testing::small_room();
    world.materials.push_back(testing::diffuse("red", Rgb(0.7F, 0.2F, 0.1F)));
    world.pieces.push_back({"room", 0, static_cast<Index>(world.bodies[furniture].triangles.size())});
    add_piece(world, box_named("chest", Vec3(2.8F, 0, 0.6F), Vec3(3.2F, 0.4F, 1.0F), 2));
    add_piece(world, box_named("shelf", Vec3(0, 1.6F, 2), Vec3(0.3F, 1.7F, 3.2F), 0));
    add_piece(world, box_named("kite", Vec3(2.2F, 1.9F, 1.6F), Vec3(2.6F, 2.1F, 1.9F), 2));
    return world;
}

SequenceConfig fine() {
    SequenceConfig config = testing::quick();
    config.asked_error = 1e-3;
    config.exposure_ev = 0;
    return config;
}

/// Root mean square difference relative to the mean.
double difference(const Picture& a, const Picture& b) {
    double squares = 0, sum = 0;
    for (std::size_t k = 0; k < a.pixels.size(); ++k) {
        const Rgb d = a.pixels[k] - b.pixels[k];
        squares += static_cast<double>(glm::dot(d, d)) / 3;
        sum += static_cast<double>(b.pixels[k].r + b.pixels[k].g + b.pixels[k].b) / 3;
    }
    const auto count = static_cast<double>(b.pixels.size());
    return std::sqrt(squares / count) * count / sum;
}

/// Whether two patches lie in one plane: where something stands on a floor, its underside and the floor are
/// seen at one distance, and which of them is met is a matter of the order in which they are looked at.
bool is_tie(const PatchMesh& mesh, Index a, Index b) {
    if (a >= mesh.size() || b >= mesh.size()) return false;
    const Vec3 between = mesh.centre[a] - mesh.centre[b];
    return std::abs(glm::dot(mesh.normal[a], mesh.normal[b])) > 0.9999F &&
           std::abs(glm::dot(between, mesh.normal[a])) < 1e-5F;
}

/// What is kept of the static pass must be what tracing every line would give.
void expect_backgrounds_as_traced(SequenceState& state) {
    const SequenceState::Parts& parts = state.parts();
    StaticLines traced = make_static_lines(parts.mesh, *parts.sight, *parts.light);
    extend_static_lines(traced, parts.mesh, *parts.sight, *parts.light, parts.caster,
                        parts.sight->lines_per_patch(), Context(2));
    ASSERT_EQ(parts.background.directions, traced.directions);
    const auto &kept = parts.background.background.patch, &all = traced.background.patch;
    ASSERT_EQ(kept.size(), all.size());
    for (std::size_t line = 0; line < all.size(); ++line)
        ASSERT_TRUE(kept[line] == all[line] || is_tie(parts.mesh, kept[line], all[line])) << line;
    for (std::size_t line = 0; line < all.size(); ++line) {
        const float here = parts.background.background.distance[line],
                    there = traced.background.distance[line];
        ASSERT_TRUE(here == there || (kept[line] != all[line] && std::abs(here - there) < 1e-5F)) << line;
    }
    EXPECT_EQ(parts.background.light_contribution, traced.light_contribution);
}

struct Edited {
    World scene = furnished_room();
    SequenceState state = make_state(scene, fine(), Context(2));

    Edited() { testing::picture_of(state, 0); }

    void expect_as_new(int frame) {
        SequenceState fresh = make_state(scene, fine(), Context(2));
        EXPECT_EQ(state.statistics().patches, fresh.statistics().patches);
        EXPECT_EQ(state.statistics().actor_patches, fresh.statistics().actor_patches);
        // Other directions of 64 lines to patches of 0.4 m: their noise is what is left.
        EXPECT_LE(difference(testing::picture_of(state, frame), testing::picture_of(fresh, frame)), noise())
            << "frame " << frame;
    }
    /// How far two jobs on one scene are apart whose lines go other ways, and half as much again.
    double noise() const {
        SequenceConfig other = fine();
        other.seed = 77;
        SequenceState one = make_state(scene, fine(), Context(2)), two = make_state(scene, other, Context(2));
        return 1.5 * difference(testing::picture_of(two, 0), testing::picture_of(one, 0));
    }
};

TEST(FurnitureEdits, APieceIsMovedAndMostLinesStay) {
    Edited job;
    const Pose motion{Vec3(-0.7F, 0, 1.3F), glm::angleAxis(0.4F, Vec3(0, 1, 0))};
    const EditOutcome outcome = move_furniture(job.state, "chest", motion, Context(2));
    EXPECT_GT(outcome.lines_reused, 0.5);
    EXPECT_LT(outcome.lines_reused, 1);
    EXPECT_TRUE(outcome.light_reused);
    move_piece(job.scene, 1, motion);
    expect_backgrounds_as_traced(job.state);
    job.expect_as_new(3);
    job.expect_as_new(12);
}

TEST(FurnitureEdits, LightStartsFromWhatTheOtherPatchesShoneWith) {
    const auto ignore = [](const Revision&) {};
    SequenceState state = make_state(furnished_room(), fine(), Context(2));
    const FrameStatistics cold = step(state, 0, ignore, Context(2));
    move_furniture(state, "chest", {Vec3(-0.2F, 0, 0), Quat(1, 0, 0, 0)}, Context(2));
    const FrameStatistics led_on = step(state, 0, ignore, Context(2));
    EXPECT_GT(led_on.shots, 0U);
    EXPECT_LT(led_on.shots, cold.shots / 2) << cold.shots;
    EXPECT_LE(led_on.error_bound, fine().asked_error);
}

TEST(FurnitureEdits, APieceIsTakenAway) {
    Edited job;
    EXPECT_GT(remove_furniture(job.state, "shelf", Context(2)).lines_reused, 0.5);
    remove_piece(job.scene, 2);
    expect_backgrounds_as_traced(job.state);
    job.expect_as_new(3);
}

TEST(FurnitureEdits, AnObjectIsAdded) {
    Edited job;
    const Body object = box_named("stool", Vec3(1, 0, 3), Vec3(1.4F, 0.5F, 3.4F), 2);
    EXPECT_GT(add_furniture(job.state, object, Context(2)).lines_reused, 0.5);
    add_piece(job.scene, object);
    expect_backgrounds_as_traced(job.state);
    job.expect_as_new(3);
}

TEST(FurnitureEdits, ALampIsAdded) {
    Edited job;
    const Body lamp = box_named("lamp", Vec3(0.4F, 2, 0.4F), Vec3(0.6F, 2.2F, 0.6F), 1);
    add_furniture(job.state, lamp, Context(2));
    add_piece(job.scene, lamp);
    expect_backgrounds_as_traced(job.state);
    job.expect_as_new(3);
}

TEST(FurnitureEdits, ThereAndBackIsAsBefore) {
    Edited job;
    const auto before = job.state.parts().background.background.patch;
    const Picture picture = testing::picture_of(job.state, 5);
    // By eighths, so that no corner is rounded.
    move_furniture(job.state, "kite", {Vec3(0.25F, 0, 0.5F), Quat(1, 0, 0, 0)}, Context(2));
    testing::picture_of(job.state, 5);
    move_furniture(job.state, "kite", {Vec3(-0.25F, 0, -0.5F), Quat(1, 0, 0, 0)}, Context(2));
    expect_backgrounds_as_traced(job.state);
    EXPECT_LE(difference(testing::picture_of(job.state, 5), picture), 0.02);
}

TEST(FurnitureEdits, AnyOrderOfThemEndsWhereANewJobStarts) {
    std::mt19937 random(9);
    const auto uniform = [&](float low, float high) {
        return low + (high - low) * static_cast<float>(random() % 1000) / 1000;
    };
    Edited job;
    int added = 0;
    for (int round = 0; round < 12; ++round) {
        const auto pieces = static_cast<Index>(job.scene.pieces.size());
        const Index piece = 1 + static_cast<Index>(random()) % std::max(Index{1}, pieces - 1);
        switch (pieces > 1 ? random() % 4 : 0) {
            case 0: {
                const Vec3 low(uniform(0.2F, 3.5F), random() % 2 == 0 ? 0.0F : uniform(0.1F, 2),
                               uniform(0.2F, 4));
                const Vec3 size(uniform(0.05F, 0.4F), uniform(0.05F, 0.9F), uniform(0.05F, 0.6F));
                const Body object = box_named("added " + std::to_string(added++), low, low + size, 2);
                add_furniture(job.state, object, Context(2));
                add_piece(job.scene, object);
                break;
            }
            case 1: {
                const std::string name = job.scene.pieces[piece].name;
                remove_furniture(job.state, name, Context(2));
                remove_piece(job.scene, piece);
                break;
            }
            case 2: {
                const Pose motion{Vec3(uniform(-0.2F, 0.2F), uniform(0, 0.1F), uniform(-0.2F, 0.2F)),
                                  Quat(1, 0, 0, 0)};
                move_furniture(job.state, job.scene.pieces[piece].name, motion, Context(2));
                move_piece(job.scene, piece, motion);
                break;
            }
            default: {
                job.scene.materials[2].reflectance = Rgb(uniform(0, 0.9F));
                set_reflectance(job.state, "red", job.scene.materials[2].reflectance);
                set_path(job.state, "walker", uniform(0, 1), job.scene.bodies[1].path, Context(2));
                break;
            }
        }
        const int frame = static_cast<int>(random() % 30);
        testing::picture_of(job.state, frame);
        expect_backgrounds_as_traced(job.state);
        if (round % 4 == 3) job.expect_as_new(frame);
        ASSERT_FALSE(HasFailure()) << "round " << round;
    }
}

TEST(FurnitureEdits, BeforeTheFirstFrameAllIsTracedOnce) {
    const Pose motion{Vec3(-0.5F, 0, 0), Quat(1, 0, 0, 0)};
    SequenceState state = make_state(furnished_room(), fine(), Context(2));
    EXPECT_EQ(move_furniture(state, "chest", motion, Context(2)).lines_reused, 0);
    testing::picture_of(state, 2);
    expect_backgrounds_as_traced(state);
}

TEST(FurnitureEdits, BadOnesAreNamedAndChangeNothing) {
    Edited job;
    const Picture before = testing::picture_of(job.state, 3);
    const auto place_of = [](auto&& edit) {
        try {
            edit();
        } catch (const Error& error) {
            return error.place();
        }
        return std::string("nothing");
    };
    EXPECT_EQ(place_of([&] { remove_furniture(job.state, "walker", Context(1)); }), "piece");
    EXPECT_EQ(place_of([&] { move_furniture(job.state, "no such", {}, Context(1)); }), "piece");
    const Pose stretched{Vec3(0), Quat(2, 0, 0, 0)};
    EXPECT_EQ(place_of([&] { move_furniture(job.state, "chest", stretched, Context(1)); }), "motion");
    EXPECT_EQ(place_of([&] { add_furniture(job.state, Body(), Context(1)); }), "object");
    Body object = box_named("chest", Vec3(1), Vec3(2), 0);
    EXPECT_EQ(place_of([&] { add_furniture(job.state, object, Context(1)); }), "object");
    object.name = "new";
    object.triangles[3].material = 99;
    EXPECT_EQ(place_of([&] { add_furniture(job.state, object, Context(1)); }), "object");
    EXPECT_TRUE(testing::same_bits(testing::picture_of(job.state, 3), before));
    // Stopped in the middle: as it was, though all is to be found again.
    std::stop_source stop;
    stop.request_stop();
    EXPECT_THROW(remove_furniture(job.state, "chest", Context(2, stop.get_token())), Error);
    EXPECT_EQ(job.state.parts().world.pieces.size(), 4U);
    job.expect_as_new(3);
}

}  // namespace
}  // namespace afterglow
