#include "service/api/scene_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "service/base/identity.h"
#include "solver/base/error.h"
#include "solver/base/file.h"
#include "solver/scene/bundle.h"
#include "tests/unit/service/fake_solver.h"
#include "tests/unit/service/zip_builder.h"

namespace afterglow {
namespace {

using testing::HasSubstr;
using Files = std::vector<std::pair<std::string, std::string>>;

const Files room = {{"room/a.bin", "12"}, {"room/room.gltf", "{}"}, {"room/t/wood.png", "png"}};

class SceneFilesTest : public testing::Test {
  protected:
    PackedScene read(const Request& request) { return read_scene_files(request, blobs_, limits_); }
    static Request form(const Files& files, const std::string& main = {}) {
        Request request{"POST", "/v1/scenes", {}, {{"content-type", "multipart/form-data; boundary=x"}}, ""};
        for (const auto& [name, content] : files) request.parts.push_back({"file", name, content});
        if (!main.empty()) request.query["main"] = main;
        return request;
    }
    static Request archive(const Files& files) {
        return {"POST", "/v1/scenes", {}, {{"content-type", "application/zip"}}, zip_of(files)};
    }
    static Request manifest(const std::string& body) {
        return {"POST", "/v1/scenes", {}, {{"content-type", manifest_type}}, body};
    }
    Request manifest(const Files& files, const std::string& main = {}) {
        Json json = {{"files", Json::object()}};
        if (!main.empty()) json["main"] = main;
        for (const auto& [name, content] : files) {
            blobs_.put(sha256(content), content);
            json["files"][name] = {{"sha256", sha256(content)}};
        }
        return manifest(json.dump());
    }
    void expect_error(const Request& request, ErrorKind kind, const std::string& what) {
        try {
            read(request);
            ADD_FAILURE() << "was taken";
        } catch (const Error& e) {
            EXPECT_EQ(e.kind(), kind) << e.what();
            EXPECT_THAT(e.what(), HasSubstr(what));
        }
    }

    ScratchFolder folder_;
    BlobStore blobs_{folder_.path(), 1 << 20};
    Limits limits_;
};

TEST_F(SceneFilesTest, TheSameFilesAreTheSameSceneHoweverTheyCome) {
    const PackedScene from_form = read(form(room));
    EXPECT_EQ(from_form.format, SceneFormat::bundle);
    EXPECT_EQ(unpack(from_form.bytes, "x").main, "room/room.gltf");
    EXPECT_EQ(read(archive(room)).bytes, from_form.bytes);
    EXPECT_EQ(read(archive({room.rbegin(), room.rend()})).bytes, from_form.bytes);
    EXPECT_EQ(read(manifest(room)).bytes, from_form.bytes);
}

TEST_F(SceneFilesTest, ASingleFileGoesByItself) {
    const PackedScene alone = read(archive({{"chair.obj", "v 0 0 0"}}));
    EXPECT_EQ(alone.format, SceneFormat::obj);
    EXPECT_EQ(alone.bytes, "v 0 0 0");
}

TEST_F(SceneFilesTest, TheSceneIsNamedWhereThereIsAChoice) {
    const Files both = {{"a.json", "{}"}, {"b.obj", ""}};
    expect_error(form(both), ErrorKind::invalid_input, "\"a.json\" or \"b.obj\"");
    EXPECT_EQ(unpack(read(form(both, "b.obj")).bytes, "x").main, "b.obj");
    EXPECT_EQ(unpack(read(manifest(both, "a.json")).bytes, "x").main, "a.json");
    expect_error(form(both, "c.obj"), ErrorKind::invalid_input, "c.obj");
    expect_error(form({{"a.png", ""}}), ErrorKind::invalid_input, "no file ends in");
    expect_error(form({}), ErrorKind::invalid_input, "no file ends in");
    EXPECT_EQ(unpack(read(archive({{"__MACOSX/._a.obj", "x"}, {"a.obj", ""}})).bytes, "x").main, "a.obj");
}

TEST_F(SceneFilesTest, PathsOutOfTheUploadAreRefused) {
    for (const char* name : {"../a.obj", "/a.obj", "a/../../b.obj", "C:\\a.obj", "a\\..\\b.obj"}) {
        expect_error(form({{name, ""}}), ErrorKind::invalid_input, "no path inside");
        expect_error(archive({{name, ""}}), ErrorKind::invalid_input, "no path inside");
        expect_error(manifest({{name, ""}}), ErrorKind::invalid_input, "no path inside");
    }
    expect_error(form({{"a.obj", ""}, {"a.obj", "1"}}), ErrorKind::invalid_input, "more than once");
}

TEST_F(SceneFilesTest, LimitsHoldForEveryKind) {
    limits_.scene_files = 2;
    for (const Request& request : {form(room), archive(room), manifest(room)})
        expect_error(request, ErrorKind::too_large, "more than the limit of 2 files");
    limits_ = {};
    limits_.upload_bytes = 6;
    for (const Request& request : {form(room), archive(room), manifest(room)})
        expect_error(request, ErrorKind::too_large, "more than the limit of 6 bytes");
}

TEST_F(SceneFilesTest, AChildUnpacksWhatIsUnpackedHere) {
    SurveyConfig config;
    config.program = AFTERGLOW_BIN_DIR "/afterglowd";
    const Unpacker there = unpacks_in_children(std::make_shared<ReaderChildren>(config));
    const auto read_there = [&](const Request& request) {
        return read_scene_files(request, blobs_, limits_, there);
    };
    for (const Files& files : {room, Files{{"chair.obj", "v 0 0 0"}}}) {
        const PackedScene here = read(archive(files));
        const PackedScene found = read_there(archive(files));
        EXPECT_EQ(found.bytes, here.bytes);
        EXPECT_EQ(found.format, here.format);
    }
    // What is wrong is said in the same words.
    limits_.upload_bytes = 6;
    const Request damaged{"POST", "/v1/scenes", {}, {{"content-type", "application/zip"}}, "no archive"};
    for (const Request& request : {archive(room), archive({{"../a.obj", ""}}), damaged}) {
        std::string here;
        try {
            read(request);
        } catch (const Error& e) {
            here = e.what();
        }
        try {
            read_there(request);
            ADD_FAILURE() << "was taken";
        } catch (const Error& e) {
            EXPECT_EQ(e.what(), here);
            EXPECT_FALSE(here.empty());
        }
    }
}

TEST_F(SceneFilesTest, AnUnpackerThatDiesFailsOnlyItsArchive) {
    const auto program = folder_.path() / "program";
    write_file(program, "#!/bin/sh\nkill -SEGV $$\n");
    std::filesystem::permissions(program, std::filesystem::perms::owner_all);
    SurveyConfig config;
    config.program = program;
    const Unpacker dies = unpacks_in_children(std::make_shared<ReaderChildren>(config));
    try {
        read_scene_files(archive(room), blobs_, limits_, dies);
        FAIL() << "was taken";
    } catch (const ProblemError& e) {
        EXPECT_EQ(e.problem().status, 422);
        EXPECT_EQ(e.problem().code, "scene_crashed_reader");
        EXPECT_EQ(e.problem().place, "archive");
    }
}

TEST_F(SceneFilesTest, ManifestsAreReadStrictly) {
    expect_error(manifest(R"({"files": 1})"), ErrorKind::invalid_input, "manifest#/files");
    expect_error(manifest(R"({"file": {}})"), ErrorKind::invalid_input, "manifest#/file");
    expect_error(manifest(R"({"files": {"a.obj": {"sha256": "x"}}})"), ErrorKind::invalid_input, "64 digits");
    expect_error(manifest(R"({"files": {"a.obj": {"sha256": ")" + sha256("?") + R"("}}})"),
                 ErrorKind::not_found, "manifest#/files/a.obj/sha256");
    EXPECT_THROW(read(manifest("{")), ProblemError);
}

}  // namespace
}  // namespace afterglow
