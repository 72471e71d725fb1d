#include "solver/sequence/edits.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "solver/base/error.h"
#include "solver/formfactor/static_cache.h"
#include "solver/scene/world_edits.h"
#include "solver/sequence/choose.h"
#include "solver/sequence/edit_tools.h"
#include "solver/sequence/prepare.h"

namespace afterglow {

namespace {

void lay_lines_to(SequenceState::Parts& parts, Lamps lamps) {
    parts.lamps = std::move(lamps);
    lay_light_lines(parts);
    forget_solution(parts);
}

/// Lays light lines to other lamps, and traces them. A stop leaves the lamps, and no background.
void set_lamps(SequenceState::Parts& parts, Lamps lamps, const Context& context) {
    const Lamps lamps_before = parts.lamps;
    lay_lines_to(parts, std::move(lamps));
    if (parts.background.directions == 0) return;
    StaticLines& background = parts.background;
    background.light_contribution.assign(parts.visible.light_contribution.size(), 0);
    try {
        trace_light_lines(*parts.light, *parts.sight, parts.caster, Scope::static_geometry,
                          background.light_contribution, context);
    } catch (...) {
        background = {};
        lay_lines_to(parts, lamps_before);
        throw;
    }
    parts.background_key = static_key(parts.world, parts.mesh, *parts.sight, parts.lamps,
                                      parts.light->lines_per_patch(), parts.config.seed);
}

}  // namespace

EditOutcome set_emission(SequenceState& state, const std::string& material, const Rgb& emission,
                         const Context& context) {
    SequenceState::Parts& parts = state.parts();
    const Index edited = index_named(parts.world.materials, 0, material, "material");
    const Rgb emission_before = parts.world.materials[edited].emission;
    const auto tracks_before = parts.world.material_emission;
    set_emission(parts.world, material, emission);
    parts.edited = true;
    // A lamp that is off is still a lamp.
    if (max_channel(emission) <= 0) return {};
    try {
        if (reaches_more(parts, context)) return begin_anew(parts, context);
        Lamps lamps = find_lamps(parts.world, parts.mesh);
        if (lamps.lamp_of_patch == parts.lamps.lamp_of_patch) return {};
        const auto sight = static_cast<double>(parts.sight->lines_per_patch());
        set_lamps(parts, std::move(lamps), context);
        return {sight / (sight + parts.light->lines_per_patch()), 0, false};
    } catch (...) {
        parts.world.materials[edited].emission = emission_before;
        parts.world.material_emission = tracks_before;
        throw;
    }
}

EditOutcome set_intensity(SequenceState& state, const std::string& lamp, const Rgb& intensity) {
    set_intensity(state.parts().world, lamp, intensity);
    state.parts().edited = true;
    return {};
}

EditOutcome set_reflectance(SequenceState& state, const std::string& material, const Rgb& reflectance) {
    set_reflectance(state.parts().world, material, reflectance);
    state.parts().edited = true;
    return {};
}

EditOutcome set_path(SequenceState& state, const std::string& actor, double from_s, const Path& path,
                     const Context& context) {
    SequenceState::Parts& parts = state.parts();
    const Index edited = index_named(parts.world.bodies, furniture + 1, actor, "actor");
    Path& old = parts.world.bodies[edited].path;
    const Path before = old;
    set_path(parts.world, actor, from_s, path);
    parts.edited = true;
    try {
        if (reaches_more(parts, context)) return begin_anew(parts, context);
        const auto ahead = parts.strategy->follow_path(parts.lines(0), edited, before, context);
        if (!ahead) renew_strategy(parts);
        return {1, ahead.value_or(0), true};
    } catch (...) {
        old = before;
        renew_strategy(parts);
        throw;
    }
}

EditOutcome set_camera(SequenceState& state, const PlacedCamera& camera) {
    if (camera.path.keys.empty()) throw Error(ErrorKind::invalid_input, "camera", "needs a place");
    state.parts().camera = camera;
    state.parts().edited = true;
    return {};
}

}  // namespace afterglow
