#include "solver/mesh/cuts.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "solver/mesh/box_tree.h"
#include "solver/mesh/lift.h"

namespace afterglow {

namespace {

// Lines start a lift above a surface, so what ends lower stops them; the rest is room for rounding.
constexpr float contact_per_lift = 1.25F;
constexpr float flattest_sine = 0.1F;  // of the angle between a surface and what stands on it

/// A flat surface and how near something must come to touch it.
struct Ground {
    Vec3 origin, normal;
    float contact_m = 0;

    [[nodiscard]] float height(const Vec3& p) const { return glm::dot(p - origin, normal); }
};

Ground ground_of(const Body& body, const Surface& surface, float lift_m) {
    Ground ground{body.positions[body.triangles[surface.triangles.front()].vertices[0]], surface.normal};
    float unevenness = 0;
    for (const Index t : surface.triangles)
        for (const Index v : body.triangles[t].vertices)
            unevenness = std::max(unevenness, std::abs(ground.height(body.positions[v])));
    ground.contact_m = contact_per_lift * lift_m + unevenness;
    return ground;
}

/// Along a direction, the extent of that part of a triangle that is within contact of the ground.
struct Span {
    float low = std::numeric_limits<float>::infinity();
    float high = -std::numeric_limits<float>::infinity();
    void add(float x) {
        low = std::min(low, x);
        high = std::max(high, x);
    }
};

Span contact_span(const std::array<Vec3, 3>& corner, const std::array<float, 3>& height, float contact_m,
                  const Vec3& origin, const Vec3& along) {
    Span span;
    const auto at = [&](const Vec3& p) { return glm::dot(p - origin, along); };
    for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t next = (k + 1) % 3;
        if (std::abs(height[k]) <= contact_m) span.add(at(corner[k]));
        for (const float bound : {-contact_m, contact_m}) {
            if ((height[k] < bound) == (height[next] < bound)) continue;
            const float t = (bound - height[k]) / (height[next] - height[k]);
            span.add(at(glm::mix(corner[k], corner[next], t)));
        }
    }
    return span;
}

std::optional<Cut> cut_by(const Ground& ground, const std::array<Vec3, 3>& corner, float lift_m) {
    std::array<float, 3> height{};
    for (std::size_t k = 0; k < 3; ++k) height[k] = ground.height(corner[k]);
    const auto [low, high] = std::minmax_element(height.begin(), height.end());
    const float contact = ground.contact_m;
    const auto touching =
        std::count_if(height.begin(), height.end(), [&](float h) { return std::abs(h) <= contact; });
    const bool is_pierced = std::min(-*low, *high) > contact;
    if (!is_pierced && touching != 2) return std::nullopt;  // clear of it, in it, or at a point of it

    const Vec3 doubled = glm::cross(corner[1] - corner[0], corner[2] - corner[0]);
    const Vec3 normal = doubled / glm::length(doubled);
    const Vec3 across = glm::cross(ground.normal, normal);
    const float sine = glm::length(across);
    if (!(sine > flattest_sine)) return std::nullopt;  // NaN where the triangle has no area
    const Vec3 along = across / sine;

    // Down the triangle's own plane from the corner nearest to the ground, where rounding is least.
    const auto nearest = static_cast<std::size_t>(
        std::min_element(height.begin(), height.end(),
                         [](float a, float b) { return std::abs(a) < std::abs(b); }) -
        height.begin());
    const Vec3 slope = glm::cross(along, normal);
    const Vec3 foot = corner[nearest] - height[nearest] / glm::dot(slope, ground.normal) * slope;

    const Span span = contact_span(corner, height, contact, foot, along);
    if (!(span.high - span.low > contact)) return std::nullopt;
    const float cotangent = std::sqrt(std::max(0.0F, 1 - sine * sine)) / sine;
    Cut cut;
    // A little longer, so that no light slips between one triangle's end and the next one's.
    cut.from = foot + (span.low - contact) * along;
    cut.to = foot + (span.high + contact) * along;
    cut.kerf_m = contact + lift_m * cotangent;
    cut.stands_on = {*high > contact, *low < -contact};
    return cut;
}

std::array<Vec3, 3> corners_of(const Body& body, Index triangle) {
    const auto& v = body.triangles[triangle].vertices;
    return {body.positions[v[0]], body.positions[v[1]], body.positions[v[2]]};
}

Box box_of(const Body& body, Index triangle) {
    Box box;
    for (const Vec3& p : corners_of(body, triangle)) box.add(p);
    return box;
}

BoxTree triangle_tree(const Body& body) {
    std::vector<Box> boxes;
    boxes.reserve(body.triangles.size());
    for (Index t = 0; t < body.triangles.size(); ++t) boxes.push_back(box_of(body, t));
    return BoxTree(std::move(boxes));
}

}  // namespace

Cuts find_cuts(const World& world, const Surfaces& surfaces, const Context& context) {
    Cuts cuts;
    cuts.lift_m = lift_for(world);
    cuts.of_surface.resize(surfaces.list.size());
    std::vector<BoxTree> trees;
    for (const Body& body : world.bodies) trees.push_back(triangle_tree(body));
    context.for_chunks(surfaces.list.size(), 16, [&](std::size_t begin, std::size_t end) {
        for (std::size_t s = begin; s < end; ++s) {
            const Surface& surface = surfaces.list[s];
            if (surface.kind != Surface::Kind::flat) continue;
            const Body& body = world.bodies[surface.body];
            const Ground ground = ground_of(body, surface, cuts.lift_m);
            Box region;
            for (const Index t : surface.triangles) region.add(box_of(body, t));
            region.low -= ground.contact_m;
            region.high += ground.contact_m;
            trees[surface.body].for_overlaps(region, [&](Index t) {
                if (surfaces.of_triangle[surface.body][t] == s) return;
                if (const auto cut = cut_by(ground, corners_of(body, t), cuts.lift_m))
                    cuts.of_surface[s].push_back(*cut);
            });
        }
    });
    return cuts;
}

}  // namespace afterglow
