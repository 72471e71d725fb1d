#include "solver/scene/furniture.h"

#include <algorithm>
#include <span>

#include "solver/scene/area.h"

namespace afterglow {

namespace {

std::span<Triangle> triangles_of(World& world, Index piece) {
    const FurniturePiece& p = world.pieces[piece];
    return {world.bodies[furniture].triangles.data() + p.first_triangle, p.triangles};
}

/// Corners that a piece's triangles use, each once.
std::vector<Index> corners_of(World& world, Index piece) {
    std::vector<Index> corners;
    for (const Triangle& triangle : triangles_of(world, piece))
        corners.insert(corners.end(), triangle.vertices.begin(), triangle.vertices.end());
    std::sort(corners.begin(), corners.end());
    corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
    return corners;
}

/// Leaves out corners that no triangle uses, and numbers those after them anew.
void drop_unused_corners(Body& body) {
    std::vector<Index> number(body.positions.size(), no_index);
    for (const Triangle& triangle : body.triangles)
        for (const Index corner : triangle.vertices) number[corner] = 0;
    Index kept = 0;
    for (std::size_t corner = 0; corner < number.size(); ++corner) {
        if (number[corner] == no_index) continue;
        body.positions[kept] = body.positions[corner];
        body.texture_coordinates[kept] = body.texture_coordinates[corner];
        number[corner] = kept++;
    }
    body.positions.resize(kept);
    body.texture_coordinates.resize(kept);
    for (Triangle& triangle : body.triangles)
        for (Index& corner : triangle.vertices) corner = number[corner];
}

void require(bool holds, const char* rule) {
    if (!holds) throw Error(ErrorKind::invalid_input, "object", rule);
}

void check_object(const World& world, const Body& object) {
    require(!object.name.empty(), "needs a name");
    for (const FurniturePiece& piece : world.pieces)
        require(piece.name != object.name, "needs a name that no other piece has");
    require(std::all_of(object.positions.begin(), object.positions.end(),
                        [](const Vec3& p) { return is_finite(p); }),
            "has a position that is not finite");
    require(
        object.texture_coordinates.empty() || object.texture_coordinates.size() == object.positions.size(),
        "needs one texture coordinate a position, or none");
    for (const Triangle& triangle : object.triangles) {
        require(triangle.material < world.materials.size(), "has a material that there is not");
        for (const Index corner : triangle.vertices)
            require(corner < object.positions.size(), "has a corner that there is not");
    }
}

}  // namespace

Box bounds_of(const World& world, Index piece) {
    const Body& body = world.bodies[furniture];
    const FurniturePiece& p = world.pieces[piece];
    Box box;
    for (Index t = p.first_triangle; t < p.first_triangle + p.triangles; ++t)
        for (const Index corner : body.triangles[t].vertices) box.add(body.positions[corner]);
    return box;
}

void move_piece(World& world, Index piece, const Pose& motion) {
    for (const Index corner : corners_of(world, piece)) {
        Vec3& position = world.bodies[furniture].positions[corner];
        position = motion.point(position);
    }
}

void remove_piece(World& world, Index piece) {
    Body& body = world.bodies[furniture];
    const FurniturePiece removed = world.pieces[piece];
    const auto first = body.triangles.begin() + removed.first_triangle;
    body.triangles.erase(first, first + removed.triangles);
    drop_unused_corners(body);
    world.pieces.erase(world.pieces.begin() + piece);
    for (FurniturePiece& later : world.pieces)
        if (later.first_triangle > removed.first_triangle) later.first_triangle -= removed.triangles;
}

void add_piece(World& world, const Body& object) {
    check_object(world, object);
    Body body = world.bodies[furniture];
    const auto base = static_cast<Index>(body.positions.size());
    const auto first = static_cast<Index>(body.triangles.size());
    body.positions.insert(body.positions.end(), object.positions.begin(), object.positions.end());
    body.texture_coordinates.insert(body.texture_coordinates.end(), object.texture_coordinates.begin(),
                                    object.texture_coordinates.end());
    body.texture_coordinates.resize(body.positions.size(), Vec2(0));
    for (Triangle triangle : object.triangles) {
        for (Index& corner : triangle.vertices) corner += base;
        const auto& [a, b, c] = triangle.vertices;
        if (has_area(body.positions[a], body.positions[b], body.positions[c]))
            body.triangles.push_back(triangle);
    }
    require(body.triangles.size() > first, "has no triangle with an area");
    world.pieces.push_back({object.name, first, static_cast<Index>(body.triangles.size()) - first});
    world.bodies[furniture] = std::move(body);
}

}  // namespace afterglow
