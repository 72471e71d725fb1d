#include "solver/scene/check_tracks.h"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>

#include "tests/unit/scene/test_scenes.h"

namespace afterglow {
namespace {

using testing::HasSubstr;

std::string refusal(const Scene& scene) {
    try {
        check_tracks(scene);
    } catch (const Error& e) {
        return e.what();
    }
    return "accepted";
}

std::string refusal_of_keys(std::vector<Key<Vec3>> keys) {
    Scene scene = room_scene();
    scene.tracks.node_translation.push_back({0, std::move(keys)});
    return refusal(scene);
}

TEST(CheckTracks, AcceptsJumpsAndSingleKeys) {
    EXPECT_EQ(refusal_of_keys({{0, Vec3(0)}, {1, Vec3(0)}, {1, Vec3(1)}}), "accepted");
    EXPECT_EQ(refusal_of_keys({{5, Vec3(0)}}), "accepted");
}

TEST(CheckTracks, RejectsBrokenKeys) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THAT(refusal_of_keys({}), HasSubstr("no keys"));
    EXPECT_THAT(refusal_of_keys({{1, Vec3(0)}, {0.5, Vec3(0)}}),
                HasSubstr(R"(node "room", translation key 1)"));
    EXPECT_THAT(refusal_of_keys({{-1, Vec3(0)}}), HasSubstr("time"));
    EXPECT_THAT(refusal_of_keys({{nan, Vec3(0)}}), HasSubstr("time"));
    EXPECT_THAT(refusal_of_keys({{0, Vec3(0, static_cast<float>(nan), 0)}}), HasSubstr("not finite"));
}

TEST(CheckTracks, RejectsValuesOutOfRange) {
    Scene scene = room_scene();
    scene.tracks.node_rotation.push_back({0, {{0, Quat(1, 1, 0, 0)}}});
    EXPECT_THAT(refusal(scene), HasSubstr("not a rotation"));
    scene = room_scene();
    scene.tracks.material_emission.push_back({1, {{0, -1.0F}}});
    EXPECT_THAT(refusal(scene), HasSubstr(R"(material "lamp", emission scale key 0)"));
    scene = room_scene();
    scene.tracks.material_reflectance.push_back({0, {{0, Rgb(0.1F, -0.1F, 0)}}});
    EXPECT_THAT(refusal(scene), HasSubstr("negative"));
}

TEST(CheckTracks, RejectsTwoTracksForOneProperty) {
    Scene scene = room_scene();
    scene.tracks.node_translation = {{0, {{0, Vec3(0)}}}, {1, {{0, Vec3(0)}}}};
    EXPECT_EQ(refusal(scene), "accepted");
    scene.tracks.node_translation[1].target = 0;
    EXPECT_THAT(refusal(scene), HasSubstr("more than one track"));
}

TEST(CheckTracks, LimitsFrameRateAndLength) {
    Scene scene = room_scene();
    scene.frames_per_second = 0;
    EXPECT_THAT(refusal(scene), HasSubstr("frame rate"));
    scene.frames_per_second = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THAT(refusal(scene), HasSubstr("frame rate"));
    EXPECT_THAT(refusal_of_keys({{0, Vec3(0)}, {1e9, Vec3(1)}}), HasSubstr("million frames"));
}

TEST(LastKeyTime, LooksAtEveryKindOfTrack) {
    Tracks tracks;
    EXPECT_EQ(last_key_time(tracks), 0);
    tracks.node_rotation.push_back({0, {{0, Quat(1, 0, 0, 0)}, {2, Quat(1, 0, 0, 0)}}});
    tracks.material_reflectance.push_back({0, {{0, Rgb(0)}, {7, Rgb(0)}}});
    EXPECT_EQ(last_key_time(tracks), 7);
}

}  // namespace
}  // namespace afterglow
