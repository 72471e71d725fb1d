#include "solver/scene/json_geometry.h"

#include <array>
#include <cmath>

#include "solver/scene/json_rows.h"

namespace afterglow {

namespace {

std::vector<Vec3> read_positions(const JsonView& view, double metres_per_unit) {
    const auto numbers = number_rows(view, 3);
    std::vector<Vec3> out;
    out.reserve(numbers.size() / 3);
    for (std::size_t k = 0; k < numbers.size(); k += 3)
        out.emplace_back(numbers[k] * metres_per_unit, numbers[k + 1] * metres_per_unit,
                         numbers[k + 2] * metres_per_unit);
    return out;
}

std::vector<Triangle> read_triangles(const JsonView& view, std::size_t positions, Index material) {
    const auto numbers = number_rows(view, 3);
    std::vector<Triangle> out;
    out.reserve(numbers.size() / 3);
    for (std::size_t row = 0; row < numbers.size() / 3; ++row) {
        Triangle triangle{{}, material};
        for (std::size_t k = 0; k < 3; ++k) {
            const double number = numbers[3 * row + k];
            // The slow way says what is wrong, and where.
            if (number != std::floor(number) || number < 0 || number >= static_cast<double>(positions))
                static_cast<void>(view.elements()[row].elements()[k].as_index(positions));
            triangle.vertices[k] = static_cast<Index>(number);
        }
        out.push_back(triangle);
    }
    return out;
}

Mesh triangle_mesh(const JsonView& geometry, Index material, double metres_per_unit) {
    geometry.allow_only({"positions", "triangles", "texture_coordinates", "material"});
    Mesh mesh;
    mesh.positions = read_positions(geometry.at("positions"), metres_per_unit);
    mesh.triangles = read_triangles(geometry.at("triangles"), mesh.positions.size(), material);
    if (const auto view = geometry.find("texture_coordinates")) {
        const auto numbers = number_rows(*view, 2);
        if (numbers.size() != 2 * mesh.positions.size())
            view->fail("expected one row for each of the " + std::to_string(mesh.positions.size()) +
                       " positions, found " + std::to_string(numbers.size() / 2));
        for (std::size_t k = 0; k < numbers.size(); k += 2)
            mesh.texture_coordinates.emplace_back(numbers[k], numbers[k + 1]);
    }
    return mesh;
}

/// `count` positive lengths in metres.
std::vector<float> read_size(const JsonView& view, std::size_t count, double metres_per_unit) {
    std::vector<float> out;
    for (const double number : view.at("size").as_numbers(count)) {
        const float length = to_single(view, number * metres_per_unit);
        if (!(length > 0)) view.at("size").fail("lengths must be above 0");
        out.push_back(length);
    }
    return out;
}

/// A rectangle around the origin, spanned by half of `u` and `v`, facing u × v.
void add_rectangle(Mesh& mesh, const Vec3& centre, const Vec3& u, const Vec3& v, Index material) {
    const auto first = static_cast<Index>(mesh.positions.size());
    constexpr std::array<Vec2, 4> corners{Vec2(-1, -1), Vec2(1, -1), Vec2(1, 1), Vec2(-1, 1)};
    for (const Vec2& corner : corners) {
        mesh.positions.push_back(centre + 0.5F * (corner.x * u + corner.y * v));
        mesh.texture_coordinates.emplace_back(0.5F + 0.5F * corner.x, 0.5F - 0.5F * corner.y);
    }
    mesh.triangles.push_back({{first, first + 1, first + 2}, material});
    mesh.triangles.push_back({{first, first + 2, first + 3}, material});
}

/// A rectangle in the plane y = 0, facing up.
Mesh quad_mesh(const JsonView& geometry, Index material, double metres_per_unit) {
    geometry.allow_only({"quad", "material"});
    const JsonView quad = geometry.at("quad");
    quad.allow_only({"size"});
    const auto size = read_size(quad, 2, metres_per_unit);
    Mesh mesh;
    add_rectangle(mesh, Vec3(0), Vec3(size[0], 0, 0), Vec3(0, 0, -size[1]), material);
    return mesh;
}

/// A box around the origin, faces outwards.
Mesh box_mesh(const JsonView& geometry, Index material, double metres_per_unit) {
    geometry.allow_only({"box", "material"});
    const JsonView box = geometry.at("box");
    box.allow_only({"size"});
    const auto size = read_size(box, 3, metres_per_unit);
    Mesh mesh;
    for (int axis = 0; axis < 3; ++axis)
        for (const float side : {-1.0F, 1.0F}) {
            Vec3 normal(0), u(0), v(0);
            normal[axis] = side * size[static_cast<std::size_t>(axis)];
            const int next = (axis + 1) % 3, last = (axis + 2) % 3;
            u[next] = side * size[static_cast<std::size_t>(next)];
            v[last] = size[static_cast<std::size_t>(last)];
            add_rectangle(mesh, 0.5F * normal, u, v, material);
        }
    return mesh;
}

}  // namespace

bool is_inline_geometry(const JsonView& geometry) {
    return geometry.find("positions") || geometry.find("box") || geometry.find("quad");
}

Mesh inline_mesh(const JsonView& geometry, const Names& materials, double metres_per_unit) {
    const Index material = materials.find(geometry.at("material"));
    if (geometry.find("quad")) return quad_mesh(geometry, material, metres_per_unit);
    if (geometry.find("box")) return box_mesh(geometry, material, metres_per_unit);
    return triangle_mesh(geometry, material, metres_per_unit);
}

}  // namespace afterglow
