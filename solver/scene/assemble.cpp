#include <algorithm>

#include "solver/scene/area.h"
#include "solver/scene/place.h"
#include "solver/scene/placement.h"
#include "solver/scene/world.h"

namespace afterglow {

namespace {

/// Beyond this, single precision no longer resolves a millimetre's neighbourhood; files that do it have their
/// units wrong.
constexpr float max_coordinate_m = 1e7F;

/// What a node's geometry hangs on: the furniture, or the actor of its nearest moving ancestor.
struct Attachment {
    Index body = furniture;
    Placement placement;  ///< from the node's coordinates to the body's
};

/// True for nodes that have a mesh, or stand above one with no moving node from there down to it.
std::vector<bool> carriers(const Scene& scene, const std::vector<NodeMotion>& motions) {
    std::vector<bool> carries(scene.nodes.size());
    for (std::size_t n = scene.nodes.size(); n-- > 0;) {
        const Node& node = scene.nodes[n];
        if (node.mesh != no_index) carries[n] = true;
        if (carries[n] && !motions[n].moves() && node.parent != no_index) carries[node.parent] = true;
    }
    return carries;
}

/// Appends a mesh as it looks through `placement`. A mirroring placement turns the corners' order round, so
/// that fronts stay fronts. Returns how many triangles lost their area.
std::size_t append(Body& body, const Mesh& mesh, const Placement& placement, const std::string& place) {
    const auto base = static_cast<Index>(body.positions.size());
    for (const Vec3& position : mesh.positions) {
        const Vec3 p = placement.point(position);
        if (!is_finite(p) || max_channel(glm::abs(p)) > max_coordinate_m)
            throw Error(ErrorKind::invalid_input, place,
                        "reaches more than 10,000 km from the origin; check the units");
        body.positions.push_back(p);
    }
    body.texture_coordinates.insert(body.texture_coordinates.end(), mesh.texture_coordinates.begin(),
                                    mesh.texture_coordinates.end());
    body.texture_coordinates.resize(body.positions.size(), Vec2(0));
    const bool mirrored = glm::determinant(placement.linear) < 0;
    std::size_t dropped = 0;
    for (Triangle triangle : mesh.triangles) {
        for (Index& vertex : triangle.vertices) vertex += base;
        if (mirrored) std::swap(triangle.vertices[1], triangle.vertices[2]);
        const auto& [a, b, c] = triangle.vertices;
        if (has_area(body.positions[a], body.positions[b], body.positions[c]))
            body.triangles.push_back(triangle);
        else
            ++dropped;
    }
    return dropped;
}

/// Joins the static geometry and makes the actors.
std::vector<Body> make_bodies(const Scene& scene, const std::vector<NodeMotion>& motions, PathMaker& paths,
                              std::vector<FurniturePiece>& pieces, Warnings& warnings) {
    const auto carries = carriers(scene, motions);
    std::vector<Body> bodies{{"furniture", {}, {}, {}, {}}};
    std::vector<Attachment> attachments(scene.nodes.size());
    for (std::size_t n = 0; n < scene.nodes.size(); ++n) {
        const Node& node = scene.nodes[n];
        Attachment& attachment = attachments[n];
        if (motions[n].moves() && carries[n]) {
            auto frame = paths.actor_frame(static_cast<Index>(n));
            attachment.body = static_cast<Index>(bodies.size());
            attachment.placement.linear = frame.baked;
            bodies.push_back({node.name, {}, {}, {}, std::move(frame.path)});
        } else {
            if (node.parent != no_index) attachment = attachments[node.parent];
            attachment.placement = attachment.placement.then(motions[n].local);
        }
        if (node.mesh == no_index) continue;
        const auto place = place_of("node", node.name, n);
        Body& body = bodies[attachment.body];
        const auto first = static_cast<Index>(body.triangles.size());
        const auto dropped = append(body, scene.meshes[node.mesh], attachment.placement, place);
        if (attachment.body == furniture)
            pieces.push_back({node.name, first, static_cast<Index>(body.triangles.size()) - first});
        if (dropped > 0)
            warnings.push_back(
                {place, std::to_string(dropped) + " triangles without area as placed here were left out"});
    }
    // What a scale of zero hides is no actor.
    const auto is_empty = [&](const Body& body) { return &body != bodies.data() && body.triangles.empty(); };
    bodies.erase(std::remove_if(bodies.begin(), bodies.end(), is_empty), bodies.end());
    return bodies;
}

}  // namespace

World assemble(const Scene& scene, double tolerance_m, double tolerance_rad) {
    const auto motions = motions_of(scene, tolerance_m, tolerance_rad);
    PathMaker paths(scene, motions, tolerance_m, tolerance_rad);
    World world;
    world.name = scene.name;
    world.warnings = scene.warnings;
    world.bodies = make_bodies(scene, motions, paths, world.pieces, world.warnings);
    for (std::size_t n = 0; n < scene.nodes.size(); ++n) {
        const Node& node = scene.nodes[n];
        const auto index = static_cast<Index>(n);
        if (node.camera != no_index)
            world.cameras.push_back({scene.cameras[node.camera], paths.view_path(index)});
        if (node.light != no_index)
            world.lights.push_back({scene.lights[node.light], paths.view_path(index)});
    }
    world.materials = scene.materials;
    world.textures = scene.textures;
    world.material_emission = scene.tracks.material_emission;
    world.material_reflectance = scene.tracks.material_reflectance;
    world.background = scene.background;
    world.frames_per_second = scene.frames_per_second;
    world.duration_s = scene.duration_s;
    return world;
}

}  // namespace afterglow
