#include "service/jobs/settings.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "service/jobs/job_json.h"

namespace afterglow {
namespace {

JobRequest read(const std::string& text, const Limits& limits = {}) {
    const Json json = parse_json(text, "request");
    return read_job_request(JsonView(json, "request"), limits);
}

JobSettings settings(const std::string& text) {
    return read(R"({"scene":"s","settings":)" + text + "}").settings;
}

/// The place that the error of unusable settings names.
std::string place_of_error(const std::string& request) {
    try {
        read(request);
    } catch (const Error& e) {
        return e.place();
    }
    return "accepted";
}

TEST(Settings, LeftOutOnesKeepTheDefaults) {
    const JobRequest request = read(R"({"scene":"s"})");
    const SequenceConfig defaults;
    EXPECT_EQ(request.scene, "s");
    EXPECT_TRUE(request.paths.empty());
    EXPECT_FALSE(request.settings.frames.has_value());
    EXPECT_EQ(request.settings.sequence.width, defaults.width);
    EXPECT_EQ(request.settings.sequence.visibility, defaults.visibility);
    EXPECT_EQ(request.settings.sequence.seed, defaults.seed);
}

TEST(Settings, EveryFieldArrives) {
    const JobSettings s = settings(R"({"frames":"3-7","fps":30,"width":64,"height":32,"quality":"final",
        "visibility":"retrace","solution":"progressive","rays":64,"patch_size_m":0.25,"error":0.05,"estimate":"probes","camera":"Eye",
        "seed":7,"exposure_ev":-1.5,"background":[0.1,0.2,0.3]})");
    EXPECT_EQ(s.frames, (FrameRange{3, 7}));
    EXPECT_EQ(s.sequence.frames_per_second, 30);
    EXPECT_EQ(s.sequence.width, 64);
    EXPECT_EQ(s.sequence.height, 32);
    EXPECT_EQ(s.sequence.quality, Quality::final);
    EXPECT_EQ(s.sequence.visibility, Visibility::retrace);
    EXPECT_EQ(s.sequence.rays_per_patch, 64);
    EXPECT_EQ(s.sequence.patch_size_m, 0.25);
    EXPECT_EQ(s.sequence.asked_error, 0.05);
    EXPECT_EQ(s.sequence.estimate, Estimate::probes);
    EXPECT_EQ(s.sequence.camera, "Eye");
    EXPECT_EQ(s.sequence.seed, 7U);
    EXPECT_EQ(s.sequence.exposure_ev, -1.5);
    EXPECT_EQ(s.background, Rgb(0.1F, 0.2F, 0.3F));
}

TEST(Settings, WhatIsShownCanBeReadAgain) {
    const JobSettings s = settings(R"({"frames":"5","width":64,"rays":64,"error":0.1,"seed":3})");
    const Json shown = to_json(s);
    // Null stands for "not given", which a request says by leaving the field out.
    Json request;
    for (const auto& [key, value] : shown.items())
        if (!value.is_null()) request[key] = value;
    const JobSettings again = settings(request.dump());
    EXPECT_EQ(to_json(again), to_json(s));
    EXPECT_EQ(again.frames, (FrameRange{5, 5}));
}

TEST(Settings, EveryMethodCanBeNamed) {
    for (const Method& method : methods()) {
        const JobSettings s = settings(R"({"method":")" + std::string(method.name) + R"("})");
        EXPECT_EQ(s.sequence.visibility, method.visibility);
        EXPECT_EQ(s.sequence.solution, method.solution);
    }
}

struct Wrong {
    std::string settings;
    std::string field;
};

class WrongSettings : public testing::TestWithParam<Wrong> {};

TEST_P(WrongSettings, AreRefusedAtTheirPlace) {
    EXPECT_EQ(place_of_error(R"({"scene":"s","settings":)" + GetParam().settings + "}"),
              "request#/settings" + GetParam().field);
}

INSTANTIATE_TEST_SUITE_P(
    Settings, WrongSettings,
    testing::Values(Wrong{R"({"widht":64})", "/widht"}, Wrong{R"({"width":0})", "/width"},
                    Wrong{R"({"width":"64"})", "/width"}, Wrong{R"({"width":1.5})", "/width"},
                    Wrong{R"({"height":1e300})", "/height"}, Wrong{R"({"width":16384,"height":16384})", ""},
                    Wrong{R"({"frames":3})", "/frames"}, Wrong{R"({"frames":""})", "/frames"},
                    Wrong{R"({"frames":"-1"})", "/frames"}, Wrong{R"({"frames":"5-2"})", "/frames"},
                    Wrong{R"({"frames":"1-2-3"})", "/frames"}, Wrong{R"({"frames":" 1"})", "/frames"},
                    Wrong{R"({"frames":"0-99999999999"})", "/frames"},
                    Wrong{R"({"frames":"0-100000"})", "/frames"}, Wrong{R"({"fps":0})", "/fps"},
                    Wrong{R"({"fps":-24})", "/fps"}, Wrong{R"({"quality":"best"})", "/quality"},
                    Wrong{R"({"estimate":"guess"})", "/estimate"}, Wrong{R"({"method":"magic"})", "/method"},
                    Wrong{R"({"visibility":"x"})", "/visibility"}, Wrong{R"({"solution":1})", "/solution"},
                    Wrong{R"({"rays":1})", "/rays"}, Wrong{R"({"rays":1e9})", "/rays"},
                    Wrong{R"({"patch_size_m":0})", "/patch_size_m"}, Wrong{R"({"error":1})", "/error"},
                    Wrong{R"({"error":0})", "/error"}, Wrong{R"({"seed":-1})", "/seed"},
                    Wrong{R"({"camera":null})", "/camera"},
                    Wrong{R"({"exposure_ev":"auto"})", "/exposure_ev"},
                    Wrong{R"({"background":[0,0]})", "/background"},
                    Wrong{R"({"background":[0,-1,0]})", "/background"}, Wrong{"[]", ""}, Wrong{"null", ""}));

TEST(Settings, ARequestWithoutASceneOrWithMoreIsRefused) {
    EXPECT_EQ(place_of_error("{}"), "request");
    EXPECT_EQ(place_of_error(R"({"scene":1})"), "request#/scene");
    EXPECT_EQ(place_of_error(R"({"scene":"s","extra":1})"), "request#/extra");
    EXPECT_EQ(place_of_error("[]"), "request");
}

TEST(Settings, LimitsAreExact) {
    Limits limits;
    limits.frames = 10;
    limits.pixels = 100;
    const std::string small = R"("width":10,"height":10)";
    EXPECT_NO_THROW(read(R"({"scene":"s","settings":{"frames":"1-10",)" + small + "}}", limits));
    EXPECT_THROW(read(R"({"scene":"s","settings":{"frames":"0-10",)" + small + "}}", limits), Error);
    EXPECT_THROW(read(R"({"scene":"s","settings":{"width":101,"height":1}})", limits), Error);
}

TEST(Settings, AChangeOfAJobIsItsPriorityOnly) {
    const auto read = [](const std::string& text) {
        const Json json = parse_json(text, "request");
        return read_priority(JsonView(json, "request"));
    };
    EXPECT_EQ(read("{}"), std::nullopt);
    EXPECT_EQ(read(R"({"priority": -10})"), -10);
    EXPECT_EQ(read(R"({"priority": null})"), 0);
    for (const char* bad : {"[]", "1", R"({"priority": 11})", R"({"priority": 1.5})", R"({"priority": "1"})",
                            R"({"state": "paused"})", R"({"priority": 1, "more": 1})"})
        EXPECT_THROW(read(bad), Error) << bad;
}

}  // namespace
}  // namespace afterglow
