#pragma once

#include <vector>

#include "solver/scene/keys.h"

// The times at which several tracks together need keys.

namespace afterglow {

/// A point in time at which a path needs a key; at a jump there is one for either side.
struct Moment {
    double time_s = 0;
    JumpSide side = JumpSide::after;
};

/// Adds the key times of one track, unsorted.
template <class T>
void add_moments(std::vector<Moment>& moments, const std::vector<Key<T>>& keys) {
    for (std::size_t k = 0; k < keys.size(); ++k) {
        moments.push_back({keys[k].time_s, JumpSide::after});
        if (k > 0 && keys[k - 1].time_s == keys[k].time_s)
            moments.push_back({keys[k].time_s, JumpSide::before});
    }
}

/// Sorts them and leaves one of each.
void sort_moments(std::vector<Moment>& moments);

/// Adds the times of frames between the first and the last moment, away from those there are. Sorted before
/// and after. At most (last − first) · frames_per_second are added: check that this is a sane number.
void add_frames(std::vector<Moment>& moments, double frames_per_second);

}  // namespace afterglow
