#include "solver/scene/gltf_container.h"

#include <gmock/gmock.h>

#include "tests/unit/scene/glb_builder.h"

namespace afterglow {
namespace {

using testing::HasSubstr;

Error glb_error(const std::string& bytes) {
    return error_of([&] { gltf::split_glb(bytes, "x.glb"); });
}

TEST(GltfContainer, SplitsJsonAndBinary) {
    const std::string bytes = glb_of("{\"a\":1}", "abcdefg");
    const auto parts = gltf::split_glb(bytes, "x.glb");
    EXPECT_EQ(parts.json, "{\"a\":1} ");
    ASSERT_TRUE(parts.binary);
    EXPECT_EQ(parts.binary->substr(0, 7), "abcdefg");
}

TEST(GltfContainer, BinaryChunkIsOptionalAndUnknownChunksAreSkipped) {
    std::string bytes = glb_of("{}", "");
    EXPECT_FALSE(gltf::split_glb(bytes, "x.glb").binary);
    append_little_endian(bytes, 4);
    bytes += "XTRAdata";
    bytes[8] = static_cast<char>(bytes.size());
    EXPECT_FALSE(gltf::split_glb(bytes, "x.glb").binary);
    EXPECT_EQ(gltf::split_glb(bytes, "x.glb").json, "{}  ");
}

TEST(GltfContainer, EveryTruncationIsAnError) {
    const std::string whole = glb_of("{\"asset\":{}}", "0123456789ab");
    for (std::size_t length = 0; length < whole.size(); ++length)
        EXPECT_EQ(glb_error(whole.substr(0, length)).kind(), ErrorKind::invalid_input) << length;
}

TEST(GltfContainer, WrongMagicVersionAndFirstChunk) {
    std::string bytes = glb_of("{}", "");
    EXPECT_THAT(glb_error("PK\3\4 something else").what(), HasSubstr("x.glb: not a binary glTF"));
    bytes[4] = 1;
    EXPECT_EQ(glb_error(bytes).kind(), ErrorKind::unsupported);
    bytes[4] = 2;
    bytes[16] = 'B';
    EXPECT_THAT(glb_error(bytes).what(), HasSubstr("first chunk is not JSON"));
}

TEST(GltfContainer, ChunkPastTheEndIsAnError) {
    std::string bytes = glb_of("{}", "");
    for (const int length : {5, 255}) {
        bytes[12] = static_cast<char>(length);
        EXPECT_THAT(glb_error(bytes).what(), HasSubstr("ends past the file"));
    }
    for (std::size_t i = 12; i < 16; ++i) bytes[i] = '\xFF';
    EXPECT_THAT(glb_error(bytes).what(), HasSubstr("ends past the file"));
}

TEST(GltfContainer, DecodesBase64) {
    const std::string head = "data:application/octet-stream;base64,";
    // RFC 4648, section 10.
    EXPECT_EQ(gltf::decode_data_uri(head + "", "p"), "");
    EXPECT_EQ(gltf::decode_data_uri(head + "Zg==", "p"), "f");
    EXPECT_EQ(gltf::decode_data_uri(head + "Zm8=", "p"), "fo");
    EXPECT_EQ(gltf::decode_data_uri(head + "Zm9v", "p"), "foo");
    EXPECT_EQ(gltf::decode_data_uri(head + "Zm9vYmFy", "p"), "foobar");
    EXPECT_EQ(gltf::decode_data_uri("data:;base64,+/8", "p"), "\xFB\xFF");
}

TEST(GltfContainer, RefusesWhatIsNoBase64) {
    const auto kind = [](const std::string& uri) {
        return error_of([&] { gltf::decode_data_uri(uri, "p"); }).kind();
    };
    EXPECT_EQ(kind("data:text/plain,hello"), ErrorKind::unsupported);
    EXPECT_EQ(kind("data:text/plain"), ErrorKind::unsupported);
    EXPECT_EQ(kind("data:;base64,Zm9v!"), ErrorKind::invalid_input);
    EXPECT_EQ(kind("data:;base64,Zm 9"), ErrorKind::invalid_input);
    EXPECT_EQ(kind("data:;base64,Zm9vY"), ErrorKind::invalid_input);
}

}  // namespace
}  // namespace afterglow
