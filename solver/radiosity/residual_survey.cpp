#include "solver/radiosity/residual_survey.h"

#include <algorithm>

namespace afterglow {

namespace {

constexpr std::size_t rows_per_chunk = 512;

// What single precision may hide of a fourth lane, which is 1 to some tens.
constexpr double fourth_rounding = 1e-4;

Lanes with_fourth(const Rgb& light, float fourth) {
    return {Lanes::Vector{light.r, light.g, light.b, fourth}};
}

float largest_channel(const Lanes& light) {
    const Lanes::Vector size = light.v < 0 ? -light.v : light.v;
    return std::max(std::max(size[0], size[1]), size[2]);
}

}  // namespace

Surveyor::Surveyor(ResidualState& state, const ResidualProblem& problem)
    : state_(state), problem_(problem), work_(state.workspace) {
    const std::size_t rows = problem.matrix.rows();
    work_.residual.resize(rows);
    work_.of_sight.resize(rows);
    work_.of_light.resize(rows);
    work_.magnitude.resize(rows);
    for (std::size_t i = 0; i < rows; ++i) {
        const Lanes of_patch = reflectance(i);
        work_.of_sight[i].v = problem.matrix.sight.scale[i] * of_patch.v;
        work_.of_light[i].v = problem.matrix.light.scale[i] * of_patch.v;
    }
    work_.place_of_whole.assign(rows, no_index);
    for (std::size_t k = 0; k < problem.matrix.whole_rows.size(); ++k)
        work_.place_of_whole[problem.matrix.whole_rows[k]] = static_cast<Index>(k);
}

Survey Surveyor::look(double gain, double asked_error, const Context& context) {
    expects_from_lamps_ = false;
    const std::size_t rows = problem_.matrix.rows();
    std::vector<Part> parts((rows + rows_per_chunk - 1) / rows_per_chunk);
    context.for_chunks(rows, rows_per_chunk, [&](std::size_t first, std::size_t last) {
        parts[first / rows_per_chunk] = look_at(first, last);
    });
    Part all;
    for (const Part& part : parts) {
        all.largest = std::max(all.largest, part.largest);
        all.brightest = std::max(all.brightest, part.brightest);
        all.amplified = std::max(all.amplified, part.amplified);
        all.missing = std::max(all.missing, part.missing);
        all.mean.add(part.mean);
    }
    const double rounding = gather_rounding * static_cast<double>(all.brightest);
    const double left = gain * static_cast<double>(all.largest);
    const double mean = all.mean.value();
    const double a = all.amplification(gain);
    Survey survey;
    survey.largest = all.largest;
    survey.enough = a > 0 ? std::max(asked_error * mean - (1 + a) * rounding, 0.0) / a : 0;
    survey.certificate = make_certificate(left + rounding, gain, mean);
    if (mean > 0)
        survey.certificate.error_bound =
            std::min(survey.certificate.error_bound, (a * survey.largest + (1 + a) * rounding) / mean);
    survey.only_rounding = 8 * left <= rounding;
    enough_ = survey.enough;
    context.for_chunks(rows, rows_per_chunk, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) work_.magnitude[i] = magnitude(i, work_.residual[i]);
    });
    return survey;
}

double Surveyor::Part::amplification(double gain) const {
    const double by_gain = gain / (1 - gain);
    const double short_of = std::max(static_cast<double>(missing), 0.0) + fourth_rounding;
    if (short_of >= 1) return by_gain;
    return std::min(by_gain, (static_cast<double>(amplified) + fourth_rounding) / (1 - short_of));
}

Lanes Surveyor::reflectance(std::size_t i) const {
    return with_fourth(problem_.reflectance[i], max_channel(problem_.reflectance[i]));
}

float Surveyor::magnitude(std::size_t i, const Lanes& residual) const {
    const float size = largest_channel(residual);
    if (state_.left.empty() || static_cast<double>(size) > enough_) return size;
    const Lanes::Vector off = residual.v - state_.left[i].v;
    return off[0] == 0 && off[1] == 0 && off[2] == 0 ? 0 : size;
}

Surveyor::Part Surveyor::look_at(std::size_t first, std::size_t last) {
    const LayeredMatrix& matrix = problem_.matrix;
    Part part;
    for (std::size_t i = first; i < last; ++i) {
        DoubleLanes::Vector sum = static_cast<double>(matrix.sight.scale[i]) * state_.by_sight[i].v +
                                  static_cast<double>(matrix.light.scale[i]) * state_.by_light[i].v;
        if (const Index k = work_.place_of_whole[i]; k != no_index) sum += state_.by_whole[k].v;
        const Lanes::Vector irradiance =
            __builtin_convertvector(sum, Lanes::Vector) + to_lanes(problem_.external_irradiance[i]).v;
        const Lanes::Vector reflected = reflectance(i).v * irradiance;
        state_.irradiance[i] = to_rgb({irradiance});
        work_.residual[i].v = with_fourth(problem_.emission[i], 1).v + reflected - state_.radiosity[i].v;
        part.largest = std::max(part.largest, largest_channel(work_.residual[i]));
        part.brightest = std::max(part.brightest, largest_channel({reflected}));
        part.amplified = std::max(part.amplified, reflected[3]);
        part.missing = std::max(part.missing, work_.residual[i].v[3]);
        part.mean.add(problem_.area[i], problem_.emission[i], to_rgb({reflected}));
    }
    return part;
}

float Surveyor::look_again(const Context& context) {
    const std::size_t rows = problem_.matrix.rows();
    std::vector<float> largest((rows + rows_per_chunk - 1) / rows_per_chunk);
    context.for_chunks(rows, rows_per_chunk, [&](std::size_t first, std::size_t last) {
        float here = 0;
        for (std::size_t i = first; i < last; ++i) {
            work_.magnitude[i] = magnitude(i, residual(i));
            here = std::max(here, work_.magnitude[i]);
        }
        largest[first / rows_per_chunk] = here;
    });
    return *std::max_element(largest.begin(), largest.end());
}

}  // namespace afterglow
