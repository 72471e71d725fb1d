#include <cmath>
#include <functional>
#include <ostream>

#include <gmock/gmock.h>

#include "solver/image/path.h"
#include "tests/support/pictures.h"
#include "tests/support/solved_world.h"

// Light must not pass what it cannot pass: the dark side stays exactly 0, in patches and in pixels.

namespace afterglow {
namespace {

using testing::add_box;
using testing::add_quad;
using testing::Facing;
using testing::SolvedWorld;
using testing::SolvedWorldConfig;

/// A world with a lit and a dark side; an actor walks on either side, the camera stands in the dark.
struct DarkSide {
    World world;
    /// Whether a place lies on the dark side, surfaces counting by the point a little in front of them.
    std::function<bool(const Vec3&)> is_dark;
};

Path walk(const Vec3& from, const Vec3& to) {
    Path path;
    path.keys = {{0, {from, Quat(1, 0, 0, 0)}}, {1, {to, glm::angleAxis(1.0F, Vec3(0, 1, 0))}}};
    return path;
}

void add_walkers(World& world, const Vec3& offset_of_lit) {
    testing::add_actor(world, "dark walker", Vec3(0.2F, 0.6F, 0.1F), 0,
                       walk(Vec3(1, 3.5F, 1), Vec3(3, 3.5F, 2.5F)));
    testing::add_actor(world, "lit walker", Vec3(0.2F, 0.6F, 0.1F), 0,
                       walk(Vec3(1, 3.5F, 1) + offset_of_lit, Vec3(3, 3.5F, 2.5F) + offset_of_lit));
    world.duration_s = 1;
}

/// What stands between the rooms, and whether the outer walls are each room's own or run past it.
enum class Shell {
    own,     ///< two closed rooms, 1 mm apart
    joined,  ///< two rooms that share a single sheet and the edges around it
    shared,  ///< one room that is divided
};

/// Two storeys of 4 × 2.5 × 4 m: light below, dark above.
World storeys(Shell shell) {
    World world = testing::empty_world(0.7F, Vec3(2, 3.8F, 3.8F));
    Body& body = world.bodies[furniture];
    if (shell == Shell::own) {
        add_box(body, Vec3(0), Vec3(4, 2.5F, 4), 0, Facing::inwards);
        add_box(body, Vec3(0, 2.501F, 0), Vec3(4, 5, 4), 0, Facing::inwards);
    } else if (shell == Shell::joined) {
        add_box(body, Vec3(0), Vec3(4, 2.5F, 4), 0, Facing::inwards);
        // The upper room without its floor, which is the lower one's ceiling.
        Body upper;
        add_box(upper, Vec3(0, 2.5F, 0), Vec3(4, 5, 4), 0, Facing::inwards);
        for (const std::size_t face : {0U, 1U, 3U, 4U, 5U}) {
            const auto& v = upper.triangles[2 * face].vertices;
            const Vec3 corner = upper.positions[v[0]];
            add_quad(body, corner, upper.positions[v[1]] - corner,
                     upper.positions[v[2]] - upper.positions[v[1]], 0);
        }
    } else {
        add_box(body, Vec3(0), Vec3(4, 5, 4), 0, Facing::inwards);
        add_quad(body, Vec3(0, 2.5F, 0), Vec3(0, 0, 4), Vec3(4, 0, 0), 0);
    }
    add_walkers(world, Vec3(0, -2.5F, 0));
    return world;
}

DarkSide dark_storey(World world, Shell shell = Shell::own) {
    // The 1 mm between closed rooms belongs to neither.
    const float floor = shell == Shell::own ? 2.501F : 2.5F;
    return {std::move(world), [floor](const Vec3& p) { return p.y > floor; }};
}

DarkSide storeys_with_lamp(Shell shell) {
    World world = storeys(shell);
    add_quad(world.bodies[furniture], Vec3(1.5F, 2.48F, 1.5F), Vec3(1, 0, 0), Vec3(0, 0, 1), 1);
    return dark_storey(std::move(world), shell);
}

/// The lamp lies in the very plane of the ceiling.
DarkSide storeys_with_lamp_in_the_ceiling() {
    World world = storeys(Shell::own);
    add_quad(world.bodies[furniture], Vec3(1.5F, 2.5F, 1.5F), Vec3(1, 0, 0), Vec3(0, 0, 1), 1);
    return dark_storey(std::move(world));
}

/// The lamp is a box that hangs from the ceiling and touches it with its top, which shines as well.
DarkSide storeys_with_lamp_touching_the_ceiling() {
    World world = storeys(Shell::own);
    add_box(world.bodies[furniture], Vec3(1.5F, 2.4F, 1.5F), Vec3(2.5F, 2.5F, 2.5F), 1);
    return dark_storey(std::move(world));
}

DarkSide storeys_with_point_light() {
    World world = storeys(Shell::own);
    PlacedLight light;
    light.light.intensity = Rgb(10);
    light.path.keys = {{0, {Vec3(2, 2.4F, 2), Quat(1, 0, 0, 0)}}};
    world.lights = {light};
    return dark_storey(std::move(world));
}

/// Two rooms side by side, 8 × 5 × 4 m in all, with a wall of 1 mm between; light beyond the wall.
DarkSide rooms_with_thin_wall(Shell shell) {
    World world = testing::empty_world(0.7F, Vec3(2, 3.8F, 3.8F));
    Body& body = world.bodies[furniture];
    if (shell == Shell::shared) {
        add_box(body, Vec3(0), Vec3(8, 5, 4), 0, Facing::inwards);
        add_box(body, Vec3(3.9995F, 0, 0), Vec3(4.0005F, 5, 4), 0);
    } else {
        add_box(body, Vec3(0), Vec3(3.9995F, 5, 4), 0, Facing::inwards);
        add_box(body, Vec3(4.0005F, 0, 0), Vec3(8, 5, 4), 0, Facing::inwards);
    }
    add_quad(body, Vec3(5.5F, 4.98F, 1.5F), Vec3(1, 0, 0), Vec3(0, 0, 1), 1);
    add_walkers(world, Vec3(4, 0, 0));
    return {std::move(world), [](const Vec3& p) { return p.x < 4; }};
}

/// Irradiance of the patches on either side.
struct Sides {
    float largest_dark = 0, largest_lit = 0;
    double mean_dark = 0, mean_lit = 0;
    int dark_patches = 0;
};

Sides sides_of(const SolvedWorld& solved, const DarkSide& scene) {
    Sides out;
    double dark_area = 0, lit_area = 0;
    for (Index p = 0; p < solved.mesh.size(); ++p) {
        const Pose& pose = solved.caster.pose(solved.mesh.body[p]);
        const Vec3 in_front = pose.point(solved.mesh.centre[p] + 1e-4F * solved.mesh.normal[p]);
        const float value = max_channel(solved.solution.state.irradiance[p]);
        const bool dark = scene.is_dark(in_front);
        (dark ? dark_area : lit_area) += static_cast<double>(solved.mesh.area_m2[p]);
        (dark ? out.mean_dark : out.mean_lit) += static_cast<double>(solved.mesh.area_m2[p] * value);
        float& largest = dark ? out.largest_dark : out.largest_lit;
        largest = std::max(largest, value);
        if (!dark) continue;
        ++out.dark_patches;
    }
    out.mean_dark /= dark_area;
    out.mean_lit /= lit_area;
    return out;
}

SolvedWorldConfig patches_of_40_cm(Visibility visibility) {
    SolvedWorldConfig config;
    config.patch_size_m = 0.4F;
    config.lines = 128;
    config.visibility = visibility;
    return config;
}

void expect_dark_patches(const DarkSide& scene, Visibility visibility) {
    SolvedWorld solved(scene.world, patches_of_40_cm(visibility));
    for (const double time_s : {0.0, 0.3, 1.0}) {
        solved.solve(time_s);
        const Sides sides = sides_of(solved, scene);
        EXPECT_GT(sides.dark_patches, 100) << "the camera makes the dark side one that is looked at";
        EXPECT_GT(sides.largest_lit, 0.1);
        EXPECT_EQ(sides.largest_dark, 0) << "time " << time_s;
    }
}

SequenceConfig picture_of_the_dark(Visibility visibility) {
    SequenceConfig config;
    config.patch_size_m = 0.4;
    config.rays_per_patch = 64;
    config.width = 96;
    config.height = 72;
    config.exposure_ev = 0;
    config.visibility = visibility;
    // Preliminary pictures spread the light still on its way everywhere; that is what they are for.
    config.revisions = Revisions::final_only;
    return config;
}

void expect_dark_pixels(const DarkSide& scene, Visibility visibility) {
    for (const int frame : {0, 7, 24})
        EXPECT_EQ(testing::brightest(
                      testing::pictures_of(scene.world, picture_of_the_dark(visibility), frame).back()),
                  0)
            << "frame " << frame;
}

void expect_dark_paths(const DarkSide& scene) {
    SolvedWorldConfig config;
    config.lines = 16;
    SolvedWorld solved(scene.world, config);
    solved.look(0.3);
    const DirectLight direct(solved.mesh, solved.lamps, solved.caster, solved.emission);
    const PathScene lit{&solved.world, &solved.caster, solved.materials,
                        &direct,       solved.lights,  solved.sight.lift_m()};
    std::uint64_t rays = 0;
    const CameraView view = view_at(solved.world.cameras[0], 0.3, 48, 36);
    EXPECT_EQ(testing::brightest(trace_picture(view, lit, {16, 1, {}}, rays, Context(1)).mean), 0);
}

void expect_dark(const DarkSide& scene) {
    for (const Visibility visibility :
         {Visibility::retrace, Visibility::back_buffer, Visibility::temporal_graph, Visibility::events}) {
        expect_dark_patches(scene, visibility);
        expect_dark_pixels(scene, visibility);
    }
    expect_dark_paths(scene);
}

TEST(Leaks, NotThroughASlab) {
    expect_dark(storeys_with_lamp(Shell::own));
}
TEST(Leaks, NotThroughASlabFromAPointLight) {
    expect_dark(storeys_with_point_light());
}
TEST(Leaks, NotFromALampInThePlaneOfTheCeiling) {
    expect_dark(storeys_with_lamp_in_the_ceiling());
}
TEST(Leaks, NotFromALampThatTouchesTheCeiling) {
    expect_dark(storeys_with_lamp_touching_the_ceiling());
}
TEST(Leaks, NotThroughAThinWall) {
    expect_dark(rooms_with_thin_wall(Shell::own));
}

/// One room of 8 × 5 × 4 m with whatever divides it: the walls and the floor run from the lit side to the
/// dark.
World room_to_divide() {
    World world = testing::empty_world(0.7F, Vec3(2, 3.8F, 3.8F));
    Body& body = world.bodies[furniture];
    add_box(body, Vec3(0), Vec3(8, 5, 4), 0, Facing::inwards);
    add_quad(body, Vec3(5.5F, 4.98F, 1.5F), Vec3(1, 0, 0), Vec3(0, 0, 1), 1);
    add_walkers(world, Vec3(4, 0, 0));
    return world;
}

/// A box across the room, which may end before or beyond the walls.
DarkSide room_with_box(const Vec3& low, const Vec3& high) {
    World world = room_to_divide();
    add_box(world.bodies[furniture], low, high, 0);
    const float middle = 0.5F * (low.x + high.x);
    return {std::move(world), [middle](const Vec3& p) { return p.x < middle; }};
}

/// A sheet across the room, that leans towards +x by `lean_m`.
DarkSide room_with_sheet(float x, float lean_m) {
    World world = room_to_divide();
    add_quad(world.bodies[furniture], Vec3(x, 0, 0), Vec3(lean_m, 5, 0), Vec3(0, 0, 4), 0);
    return {std::move(world), [x, lean_m](const Vec3& p) { return p.x < x + lean_m * p.y / 5; }};
}

/// Upright sheets from place to place of the floor, (x, z). They share their corners exactly: rounding would
/// leave gaps, and light does find them.
void add_screens(World& world, const std::vector<Vec2>& places) {
    Body& body = world.bodies[furniture];
    for (std::size_t k = 0; k + 1 < places.size(); ++k) {
        const Vec3 from(places[k].x, 0, places[k].y), to(places[k + 1].x, 0, places[k + 1].y);
        add_quad(body, from, Vec3(0, 5, 0), to - from, 0);
        body.positions.end()[-2] = to + Vec3(0, 5, 0);
        body.positions.end()[-1] = to;
    }
}

/// Light in a corner of the room behind two screens that meet within a cell.
DarkSide room_with_lit_corner() {
    World world = room_to_divide();
    add_screens(world, {{4.33F, 0}, {4.33F, 3.27F}, {8, 3.27F}});
    return {std::move(world), [](const Vec3& p) { return p.x < 4.33F || p.z > 3.27F; }};
}

/// A folding screen across the room: points of a surface are dark on one side of its fold.
DarkSide room_with_folding_screen() {
    const std::vector<Vec2> places{{4.1F, 0},    {3.7F, 0.5F},  {4.3F, 1.17F},
                                   {3.9F, 1.2F}, {4.25F, 2.9F}, {4, 4}};
    World world = room_to_divide();
    add_screens(world, places);
    return {std::move(world), [places](const Vec3& p) {
                std::size_t k = 0;
                while (k + 2 < places.size() && p.z > places[k + 1].y) ++k;
                const float t = (p.z - places[k].y) / (places[k + 1].y - places[k].y);
                return p.x < glm::mix(places[k].x, places[k + 1].x, t);
            }};
}

/// A sheet through the points of (u, v) in [0,1]²; if its facets are small, meshed as one curved surface.
void add_curved(World& world, const std::function<Vec3(float, float)>& at, Index facets_u, Index facets_v) {
    Body& body = world.bodies[furniture];
    const auto first = static_cast<Index>(body.positions.size());
    for (Index k = 0; k < (facets_u + 1) * (facets_v + 1); ++k) {
        const Index u = k % (facets_u + 1), v = k / (facets_u + 1), a = first + k, b = a + facets_u + 1;
        body.positions.push_back(at(static_cast<float>(u) / static_cast<float>(facets_u),
                                    static_cast<float>(v) / static_cast<float>(facets_v)));
        body.texture_coordinates.emplace_back(0);
        if (u == facets_u || v == facets_v) continue;
        body.triangles.push_back({{a, a + 1, b + 1}, 0});
        body.triangles.push_back({{a, b + 1, b}, 0});
    }
}

/// A wall that winds across the room, with bumps on both faces: facets that curve both ways.
DarkSide room_with_bumpy_wall() {
    const auto middle = [](float z) { return 4 + 0.3F * std::sin(0.5F * pi * z); };
    World world = room_to_divide();
    for (const float side : {-1.0F, 1.0F}) {
        const auto face = [&](float u, float v) {
            const float bump = 0.15F + 0.03F * std::sin(8 * pi * u) * std::sin(8 * pi * v);
            return Vec3(middle(4 * u) + side * bump, 5 * v, 4 * u);
        };
        add_curved(world, face, 40, 50);
    }
    return {std::move(world), [middle](const Vec3& p) { return p.x < middle(p.z); }};
}

constexpr float below_a_lift = 1e-4F;  // lines start a hair higher above the floor of these rooms

/// Walls and floors that run from the lit side to the dark, past what divides them.
struct Astride {
    std::string name;
    std::function<DarkSide()> scene;
};
void PrintTo(const Astride& astride, std::ostream* out) {
    *out << astride.name;
}

class SurfacesAstride : public ::testing::TestWithParam<Astride> {};
INSTANTIATE_TEST_SUITE_P(
    Leaks, SurfacesAstride,
    ::testing::Values(
        Astride{"a_shared_floor", [] { return storeys_with_lamp(Shell::joined); }},
        Astride{"a_floor_in_a_room", [] { return storeys_with_lamp(Shell::shared); }},
        Astride{"a_thin_wall", [] { return rooms_with_thin_wall(Shell::shared); }},
        Astride{"a_wall", [] { return room_with_box(Vec3(4.03F, 0, 0), Vec3(4.13F, 5, 4)); }},
        Astride{"a_sunk_wall",
                [] { return room_with_box(Vec3(3.95F, -0.02F, -0.02F), Vec3(4.05F, 5.02F, 4.02F)); }},
        Astride{"a_wall_through_all", [] { return room_with_box(Vec3(3.9F, -1, -1), Vec3(4.1F, 6, 5)); }},
        Astride{"a_wall_a_hair_above",
                [] { return room_with_box(Vec3(3.97F, below_a_lift, 0), Vec3(4.07F, 5, 4)); }},
        Astride{"a_sheet_along_the_cells", [] { return room_with_sheet(4, 0); }},
        Astride{"a_sheet_within_cells", [] { return room_with_sheet(4.1F, 0); }},
        Astride{"a_leaning_sheet", [] { return room_with_sheet(3.8F, 0.6F); }},
        Astride{"a_sheet_leaning_by_a_third", [] { return room_with_sheet(2.2F, 3); }},
        Astride{"a_bumpy_wall", room_with_bumpy_wall}, Astride{"a_corner_of_screens", room_with_lit_corner},
        Astride{"a_folding_screen", room_with_folding_screen}),
    [](const auto& test) { return test.param.name; });

TEST_P(SurfacesAstride, CarryNoLightAcross) {
    expect_dark(GetParam().scene());
}

/// A sheet through a vault of small facets: the patch that a cut facet belongs to carries light over.
DarkSide room_under_a_vault() {
    World world = testing::empty_world(0.7F, Vec3(2, 3.8F, 3.8F));
    Body& body = world.bodies[furniture];
    add_box(body, Vec3(0), Vec3(8, 6, 4), 0, Facing::inwards);
    add_quad(body, Vec3(5.5F, 4.98F, 1.5F), Vec3(1, 0, 0), Vec3(0, 0, 1), 1);
    add_quad(body, Vec3(4.1F, 0, 0), Vec3(0, 6, 0), Vec3(0, 0, 4), 0);
    const auto vault = [](float u, float v) {
        return Vec3(-0.02F + 8.04F * u, 5 + 0.5F * std::sin(pi * v) + 0.05F * std::sin(12 * pi * u),
                    -0.02F + 4.04F * v);
    };
    add_curved(world, vault, 80, 40);
    add_walkers(world, Vec3(4, 0, 0));
    return {std::move(world), [](const Vec3& p) { return p.x < 4.1F; }};
}

TEST(Leaks, AVaultAstrideAWallCarriesLittle) {
    const DarkSide scene = room_under_a_vault();
    SolvedWorld solved(scene.world, patches_of_40_cm(Visibility::back_buffer));
    solved.solve(0.3);
    const Sides sides = sides_of(solved, scene);
    EXPECT_LT(sides.mean_dark, 0.01 * sides.mean_lit);
}
TEST(Leaks, LightGoesRoundAScreenThatEndsMidFloor) {
    World world = room_to_divide();
    add_screens(world, {{4.1F, 0}, {4.1F, 2.33F}});
    const DarkSide scene{std::move(world), [](const Vec3& p) { return p.x < 4.1F; }};
    SolvedWorld solved(scene.world, patches_of_40_cm(Visibility::back_buffer));
    solved.solve(0.3);
    double area = 0;
    for (const float a : solved.mesh.area_m2) area += static_cast<double>(a);
    double surfaces = 0;
    for (const Surface& s : solved.mesh.surfaces.list) surfaces += static_cast<double>(s.area_m2);
    // Rooms and boxes show one side, the screen and the lamp both.
    EXPECT_NEAR(area, surfaces + 5 * 2.33 + 1, 1e-4 * area);
    const Sides sides = sides_of(solved, scene);
    EXPECT_GT(sides.mean_dark, 0.05 * sides.mean_lit);
    const Picture picture =
        testing::pictures_of(scene.world, picture_of_the_dark(Visibility::back_buffer), 7).back();
    EXPECT_GT(static_cast<double>(testing::brightest(picture)),
              0.05 * 0.7 / static_cast<double>(pi) * sides.mean_lit);
}

}  // namespace
}  // namespace afterglow
