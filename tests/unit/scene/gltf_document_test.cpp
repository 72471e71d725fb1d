#include "solver/scene/gltf_document.h"

#include <gmock/gmock.h>

#include "tests/unit/scene/glb_builder.h"

namespace afterglow {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

Error json_error(const std::string& text, const ResourceReader& reader = {}) {
    return error_of([&] { read_gltf(text, SceneFormat::gltf, "x.gltf", reader, {}); });
}

TEST(GltfDocument, RefusesOtherVersions) {
    EXPECT_EQ(json_error(R"({"asset":{"version":"1.0"}})").kind(), ErrorKind::unsupported);
    EXPECT_EQ(json_error(R"({"asset":{"version":"2.1","minVersion":"2.1"}})").place(),
              "x.gltf#/asset/minVersion");
    EXPECT_THAT(json_error("{}").what(), HasSubstr("\"asset\" is missing"));
    EXPECT_NO_THROW(read_gltf(R"({"asset":{"version":"2.1"}})", SceneFormat::gltf, "x", {}, {}));
}

TEST(GltfDocument, NamesEveryUnknownRequiredExtension) {
    const Error error = json_error(R"({"asset":{"version":"2.0"}, "extensionsRequired":
        ["KHR_draco_mesh_compression", "KHR_texture_transform", "EXT_bogus\nline"]})");
    EXPECT_EQ(error.kind(), ErrorKind::unsupported);
    EXPECT_THAT(error.what(), AllOf(HasSubstr("KHR_draco_mesh_compression"), HasSubstr("EXT_bogus?line"),
                                    Not(HasSubstr("KHR_texture_transform"))));
}

TEST(GltfDocument, DeepNestingIsAnErrorAndNotACrash) {
    const std::string deep(200000, '[');
    EXPECT_EQ(json_error(deep).kind(), ErrorKind::too_large);
    EXPECT_EQ(
        json_error(R"({"asset":{"version":"2.0","extras":)" + deep + std::string(200000, ']') + "}}").kind(),
        ErrorKind::too_large);
    EXPECT_EQ(error_of([&] { read_gltf(glb_of(deep, ""), SceneFormat::glb, "x", {}, {}); }).kind(),
              ErrorKind::too_large);
}

TEST(GltfDocument, MissingAndShortBuffers) {
    EXPECT_THAT(json_error(R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":4}]})").what(),
                HasSubstr("x.gltf#/buffers/0: the buffer has no content"));
    EXPECT_THAT(
        json_error(R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":4,"uri":"data:;base64,Zm9v"}]})")
            .what(),
        HasSubstr("should have 4 bytes, there are 3"));
    EXPECT_EQ(
        json_error(R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":9e18,"uri":"data:;base64,"}]})")
            .kind(),
        ErrorKind::invalid_input);
}

TEST(GltfDocument, ExternalFilesGoThroughTheReader) {
    const std::string text = R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":3,"uri":"a%20b.bin"}]})";
    EXPECT_THAT(json_error(text).what(), AllOf(HasSubstr("x.gltf#/buffers/0/uri"), HasSubstr("a%20b.bin")));
    std::string asked;
    const ResourceReader reader = [&](const std::string& uri) {
        asked = uri;
        return std::string("abc");
    };
    EXPECT_NO_THROW(read_gltf(text, SceneFormat::gltf, "x.gltf", reader, {}));
    EXPECT_EQ(asked, "a%20b.bin");
    const ResourceReader failing = [](const std::string&) -> std::string {
        throw Error(ErrorKind::not_found, "\"a%20b.bin\"", "no such file");
    };
    EXPECT_EQ(json_error(text, failing).kind(), ErrorKind::not_found);
    EXPECT_THAT(json_error(text, failing).what(),
                AllOf(HasSubstr("/buffers/0/uri"), HasSubstr("no such file")));
}

TEST(GltfDocument, WrongTypesNameTheirField) {
    EXPECT_THAT(json_error(R"({"asset":{"version":"2.0"},"nodes":{}})").what(), HasSubstr("x.gltf#/nodes"));
    EXPECT_THAT(json_error(R"({"asset":{"version":2}})").what(), HasSubstr("x.gltf#/asset/version"));
    EXPECT_THAT(json_error(R"({"asset":{"version":"2.0"},"nodes":[7]})").what(),
                HasSubstr("x.gltf#/nodes/0"));
    EXPECT_THAT(json_error("{\"asset\":").what(), HasSubstr("x.gltf: not valid JSON"));
}

}  // namespace
}  // namespace afterglow
