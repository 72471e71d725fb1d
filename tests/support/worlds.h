#pragma once

#include <random>

#include "solver/scene/world.h"

namespace afterglow::testing {

/// A diffuse material; emission is radiance.
Material diffuse(const std::string& name, Rgb reflectance, Rgb emission = Rgb(0));

/// Adds an axis-aligned box to a body; faces look outwards, or inwards for a room.
enum class Facing { outwards, inwards };
void add_box(Body& body, const Vec3& low, const Vec3& high, Index material, Facing facing = Facing::outwards);

/// Adds a triangle with corners of its own.
void add_triangle(Body& body, const Vec3& a, const Vec3& b, const Vec3& c, Index material);

/// Adds a parallelogram whose front is on the side of edge_u × edge_v.
void add_quad(Body& body, const Vec3& corner, const Vec3& edge_u, const Vec3& edge_v, Index material);

/// Adds a ball of 20 · 4^levels triangles.
void add_ball(Body& body, const Vec3& centre, float radius, int levels, Index material);

/// A world with an empty furniture, two materials (0: grey of `reflectance`, 1: a black lamp of radiance 1)
/// and a camera at `eye` looking along −z.
World empty_world(float reflectance = 0.5F, const Vec3& eye = Vec3(0));

/// A 4 × 3 × 5 m room with a ceiling lamp, a table and one actor box that walks across in two segments and
/// turns.
World small_room();

/// Adds an actor made of one box, and returns its number.
Index add_actor(World& world, const std::string& name, const Vec3& half_size, Index material, Path path);

/// A path through random places in a box, with random turns where asked.
enum class Turning { no, yes };
Path random_path(std::mt19937& random, const Box& within, int segments, Turning turning);

}  // namespace afterglow::testing
