#include "solver/formfactor/polygon_pair.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "solver/formfactor/edge_pair.h"

namespace afterglow {

namespace {

constexpr double in_plane = 1e-13;     // of the pair's extent: nearer corners lie in the other's plane
constexpr double asked_error = 1e-12;  // of F

/// A pair moved to the origin and shrunk to unit extent, so that no logarithm is large: a common factor in r
/// adds nothing around closed contours, but its rounding would.
struct UnitPair {
    std::vector<Vec3d> from, to;
    double scale_m;
};

UnitPair unit_pair(std::span<const Vec3d> from, std::span<const Vec3d> to) {
    Vec3d low = from[0], high = from[0];
    for (const auto& polygon : {from, to})
        for (const Vec3d& c : polygon) {
            low = glm::min(low, c);
            high = glm::max(high, c);
        }
    const Vec3d centre = 0.5 * (low + high);
    UnitPair out{{}, {}, glm::length(high - low)};
    for (const Vec3d& c : from) out.from.push_back((c - centre) / out.scale_m);
    for (const Vec3d& c : to) out.to.push_back((c - centre) / out.scale_m);
    return out;
}

double around(std::span<const Vec3d> from, std::span<const Vec3d> to, double tolerance) {
    double sum = 0;
    for (std::size_t i = 0; i < from.size(); ++i)
        for (std::size_t j = 0; j < to.size(); ++j)
            sum += contour_integral({from[i], from[(i + 1) % from.size()]}, {to[j], to[(j + 1) % to.size()]},
                                    tolerance);
    return sum;
}

}  // namespace

double polygon_exchange_area(std::span<const Vec3d> from, std::span<const Vec3d> to) {
    check_polygon(from, "polygon_form_factor, first polygon");
    check_polygon(to, "polygon_form_factor, second polygon");
    const UnitPair pair = unit_pair(from, to);
    std::vector<Vec3d> seeing, seen;
    clip_to_front(pair.from, plane_of(pair.to), in_plane, seeing);
    clip_to_front(pair.to, plane_of(pair.from), in_plane, seen);
    if (seeing.size() < 3 || seen.size() < 3) return 0;
    const double area_from = glm::length(area_vector(pair.from)), area_to = glm::length(area_vector(pair.to));
    const double edges = static_cast<double>(seeing.size() * seen.size());
    const double tolerance = asked_error * 2 * pi_d * std::min(area_from, area_to) / std::sqrt(edges);
    const double exchange = around(seeing, seen, tolerance) / (2 * pi_d);
    return pair.scale_m * pair.scale_m * std::clamp(exchange, 0.0, std::min(area_from, area_to));
}

double polygon_form_factor(std::span<const Vec3d> from, std::span<const Vec3d> to) {
    const double exchange = polygon_exchange_area(from, to);
    return exchange / glm::length(area_vector(from));
}

}  // namespace afterglow
