#include "solver/formfactor/edge_pair.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>

namespace afterglow {

namespace {

using Complex = std::complex<double>;

constexpr double rounding = std::numeric_limits<double>::epsilon();
constexpr double far_apart = 2;  // longer edges

/// Nodes and weights on [−1, 1], of the positive half; the others mirror them.
constexpr std::array<double, 5> gauss_node{0.14887433898163121, 0.43339539412924719, 0.67940956829902441,
                                           0.86506336668898451, 0.97390652851717172};
constexpr std::array<double, 5> gauss_weight{0.29552422471475287, 0.26926671930999636, 0.21908636251598204,
                                             0.14945134915058059, 0.06667134430868814};
constexpr std::array<double, 8> kronrod_node{0.0,
                                             0.20778495500789847,
                                             0.40584515137739717,
                                             0.58608723546769113,
                                             0.74153118559939444,
                                             0.86486442335976907,
                                             0.94910791234275852,
                                             0.99145537112081264};
constexpr std::array<double, 8> kronrod_weight{0.20948214108472783, 0.20443294007529889, 0.19035057806478541,
                                               0.16900472663926790, 0.14065325971552592, 0.10479001032225018,
                                               0.06309209262997855, 0.02293532201052922};
/// Of the seven-point rule that shares every second node.
constexpr std::array<double, 4> embedded_weight{0.41795918367346939, 0.38183005050511894, 0.27970539148927664,
                                                0.12948496616886969};

/// Li₂ on the closed unit disc. Source: Bernoulli series in −ln(1−z), 't Hooft and Veltman 1979.
Complex dilogarithm(const Complex& z) {
    if (z == Complex(1)) return pi_d * pi_d / 6;
    // The right half is mirrored, so that the series' argument stays below 1.3 and its terms fall by 1/25.
    if (z.real() > 0.5) return pi_d * pi_d / 6 - std::log(z) * std::log(1.0 - z) - dilogarithm(1.0 - z);
    constexpr std::array<double, 10> bernoulli{1.0 / 36,
                                               -1.0 / 3600,
                                               1.0 / 211680,
                                               -1.0 / 10886400,
                                               1.0 / 526901760,
                                               -4.06476164514422e-11,
                                               8.92169102045645e-13,
                                               -1.99392958607211e-14,
                                               4.51898002961992e-16,
                                               -1.03565176121825e-17};
    const Complex u = -std::log(1.0 - z), uu = u * u;
    Complex sum = 0;
    for (std::size_t k = bernoulli.size(); k-- > 0;) sum = (sum + bernoulli[k]) * uu;
    return u - 0.25 * uu + u * sum;
}

/// x ln(y), 0 where x is, whatever y.
double times_log(double x, double y) {
    return x == 0 ? 0 : x * std::log(y);
}

/// Two edges by arc length, directions unit.
struct EdgePair {
    Vec3d a, along_a;
    double length_a;
    Vec3d b, along_b;
    double length_b;
    double cosine;  ///< of the angle between them
    double sine;    ///< ≥ 0
};

double far_integral(const EdgePair& e) {
    const Vec3d apart = e.a + 0.5 * e.length_a * e.along_a - e.b - 0.5 * e.length_b * e.along_b;
    const Vec3d half_a = 0.5 * e.length_a * e.along_a, half_b = 0.5 * e.length_b * e.along_b;
    double sum = 0;
    for (std::size_t i = 0; i < 5; ++i)
        for (std::size_t j = 0; j < 5; ++j) {
            double logs = 0;
            for (const double s : {-gauss_node[i], gauss_node[i]})
                for (const double t : {-gauss_node[j], gauss_node[j]}) {
                    const Vec3d r = apart + s * half_a - t * half_b;
                    logs += std::log(glm::dot(r, r));
                }
            sum += gauss_weight[i] * gauss_weight[j] * logs;
        }
    return 0.125 * e.length_a * e.length_b * sum;
}

/// A function whose second derivative is ½ ln(x² + d²).
double twice_integrated_log(double x, double d) {
    const double rr = x * x + d * d;
    if (rr == 0) return 0;
    return 0.25 * times_log(x * x - d * d, rr) - 0.75 * x * x + d * x * std::atan2(x, d);
}

double parallel_integral(const EdgePair& e) {
    const Vec3d w = e.b - e.a;
    const double start = glm::dot(w, e.along_a);
    const double gap = glm::length(w - start * e.along_a);
    const double end = start + (e.cosine < 0 ? -e.length_b : e.length_b);
    const double low = std::min(start, end), high = std::max(start, end);
    const auto h = [&](double x) { return twice_integrated_log(x, gap); };
    return h(e.length_a - low) - h(-low) - h(e.length_a - high) + h(-high);
}

/// Two skew or crossing lines, arc lengths counted from their common perpendicular: r² = h² + s² + t² − 2cst.
struct SkewLines {
    double cosine, sine;
    double distance;  ///< h
    std::array<double, 2> s, t;
};

SkewLines skew_lines(const EdgePair& e) {
    const Vec3d n = glm::cross(e.along_a, e.along_b), w = e.b - e.a;
    const double nn = glm::dot(n, n);
    const double s = glm::dot(glm::cross(w, e.along_b), n) / nn;
    const double t = glm::dot(glm::cross(w, e.along_a), n) / nn;
    return {e.cosine, e.sine, std::abs(glm::dot(w, n)) / e.sine, {-s, e.length_a - s}, {-t, e.length_b - t}};
}

/// ∫ ln(1 + m / cos² φ) dφ from 0.
double integrated_secant_log(double angle, double m) {
    // With p so that cos² φ + m = |1 + p exp(2iφ)|² / 4p the logarithm is that of an analytic function.
    const double root = std::sqrt(m);
    const double p = 1 / ((std::sqrt(m + 1) + root) * (std::sqrt(m + 1) + root));
    const Complex turn = std::polar(1.0, 2 * angle);
    return 2 * std::asinh(root) * angle - dilogarithm(-p * turn).imag() + dilogarithm(-turn).imag();
}

/// The integral of ln r over the triangle of the parameter plane whose apex is the foot of the common
/// perpendicular and whose far side runs from `from` to `to` at the other parameter's value `at`. Along each
/// line through the apex it is elementary: s (½ ln(h² + s²q)) has the antiderivative used here.
double triangle(const SkewLines& lines, double at, double from, double to) {
    if (at == 0) return 0;
    const double h = lines.distance, across = lines.sine * std::abs(at);
    const double width = std::hypot(h, across);
    const auto elementary = [&](double x) {
        return times_log(x, x * x + width * width) - 3 * x + 2 * width * std::atan2(x, width);
    };
    const double low = from - lines.cosine * at, high = to - lines.cosine * at;
    double sum = 0.25 * at * (elementary(high) - elementary(low));
    // Where the lines cross, what has the dilogarithms vanishes with h².
    if (h > 1e-15 * across) {
        const double m = across * across / (h * h);
        sum += std::copysign(h * h / (4 * lines.sine), at) *
               (integrated_secant_log(std::atan2(high, across), m) -
                integrated_secant_log(std::atan2(low, across), m));
    }
    return sum;
}

double skew_integral(const SkewLines& l) {
    return triangle(l, l.s[1], l.t[0], l.t[1]) - triangle(l, l.s[0], l.t[0], l.t[1]) +
           triangle(l, l.t[1], l.s[0], l.s[1]) - triangle(l, l.t[0], l.s[0], l.s[1]);
}

/// The rounding error of `skew_integral` is a few roundings of this: the size of what cancels, and for small
/// angles how far rounding moves the common perpendicular along the edges.
double skew_magnitude(const SkewLines& l) {
    const double s = std::max(std::abs(l.s[0]), std::abs(l.s[1]));
    const double t = std::max(std::abs(l.t[0]), std::abs(l.t[1]));
    const double cancelling = s * s + t * t + l.distance * l.distance;
    return cancelling * (1 + std::abs(std::log(s + t + l.distance))) / l.sine;
}

/// The integral of ln r over edge b, seen from a point of edge a.
double from_point(const EdgePair& e, double s) {
    const Vec3d w = e.a + s * e.along_a - e.b;
    const double along = glm::dot(w, e.along_b), across = glm::length(glm::cross(w, e.along_b));
    const auto part = [&](double x) {
        return 0.5 * times_log(x, x * x + across * across) - x + across * std::atan2(x, across);
    };
    return part(e.length_b - along) - part(-along);
}

struct Adaptive {
    const EdgePair& edges;
    double floor;  ///< no part needs to be better than this: rounding

    /// Over [low, high], halved until both rules agree.
    [[nodiscard]] double integral(double low, double high, double tolerance, int halvings) const {
        const double centre = 0.5 * (low + high), half = 0.5 * (high - low);
        double fine = 0, coarse = 0;
        for (std::size_t k = 0; k < kronrod_node.size(); ++k) {
            const double x = half * kronrod_node[k];
            const double value = k == 0 ? from_point(edges, centre)
                                        : from_point(edges, centre - x) + from_point(edges, centre + x);
            fine += kronrod_weight[k] * value;
            if (k % 2 == 0) coarse += embedded_weight[k / 2] * value;
        }
        if (halvings == 0 || half * std::abs(fine - coarse) <= std::max(tolerance, floor)) return half * fine;
        return integral(low, centre, 0.5 * tolerance, halvings - 1) +
               integral(centre, high, 0.5 * tolerance, halvings - 1);
    }
};

double adaptive_integral(const EdgePair& e, double tolerance) {
    constexpr int most_halvings = 40;
    const double size = e.length_a + e.length_b + glm::length(e.b - e.a);
    const double value = e.length_a * e.length_b * (1 + std::abs(std::log(size)));
    return Adaptive{e, rounding * value}.integral(0, e.length_a, tolerance, most_halvings);
}

double log_integral(const EdgePair& e, double tolerance) {
    const Vec3d apart = e.a + 0.5 * e.length_a * e.along_a - e.b - 0.5 * e.length_b * e.along_b;
    const double longer = std::max(e.length_a, e.length_b), distance = glm::length(apart);
    if (distance - 0.5 * (e.length_a + e.length_b) > far_apart * longer) return far_integral(e);
    // How far one edge strays from the other's direction; the integral changes by about its length times
    // that.
    if (e.sine * (longer + distance) * longer <= 0.1 * tolerance) return parallel_integral(e);
    const SkewLines lines = skew_lines(e);
    if (8 * rounding * skew_magnitude(lines) <= tolerance) return skew_integral(lines);
    return adaptive_integral(e, tolerance);
}

}  // namespace

double contour_integral(const ContourEdge& a, const ContourEdge& b, double tolerance) {
    const Vec3d to_a = a.to - a.from, to_b = b.to - b.from;
    const double length_a = glm::length(to_a), length_b = glm::length(to_b);
    if (length_a == 0 || length_b == 0) return 0;
    const Vec3d along_a = to_a / length_a, along_b = to_b / length_b;
    const double cosine = glm::dot(along_a, along_b);
    if (cosine == 0) return 0;
    return cosine * log_integral({a.from, along_a, length_a, b.from, along_b, length_b, cosine,
                                  glm::length(glm::cross(along_a, along_b))},
                                 tolerance);
}

}  // namespace afterglow
