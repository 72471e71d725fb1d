#pragma once

#include <cstring>
#include <vector>

#include "solver/sequence/sequence.h"
#include "tests/support/worlds.h"

namespace afterglow::testing {

/// Small pictures of coarse patches, by what follows the last frame.
inline SequenceConfig quick() {
    SequenceConfig config;
    config.patch_size_m = 0.4;
    config.rays_per_patch = 64;
    config.quality = Quality::draft;
    config.asked_error = 0.02;
    config.visibility = Visibility::events;
    config.solution = Solution::residual;
    config.width = 48;
    config.height = 32;
    config.picture_tolerance = 0;
    return config;
}

/// All pictures of a range of frames.
inline std::vector<Revision> revisions_of(World world, const SequenceConfig& config, int first, int last,
                                          const Context& context = Context(2)) {
    std::vector<Revision> all;
    render_sequence(
        std::move(world), config, first, last, [&](const Revision& r) { all.push_back(r); }, context);
    return all;
}

/// The picture that a running job comes to in a frame.
inline Picture picture_of(SequenceState& state, int frame, const Context& context = Context(2)) {
    Picture last;
    step(
        state, frame, [&](const Revision& r) { last = r.radiance; }, context);
    return last;
}

/// The final picture of a frame by itself.
inline Picture final_of(World world, const SequenceConfig& config, int frame,
                        const Context& context = Context(2)) {
    return revisions_of(std::move(world), config, frame, frame, context).back().radiance;
}

inline bool same_bits(const Picture& a, const Picture& b) {
    return a.width == b.width && a.height == b.height &&
           std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size() * sizeof(Rgb)) == 0;
}

}  // namespace afterglow::testing
