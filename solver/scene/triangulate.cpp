#include "solver/scene/triangulate.h"

#include <algorithm>
#include <numeric>

#include "solver/base/error.h"

namespace afterglow {

namespace {

using Point = glm::dvec2;

glm::dvec3 newell_normal(const std::vector<Vec3>& corners) {
    glm::dvec3 normal(0);
    const glm::dvec3 origin(corners[0]);
    for (std::size_t k = 0; k < corners.size(); ++k)
        normal += glm::cross(glm::dvec3(corners[k]) - origin,
                             glm::dvec3(corners[(k + 1) % corners.size()]) - origin);
    return normal;
}

/// The corners in the plane across the normal, going round counter-clockwise.
std::vector<Point> flattened(const std::vector<Vec3>& corners, const glm::dvec3& normal) {
    const Frame frame{Vec3(glm::normalize(normal))};
    const glm::dvec3 x(frame.x), y(frame.y), origin(corners[0]);
    std::vector<Point> out;
    out.reserve(corners.size());
    for (const Vec3& corner : corners)
        out.emplace_back(glm::dot(glm::dvec3(corner) - origin, x), glm::dot(glm::dvec3(corner) - origin, y));
    return out;
}

/// Twice the signed area: positive where a, b, c go round counter-clockwise.
double turn(const Point& a, const Point& b, const Point& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

Triangulation fan(std::size_t corners) {
    Triangulation out;
    for (std::uint32_t k = 1; k + 1 < corners; ++k) out.triangles.push_back({0, k, k + 1});
    return out;
}

/// True where no corner turns the wrong way and the outline goes round once only.
bool is_convex(const std::vector<Point>& points) {
    const std::size_t n = points.size();
    int changes_of_direction = 0;
    int last_sign = 0;
    for (std::size_t k = 0; k < 2 * n; ++k) {
        const Point& a = points[k % n];
        const Point& b = points[(k + 1) % n];
        if (k < n && turn(a, b, points[(k + 2) % n]) < 0) return false;
        const int sign = b.x > a.x ? 1 : b.x < a.x ? -1 : 0;
        if (sign == 0 || sign == last_sign) continue;
        if (k >= n) ++changes_of_direction;
        last_sign = sign;
    }
    return changes_of_direction <= 2;
}

/// Clips ears off until three corners are left.
class EarClipper {
  public:
    explicit EarClipper(const std::vector<Point>& points) : points_(points), left_(points.size()) {
        std::iota(left_.begin(), left_.end(), 0U);
    }

    Triangulation clip() {
        std::size_t at = 0;
        while (left_.size() > 3) {
            std::size_t tried = 0;
            while (tried < left_.size() && !is_ear(at)) {
                at = (at + 1) % left_.size();
                ++tried;
            }
            // A simple outline always has an ear; go on with any corner where it is not.
            if (tried == left_.size()) out_.is_simple = false;
            cut(at);
            at %= left_.size();
        }
        if (turn(points_[left_[0]], points_[left_[1]], points_[left_[2]]) < 0) out_.is_simple = false;
        out_.triangles.push_back({left_[0], left_[1], left_[2]});
        return std::move(out_);
    }

  private:
    [[nodiscard]] std::uint32_t corner(std::size_t at, std::size_t ahead) const {
        return left_[(at + ahead) % left_.size()];
    }

    /// True where corner at + 1 stands out and no other corner lies in its triangle.
    [[nodiscard]] bool is_ear(std::size_t at) const {
        const Point& a = points_[corner(at, 0)];
        const Point& b = points_[corner(at, 1)];
        const Point& c = points_[corner(at, 2)];
        if (!(turn(a, b, c) > 0)) return turn(a, b, c) == 0;
        return std::none_of(left_.begin(), left_.end(), [&](std::uint32_t k) {
            const Point& p = points_[k];
            // Corners at the same place touch but do not lie inside: holes are joined by double edges.
            if (p == a || p == b || p == c) return false;
            return turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0;
        });
    }

    void cut(std::size_t at) {
        out_.triangles.push_back({corner(at, 0), corner(at, 1), corner(at, 2)});
        left_.erase(left_.begin() + static_cast<std::ptrdiff_t>((at + 1) % left_.size()));
    }

    const std::vector<Point>& points_;
    std::vector<std::uint32_t> left_;
    Triangulation out_;
};

}  // namespace

Triangulation triangulated(const std::vector<Vec3>& corners) {
    if (corners.size() == 3) return fan(3);
    const auto normal = newell_normal(corners);
    if (!(glm::length(normal) > 0)) return fan(corners.size());
    const auto points = flattened(corners, normal);
    if (is_convex(points)) return fan(corners.size());
    if (corners.size() > max_concave_corners)
        throw Error(ErrorKind::too_large, "polygon", "a concave polygon has more than 1024 corners");
    return EarClipper(points).clip();
}

}  // namespace afterglow
