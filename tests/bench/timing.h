#pragma once

#include <algorithm>
#include <ctime>
#include <functional>
#include <vector>

namespace afterglow {

/// The middle value; 0 of none.
inline double median(std::vector<double> values) {
    if (values.empty()) return 0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// CPU time of all threads, which other work on the machine disturbs less than it does the clock on the wall.
inline double ms_of(const std::function<void()>& work) {
    const std::clock_t start = std::clock();
    work();
    return 1000.0 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

}  // namespace afterglow
