#include "solver/visibility/reach.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>
#include <utility>

#include "solver/base/sampling.h"

namespace afterglow {

namespace {

/// Sides of surfaces, and the two places where light may come from without a surface, as one numbering.
struct SideNumbers {
    std::size_t surfaces;
    [[nodiscard]] Index of(Index surface, Side side) const { return 2 * surface + static_cast<Index>(side); }
    [[nodiscard]] Index lit() const { return static_cast<Index>(2 * surfaces); }  ///< lights, cameras
    [[nodiscard]] Index sky() const { return static_cast<Index>(2 * surfaces + 1); }
    [[nodiscard]] std::size_t count() const { return 2 * surfaces + 2; }
};

using Link = std::pair<Index, Index>;

class Components {
  public:
    explicit Components(std::size_t count) : parent_(count) {
        std::iota(parent_.begin(), parent_.end(), Index{0});
    }
    Index root(Index i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    void join(const Link& link) {
        parent_[std::max(root(link.first), root(link.second))] =
            std::min(root(link.first), root(link.second));
    }

  private:
    std::vector<Index> parent_;
};

/// Where all bodies stand at the moments that matter: every knot, and halfway between knots.
std::vector<double> moments_of(const World& world) {
    std::vector<double> times{0};
    for (const Body& body : world.bodies) {
        const auto& keys = body.path.keys;
        for (std::size_t k = 0; k < keys.size(); ++k) {
            times.push_back(keys[k].time_s);
            if (k + 1 < keys.size()) times.push_back(0.5 * (keys[k].time_s + keys[k + 1].time_s));
        }
    }
    std::sort(times.begin(), times.end());
    times.erase(std::unique(times.begin(), times.end()), times.end());
    // Long key lists are thinned evenly: reach is a property of the whole motion, not of each key.
    constexpr std::size_t most = 16;
    if (times.size() <= most) return times;
    std::vector<double> thinned;
    for (std::size_t k = 0; k < most; ++k) thinned.push_back(times[k * (times.size() - 1) / (most - 1)]);
    return thinned;
}

bool shines(const World& world, const Surface& surface, Side side) {
    const Material& material = world.materials[surface.material];
    return max_channel(material.emission) > 0 &&
           (side == Side::front || material.shines == Material::Shines::both);
}

class ReachSearch {
  public:
    ReachSearch(const World& world, const Surfaces& surfaces, const RayCaster& caster,
                const ReachConfig& config)
        : world_(world),
          surfaces_(surfaces),
          caster_(caster),
          config_(config),
          numbers_{surfaces.list.size()},
          points_(64) {
        Box box;
        for (const Body& body : world.bodies)
            for (const Vec3& p : body.positions) box.add(p);
        lift_m_ = box.empty() ? 0 : 1e-5F * glm::length(box.extent());
    }

    [[nodiscard]] const SideNumbers& numbers() const { return numbers_; }

    /// Lines from points of a surface's side.
    void links_of(Index surface, Side side, std::vector<Link>& links) const {
        const Surface& s = surfaces_.list[surface];
        const Index from = numbers_.of(surface, side);
        if (shines(world_, s, side)) links.emplace_back(from, numbers_.lit());
        const float wanted = s.area_m2 / (config_.spacing_m * config_.spacing_m);
        const int origins =
            static_cast<int>(std::clamp(wanted, 4.0F, static_cast<float>(config_.max_origins)));
        const Body& body = world_.bodies[s.body];
        std::size_t member = 0;
        float reached_area = triangle_area(body, s.triangles[0]);
        for (int k = 0; k < origins; ++k) {
            const float at = (static_cast<float>(k) + 0.5F) / static_cast<float>(origins) * s.area_m2;
            while (reached_area < at && member + 1 < s.triangles.size())
                reached_area += triangle_area(body, s.triangles[++member]);
            lines_from(s.triangles[member], s.body, side, from,
                       mixed(config_.seed, mixed(from, static_cast<std::uint64_t>(k))), links);
        }
    }

    /// Lines from a camera or a light, in all directions.
    void links_from_point(const Vec3& position, std::vector<Link>& links) const {
        constexpr std::size_t directions = 256;
        for (std::size_t k = 0; k < directions; ++k) {
            const Sample4 s = points_.at(k % points_.size(), mixed(config_.seed, k));
            const float z = 1 - 2 * s[0], r = std::sqrt(std::max(0.0F, 1 - z * z)), angle = 2 * pi * s[1];
            link({position, Vec3(r * std::cos(angle), r * std::sin(angle), z)}, numbers_.lit(), links);
        }
    }

  private:
    static float triangle_area(const Body& body, Index t) {
        return 0.5F * glm::length(doubled_area_normal(body, t));
    }

    void lines_from(Index triangle, Index body_index, Side side, Index from, std::uint64_t seed,
                    std::vector<Link>& links) const {
        const Body& body = world_.bodies[body_index];
        const auto& v = body.triangles[triangle].vertices;
        const float sign = side == Side::front ? 1.0F : -1.0F;
        const Vec3 normal = sign * glm::normalize(doubled_area_normal(body, triangle));
        const Frame frame(normal);
        const Pose& pose = caster_.pose(body_index);
        for (int k = 0; k < config_.rays_per_origin; ++k) {
            const Sample4 s = points_.at(static_cast<std::size_t>(k) % points_.size(), seed);
            float a = s[2], b = s[3];
            if (a + b > 1) {
                a = 1 - a;
                b = 1 - b;
            }
            const Vec3 point =
                (1 - a - b) * body.positions[v[0]] + a * body.positions[v[1]] + b * body.positions[v[2]];
            Ray ray{point + lift_m_ * normal, frame.to_world(cosine_direction(s[0], s[1]))};
            if (body_index != furniture) ray = {pose.point(ray.origin), pose.direction(ray.direction)};
            link(ray, from, links);
        }
    }

    void link(const Ray& ray, Index from, std::vector<Link>& links) const {
        const Hit hit = caster_.nearest(ray, Scope::everything);
        const Index to = hit.body == no_index
                             ? numbers_.sky()
                             : numbers_.of(surfaces_.of_triangle[hit.body][hit.triangle], hit.side);
        if (links.empty() || links.back() != Link(from, to)) links.emplace_back(from, to);
    }

    const World& world_;
    const Surfaces& surfaces_;
    const RayCaster& caster_;
    const ReachConfig& config_;
    SideNumbers numbers_;
    SobolPoints points_;
    float lift_m_ = 0;
};

}  // namespace

SideMask reachable_sides(const World& world, const Surfaces& surfaces, RayCaster& caster,
                         const ReachConfig& config, const Context& context) {
    const ReachSearch search(world, surfaces, caster, config);
    const SideNumbers& numbers = search.numbers();
    Components components(numbers.count());
    if (max_channel(world.background) > 0) components.join({numbers.lit(), numbers.sky()});

    const auto moments = moments_of(world);
    for (std::size_t m = 0; m < moments.size(); ++m) {
        context.report(static_cast<double>(m) / static_cast<double>(moments.size()),
                       "finding what light can reach");
        caster.set_poses(poses_at(world, moments[m]));
        std::vector<std::vector<Link>> links(surfaces.list.size());
        context.for_chunks(surfaces.list.size(), 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t s = begin; s < end; ++s) {
                // Furniture sees furniture the same way at every moment; later moments only follow the
                // actors.
                if (m > 0 && surfaces.list[s].body == furniture) continue;
                for (const Side side : {Side::front, Side::back})
                    search.links_of(static_cast<Index>(s), side, links[s]);
            }
        });
        std::vector<Link>& from_points = links.emplace_back();
        for (const PlacedCamera& camera : world.cameras)
            search.links_from_point(camera.path.at(moments[m]).translation, from_points);
        for (const PlacedLight& light : world.lights)
            search.links_from_point(light.path.at(moments[m]).translation, from_points);
        for (const auto& list : links)
            for (const Link& link : list) components.join(link);
    }
    // A directional light comes from outside.
    for (const PlacedLight& light : world.lights)
        if (light.light.kind == Light::Kind::directional) components.join({numbers.lit(), numbers.sky()});

    SideMask reached(surfaces.list.size());
    for (Index s = 0; s < surfaces.list.size(); ++s)
        for (const Side side : {Side::front, Side::back})
            reached[s][static_cast<std::size_t>(side)] =
                components.root(numbers.of(s, side)) == components.root(numbers.lit());
    return reached;
}

}  // namespace afterglow
