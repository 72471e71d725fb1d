#include "solver/sequence/edits.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "solver/base/error.h"
#include "solver/formfactor/static_cache.h"
#include "solver/sequence/choose.h"
#include "solver/sequence/edit_tools.h"
#include "solver/sequence/prepare.h"

namespace afterglow {

namespace {

void require_light(const Rgb& value, float limit, const char* field, const char* rule) {
    if (!is_finite(value) || value.r < 0 || value.g < 0 || value.b < 0 || max_channel(value) >= limit)
        throw Error(ErrorKind::invalid_input, field, rule);
}

void require_path(const Path& path) {
    if (path.keys.empty()) throw Error(ErrorKind::invalid_input, "path", "needs at least one key");
    for (std::size_t k = 0; k < path.keys.size(); ++k) {
        const Key<Pose>& key = path.keys[k];
        const std::string place = "path key " + std::to_string(k);
        if (!std::isfinite(key.time_s) || !is_finite(key.value.translation) ||
            !(std::abs(glm::length(key.value.rotation) - 1) < 1e-3F))
            throw Error(ErrorKind::invalid_input, place, "must be finite, its rotation of unit length");
        if (k > 0 && key.time_s < path.keys[k - 1].time_s)
            throw Error(ErrorKind::invalid_input, place, "must not come before the one before it");
    }
}

template <class Tracks>
void drop_track(Tracks& tracks, Index target) {
    std::erase_if(tracks, [&](const auto& track) { return track.target == target; });
}

void set_lamps(SequenceState::Parts& parts, Lamps lamps, const Context& context) {
    parts.lamps = std::move(lamps);
    lay_light_lines(parts);
    parts.strategy = make_strategy(parts.config.visibility, parts.world, parts.clock());
    parts.kept_light.reset();
    parts.kept_rows.reset();
    parts.picture = {};
    if (parts.background.directions == 0) return;
    StaticLines& background = parts.background;
    background.light_contribution.assign(parts.visible.light_contribution.size(), 0);
    trace_light_lines(*parts.light, *parts.sight, parts.caster, Scope::static_geometry,
                      background.light_contribution, context);
    parts.background_key = static_key(parts.world, parts.mesh, *parts.sight, parts.lamps,
                                      parts.light->lines_per_patch(), parts.config.seed);
}

}  // namespace

EditOutcome set_emission(SequenceState& state, const std::string& material, const Rgb& emission,
                         const Context& context) {
    SequenceState::Parts& parts = state.parts();
    const Index edited = index_named(parts.world.materials, 0, material, "material");
    require_light(emission, 1e6F, "emission", "must lie in [0, 1e6) W/m²/sr");
    parts.world.materials[edited].emission = emission;
    drop_track(parts.world.material_emission, edited);
    // A lamp that is off is still a lamp.
    if (max_channel(emission) <= 0) return {};
    if (reaches_more(parts, context)) return begin_anew(parts, context);
    Lamps lamps = find_lamps(parts.world, parts.mesh);
    if (lamps.lamp_of_patch == parts.lamps.lamp_of_patch) return {};
    const auto sight = static_cast<double>(parts.sight->lines_per_patch());
    set_lamps(parts, std::move(lamps), context);
    return {sight / (sight + parts.light->lines_per_patch()), 0, false};
}

EditOutcome set_reflectance(SequenceState& state, const std::string& material, const Rgb& reflectance) {
    SequenceState::Parts& parts = state.parts();
    const Index edited = index_named(parts.world.materials, 0, material, "material");
    require_light(reflectance, 1, "reflectance", "must lie in [0, 1)");
    parts.world.materials[edited].reflectance = reflectance;
    drop_track(parts.world.material_reflectance, edited);
    return {};
}

EditOutcome set_path(SequenceState& state, const std::string& actor, double from_s, const Path& path,
                     const Context& context) {
    SequenceState::Parts& parts = state.parts();
    const Index edited = index_named(parts.world.bodies, furniture + 1, actor, "actor");
    require_path(path);
    if (!std::isfinite(from_s)) throw Error(ErrorKind::invalid_input, "from", "must be a finite time");
    Path& old = parts.world.bodies[edited].path;
    Path joined;
    for (const Key<Pose>& key : old.keys)
        if (key.time_s < from_s) joined.keys.push_back(key);
    // Until then as before: two keys at one time are a jump.
    if (!joined.keys.empty()) joined.keys.push_back({from_s, old.at(from_s)});
    joined.keys.push_back({from_s, path.at(from_s)});
    for (const Key<Pose>& key : path.keys)
        if (key.time_s > from_s) joined.keys.push_back(key);
    const Path before = std::exchange(old, std::move(joined));
    try {
        if (reaches_more(parts, context)) return begin_anew(parts, context);
        const auto ahead = parts.strategy->follow_path(parts.lines(0), edited, before, context);
        if (!ahead) parts.strategy = make_strategy(parts.config.visibility, parts.world, parts.clock());
        return {1, ahead.value_or(0), true};
    } catch (...) {
        old = before;
        begin_anew(parts, Context(context.threads()));
        throw;
    }
}

EditOutcome set_camera(SequenceState& state, const PlacedCamera& camera) {
    if (camera.path.keys.empty()) throw Error(ErrorKind::invalid_input, "camera", "needs a place");
    state.parts().camera = camera;
    return {};
}

}  // namespace afterglow
