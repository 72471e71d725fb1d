#include <cmath>
#include <limits>

#include <gmock/gmock.h>

#include "solver/base/error.h"
#include "tests/support/pictures.h"
#include "tests/support/worlds.h"

// Scenes that are wrong or extreme: a clear error, or pictures without a NaN, an infinity or negative light.

namespace afterglow {
namespace {

using testing::add_box;
using testing::add_quad;
using testing::Facing;
using testing::small_room;

SequenceConfig quick() {
    SequenceConfig config;
    config.patch_size_m = 0.4;
    config.rays_per_patch = 64;
    config.quality = Quality::draft;
    config.width = 64;
    config.height = 48;
    return config;
}

/// All pictures of two frames, by every strategy, of the world as if it came from a file; the last one.
Picture expect_clean(const World& bad, const SequenceConfig& settings = quick()) {
    const World world = testing::from_file(bad);
    Picture last;
    for (const Visibility visibility :
         {Visibility::retrace, Visibility::back_buffer, Visibility::temporal_graph, Visibility::events}) {
        SequenceConfig config = settings;
        config.visibility = visibility;
        for (const int frame : {0, 20}) {
            for (const Picture& picture : testing::pictures_of(world, config, frame)) {
                EXPECT_EQ(testing::faults_of(picture), "") << "frame " << frame;
                last = picture;
            }
        }
    }
    return last;
}

double mean_of(const Picture& picture) {
    double sum = 0;
    for (const Rgb& p : picture.pixels) sum += static_cast<double>(p.x + p.y + p.z) / 3;
    return sum / static_cast<double>(picture.pixels.size());
}

/// The message of the error that a world is refused with; empty where it is accepted.
std::string refusal_of(const World& world) {
    try {
        testing::from_file(world);
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

void add_triangle(World& world, const Vec3& a, const Vec3& b, const Vec3& c, Index material = 0) {
    Body& body = world.bodies[furniture];
    const auto first = static_cast<Index>(body.positions.size());
    for (const Vec3& p : {a, b, c}) {
        body.positions.push_back(p);
        body.texture_coordinates.emplace_back(0);
    }
    body.triangles.push_back({{first, first + 1, first + 2}, material});
}

TEST(BadInput, TheHelperFindsFaults) {
    Picture picture(4, 3);
    EXPECT_EQ(testing::faults_of(picture), "");
    picture.at(1, 2).y = -1e-20F;
    picture.at(3, 2).x = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THAT(testing::faults_of(picture), ::testing::HasSubstr("(1, 2)"));
    EXPECT_THAT(testing::faults_of(picture), ::testing::HasSubstr("1 more"));
}

TEST(BadInput, DegenerateTriangles) {
    World world = small_room();
    const Picture good = expect_clean(world);
    const Vec3 a(1, 1, 1), b(3, 1, 1);
    add_triangle(world, a, a, a);
    add_triangle(world, a, b, b);
    add_triangle(world, a, 0.5F * (a + b), b);
    add_triangle(world, a, a, b, 1);
    const World cleaned = testing::from_file(world);
    ASSERT_FALSE(cleaned.warnings.empty());
    EXPECT_EQ(expect_clean(world).pixels, good.pixels) << "what has no area is left out";
}

TEST(BadInput, SliversAndTinyTriangles) {
    World world = small_room();
    const double good = mean_of(expect_clean(world));
    for (const float height : {1e-3F, 1e-5F, 1e-6F, 1e-7F})
        for (const Index material : {0U, 1U}) {
            add_triangle(world, Vec3(1, 1, 1), Vec3(3, 1, 1), Vec3(2, 1 + height, 1), material);
            add_triangle(world, Vec3(1, 1, 2), Vec3(1 + height, 1, 2), Vec3(1, 1 + height, 2), material);
        }
    // They shine with the radiance of the lamp and have a thousandth of its area.
    EXPECT_NEAR(mean_of(expect_clean(world)), good, 0.05 * good);
}

TEST(BadInput, ManyNeedlesInOneFan) {
    World world = small_room();
    constexpr int needles = 300;
    for (int k = 0; k < needles; ++k) {
        const auto at = [](int i) {
            const float angle = 2 * pi * static_cast<float>(i) / needles;
            return Vec3(3 + 0.6F * std::cos(angle), 1, 3.5F + 0.6F * std::sin(angle));
        };
        add_triangle(world, Vec3(3, 1, 3.5F), at(k + 1), at(k));
    }
    expect_clean(world);
}

TEST(BadInput, CoplanarOverlappingFaces) {
    World world = small_room();
    Body& body = world.bodies[furniture];
    world.materials.push_back(testing::diffuse("red", Rgb(0.8F, 0, 0)));
    // The same floor twice in other colours, part of a wall, a face against its own back, a second lamp.
    add_quad(body, Vec3(0), Vec3(0, 0, 5), Vec3(4, 0, 0), 2);
    add_quad(body, Vec3(0.5F, 0.5F, 0), Vec3(2, 0, 0), Vec3(0, 2, 0), 2);
    add_quad(body, Vec3(2, 1, 2), Vec3(1, 0, 0), Vec3(0, 0, 1), 0);
    add_quad(body, Vec3(2, 1, 2), Vec3(0, 0, 1), Vec3(1, 0, 0), 2);
    add_quad(body, Vec3(1.5F, 2.98F, 2), Vec3(1, 0, 0), Vec3(0, 0, 1), 1);
    add_quad(body, Vec3(1.7F, 2.98F, 2.2F), Vec3(0, 0, 0.5F), Vec3(0.5F, 0, 0), 0);
    EXPECT_GT(mean_of(expect_clean(world)), 0);
}

TEST(BadInput, InvertedNormals) {
    World world = small_room();
    const double good = mean_of(expect_clean(world));
    World inverted = world;
    for (Body& body : inverted.bodies)
        for (Triangle& triangle : body.triangles)
            if (triangle.material == 0) std::swap(triangle.vertices[1], triangle.vertices[2]);
    // Every face reflects on both sides, so only the chances of sampling differ.
    EXPECT_NEAR(mean_of(expect_clean(inverted)), good, 0.03 * good);

    // A lamp that faces the ceiling 2 cm above it still lights the room, by what comes out at its edges.
    for (Triangle& triangle : world.bodies[furniture].triangles)
        if (triangle.material == 1) std::swap(triangle.vertices[1], triangle.vertices[2]);
    const double turned = mean_of(expect_clean(world));
    EXPECT_GT(turned, 0);
    EXPECT_LT(turned, 0.2 * good);
}

World seen_from(const Vec3& eye) {
    World world = small_room();
    world.cameras[0].path.keys = {{0, {eye, Quat(1, 0, 0, 0)}}};
    return world;
}

TEST(BadInput, CameraInsideAnObject) {
    // In the table's top, in the actor at time 0: closed, so there is nothing but darkness.
    EXPECT_EQ(testing::brightest(
                  testing::pictures_of(testing::from_file(seen_from(Vec3(1, 0.72F, 1))), quick(), 0).back()),
              0);
    EXPECT_EQ(
        testing::brightest(
            testing::pictures_of(testing::from_file(seen_from(Vec3(0.6F, 0.9F, 3))), quick(), 0).back()),
        0);
    for (const Vec3& eye : {Vec3(1, 0.72F, 1), Vec3(0.6F, 0.9F, 3)}) expect_clean(seen_from(eye));
}

TEST(BadInput, CameraOnASurfaceInACornerOrOutside) {
    for (const Vec3& eye : {Vec3(2, 0, 4), Vec3(2, 1, 5), Vec3(0), Vec3(4, 3, 5), Vec3(2, 2.98F, 2.5F),
                            Vec3(0, -3, 20), Vec3(1e5F, 1e5F, 1e5F)})
        expect_clean(seen_from(eye));
}

TEST(BadInput, ALampOfNoArea) {
    World world = small_room();
    Body& body = world.bodies[furniture];
    for (std::size_t t = 12; t < 14; ++t) {
        ASSERT_EQ(body.triangles[t].material, 1U);
        for (const Index v : body.triangles[t].vertices) body.positions[v] = Vec3(2, 2.9F, 2.5F);
    }
    EXPECT_THAT(refusal_of(world), ::testing::HasSubstr("nothing in it shines"));
    // With another light it is only left out.
    world.background = Rgb(1);
    EXPECT_EQ(refusal_of(world), "");
    expect_clean(world);
}

TEST(BadInput, ATinyLampOfGreatRadiance) {
    for (const float edge : {1e-2F, 1e-4F, 1e-6F}) {
        World world = small_room();
        world.materials[1].emission = Rgb(0);
        world.materials.push_back(testing::diffuse("spark", Rgb(0), Rgb(std::min(1 / (edge * edge), 1e9F))));
        add_quad(world.bodies[furniture], Vec3(2, 2.5F, 2.5F), Vec3(edge, 0, 0), Vec3(0, 0, edge), 2);
        SCOPED_TRACE(edge);
        if (refusal_of(world).empty()) expect_clean(world);
    }
}

PlacedLight light_at_place(Light::Kind kind, const Vec3& place, const Rgb& intensity) {
    PlacedLight light;
    light.light.name = "light";
    light.light.kind = kind;
    light.light.intensity = intensity;
    light.path.keys = {{0, {place, Quat(1, 0, 0, 0)}}};
    return light;
}

TEST(BadInput, LightsOnSurfacesInCornersInsideThingsAndDark) {
    using Kind = Light::Kind;
    for (const Kind kind : {Kind::point, Kind::spot, Kind::directional})
        for (const Vec3& place : {Vec3(2, 0, 2), Vec3(0), Vec3(2, 1.5F, 4.7F), Vec3(1, 0.72F, 1), Vec3(50)})
            for (const Rgb& intensity : {Rgb(0), Rgb(10, 0, 1e6F)}) {
                World world = small_room();
                world.lights = {light_at_place(kind, place, intensity)};
                SequenceConfig config = quick();
                config.width = 24;
                config.height = 18;
                expect_clean(world, config);
            }
}

/// Everything `factor` times as large.
World scaled(World world, float factor) {
    for (Body& body : world.bodies) {
        for (Vec3& p : body.positions) p *= factor;
        for (auto& key : body.path.keys) key.value.translation *= factor;
    }
    for (PlacedCamera& camera : world.cameras)
        for (auto& key : camera.path.keys) key.value.translation *= factor;
    return world;
}

/// Small pictures from patches that are refined where light bends, and from light that follows a frame.
SequenceConfig refined() {
    SequenceConfig config = quick();
    config.patch_size_m.reset();
    config.quality = Quality::preview;
    config.solution = Solution::residual;
    config.width = 24;
    config.height = 18;
    return config;
}

TEST(BadInput, RefinedPatchesOfAllOfThemAtOnce) {
    World world = small_room();
    Body& body = world.bodies[furniture];
    const Vec3 a(1, 1, 1), b(3, 1, 1);
    // No area; almost none; the floor again, turned over; a wall's part twice; a lamp in a lamp.
    add_triangle(world, a, a, b);
    for (const float height : {1e-3F, 1e-5F, 1e-7F}) add_triangle(world, a, b, Vec3(2, 1 + height, 1), 1);
    add_quad(body, Vec3(0), Vec3(4, 0, 0), Vec3(0, 0, 5), 0);
    for (int times = 0; times < 2; ++times)
        add_quad(body, Vec3(0.5F, 0.5F, 0), Vec3(2, 0, 0), Vec3(0, 2, 0), 0);
    add_quad(body, Vec3(1.5F, 2.98F, 2), Vec3(1, 0, 0), Vec3(0, 0, 1), 1);
    for (const float size_m : {1e-3F, 1e4F}) {
        SCOPED_TRACE(size_m);
        EXPECT_GT(mean_of(expect_clean(scaled(world, size_m / 4), refined())), 0);
    }
}

TEST(BadInput, NumbersThatAreNone) {
    const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
    for (const float bad : {nan, inf, -inf}) {
        World world = small_room();
        world.bodies[furniture].positions[3].y = bad;
        EXPECT_THAT(refusal_of(world), ::testing::HasSubstr("vertex 3")) << bad;
        world = small_room();
        world.materials[1].emission.y = bad;
        EXPECT_THAT(refusal_of(world), ::testing::HasSubstr("lamp")) << bad;
        world = small_room();
        world.bodies[1].path.keys[1].value.translation.x = bad;
        EXPECT_THAT(refusal_of(world), ::testing::HasSubstr("walker")) << bad;
    }
}

TEST(BadInput, ScenesOfAnySizeLookTheSame) {
    // The room is 4 m long; radiance does not depend on scale, so only rounding may differ. The default patch
    // size follows the scene, and so does a given one.
    const Picture metres = expect_clean(small_room());
    for (const float size_m : {1e-3F, 0.1F, 100.0F, 1e4F}) {
        const float factor = size_m / 4;
        SequenceConfig config = quick();
        config.patch_size_m = 0.4 * static_cast<double>(factor);
        SCOPED_TRACE(size_m);
        const Picture picture = expect_clean(scaled(small_room(), factor), config);
        double difference = 0;
        for (std::size_t k = 0; k < picture.pixels.size(); ++k)
            difference += static_cast<double>(std::abs(picture.pixels[k].x - metres.pixels[k].x));
        EXPECT_LT(difference / static_cast<double>(picture.pixels.size()), 0.01 * mean_of(metres));
    }
}

TEST(BadInput, ScenesOfAnySizeByDefaultSettings) {
    for (const float size_m : {1e-3F, 1e4F}) {
        SequenceConfig config = quick();
        config.patch_size_m.reset();
        SCOPED_TRACE(size_m);
        EXPECT_GT(mean_of(expect_clean(scaled(small_room(), size_m / 4), config)), 0);
    }
}

TEST(BadInput, FarFromTheOrigin) {
    // Single precision resolves a millimetre at 10 km.
    World world = small_room();
    const Vec3 far(1e4F, -1e4F, 1e4F);
    for (Body& body : world.bodies) {
        if (body.path.keys.empty())
            for (Vec3& p : body.positions) p += far;
        for (auto& key : body.path.keys) key.value.translation += far;
    }
    for (auto& key : world.cameras[0].path.keys) key.value.translation += far;
    EXPECT_GT(mean_of(expect_clean(world)), 0);
}

}  // namespace
}  // namespace afterglow
