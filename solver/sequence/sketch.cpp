#include "solver/sequence/sketch.h"

#include <utility>

#include "solver/image/tone_map.h"
#include "solver/sequence/frame_refinement.h"

namespace afterglow {

namespace {

constexpr int lines_per_patch = 16;
// Certificate that is good enough: what is still on its way is estimated.
constexpr double coarse_error = 0.5;

}  // namespace

SequenceState make_sketch_state(World world, const SequenceConfig& config, const Context& context) {
    SequenceConfig rough = config;
    rough.quality = Quality::draft;
    rough.visibility = Visibility::retrace;
    rough.solution = Solution::progressive;
    rough.rays_per_patch = lines_per_patch;
    rough.patch_size_m.reset();
    rough.asked_error.reset();
    rough.cache_folder.clear();
    return make_state(std::move(world), rough, context);
}

Revision sketch(SequenceState& state, int frame, const Context& context) {
    if (frame < 0) throw Error(ErrorKind::invalid_input, "frame", "must be 0 or more");
    SequenceState::Parts& parts = state.parts();
    FrameRefinement refinement(parts, frame);
    refinement.look(lines_per_patch, *parts.strategy, context);
    refinement.solve(coarse_error, context);
    Revision revision;
    revision.frame = frame;
    revision.revision = 1;
    revision.residual = refinement.certificate().residual;
    revision.radiance = refinement.preliminary_picture(parts.config.width, parts.config.height, context);
    const float exposure_ev = parts.config.exposure_ev ? static_cast<float>(*parts.config.exposure_ev)
                                                       : automatic_exposure_ev(revision.radiance);
    revision.srgb = to_srgb(revision.radiance, exposure_ev, context);
    return revision;
}

}  // namespace afterglow
