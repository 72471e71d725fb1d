#include "solver/scene/mtl_reader.h"

#include <map>

#include <gmock/gmock.h>

#include "solver/base/pixels.h"

namespace afterglow {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

/// A library read with a one-pixel red picture at hand under several names.
struct Library {
    Scene scene;
    int pictures_read = 0;
    std::string text;
    ResourceReader reader = [this](const std::string& uri) -> std::string {
        if (uri == "room.mtl") return text;
        if (uri == "red.png" || uri == "tex/old oak.png" || uri == "100%25.png") {
            ++pictures_read;
            return encode_png(1, 1, {255, 0, 0});
        }
        throw Error(ErrorKind::not_found, uri, "no such file");
    };
    MtlReader materials{reader, scene};

    explicit Library(std::string content) : text(std::move(content)) {
        materials.read_library("room.mtl", "room.obj:1");
    }
    Material& material(const std::string& name) {
        return scene.materials.at(materials.named(name, "room.obj:9").material);
    }
    ObjMaterial::Kind kind(const std::string& name) { return materials.named(name, "room.obj:9").kind; }
};

std::string refusal(const std::string& text) {
    try {
        const Library library(text);
    } catch (const Error& e) {
        return e.what();
    }
    return "accepted";
}

TEST(MtlReader, ReadsColoursAndEmission) {
    Library library(
        "newmtl wall paint\r\nKa 1 1 1\r\nKd .1 .2 .3 # mat\r\nNs 10\r\n\r\nnewmtl lamp\nKd 0\nKe 9 8 7\n");
    EXPECT_EQ(library.material("wall paint").reflectance, Rgb(0.1F, 0.2F, 0.3F));
    EXPECT_EQ(library.material("wall paint").emission, Rgb(0));
    EXPECT_EQ(library.material("lamp").reflectance, Rgb(0));
    EXPECT_EQ(library.material("lamp").emission, Rgb(9, 8, 7));
    EXPECT_THAT(library.scene.warnings, IsEmpty());
}

TEST(MtlReader, ReadsEachPictureOnce) {
    Library library(
        "newmtl a\nmap_Kd red.png\nnewmtl b\nmap_Kd red.png\nnewmtl c\nmap_Kd tex/old oak.png\n"
        "newmtl d\nmap_Kd 100%.png\n");
    EXPECT_EQ(library.material("a").texture, library.material("b").texture);
    EXPECT_NE(library.material("a").texture, library.material("c").texture);
    EXPECT_EQ(library.pictures_read, 3);
    EXPECT_EQ(library.scene.textures.at(0).at(Vec2(0.5F, 0.5F)).r, 1.0F);
}

TEST(MtlReader, FindsTheNameAfterOptions) {
    Library library("newmtl a\nmap_Kd -s 2 2 -o 0 0 0 -clamp on -mm 0 1 tex/old oak.png\n");
    EXPECT_EQ(library.material("a").texture, 0U);
    ASSERT_THAT(library.scene.warnings, SizeIs(1));
    EXPECT_THAT(library.scene.warnings[0].message, HasSubstr("options"));
}

TEST(MtlReader, TreatsTransparentPanesAsOpenings) {
    Library library(
        "newmtl dim\nd 0.7\nnewmtl pane\nd 0.2\nnewmtl tr\nTr 0.9\nnewmtl halo\nd -halo 0.1\n"
        "newmtl glass\nillum 7\nd 1\nnewmtl maya\nillum 4\nnewmtl glowing\nd 0\nKe 1 1 1\n");
    using Kind = ObjMaterial::Kind;
    EXPECT_EQ(library.kind("dim"), Kind::surface);
    EXPECT_EQ(library.kind("pane"), Kind::opening);
    EXPECT_EQ(library.kind("tr"), Kind::opening);
    EXPECT_EQ(library.kind("halo"), Kind::opening);
    EXPECT_EQ(library.kind("glass"), Kind::opening);
    EXPECT_EQ(library.kind("maya"), Kind::surface);
    EXPECT_EQ(library.kind("glowing"), Kind::surface);
    EXPECT_THAT(library.scene.warnings, SizeIs(4));
}

TEST(MtlReader, SaysOnceWhatIsNotDiffuse) {
    Library library("newmtl a\nKs 1 1 1\nnewmtl b\nKs .5 .5 .5\nnewmtl c\nKs 0 0 0\nmap_Bump red.png\n");
    ASSERT_THAT(library.scene.warnings, SizeIs(2));
    EXPECT_THAT(library.scene.warnings[0].message, AllOf(HasSubstr("\"a\", \"b\""), HasSubstr("diffuse")));
    EXPECT_THAT(library.scene.warnings[1].message, HasSubstr("map_Bump"));
}

TEST(MtlReader, TakesTheMeanOfAnEmissionPicture) {
    Library library("newmtl a\nKe 4 4 4\nmap_Ke red.png\n");
    EXPECT_EQ(library.material("a").emission, Rgb(4, 0, 0));
}

TEST(MtlReader, NamesFileAndLineOfErrors) {
    EXPECT_THAT(refusal("newmtl a\nKd 1 x 0\n"), HasSubstr("room.mtl:2"));
    EXPECT_THAT(refusal("newmtl a\nKd -1 0 0\n"), HasSubstr("negative"));
    EXPECT_THAT(refusal("newmtl a\nKd spectral a.rfl\n"), HasSubstr("red, green and blue"));
    EXPECT_THAT(refusal("newmtl a\nKd\n"), HasSubstr("room.mtl:2"));
    EXPECT_THAT(refusal("newmtl a\nmap_Kd gone.png\n"),
                AllOf(HasSubstr("room.mtl:2"), HasSubstr("gone.png")));
    EXPECT_THAT(refusal("newmtl a\nmap_Kd room.mtl\n"), HasSubstr("room.mtl:2")) << "no picture";
    EXPECT_THAT(refusal("newmtl a\nmap_Kd -s 1 1 1\n"), HasSubstr("names no picture"));
    EXPECT_THAT(refusal("Kd 1 1 1\n"), HasSubstr("newmtl"));
    EXPECT_THAT(refusal("newmtl\n"), HasSubstr("names no material"));
}

}  // namespace
}  // namespace afterglow
