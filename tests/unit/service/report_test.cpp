#include "service/commands/report.h"

#include <filesystem>
#include <iterator>
#include <string>
#include <unistd.h>
#include <vector>

#include <gtest/gtest.h>

#include "solver/base/error.h"
#include "solver/base/file.h"

namespace afterglow {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> keys(const Json& object) {
    std::vector<std::string> out;
    for (const auto& [key, value] : object.items()) out.push_back(key);
    return out;
}

TEST(Report, HasTheFieldsOfTheContractInOrder) {
    Report report;
    report.scene = "room.glb";
    report.sequence.method = "full";
    report.load = Milliseconds(1.5);
    report.sequence.patches = 10;
    FrameStatistics frame;
    frame.frame = 4;
    frame.total = Milliseconds(7);
    frame.rays_traced = 3'000'000'000;
    frame.error_bound = 0.25;
    report.frames = {frame, frame};
    report.frames[1].picture_error = 0.03;
    report.frames[1].picture_error_spread = 0.01;
    report.frames[1].line_noise = 0.02;

    const Json json = to_json(report, 12.5);
    EXPECT_EQ(keys(json),
              (std::vector<std::string>{"scene", "method", "patches", "actor_patches", "sight_lines",
                                        "rays_per_patch", "load_ms", "static_ms", "precompute", "peak_rss_mb",
                                        "frames", "made_for_error", "method_reason"}));
    EXPECT_EQ(keys(json["frames"][0]),
              (std::vector<std::string>{"frame", "ms", "rays_traced", "visibility_changes", "shots",
                                        "active_patches", "residual", "error_bound", "picture_error",
                                        "picture_error_spread", "line_noise"}));
    EXPECT_EQ(json["frames"][0]["picture_error"], nullptr);
    EXPECT_EQ(keys(json["frames"][0]["ms"]),
              (std::vector<std::string>{"visibility", "solve", "image", "total"}));
    EXPECT_EQ(json["frames"].size(), 2U);
    EXPECT_EQ(json["frames"][1]["picture_error"], 0.03);
    EXPECT_EQ(json["frames"][1]["picture_error_spread"], 0.01);
    EXPECT_EQ(json["frames"][1]["line_noise"], 0.02);
    EXPECT_EQ(json["precompute"], Json::array());
    EXPECT_EQ(json["load_ms"], 1.5);
    EXPECT_EQ(json["peak_rss_mb"], 12.5);
    EXPECT_EQ(json["frames"][1]["rays_traced"], 3'000'000'000);
    EXPECT_EQ(json["frames"][1]["ms"]["total"], 7.0);
}

TEST(Report, WithoutFramesIsStillAList) {
    EXPECT_EQ(to_json(Report(), 0)["frames"], Json::array());
}

TEST(PeakMemory, CoversWhatWasTouched) {
    const double before = peak_memory_mb();
    EXPECT_GT(before, 1);
    // Twice the old peak cannot fit into it.
    const std::vector<char> block(static_cast<std::size_t>(2e6 * before), 'x');
    EXPECT_GT(peak_memory_mb(), 1.5 * before) << block.back();
}

TEST(WritableFile, IsProbedWithoutTouchingAnything) {
    const fs::path folder = fs::path(testing::TempDir()) / ("afterglow_report_" + std::to_string(::getpid()));
    fs::create_directories(folder / "taken");
    EXPECT_NO_THROW(require_writable_file(folder / "new.json"));
    EXPECT_FALSE(fs::exists(folder / "new.json"));
    write_file(folder / "old.json", "old");
    EXPECT_NO_THROW(require_writable_file(folder / "old.json"));
    EXPECT_EQ(read_file(folder / "old.json"), "old");
    EXPECT_THROW(require_writable_file(folder / "taken"), Error);
    EXPECT_THROW(require_writable_file(folder / "missing" / "r.json"), Error);
    EXPECT_THROW(require_writable_file("/dev/null"), Error);
    EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), 2);
    fs::remove_all(folder);
}

}  // namespace
}  // namespace afterglow
