#include "solver/visibility/face_search.h"

#include <bit>

namespace afterglow {

namespace {

/// Tests one face and keeps what is nearer. `part` is the part of the triangle that counts, or null.
class FaceTest {
  public:
    FaceTest(const SearchedBody& body, const RayPacket& rays, LaneHits& hits, SearchWork& work)
        : body_(body), rays_(rays), axes_(rays), hits_(hits), work_(work) {}

    std::uint32_t triangle(Index index, std::uint32_t lanes) const {
        return test(index, lanes, [](std::size_t, float) { return true; });
    }
    std::uint32_t face(Index index, std::uint32_t lanes) const {
        const BspTree::Face& part = body_.tree.faces[index];
        return test(part.triangle, lanes, [&](std::size_t lane, float distance) {
            if (part.splits == 0) return true;
            const Ray ray = rays_.ray(lane);
            return body_.tree.holds(part,
                                    Vec3d(ray.origin) + static_cast<double>(distance) * Vec3d(ray.direction));
        });
    }

  private:
    template <class Counts>
    std::uint32_t test(Index index, std::uint32_t lanes, const Counts& counts) const {
        work_.line_face_tests += static_cast<std::uint64_t>(std::popcount(lanes));
        alignas(64) std::array<float, 16> distance;
        meet(rays_, axes_, body_.faces[index], distance);
        std::uint32_t nearer = 0;
        for (std::size_t lane = 0; lane < 16; ++lane)
            nearer |= static_cast<std::uint32_t>(distance[lane] <= hits_.distance[lane]) << lane;
        std::uint32_t found = 0;
        // A line that reaches for ever has no hit at infinity.
        for (std::uint32_t left = nearer & lanes; left != 0; left &= left - 1) {
            const auto lane = static_cast<std::size_t>(std::countr_zero(left));
            if (distance[lane] == std::numeric_limits<float>::infinity() || !counts(lane, distance[lane]))
                continue;
            hits_.distance[lane] = distance[lane];
            hits_.body[lane] = body_.body;
            hits_.triangle[lane] = index;
            hits_.side[lane] =
                glm::dot(rays_.ray(lane).direction, body_.faces[index].normal) < 0 ? Side::front : Side::back;
            found |= 1U << lane;
        }
        return found;
    }

    const SearchedBody& body_;
    const RayPacket& rays_;
    LineAxes axes_;
    LaneHits& hits_;
    SearchWork& work_;
};

/// Walks a tree with those lanes that still look for something.
class Walk {
  public:
    Walk(const SearchedBody& body, const TemporalBsp& temporal, const LinePacket& lines, LaneHits& hits,
         SearchWork& work)
        : tree_(body.tree),
          temporal_(temporal),
          lines_(lines),
          work_(work),
          test_(body, lines.rays, hits, work) {}

    std::uint32_t visit(Index index, std::uint32_t lanes) const {
        const BspTree::Node& node = tree_.nodes[index];
        ++work_.node_visits;
        lanes &= lanes_through(lines_, node.box);
        if (lanes == 0) return 0;
        const PlaneSide side = temporal_.nodes[index].side;
        if (side == PlaneSide::across) return visit_unordered(index, lanes);
        const Index near = side == PlaneSide::front ? node.front : node.back;
        const Index far = side == PlaneSide::front ? node.back : node.front;
        std::uint32_t found = near == no_index ? 0 : visit(near, lanes);
        found |= own(node, lanes & ~found);
        if (far != no_index && (lanes & ~found) != 0) found |= visit(far, lanes & ~found);
        return found;
    }

  private:
    /// The lines begin on both sides of the plane: all that they may meet is tested, the nearest counts.
    [[nodiscard]] std::uint32_t visit_unordered(Index index, std::uint32_t lanes) const {
        const BspTree::Node& node = tree_.nodes[index];
        std::uint32_t found = own(node, lanes);
        for (const Index child : {node.front, node.back}) {
            if (child == no_index) continue;
            ++work_.node_visits;
            const std::uint32_t within = lanes & lanes_through(lines_, tree_.nodes[child].box);
            if (within != 0) found |= visit_unordered(child, within);
        }
        return found;
    }

    [[nodiscard]] std::uint32_t own(const BspTree::Node& node, std::uint32_t lanes) const {
        std::uint32_t found = 0;
        if (lanes == 0) return found;
        for (Index k = node.first_face; k < node.first_face + node.own_faces; ++k)
            found |= test_.face(k, lanes);
        return found;
    }

    const BspTree& tree_;
    const TemporalBsp& temporal_;
    const LinePacket& lines_;
    SearchWork& work_;
    FaceTest test_;
};

}  // namespace

SearchedBody make_searched_body(const World& world, Index body) {
    SearchedBody out;
    out.body = body;
    const Body& source = world.bodies[body];
    for (const Triangle& triangle : source.triangles) {
        const auto& v = triangle.vertices;
        out.faces.emplace_back(source.positions[v[0]], source.positions[v[1]], source.positions[v[2]]);
        for (const Index vertex : v) out.box.add(source.positions[vertex]);
    }
    for (Index t = 0; t < out.faces.size(); ++t)
        if (out.faces[t].normal != Vec3(0)) out.solid.push_back(t);
    out.tree = make_bsp_tree(source);
    return out;
}

std::uint32_t search_all(const SearchedBody& body, const RayPacket& rays, std::uint32_t lanes, LaneHits& hits,
                         SearchWork& work) {
    const FaceTest test(body, rays, hits, work);
    std::uint32_t found = 0;
    for (const Index triangle : body.solid) found |= test.triangle(triangle, lanes);
    return found;
}

std::uint32_t search_in_order(const SearchedBody& body, const TemporalBsp& temporal, const RayPacket& rays,
                              std::uint32_t lanes, LaneHits& hits, SearchWork& work) {
    const FaceTest test(body, rays, hits, work);
    std::uint32_t found = 0, looking = lanes;
    for (const OrderedFace& next : temporal.order) {
        if (next.begins_run) looking = lanes & ~found;
        if (looking == 0) break;
        found |= test.face(next.face, looking);
    }
    return found;
}

std::uint32_t search_tree(const SearchedBody& body, const TemporalBsp& temporal, const LinePacket& lines,
                          std::uint32_t lanes, LaneHits& hits, SearchWork& work) {
    if (body.tree.nodes.empty()) return 0;
    return Walk(body, temporal, lines, hits, work).visit(0, lanes);
}

}  // namespace afterglow
