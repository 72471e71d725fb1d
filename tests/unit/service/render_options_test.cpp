#include "service/commands/render_options.h"

#include <cstdlib>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "solver/base/error.h"

namespace afterglow {
namespace {

using testing::HasSubstr;

RenderOptions read(std::vector<const char*> arguments) {
    return std::get<RenderOptions>(read_render_options(arguments));
}

Error failure(std::vector<const char*> arguments) {
    try {
        read_render_options(arguments);
    } catch (const Error& e) {
        return e;
    }
    return {ErrorKind::cancelled, "no failure", ""};
}

TEST(RenderOptions, DefaultsAreThoseOfTheSolver) {
    const RenderOptions options = read({"room.glb"});
    const SequenceConfig defaults;
    EXPECT_EQ(options.scene, "room.glb");
    EXPECT_EQ(options.out, "out");
    EXPECT_FALSE(options.paths || options.frames || options.report);
    EXPECT_EQ(options.threads, 0);
    EXPECT_EQ(options.sequence.visibility, defaults.visibility);
    EXPECT_EQ(options.sequence.solution, defaults.solution);
    EXPECT_EQ(options.sequence.rays_per_patch, defaults.rays_per_patch);
    EXPECT_EQ(options.sequence.asked_error, defaults.asked_error);
    EXPECT_FALSE(options.sequence.patch_size_m || options.sequence.exposure_ev);
    EXPECT_EQ(options.sequence.revisions, Revisions::final_only);
    EXPECT_FALSE(options.load.background);
}

TEST(RenderOptions, EveryOptionReachesItsField) {
    const RenderOptions o = read({"--paths",
                                  "p.json",
                                  "--frames",
                                  "3-9",
                                  "--fps",
                                  "12.5",
                                  "--size=320x180",
                                  "--quality",
                                  "final",
                                  "--rays",
                                  "512",
                                  "--patch-size",
                                  "0.25",
                                  "--error",
                                  "1%",
                                  "--estimate",
                                  "probes",
                                  "--camera",
                                  "side",
                                  "--threads",
                                  "3",
                                  "--seed",
                                  "18446744073709551",
                                  "--out",
                                  "o",
                                  "--report",
                                  "r.json",
                                  "--background",
                                  "0,0.5,1",
                                  "--unit",
                                  "cm",
                                  "--up",
                                  "z",
                                  "--punctual-lights",
                                  "per-683",
                                  "--exposure",
                                  "-1.5",
                                  "--cache",
                                  "c",
                                  "--quiet",
                                  "a.obj"});
    EXPECT_EQ(o.scene, "a.obj");
    EXPECT_EQ(o.paths, "p.json");
    EXPECT_EQ(o.frames, (FrameRange{3, 9}));
    EXPECT_EQ(o.sequence.frames_per_second, 12.5);
    EXPECT_EQ(o.sequence.width, 320);
    EXPECT_EQ(o.sequence.height, 180);
    EXPECT_EQ(o.sequence.quality, Quality::final);
    EXPECT_EQ(o.sequence.rays_per_patch, 512);
    EXPECT_EQ(o.sequence.patch_size_m, 0.25);
    EXPECT_EQ(o.sequence.asked_error, 0.01);
    EXPECT_EQ(o.sequence.estimate, Estimate::probes);
    EXPECT_EQ(o.sequence.camera, "side");
    EXPECT_EQ(o.threads, 3);
    EXPECT_EQ(o.sequence.seed, 18446744073709551U);
    EXPECT_EQ(o.out, "o");
    EXPECT_EQ(o.report, "r.json");
    EXPECT_EQ(o.load.background, Rgb(0, 0.5F, 1));
    EXPECT_EQ(o.load.obj_unit_m, 0.01);
    EXPECT_EQ(o.load.obj_up, UpAxis::z);
    EXPECT_EQ(o.load.lumen_scale, LumenScale::divide);
    EXPECT_EQ(o.sequence.exposure_ev, -1.5);
    EXPECT_EQ(o.sequence.cache_folder, "c");
    EXPECT_EQ(o.progress, RenderOptions::Progress::hidden);
}

TEST(RenderOptions, AMethodSetsBothAxesAndEachAxisOverrides) {
    for (const Method& method : methods()) {
        const std::string name(method.name);
        const RenderOptions plain = read({"a.glb", "--method", name.c_str()});
        EXPECT_EQ(plain.sequence.visibility, method.visibility) << name;
        EXPECT_EQ(plain.sequence.solution, method.solution) << name;
        const RenderOptions other = read({"a.glb", "--visibility", "retrace", "--method", name.c_str()});
        EXPECT_EQ(other.sequence.visibility, Visibility::retrace) << name;
        EXPECT_EQ(other.sequence.solution, method.solution) << name;
    }
}

TEST(RenderOptions, FailuresNameTheOption) {
    for (const auto& [option, value] :
         std::vector<std::pair<const char*, const char*>>{{"--frames", "9-3"},
                                                          {"--fps", "0"},
                                                          {"--size", "0x0"},
                                                          {"--rays", "8"},
                                                          {"--error", "2"},
                                                          {"--patch-size", "0"},
                                                          {"--threads", "0"},
                                                          {"--seed", "-1"},
                                                          {"--exposure", "hi"},
                                                          {"--unit", "mile"},
                                                          {"--up", "x"},
                                                          {"--punctual-lights", "no"},
                                                          {"--background", "1"},
                                                          {"--out", ""},
                                                          {"--report", ""},
                                                          {"--cache", ""},
                                                          {"--paths", ""}}) {
        const Error error = failure({"a.glb", option, value});
        EXPECT_EQ(error.kind(), ErrorKind::invalid_input) << option;
        EXPECT_EQ(error.place(), option);
    }
    for (const char* option : {"--method", "--visibility", "--solution", "--quality", "--estimate"}) {
        const Error error = failure({"a.glb", option, "magic"});
        EXPECT_EQ(error.kind(), ErrorKind::not_found) << option;
        EXPECT_THAT(error.what(), HasSubstr("\"magic\"; there are: "));
    }
}

TEST(RenderOptions, UnknownMissingAndRepeatedOptionsAreRefusedInOneLine) {
    for (const auto& arguments :
         std::vector<std::vector<const char*>>{{},
                                               {"a.glb", "b.glb"},
                                               {"a.glb", "--ray", "16"},
                                               {"a.glb", "--rays"},
                                               {"a.glb", "--rays", "16", "--rays", "32"}}) {
        const Error error = failure(arguments);
        EXPECT_EQ(error.kind(), ErrorKind::invalid_input);
        EXPECT_THAT(error.what(), testing::Not(HasSubstr("\n")));
    }
}

TEST(RenderOptions, HelpListsEveryOptionOfTheContract) {
    const std::vector<const char*> arguments{"--help"};
    const auto help = std::get<HelpText>(read_render_options(arguments));
    for (const char* option : {"--paths",    "--frames",     "--fps",      "--size", "--quality",
                               "--method",   "--visibility", "--solution", "--rays", "--patch-size",
                               "--error",    "--camera",     "--threads",  "--seed", "--out",
                               "--report",   "--background", "--unit",     "--up",   "--punctual-lights",
                               "--exposure", "--cache",      "--quiet"})
        EXPECT_THAT(help.text, HasSubstr(option));
}

TEST(CacheFolder, FollowsTheBaseDirectoryRules) {
    ::setenv("HOME", "/h", 1);
    ::setenv("XDG_CACHE_HOME", "/x", 1);
    EXPECT_EQ(default_cache_folder(), "/x/afterglow");
    EXPECT_EQ(read({"a.glb"}).sequence.cache_folder, "/x/afterglow");
    EXPECT_EQ(read({"a.glb", "--cache", "none"}).sequence.cache_folder, "");
    ::setenv("XDG_CACHE_HOME", "relative", 1);
    EXPECT_EQ(default_cache_folder(), "/h/.cache/afterglow");
    ::unsetenv("XDG_CACHE_HOME");
    EXPECT_EQ(default_cache_folder(), "/h/.cache/afterglow");
    ::unsetenv("HOME");
    EXPECT_EQ(default_cache_folder(), "");
}

}  // namespace
}  // namespace afterglow
