#include "solver/scene/gltf_accessors.h"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>

#include "tests/unit/scene/glb_builder.h"

namespace afterglow {
namespace {

using testing::ElementsAre;
using testing::FloatEq;
using testing::HasSubstr;

/// Opens what was built and reads accessor 0.
std::vector<float> floats(const GlbBuilder& builder, std::size_t components) {
    const std::string bytes = builder.glb();
    const auto document = gltf::open_document(bytes, SceneFormat::glb, "t", {});
    const Json reference = 0;
    return gltf::read_floats(*document, {reference, "t"}, components);
}

std::vector<Index> indices(const GlbBuilder& builder) {
    const std::string bytes = builder.glb();
    const auto document = gltf::open_document(bytes, SceneFormat::glb, "t", {});
    const Json reference = 0;
    return gltf::read_indices(*document, {reference, "t"});
}

Error floats_error(const GlbBuilder& builder, std::size_t components = 3) {
    return error_of([&] { floats(builder, components); });
}

/// Twelve bytes of data behind accessor 0, which the test then changes.
GlbBuilder one_vec3() {
    GlbBuilder builder;
    builder.add_vec3({1, 2, 3});
    return builder;
}

TEST(GltfAccessors, ReadsEveryComponentTypeAsAFraction) {
    const auto normalised = [](const auto& values, int type) {
        GlbBuilder builder;
        builder.add(values, type, "SCALAR", 1);
        builder.json["accessors"][0]["normalized"] = true;
        return floats(builder, 1);
    };
    EXPECT_THAT(normalised(std::vector<std::int8_t>{127, 0, -127, -128}, 5120), ElementsAre(1, 0, -1, -1));
    EXPECT_THAT(normalised(std::vector<std::uint8_t>{255, 51, 0}, 5121), ElementsAre(1, FloatEq(0.2F), 0));
    EXPECT_THAT(normalised(std::vector<std::int16_t>{32767, -32768}, 5122), ElementsAre(1, -1));
    EXPECT_THAT(normalised(std::vector<std::uint16_t>{65535, 13107}, 5123), ElementsAre(1, FloatEq(0.2F)));
}

TEST(GltfAccessors, IntegersKeepTheirValue) {
    GlbBuilder builder;
    builder.add(std::vector<std::int16_t>{-7, 300, 2, 0}, 5122, "VEC2", 2);
    EXPECT_THAT(floats(builder, 2), ElementsAre(-7, 300, 2, 0));
}

TEST(GltfAccessors, ReadsIndicesOfEveryWidth) {
    GlbBuilder bytes;
    bytes.add(std::vector<std::uint8_t>{0, 255, 3}, 5121, "SCALAR", 1);
    EXPECT_THAT(indices(bytes), ElementsAre(0, 255, 3));
    GlbBuilder shorts;
    shorts.add(std::vector<std::uint16_t>{65535, 1}, 5123, "SCALAR", 1);
    EXPECT_THAT(indices(shorts), ElementsAre(65535, 1));
    GlbBuilder words;
    words.add(std::vector<std::uint32_t>{4000000000U, 1}, 5125, "SCALAR", 1);
    EXPECT_THAT(indices(words), ElementsAre(4000000000U, 1));
    GlbBuilder reals;
    reals.add_scalars({1});
    EXPECT_THAT(error_of([&] { indices(reals); }).what(), HasSubstr("unsigned integers"));
}

TEST(GltfAccessors, HonoursOffsetsAndStrides) {
    GlbBuilder builder;
    builder.add_view(GlbBuilder::bytes_of(std::vector<float>{9, 1, 2, 9, 3, 4, 9}));
    builder.json["bufferViews"][0]["byteStride"] = 12;
    builder.add_accessor(
        {{"bufferView", 0}, {"byteOffset", 4}, {"componentType", 5126}, {"type", "VEC2"}, {"count", 2}});
    EXPECT_THAT(floats(builder, 2), ElementsAre(1, 2, 3, 4));
    builder.json["accessors"][0]["count"] = 3;
    EXPECT_THAT(floats_error(builder, 2).what(), HasSubstr("reaches past its buffer view"));
    builder.json["bufferViews"][0]["byteStride"] = 4;
    EXPECT_THAT(floats_error(builder, 2).place(), HasSubstr("/bufferViews/0/byteStride"));
}

TEST(GltfAccessors, AppliesSparseEntries) {
    GlbBuilder builder = one_vec3();
    builder.json["accessors"][0]["count"] = 1;
    const int which = builder.add_view(GlbBuilder::bytes_of(std::vector<std::uint8_t>{0}));
    const int what = builder.add_view(GlbBuilder::bytes_of(std::vector<float>{7, 8, 9}));
    builder.json["accessors"][0]["sparse"] = {{"count", 1},
                                              {"indices", {{"bufferView", which}, {"componentType", 5121}}},
                                              {"values", {{"bufferView", what}}}};
    EXPECT_THAT(floats(builder, 3), ElementsAre(7, 8, 9));
    // Without a base the rest is zero.
    builder.json["accessors"][0].erase("bufferView");
    builder.json["accessors"][0]["count"] = 2;
    EXPECT_THAT(floats(builder, 3), ElementsAre(7, 8, 9, 0, 0, 0));
    builder.binary[12] = 2;
    EXPECT_THAT(floats_error(builder).what(), HasSubstr("sparse index is out of range"));
}

TEST(GltfAccessors, ABillionElementsInTwelveBytes) {
    GlbBuilder builder = one_vec3();
    builder.json["accessors"][0]["count"] = 1000000000;
    EXPECT_EQ(floats_error(builder).kind(), ErrorKind::invalid_input);
    EXPECT_EQ(floats_error(builder).place(), "t#/accessors/0");
    builder.json["accessors"][0].erase("bufferView");
    EXPECT_EQ(floats_error(builder).kind(), ErrorKind::too_large);
    builder.json["accessors"][0]["count"] = 1e30;
    EXPECT_EQ(floats_error(builder).kind(), ErrorKind::invalid_input);
    builder.json["accessors"][0]["count"] = -1;
    EXPECT_EQ(floats_error(builder).kind(), ErrorKind::invalid_input);
}

TEST(GltfAccessors, OffsetsThatWouldWrapAreErrors) {
    const Json huge[] = {9223372036854775807LL,
                         9223372036854775800LL,
                         18446744073709551615ULL,
                         18446744073709551604ULL,
                         4294967295U,
                         13,
                         -4,
                         1.5};
    for (const Json& offset : huge) {
        for (const char* place : {"accessors", "bufferViews"}) {
            GlbBuilder builder = one_vec3();
            builder.json[place][0]["byteOffset"] = offset;
            EXPECT_EQ(floats_error(builder).kind(), ErrorKind::invalid_input) << place << " " << offset;
        }
        GlbBuilder length = one_vec3();
        length.json["bufferViews"][0]["byteLength"] = offset;
        EXPECT_EQ(floats_error(length).kind(), ErrorKind::invalid_input) << offset;
        GlbBuilder stride = one_vec3();
        stride.json["bufferViews"][0]["byteStride"] = offset;
        stride.json["accessors"][0]["count"] = 2;
        EXPECT_EQ(floats_error(stride).kind(), ErrorKind::invalid_input) << offset;
    }
}

TEST(GltfAccessors, AcceptsExactlyWhatFits) {
    // Whatever offset and count: read if and only if the last element ends inside the twelve bytes.
    for (int offset = 0; offset <= 16; ++offset)
        for (int count = 0; count <= 4; ++count) {
            GlbBuilder builder = one_vec3();
            builder.json["accessors"][0]["type"] = "SCALAR";
            builder.json["accessors"][0]["byteOffset"] = offset;
            builder.json["accessors"][0]["count"] = count;
            if (count == 0 || offset + 4 * count <= 12)
                EXPECT_EQ(floats(builder, 1).size(), static_cast<std::size_t>(count));
            else
                EXPECT_EQ(floats_error(builder, 1).kind(), ErrorKind::invalid_input);
        }
}

TEST(GltfAccessors, NumbersThatAreNotFiniteAreErrors) {
    for (const float bad : {std::nanf(""), std::numeric_limits<float>::infinity()}) {
        GlbBuilder builder;
        builder.add_vec3({0, 0, 0, 1, bad, 0});
        EXPECT_THAT(floats_error(builder).what(),
                    HasSubstr("t#/accessors/0: element 1 is not a finite number"));
    }
}

TEST(GltfAccessors, WrongShapesAndNumbersAreErrors) {
    EXPECT_THAT(floats_error(one_vec3(), 2).what(), HasSubstr("3 numbers an element where 2"));
    GlbBuilder builder = one_vec3();
    builder.json["accessors"][0]["componentType"] = 5124;
    EXPECT_THAT(floats_error(builder).what(), HasSubstr("unknown component type 5124"));
    builder = one_vec3();
    builder.json["accessors"][0]["type"] = "VEC9";
    EXPECT_THAT(floats_error(builder).what(), HasSubstr("\"VEC9\""));
    builder = one_vec3();
    builder.json["accessors"][0]["bufferView"] = 1;
    EXPECT_EQ(floats_error(builder).place(), "t#/accessors/0/bufferView");
    builder = one_vec3();
    builder.json["bufferViews"][0]["buffer"] = 3;
    EXPECT_EQ(floats_error(builder).place(), "t#/bufferViews/0/buffer");
}

}  // namespace
}  // namespace afterglow
