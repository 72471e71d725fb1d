#include "solver/formfactor/method.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <string>

#include "solver/base/error.h"
#include "solver/formfactor/polygon_pair.h"
#include "solver/visibility/block_lines.h"

namespace afterglow {

namespace {

constexpr Index most_points_per_edge = 64;
constexpr double lift_per_extent = 1e-5;  // as sight lines are lifted

void check_patch(const PlacedPatches& scene, Index patch) {
    if (patch >= scene.mesh.size())
        throw Error(
            ErrorKind::invalid_input, "form factor row",
            "there is no patch " + std::to_string(patch) + " among " + std::to_string(scene.mesh.size()));
}

/// From a body's frame to where it stands, in double precision: edges shared in the body stay shared.
class Placing {
  public:
    Placing(const PlacedPatches& scene, Index body)
        : turn_(scene.placed.pose(body).rotation), shift_(scene.placed.pose(body).translation) {
        if (body == furniture) {
            turn_ = glm::dquat(1, 0, 0, 0);
            shift_ = Vec3d(0);
        }
        turn_ = glm::normalize(turn_);
    }
    [[nodiscard]] Vec3d point(const Vec3& p) const { return turn_ * Vec3d(p) + shift_; }
    [[nodiscard]] Vec3d direction(const Vec3& d) const { return turn_ * Vec3d(d); }

  private:
    glm::dquat turn_;
    Vec3d shift_;
};

/// A convex piece of a patch, its front that of the patch.
struct Piece {
    std::array<Vec3d, 4> corner;
    std::size_t corners;

    [[nodiscard]] std::span<const Vec3d> polygon() const { return std::span(corner).first(corners); }
};

void orient(Piece& piece, const Vec3d& normal) {
    if (glm::dot(area_vector(piece.polygon()), normal) < 0)
        std::reverse(piece.corner.begin(), piece.corner.begin() + static_cast<std::ptrdiff_t>(piece.corners));
}

std::vector<Piece> pieces_of(const PlacedPatches& scene, Index patch) {
    const PatchMesh& mesh = scene.mesh;
    const Placing placing(scene, mesh.body[patch]);
    std::vector<Piece> out;
    const std::size_t first = mesh.first_fragment[patch], last = mesh.first_fragment[patch + 1];
    if (first == last) {
        // Corners are summed in double precision, so that they do not leave the patch's plane.
        const Vec3d o = placing.point(mesh.origin[patch]), u = placing.direction(mesh.edge_u[patch]);
        const Vec3d v = placing.direction(mesh.edge_v[patch]);
        out.push_back({{o, o + u, o + u + v, o + v}, 4});
        orient(out.back(), placing.direction(mesh.normal[patch]));
    }
    for (std::size_t f = first; f < last; ++f) {
        const Fragment& fragment = mesh.fragments[f];
        const Vec3d o = placing.point(fragment.corner);
        const Vec3d a = placing.direction(fragment.edge_a), b = placing.direction(fragment.edge_b);
        // Slivers left by clipping have no plane, and no area that matters.
        const double area = glm::length(glm::cross(a, b));
        if (!(area > 1e-9 * std::max({glm::dot(a, a), glm::dot(b, b), glm::dot(a - b, a - b)}))) continue;
        out.push_back({{o, o + a, o + b, o}, 3});
        orient(out.back(), placing.direction(fragment.normal));
    }
    return out;
}

std::vector<std::vector<Piece>> all_pieces(const PlacedPatches& scene) {
    std::vector<std::vector<Piece>> out(scene.mesh.size());
    for (Index p = 0; p < scene.mesh.size(); ++p) out[p] = pieces_of(scene, p);
    return out;
}

/// How far points are lifted off their patches, so that they are not hidden by what they lie on.
double lift_m(const std::vector<std::vector<Piece>>& pieces) {
    Vec3d low(std::numeric_limits<double>::infinity()), high(-low);
    for (const auto& patch : pieces)
        for (const Piece& piece : patch)
            for (const Vec3d& c : piece.polygon()) {
                low = glm::min(low, c);
                high = glm::max(high, c);
            }
    return low.x > high.x ? 0 : lift_per_extent * glm::length(high - low);
}

/// A point of a patch, in the world, and the normal there.
struct PlacedPoint {
    Vec3d point, normal;
};
PlacedPoint point_on(const PlacedPatches& scene, Index patch, float s, float t) {
    const PatchPoint local = scene.mesh.point_on(patch, s, t);
    const Placing placing(scene, scene.mesh.body[patch]);
    return {placing.point(local.position), placing.direction(local.normal)};
}

/// Makes factors and sky sum to 1 again, without the buried share.
void leave_out_buried(FormFactorRow& row) {
    const double valid = 1 - row.buried;
    const double scale = valid > 0 ? 1 / valid : 0;
    for (double& f : row.factor) f *= scale;
    row.sky *= scale;
}

class Analytic final : public FormFactorMethod {
  public:
    explicit Analytic(const AnalyticConfig& config) : config_(config), points_(config.lines_per_pair) {}

    [[nodiscard]] std::string_view name() const override { return "analytic"; }

    [[nodiscard]] FormFactorRow row(const PlacedPatches& scene, Index patch) const override {
        check_patch(scene, patch);
        const auto pieces = all_pieces(scene);
        const double lift = lift_m(pieces);
        double area = 0, sum = 0;
        for (const Piece& piece : pieces[patch]) area += glm::length(area_vector(piece.polygon()));
        FormFactorRow out{std::vector<double>(pieces.size(), 0.0), 0, 0};
        if (!(area > 0)) return out;
        for (Index other = 0; other < pieces.size(); ++other) {
            double exchange = 0;
            for (const Piece& from : pieces[patch])
                for (const Piece& to : pieces[other])
                    if (&from != &to) exchange += polygon_exchange_area(from.polygon(), to.polygon());
            if (exchange > 0) exchange *= seen_share(scene, {patch, other}, lift);
            out.factor[other] = exchange / area;
            sum += out.factor[other];
        }
        out.sky = std::max(0.0, 1 - sum);
        return out;
    }

  private:
    struct Pair {
        Index a, b;
    };

    /// Weighted share of a pair's sample lines that nothing blocks; 1 where none of them counts.
    [[nodiscard]] double seen_share(const PlacedPatches& scene, Pair pair, double lift) const {
        if (pair.a > pair.b) std::swap(pair.a, pair.b);
        const std::uint64_t seed = mixed(config_.seed, mixed(pair.a, pair.b));
        double all = 0, seen = 0;
        RayPacket rays;
        std::array<double, 16> weight{};
        const auto trace = [&] {
            const std::uint32_t blocked = scene.placed.occluded(rays, Scope::everything);
            for (Index k = 0; k < rays.count; ++k)
                if (((blocked >> k) & 1U) == 0) seen += weight[k];
            rays.count = 0;
        };
        for (Index k = 0; k < config_.lines_per_pair; ++k) {
            const Sample4 s = points_.at(k, seed);
            const PlacedPoint a = point_on(scene, pair.a, s[0], s[1]);
            const PlacedPoint b = point_on(scene, pair.b, s[2], s[3]);
            const Vec3d from = a.point + lift * a.normal, way = b.point + lift * b.normal - from;
            const double rr = glm::dot(way, way);
            const double cosines = glm::dot(a.normal, way) * -glm::dot(b.normal, way);
            if (glm::dot(a.normal, way) <= 0 || cosines <= 0) continue;
            weight[rays.count] = cosines / (rr * rr);
            all += weight[rays.count];
            const double distance = std::sqrt(rr);
            rays.set(rays.count++, {Vec3(from), Vec3(way / distance), static_cast<float>(distance)});
            if (rays.count == 16) trace();
        }
        if (rays.count > 0) trace();
        return all > 0 ? seen / all : 1;
    }

    AnalyticConfig config_;
    SobolPoints points_;
};

class HemicubeMethod final : public FormFactorMethod {
  public:
    explicit HemicubeMethod(const HemicubeMethodConfig& config)
        : config_(config), hemicube_(config.hemicube) {
        if (config.points_per_edge < 1 || config.points_per_edge > most_points_per_edge)
            throw Error(ErrorKind::invalid_input, "hemicube points_per_edge",
                        std::to_string(config.points_per_edge) + " is not from 1 to 64");
    }

    [[nodiscard]] std::string_view name() const override { return "hemicube"; }

    [[nodiscard]] FormFactorRow row(const PlacedPatches& scene, Index patch) const override {
        check_patch(scene, patch);
        const auto pieces = all_pieces(scene);
        const auto has_patches = sides_with_patches(scene.mesh);
        const double lift = lift_m(pieces);
        const Index n = config_.points_per_edge, patches = scene.mesh.size();
        FormFactorRow out{std::vector<double>(patches, 0.0), 0, 0};
        const double weight = 1.0 / (static_cast<double>(n) * n);
        for (Index i = 0; i < n; ++i)
            for (Index j = 0; j < n; ++j) {
                const PlacedPoint at = point_on(scene, patch, centre_of(i), centre_of(j));
                const HemicubeEye eye{at.point + lift * at.normal, at.normal};
                const auto polygons = seen_polygons(scene.mesh, pieces, has_patches, eye.point);
                const HemicubeView view = hemicube_.look(eye, polygons, patches);
                for (Index p = 0; p < patches; ++p) out.factor[p] += weight * view.factor[p];
                out.buried += weight * view.hidden;
                out.sky += weight * view.sky;
            }
        leave_out_buried(out);
        return out;
    }

  private:
    using Sides = std::array<bool, 2>;

    [[nodiscard]] float centre_of(Index cell) const {
        return (static_cast<float>(cell) + 0.5F) / static_cast<float>(config_.points_per_edge);
    }

    static std::vector<Sides> sides_with_patches(const PatchMesh& mesh) {
        std::vector<Sides> out(mesh.surfaces.list.size(), Sides{false, false});
        for (Index p = 0; p < mesh.size(); ++p)
            out[mesh.surface[p]][static_cast<std::size_t>(mesh.side[p])] = true;
        return out;
    }

    /// Patches that face the point; sides that face it but have no patches hide what is behind them, drawn as
    /// the backs of those that have.
    static std::vector<HemicubePolygon> seen_polygons(const PatchMesh& mesh,
                                                      const std::vector<std::vector<Piece>>& pieces,
                                                      const std::vector<Sides>& has_patches,
                                                      const Vec3d& from) {
        std::vector<HemicubePolygon> out;
        for (Index p = 0; p < mesh.size(); ++p) {
            const std::size_t other_side = 1 - static_cast<std::size_t>(mesh.side[p]);
            for (const Piece& piece : pieces[p]) {
                const auto corners = piece.polygon();
                if (glm::dot(area_vector(corners), from - corners[0]) > 0)
                    out.push_back({corners, p});
                else if (!has_patches[mesh.surface[p]][other_side])
                    out.push_back({corners, no_index});
            }
        }
        return out;
    }

    HemicubeMethodConfig config_;
    Hemicube hemicube_;
};

class RayCast final : public FormFactorMethod {
  public:
    explicit RayCast(const SightLines& lines) : lines_(&lines) {}

    [[nodiscard]] std::string_view name() const override { return "ray-cast"; }

    [[nodiscard]] FormFactorRow row(const PlacedPatches& scene, Index patch) const override {
        check_patch(scene, patch);
        const auto& blocks = lines_->blocks();
        const auto after = std::upper_bound(blocks.begin(), blocks.end(), patch,
                                            [](Index p, const PatchBlock& block) { return p < block.first; });
        const auto block = static_cast<std::size_t>(after - blocks.begin()) - 1;
        const Index lane = patch - blocks[block].first;
        FormFactorRow out{std::vector<double>(scene.mesh.size(), 0.0), 0, 0};
        const double weight = 1.0 / lines_->lines_per_patch();
        const BlockLines of_block(*lines_, block, scene.placed.pose(blocks[block].body));
        RayPacket all, rays;
        HitPacket hits;
        for (Index d = 0; d < lines_->lines_per_patch(); ++d) {
            of_block.rays(d, all);
            rays.set(rays.count++, all.ray(lane));
            if (rays.count < 16 && d + 1 < lines_->lines_per_patch()) continue;
            scene.placed.nearest(rays, Scope::everything, hits);
            for (Index k = 0; k < rays.count; ++k)
                add(target_of(hits[k], rays.ray(k), scene.mesh, scene.placed), weight, out);
            rays.count = 0;
        }
        leave_out_buried(out);
        return out;
    }

  private:
    static void add(Index target, double weight, FormFactorRow& out) {
        double& share = target == sees_nothing  ? out.sky
                        : target == sees_inside ? out.buried
                                                : out.factor[target];
        share += weight;
    }

    const SightLines* lines_;
};

}  // namespace

std::unique_ptr<FormFactorMethod> make_analytic(const AnalyticConfig& config) {
    return std::make_unique<Analytic>(config);
}

std::unique_ptr<FormFactorMethod> make_hemicube(const HemicubeMethodConfig& config) {
    return std::make_unique<HemicubeMethod>(config);
}

std::unique_ptr<FormFactorMethod> make_ray_cast(const SightLines& lines) {
    return std::make_unique<RayCast>(lines);
}

}  // namespace afterglow
