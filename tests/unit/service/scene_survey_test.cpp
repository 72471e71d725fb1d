#include "service/store/scene_survey.h"

#include <chrono>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "service/base/problem.h"
#include "solver/base/file.h"
#include "tests/unit/service/fake_solver.h"
#include "tests/unit/service/sanitized.h"

namespace afterglow {
namespace {

using testing::HasSubstr;

const std::filesystem::path daemon_path = AFTERGLOW_BIN_DIR "/afterglowd";

SurveyConfig real_children() {
    SurveyConfig config;
    config.program = daemon_path;
    return config;
}

/// The code of the problem that a survey ends with; empty where it succeeds.
std::string code_of(const SurveyConfig& config, const WorldSource& source) {
    try {
        surveys_in_children(config)(source, 0);
        return "";
    } catch (const ProblemError& e) {
        EXPECT_EQ(e.problem().status, 422);
        EXPECT_EQ(e.problem().place, source.upload.name);
        EXPECT_FALSE(e.problem().detail.empty());
        return e.problem().code;
    }
}

class SceneSurveyTest : public testing::Test {
  protected:
    WorldSource sample() const {
        return {AFTERGLOW_TEST_DATA "/living-room.glb", {SceneFormat::glb, "living-room.glb", {}}, {}};
    }
    /// A program of one shell line in the reader's place.
    SurveyConfig instead(const std::string& line) const {
        const auto path = folder_.path() / "program";
        write_file(path, "#!/bin/sh\n" + line + "\n");
        std::filesystem::permissions(path, std::filesystem::perms::owner_all);
        SurveyConfig config;
        config.program = path;
        return config;
    }
    /// A carpet of many triangles: its text is small beside what reading it takes.
    WorldSource carpet(int triangles) const {
        std::ofstream out(folder_.path() / "carpet.obj");
        out << "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
        for (int i = 0; i < triangles; ++i) out << "f 1 2 3\n";
        WorldSource source{folder_.path() / "carpet.obj", {SceneFormat::obj, "carpet.obj", {}}, {}};
        source.upload.load.background = Rgb(1);
        return source;
    }
    ScratchFolder folder_;
};

TEST_F(SceneSurveyTest, AChildFindsWhatIsFoundHere) {
    WorldSource source = sample();
    for (const double fps : {0.0, 7.0}) {
        const SceneSurvey here = surveys_here(usual_reader())(source, fps);
        const SceneSurvey there = surveys_in_children(real_children())(source, fps);
        EXPECT_GT(here.triangles, 0U);
        EXPECT_EQ(there.triangles, here.triangles);
        EXPECT_EQ(there.actors, here.actors);
        EXPECT_EQ(there.cameras, here.cameras);
        EXPECT_EQ(there.frames_per_second, here.frames_per_second);
        EXPECT_EQ(there.last_frame, here.last_frame);
        ASSERT_EQ(there.warnings.size(), here.warnings.size());
        for (std::size_t i = 0; i < here.warnings.size(); ++i) {
            EXPECT_EQ(there.warnings[i].place, here.warnings[i].place);
            EXPECT_EQ(there.warnings[i].message, here.warnings[i].message);
        }
    }
}

TEST_F(SceneSurveyTest, AnUnusableFileIsTheSameErrorAsHere) {
    const auto path = folder_.path() / "bad.glb";
    write_file(path, "no scene at all");
    const WorldSource source{path, {SceneFormat::glb, "mine.glb", {}}, {}};
    const auto told = [&](const Surveyor& surveyor) {
        try {
            surveyor(source, 0);
        } catch (const Error& e) {
            return std::to_string(static_cast<int>(e.kind())) + e.what();
        }
        return std::string("accepted");
    };
    EXPECT_EQ(told(surveys_in_children(real_children())), told(surveys_here(usual_reader())));
    EXPECT_THAT(told(surveys_here(usual_reader())), HasSubstr("mine.glb"));
}

TEST_F(SceneSurveyTest, AFileThatTakesTooMuchMemoryIsRefused) {
    if (takes_all_address_space) return;
    SurveyConfig config = real_children();
    config.limits.memory_bytes = std::uint64_t{24} << 20U;
    EXPECT_EQ(code_of(config, carpet(1'000'000)), "scene_out_of_memory");
    EXPECT_EQ(code_of(config, sample()), "") << "others are read as before";
}

TEST_F(SceneSurveyTest, AFileThatTakesTooMuchTimeIsRefused) {
    SurveyConfig config = real_children();
    config.wall = std::chrono::milliseconds(1);
    EXPECT_EQ(code_of(config, carpet(1'000'000)), "scene_out_of_time");
    config = instead("while :; do :; done");
    config.limits.cpu = std::chrono::seconds(1);
    config.wall = std::chrono::milliseconds(200);
    EXPECT_EQ(code_of(config, sample()), "scene_out_of_time");
}

TEST_F(SceneSurveyTest, ProcessorTimeIsLimitedToo) {
    // A shell stands for a reader that loops; it takes its limit from the arguments as a child does.
    SurveyConfig config = instead("ulimit -St $4; while :; do :; done");
    config.limits.cpu = std::chrono::seconds(1);
    EXPECT_EQ(code_of(config, sample()), "scene_out_of_time");
}

TEST_F(SceneSurveyTest, AReaderThatDiesFailsOnlyItsFile) {
    EXPECT_EQ(code_of(instead("kill -SEGV $$"), sample()), "scene_crashed_reader");
    EXPECT_EQ(code_of(instead("kill -ABRT $$"), sample()), "scene_crashed_reader");
    EXPECT_EQ(code_of(instead("exit 0"), sample()), "scene_crashed_reader");
    EXPECT_EQ(code_of(instead("echo this is nonsense, and long enough for a head >&3; sleep 100"), sample()),
              "scene_crashed_reader");
    EXPECT_EQ(code_of(real_children(), sample()), "");
}

TEST_F(SceneSurveyTest, AChildGetsNeitherDescriptorsNorTheEnvironment) {
    ::setenv("AFTERGLOW_TOKEN", "a secret", 1);
    const std::ifstream open_here(AFTERGLOW_TEST_DATA "/living-room.glb");
    const std::string out = (folder_.path() / "out").string();
    code_of(instead("/usr/bin/env > " + out + "; ls /proc/$$/fd >> " + out), sample());
    ::unsetenv("AFTERGLOW_TOKEN");
    const std::string seen = read_file(out);
    EXPECT_THAT(seen, testing::Not(HasSubstr("secret")));
    EXPECT_THAT(seen, testing::Not(HasSubstr("HOME=")));
    // 10 and above are the shell's own, for its script.
    for (const char* number : {"\n4\n", "\n5\n", "\n6\n", "\n7\n", "\n8\n", "\n9\n"})
        EXPECT_THAT(seen, testing::Not(HasSubstr(number)));
    EXPECT_THAT(seen, HasSubstr("\n3\n"));
}

}  // namespace
}  // namespace afterglow
