#include "solver/image/visible_surfaces.h"

#include <algorithm>

namespace afterglow {

namespace {

/// The triangles of each object, and the bodies they belong to.
struct Parts {
    std::vector<Index> body;
    std::vector<std::vector<Index>> triangles;
};

Parts parts_of(const World& world, const Surfaces& surfaces) {
    Parts parts;
    for (const Surface& surface : surfaces.list) {
        if (surface.body != furniture) continue;
        parts.body.push_back(furniture);
        parts.triangles.push_back(surface.triangles);
    }
    for (Index b = 1; b < world.bodies.size(); ++b) {
        parts.body.push_back(b);
        std::vector<Index>& all = parts.triangles.emplace_back();
        for (Index t = 0; t < world.bodies[b].triangles.size(); ++t) all.push_back(t);
    }
    return parts;
}

Box box_of(const Body& body, const std::vector<Index>& triangles) {
    Box box;
    for (const Index t : triangles)
        for (const Index vertex : body.triangles[t].vertices) box.add(body.positions[vertex]);
    return box;
}

}  // namespace

ObserverSight make_observer_sight(const World& world, const Surfaces& surfaces, const Path& camera,
                                  const ObserverConfig& config) {
    ObserverSight sight;
    std::vector<Path> paths{camera};
    for (const Body& body : world.bodies) {
        paths.push_back(body.path);
        sight.views.push_back(steady_views(body.path, camera));
    }
    const TimeTree times = make_time_tree(paths, config.slice_s, config.most_levels);
    const Parts parts = parts_of(world, surfaces);
    std::vector<SpacetimeExtent> extents;
    for (std::size_t k = 0; k < parts.body.size(); ++k) {
        const Body& body = world.bodies[parts.body[k]];
        ObserverSight::Object object{parts.body[k], make_bsp_tree(body, parts.triangles[k]), {}};
        object.temporal = make_temporal_bsp(object.tree, sight.views[object.body], {}, 0);
        extents.push_back(swept_extent(box_of(body, parts.triangles[k]), body.path, times, config.slack_m));
        sight.objects.push_back(std::move(object));
    }
    const SpacetimeExtent eye = swept_extent({Vec3(0), Vec3(0)}, camera, times, config.slack_m);
    sight.graph = make_temporal_graph(find_adjacencies(extents, eye, times));
    update(sight.graph, 0);
    return sight;
}

ObserverWork update(ObserverSight& sight, double time_s) {
    ObserverWork work;
    sight.time_s = time_s;
    work.graph = update(sight.graph, time_s);
    for (ObserverSight::Object& object : sight.objects) {
        const TreeWork one = update(object.temporal, object.tree, sight.views[object.body], {}, time_s);
        work.trees.nodes_visited += one.nodes_visited;
        work.trees.sides_changed += one.sides_changed;
    }
    return work;
}

std::vector<SortedFace> sorted_faces(const ObserverSight& sight) {
    std::vector<SortedFace> faces;
    std::vector<Index> listed;
    for (const Index object : sight.graph.order) {
        const ObserverSight::Object& one = sight.objects[object];
        const std::size_t first = faces.size();
        for (const OrderedFace& next : one.temporal.order)
            faces.push_back({one.body, one.tree.faces[next.face].triangle, object});
        if (one.tree.split_list.empty()) continue;
        // Parts of one triangle: the nearest stands for all.
        listed.clear();
        const auto again = [&](const SortedFace& face) {
            const auto at = std::lower_bound(listed.begin(), listed.end(), face.triangle);
            if (at != listed.end() && *at == face.triangle) return true;
            listed.insert(at, face.triangle);
            return false;
        };
        std::vector<SortedFace> once;
        for (std::size_t k = first; k < faces.size(); ++k)
            if (!again(faces[k])) once.push_back(faces[k]);
        faces.resize(first);
        faces.insert(faces.end(), once.begin(), once.end());
    }
    return faces;
}

std::vector<PlacedTriangle> placed(const World& world, const std::vector<SortedFace>& faces, double time_s) {
    const std::vector<Pose> poses = poses_at(world, time_s);
    std::vector<PlacedTriangle> out;
    out.reserve(faces.size());
    for (const SortedFace& face : faces) {
        const Body& body = world.bodies[face.body];
        const auto& v = body.triangles[face.triangle].vertices;
        const auto corner = [&](std::size_t k) {
            const Vec3& p = body.positions[v[k]];
            return face.body == furniture ? p : poses[face.body].point(p);
        };
        out.push_back({corner(0), corner(1), corner(2)});
    }
    return out;
}

std::vector<SortedFace> visible_faces(const std::vector<SortedFace>& faces, const ItemBuffer& buffer) {
    std::vector<char> seen(faces.size(), 0);
    for (const Index item : buffer.item)
        if (item != no_index) seen[item] = 1;
    std::vector<SortedFace> out;
    for (std::size_t k = 0; k < faces.size(); ++k)
        if (seen[k] != 0) out.push_back(faces[k]);
    return out;
}

}  // namespace afterglow
