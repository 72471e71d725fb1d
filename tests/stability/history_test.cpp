// A frame reached through others, by any way, against the same frame solved cold: within their certificates.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>

#include <gtest/gtest.h>

#include "solver/scene/furniture.h"
#include "solver/scene/load.h"
#include "solver/sequence/edit_tools.h"
#include "solver/sequence/furniture_edits.h"
#include "tests/support/actors.h"

namespace afterglow {
namespace {

constexpr double asked = 5e-3;

SequenceConfig settings(const Method& method, double patch_size_m) {
    SequenceConfig config;
    config.visibility = method.visibility;
    config.solution = method.solution;
    config.frames_expected = 100;
    config.patch_size_m = patch_size_m;
    config.rays_per_patch = 32;
    config.quality = Quality::draft;
    config.asked_error = asked;
    config.picture_tolerance = 0;
    config.width = 24;
    config.height = 16;
    config.exposure_ev = 0;
    config.revisions = Revisions::final_only;
    return config;
}

/// What a frame comes to: its picture, and its irradiance where the solution keeps it.
struct Shown {
    Picture picture;
    std::vector<Rgb> irradiance;
    std::vector<Index> seen;  ///< by sight line
    double error_bound = 0;
};

Shown show_frame(SequenceState& state, int frame) {
    Shown shown;
    const FrameStatistics statistics = step(
        state, frame, [&](const Revision& r) { shown.picture = r.radiance; }, Context(2));
    shown.error_bound = statistics.error_bound;
    const SequenceState::Parts& parts = state.parts();
    shown.seen = parts.visible.patch;
    if (parts.kept_light) shown.irradiance = parts.kept_light->state->irradiance;
    if (parts.kept_rows && parts.kept_rows->incremental)
        shown.irradiance = parts.kept_rows->incremental->irradiance;
    if (parts.kept_rows && parts.kept_rows->active_passive)
        shown.irradiance = parts.kept_rows->active_passive->irradiance;
    return shown;
}

/// How far ρa and ρb are apart, relative to the mean of ρb over what does not shine, as certificates are.
struct Distance {
    double largest = 0, rms = 0;
};
Distance apart(SequenceState& state, int frame, const std::vector<Rgb>& a, const std::vector<Rgb>& b) {
    const SequenceState::Parts& parts = state.parts();
    ReflectedMean mean;
    float largest = 0, squares = 0, area = 0;
    for (Index p = 0; p < parts.mesh.size(); ++p) {
        const Material material = material_at(parts.world, parts.mesh.material(p), parts.time_of(frame));
        const bool shines = parts.mesh.side[p] == Side::front || material.shines == Material::Shines::both;
        const Rgb reflectance = material.reflectance * parts.mesh.texture_mean[p];
        mean.add(parts.mesh.area_m2[p], shines ? pi * material.emission : Rgb(0), reflectance * b[p]);
        const float off = max_channel(glm::abs(reflectance * (a[p] - b[p])));
        largest = std::max(largest, off);
        squares += parts.mesh.area_m2[p] * off * off;
        area += parts.mesh.area_m2[p];
    }
    return {static_cast<double>(largest) / mean.value(),
            static_cast<double>(std::sqrt(squares / area)) / mean.value()};
}

/// A frame as followed against the same frame cold, on the same lines.
void expect_same(SequenceState& state, int frame, const Shown& followed, const Shown& cold) {
    EXPECT_LE(followed.error_bound, asked);
    ASSERT_EQ(followed.irradiance.size(), cold.irradiance.size());
    if (cold.irradiance.empty()) {
        // Cold at every frame anyway: to the bit.
        EXPECT_EQ(0, std::memcmp(followed.picture.pixels.data(), cold.picture.pixels.data(),
                                 cold.picture.pixels.size() * sizeof(Rgb)))
            << "frame " << frame;
        return;
    }
    ASSERT_EQ(followed.seen.size(), cold.seen.size());
    std::size_t ties = 0;
    for (std::size_t line = 0; line < cold.seen.size(); ++line)
        ties += followed.seen[line] != cold.seen[line] ? 1U : 0U;
    EXPECT_LE(ties, cold.seen.size() / 10000) << "frame " << frame;
    // Where edges meet, what a line sees is a matter of rounding, and one of few lines counts for much of a
    // dark patch's light: with ties it is the mean that must keep the promise.
    const Distance distance = apart(state, frame, followed.irradiance, cold.irradiance);
    // A little for the means, which differ as much.
    EXPECT_LE(ties == 0 ? distance.largest : distance.rms, 1.01 * (followed.error_bound + cold.error_bound))
        << "frame " << frame << ", " << ties << " ties";
}

/// Plays frames in an order by one state and compares those in `looks` with a state that begins there.
void expect_history_does_not_matter(const World& world, const SequenceConfig& config,
                                    std::span<const int> order, std::span<const int> looks) {
    SequenceState following = make_state(world, config, Context(2));
    for (const int frame : order) {
        const Shown followed = show_frame(following, frame);
        if (std::find(looks.begin(), looks.end(), frame) == looks.end()) continue;
        SequenceState fresh = make_state(world, config, Context(2));
        expect_same(fresh, frame, followed, show_frame(fresh, frame));
    }
}

class History : public ::testing::TestWithParam<Method> {};

/// On through consecutive frames, jumps, and back.
void expect_on_sample_scene(const char* file, const Method& method, double patch_size_m) {
    const World world = assemble(load_scene(std::string(AFTERGLOW_TEST_DATA "/") + file));
    const std::vector<int> order{0, 1, 2, 3, 4, 5, 6, 30, 16, 15, 14, 2};
    const std::vector<int> looks{6, 30, 14};
    expect_history_does_not_matter(world, settings(method, patch_size_m), order, looks);
}

TEST_P(History, DoesNotMatterInTheCornellBox) {
    expect_on_sample_scene("cornell-slide.glb", GetParam(), 0.3);
}

TEST_P(History, SlowDoesNotMatterInTheLivingRoom) {
    expect_on_sample_scene("living-room.glb", GetParam(), 0.4);
}

TEST_P(History, DoesNotMatterInRandomScenes) {
    for (const unsigned seed : {1U, 2U, 3U}) {
        const auto movements = seed % 2 == 0 ? testing::Movements::straight : testing::Movements::turning;
        const World world = testing::random_world(seed, 2 + static_cast<int>(seed), movements);
        std::mt19937 random(seed);
        std::vector<int> order(8);
        for (int& frame : order) frame = static_cast<int>(random() % 96);
        // From a random place on, and then back.
        const int from = order.back();
        for (int k = 1; k <= 5; ++k) order.push_back(from + k);
        for (int k = 4; k >= 3; --k) order.push_back(from + k);
        const std::vector<int> looks{order[3], order[7], from + 5, from + 3};
        expect_history_does_not_matter(world, settings(GetParam(), 0.5), order, looks);
    }
}

/// The same random edits for two jobs.
class Editor {
  public:
    explicit Editor(unsigned seed) : random_(seed) {}

    void edit(SequenceState& one, SequenceState& two) {
        const auto what = random_() % 7;
        const Rgb colour(uniform(0, 0.8F), uniform(0, 0.8F), uniform(0, 0.8F));
        const Vec3 place(uniform(0.5F, 3.3F), uniform(0.2F, 2), uniform(0.5F, 4));
        Path path;
        path.keys = {{0, {place, Quat(1, 0, 0, 0)}},
                     {1, {Vec3(4) - place, glm::angleAxis(uniform(0, 1), Vec3(0, 1, 0))}}};
        const double from_s = static_cast<double>(uniform(0, 1));
        Body object;
        object.name = "object " + std::to_string(++objects_);
        testing::add_box(object, place, place + Vec3(uniform(0.1F, 0.4F)), 0);
        for (SequenceState* state : {&one, &two}) {
            if (what == 0) set_reflectance(*state, "grey", Rgb(0.1F) + colour);
            if (what == 1) set_emission(*state, "lamp", Rgb(0.2F) + colour, Context(2));
            if (what == 2 || what == 3)
                set_path(*state, state->parts().world.bodies[1].name, from_s, path, Context(2));
            if (what == 4 || what == 5) add_furniture(*state, object, Context(2));
            if (what == 6 && !state->parts().world.pieces.empty())
                remove_furniture(*state, state->parts().world.pieces.front().name, Context(2));
        }
    }
    int any_frame() { return static_cast<int>(random_() % 40); }

  private:
    float uniform(float low, float high) {
        return low + (high - low) * static_cast<float>(random_() % 1000) / 1000;
    }
    std::mt19937 random_;
    int objects_ = 0;
};

TEST_P(History, DoesNotMatterWhateverIsEdited) {
    for (const unsigned seed : {1U, 2U, 3U}) {
        const World world = testing::random_world(seed, 3, testing::Movements::turning);
        const SequenceConfig config = settings(GetParam(), 0.5);
        SequenceState following = make_state(world, config, Context(2));
        SequenceState cold = make_state(world, config, Context(2));
        // Both have all lines, so that edits find the same to keep.
        show_frame(following, 3);
        show_frame(cold, 3);
        Editor editor(seed);
        for (int round = 0; round < 8; ++round) {
            if (round % 3 != 2) editor.edit(following, cold);
            const int frame = editor.any_frame();
            const Shown followed = show_frame(following, frame);
            forget_frames(cold.parts());
            expect_same(cold, frame, followed, show_frame(cold, frame));
            ASSERT_FALSE(HasFailure()) << "seed " << seed << " round " << round;
        }
    }
}

std::string name_of_case(const ::testing::TestParamInfo<Method>& info) {
    std::string name(info.param.name);
    std::erase(name, '-');
    return name;
}

/// All methods that promise something of all patches: what is solved in view alone, does not.
std::vector<Method> whole_methods() {
    std::vector<Method> whole;
    for (const Method& method : methods())
        if (method.solution != Solution::in_view) whole.push_back(method);
    return whole;
}

INSTANTIATE_TEST_SUITE_P(Stability, History, ::testing::ValuesIn(whole_methods()), name_of_case);

}  // namespace
}  // namespace afterglow
