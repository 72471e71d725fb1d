#include "solver/scene/moments.h"

#include <algorithm>
#include <cmath>

namespace afterglow {

namespace {

bool is_before(const Moment& a, const Moment& b) {
    return a.time_s != b.time_s ? a.time_s < b.time_s : a.side < b.side;
}

bool is_same(const Moment& a, const Moment& b) {
    return a.time_s == b.time_s && a.side == b.side;
}

}  // namespace

void sort_moments(std::vector<Moment>& moments) {
    std::sort(moments.begin(), moments.end(), is_before);
    moments.erase(std::unique(moments.begin(), moments.end(), is_same), moments.end());
}

void add_frames(std::vector<Moment>& moments, double frames_per_second) {
    constexpr double apart_s = 1e-6;
    const std::size_t count = moments.size();
    for (std::size_t k = 0; k + 1 < count; ++k) {
        const double from = moments[k].time_s + apart_s;
        const double to = moments[k + 1].time_s - apart_s;
        for (double frame = std::ceil(from * frames_per_second); frame / frames_per_second < to; ++frame)
            moments.push_back({frame / frames_per_second, JumpSide::after});
    }
    std::sort(moments.begin(), moments.end(), is_before);
}

}  // namespace afterglow
