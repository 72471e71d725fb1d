#include "solver/scene/gltf_nodes.h"

#include <array>
#include <cmath>
#include <string>
#include <utility>

namespace afterglow::gltf {

namespace {

using Column = glm::dvec3;

Transform transform_of(const JsonView& element, const std::string& name) {
    if (const auto matrix = element.find("matrix")) {
        const auto numbers = matrix->as_numbers(16);
        try {
            return decomposed(numbers, *matrix);
        } catch (const Error& e) {
            // People know their nodes by name, not by number.
            throw Error(e.kind(), e.place(), in_quotes(name) + ": " + e.message());
        }
    }
    Transform out;
    if (const auto translation = element.find("translation")) out.translation = translation->as_vec3();
    if (const auto scale = element.find("scale")) out.scale = scale->as_vec3();
    if (const auto rotation = element.find("rotation")) {
        const auto q = rotation->as_numbers(4);
        out.rotation = to_rotation(q[0], q[1], q[2], q[3], *rotation);
    }
    return out;
}

/// The tree as the file draws it: every child's parent, checked to be a forest.
struct Forest {
    std::vector<std::vector<Index>> children;
    std::vector<Index> parents;
};

Forest read_forest(const Document& document) {
    const std::size_t count = document.nodes.size();
    Forest forest{std::vector<std::vector<Index>>(count), std::vector<Index>(count, no_index)};
    for (std::size_t i = 0; i < count; ++i) {
        const auto children = document.nodes[i].find("children");
        if (!children) continue;
        for (const JsonView& item : children->elements()) {
            const Index child = item.as_index(count);
            if (forest.parents[child] != no_index)
                item.fail("node " + std::to_string(child) + " has two parents");
            forest.parents[child] = static_cast<Index>(i);
            forest.children[i].push_back(child);
        }
    }
    return forest;
}

/// All nodes below the given roots, parents first, in file order otherwise. A loop instead of recursion, so
/// that a chain of any length is fine.
std::vector<Index> preorder(const Forest& forest, const std::vector<Index>& roots) {
    std::vector<Index> order;
    std::vector<Index> stack(roots.rbegin(), roots.rend());
    while (!stack.empty()) {
        const Index node = stack.back();
        stack.pop_back();
        order.push_back(node);
        const auto& children = forest.children[node];
        stack.insert(stack.end(), children.rbegin(), children.rend());
    }
    return order;
}

std::vector<Index> all_roots(const Forest& forest) {
    std::vector<Index> roots;
    for (std::size_t i = 0; i < forest.parents.size(); ++i)
        if (forest.parents[i] == no_index) roots.push_back(static_cast<Index>(i));
    return roots;
}

/// With one parent each, whatever no root leads to goes round in circles.
void check_cycles(const Document& document, const Forest& forest) {
    std::vector<bool> reached(document.nodes.size(), false);
    for (const Index node : preorder(forest, all_roots(forest))) reached[node] = true;
    for (std::size_t i = 0; i < reached.size(); ++i)
        if (!reached[i])
            document.nodes[i].fail("the node " + in_quotes(name_of(document.nodes[i], "node", i)) +
                                   " is its own ancestor");
}

std::vector<Index> scene_roots(const Document& document, const Forest& forest) {
    const auto chosen = document.root().find("scene");
    if (document.scenes.empty() && !chosen) return all_roots(forest);
    const JsonView& scene = document.scenes[chosen ? chosen->as_index(document.scenes.size()) : 0];
    std::vector<Index> roots;
    const auto listed = scene.find("nodes");
    if (!listed) return roots;
    std::vector<bool> seen(document.nodes.size(), false);
    for (const JsonView& item : listed->elements()) {
        const Index root = item.as_index(document.nodes.size());
        if (forest.parents[root] != no_index)
            item.fail("node " + std::to_string(root) + " is not a root: it has a parent");
        if (seen[root]) item.fail("node " + std::to_string(root) + " is listed twice");
        seen[root] = true;
        roots.push_back(root);
    }
    return roots;
}

Index optional_index(const JsonView& element, std::string_view key, std::size_t size) {
    const auto member = element.find(key);
    return member ? member->as_index(size) : no_index;
}

Node read_node(const Document& document, Index position, const std::vector<Index>& cameras,
               const Scene& scene) {
    const JsonView& element = document.nodes[position];
    Node node;
    node.name = name_of(element, "node", position);
    node.local = transform_of(element, node.name);
    node.mesh = optional_index(element, "mesh", scene.meshes.size());
    const Index camera = optional_index(element, "camera", cameras.size());
    if (camera != no_index) node.camera = cameras[camera];
    if (const auto light = extension_of(element, "KHR_lights_punctual"))
        node.light = light->at("light").as_index(scene.lights.size());
    return node;
}

}  // namespace

Quat to_rotation(double x, double y, double z, double w, const JsonView& place) {
    const double length = std::sqrt(x * x + y * y + z * z + w * w);
    // Rotations stored in bytes are off by up to about a hundredth.
    if (!(std::abs(length - 1) < 0.1)) place.fail("a rotation must be a quaternion of unit length");
    return {static_cast<float>(w / length), static_cast<float>(x / length), static_cast<float>(y / length),
            static_cast<float>(z / length)};
}

Transform decomposed(const std::vector<double>& matrix, const JsonView& place) {
    constexpr double tolerance = 1e-4;  // of 1; exporters write single precision
    std::array<Column, 3> columns;
    std::array<double, 3> lengths{};
    for (std::size_t c = 0; c < 3; ++c) {
        columns[c] = {matrix[4 * c], matrix[4 * c + 1], matrix[4 * c + 2]};
        lengths[c] = glm::length(columns[c]);
        if (std::abs(matrix[4 * c + 3]) > tolerance)
            place.fail("the last row of a node's matrix must be 0 0 0 1");
        if (!(lengths[c] > 1e-12) || !std::isfinite(lengths[c])) place.fail("the matrix flattens space");
        columns[c] /= lengths[c];
    }
    if (std::abs(matrix[15] - 1) > tolerance) place.fail("the last row of a node's matrix must be 0 0 0 1");
    if (std::abs(glm::dot(columns[0], columns[1])) > tolerance ||
        std::abs(glm::dot(columns[1], columns[2])) > tolerance ||
        std::abs(glm::dot(columns[2], columns[0])) > tolerance)
        place.fail("the matrix shears; only translation, rotation and scale are read");
    // A mirroring matrix is a rotation of a mirrored axis.
    if (glm::dot(glm::cross(columns[0], columns[1]), columns[2]) < 0) {
        columns[0] = -columns[0];
        lengths[0] = -lengths[0];
    }
    const glm::dquat turn = glm::normalize(glm::quat_cast(glm::dmat3(columns[0], columns[1], columns[2])));
    Transform out;
    for (int c = 0; c < 3; ++c) {
        out.translation[c] = to_float(place, matrix[12 + static_cast<std::size_t>(c)]);
        out.scale[c] = to_float(place, lengths[static_cast<std::size_t>(c)]);
    }
    out.rotation = Quat(turn);
    return out;
}

std::vector<Index> read_nodes(const Document& document, const std::vector<Index>& cameras, Scene& scene) {
    const Forest forest = read_forest(document);
    check_cycles(document, forest);
    std::vector<Index> places(document.nodes.size(), no_index);
    for (const Index position : preorder(forest, scene_roots(document, forest))) {
        Node node = read_node(document, position, cameras, scene);
        if (forest.parents[position] != no_index) node.parent = places[forest.parents[position]];
        places[position] = static_cast<Index>(scene.nodes.size());
        scene.nodes.push_back(std::move(node));
    }
    return places;
}

}  // namespace afterglow::gltf
