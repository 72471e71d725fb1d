#include "tests/support/flicker.h"

#include <cmath>
#include <stdexcept>
#include <vector>

namespace afterglow::testing {

namespace {

using Values = std::vector<glm::dvec3>;

/// Means over blocks, row by row.
Values block_means(const Picture& picture, int block) {
    const int wide = picture.width / block, high = picture.height / block;
    Values out;
    for (int v = 0; v < high; ++v)
        for (int u = 0; u < wide; ++u) {
            glm::dvec3 sum(0);
            for (int y = v * block; y < (v + 1) * block; ++y)
                for (int x = u * block; x < (u + 1) * block; ++x)
                    sum += glm::dvec3(picture.pixels[static_cast<std::size_t>(y * picture.width + x)]);
            out.push_back(sum / static_cast<double>(block * block));
        }
    return out;
}

}  // namespace

double flicker(std::span<const Picture> shown, std::span<const Picture> truth, int block) {
    if (shown.size() < 3 || shown.size() != truth.size() || block < 1)
        throw std::invalid_argument("flicker needs three frames or more, and as many true ones");
    std::vector<Values> errors;
    double light = 0;
    for (std::size_t f = 0; f < shown.size(); ++f) {
        if (shown[f].width != shown[0].width || shown[f].height != shown[0].height ||
            truth[f].width != shown[0].width || truth[f].height != shown[0].height)
            throw std::invalid_argument("flicker needs pictures of one size");
        errors.push_back(block_means(shown[f], block));
        const Values exact = block_means(truth[f], block);
        for (std::size_t k = 0; k < exact.size(); ++k) {
            errors.back()[k] -= exact[k];
            light += (exact[k].x + exact[k].y + exact[k].z) / 3;
        }
    }
    const std::size_t pixels = errors[0].size();
    if (pixels == 0 || light <= 0) throw std::invalid_argument("flicker needs light");
    double squares = 0;
    for (std::size_t f = 1; f + 1 < errors.size(); ++f)
        for (std::size_t k = 0; k < pixels; ++k) {
            const glm::dvec3 second = errors[f - 1][k] - 2.0 * errors[f][k] + errors[f + 1][k];
            squares += glm::dot(second, second) / 3;
        }
    const auto inner = static_cast<double>((errors.size() - 2) * pixels);
    return std::sqrt(squares / inner / 6) / (light / static_cast<double>(errors.size() * pixels));
}

}  // namespace afterglow::testing
