#include "solver/sequence/furniture_edits.h"

#include <cmath>
#include <functional>

#include "solver/formfactor/static_cache.h"
#include "solver/mesh/kept_numbers.h"
#include "solver/mesh/lift.h"
#include "solver/scene/furniture.h"
#include "solver/sequence/edit_tools.h"
#include "solver/sequence/prepare.h"
#include "solver/visibility/kept_lines.h"

namespace afterglow {

namespace {

// Within so many lifts of an object lines may see otherwise what it touches: see PatchMesh::slipped.
constexpr float margin_lifts = 32;

using Parts = SequenceState::Parts;

/// A static pass and what its lines depend on, from before an edit.
struct Before {
    PatchMesh mesh;
    Lamps lamps;
    StaticLines lines;
    float lift_m;
    std::vector<Lanes> radiosity;  ///< by patch; empty where none was kept
};

/// What patches that are still there shone with.
std::vector<std::optional<Lanes>> known_radiosity(const Before& before, const PatchMesh& mesh,
                                                  const std::vector<std::uint8_t>& kept) {
    if (before.radiosity.empty()) return {};
    std::vector<std::optional<Lanes>> known(mesh.size());
    for (Index p = 0; p < mesh.size(); ++p) {
        const bool moves = p >= mesh.static_size();
        const Index then = moves ? p - mesh.static_size() + before.mesh.static_size() : p;
        // Actors may be divided otherwise near what moved: then their numbers say nothing.
        const bool is_there =
            moves ? before.mesh.size() - before.mesh.static_size() == mesh.size() - mesh.static_size()
                  : kept[p] != 0;
        if (is_there) known[p] = before.radiosity[then];
    }
    return known;
}

/// Whether light lines end as they did: lamps of actors count by their place among the moving patches.
bool same_lamps(const Before& before, const Parts& parts, const std::vector<std::uint8_t>& kept) {
    const Lamps &a = before.lamps, &b = parts.lamps;
    if (a.patches.size() != b.patches.size() || a.cumulative_power != b.cumulative_power) return false;
    for (std::size_t k = 0; k < a.patches.size(); ++k) {
        const Index p = a.patches[k], q = b.patches[k];
        const bool moves = q >= parts.mesh.static_size();
        if (moves ? p - before.mesh.static_size() != q - parts.mesh.static_size() : p != q || kept[q] == 0)
            return false;
    }
    return true;
}

/// Lines and light after the world has changed within some boxes; returns the share of lines kept.
double lay_again(Parts& parts, const Before& before, std::vector<Box> changed, const Context& context) {
    divide_world(parts, context);
    const auto kept = keep_numbers(before.mesh, parts.mesh);
    lay_lines(parts);
    forget_frames(parts);
    parts.edited = true;
    parts.radiosity_before = known_radiosity(before, parts.mesh, kept);
    parts.background = {};
    // Coarser preliminary pictures may have been all there is so far.
    const Index lines = parts.sight->lines_per_patch();
    if (before.lines.directions != lines || before.lift_m != parts.sight->lift_m()) return 0;
    for (Box& box : changed) {
        box.low -= Vec3(margin_lifts * before.lift_m);
        box.high += Vec3(margin_lifts * before.lift_m);
    }
    const KeptFurniture furnished{
        before.lines, before.mesh.static_size(), kept, changed,
        same_lamps(before, parts, kept) &&
            before.lines.light_contribution.size() ==
                std::size_t{before.mesh.static_size()} * parts.light->lines_per_patch()};
    parts.caster.set_poses(poses_at(parts.world, 0));
    const std::uint64_t traced = retrace_changed_lines(furnished, parts.background, parts.mesh, *parts.sight,
                                                       *parts.light, parts.caster, context);
    parts.background_key = static_key(parts.world, parts.mesh, *parts.sight, parts.lamps,
                                      parts.light->lines_per_patch(), parts.config.seed);
    const auto all = static_cast<double>(parts.background.background.patch.size() +
                                         parts.background.light_contribution.size());
    return std::max(0.0, 1 - static_cast<double>(traced) / all);
}

/// Changes the world and what hangs on it. `change` returns the places concerned.
EditOutcome refurnish(Parts& parts, const std::function<std::vector<Box>(World&)>& change,
                      const Context& context) {
    World world_before = parts.world;
    std::vector<Box> changed = change(parts.world);
    Before before{std::move(parts.mesh),
                  std::move(parts.lamps),
                  std::move(parts.background),
                  parts.sight->lift_m(),
                  {}};
    if (parts.kept_light && parts.kept_light->state)
        before.radiosity = std::move(parts.kept_light->state->radiosity);
    try {
        parts.caster = RayCaster(parts.world);
        const double lines_reused = lay_again(parts, before, std::move(changed), context);
        return {lines_reused, 0, !parts.radiosity_before.empty()};
    } catch (...) {
        parts.world = std::move(world_before);
        parts.caster = RayCaster(parts.world);
        begin_anew(parts, Context(context.threads()));
        parts.edited = true;
        throw;
    }
}

}  // namespace

EditOutcome move_furniture(SequenceState& state, const std::string& piece, const Pose& motion,
                           const Context& context) {
    Parts& parts = state.parts();
    const Index moved = index_named(parts.world.pieces, 0, piece, "piece");
    if (!is_finite(motion.translation) || !(std::abs(glm::length(motion.rotation) - 1) < 1e-3F))
        throw Error(ErrorKind::invalid_input, "motion", "must be finite, its rotation of unit length");
    const auto change = [&](World& world) {
        const Box from = bounds_of(world, moved);
        move_piece(world, moved, motion);
        return std::vector<Box>{from, bounds_of(world, moved)};
    };
    return refurnish(parts, change, context);
}

EditOutcome remove_furniture(SequenceState& state, const std::string& piece, const Context& context) {
    Parts& parts = state.parts();
    const Index removed = index_named(parts.world.pieces, 0, piece, "piece");
    const auto change = [&](World& world) {
        const Box from = bounds_of(world, removed);
        remove_piece(world, removed);
        return std::vector<Box>{from};
    };
    return refurnish(parts, change, context);
}

EditOutcome add_furniture(SequenceState& state, const Body& object, const Context& context) {
    Parts& parts = state.parts();
    const auto change = [&](World& world) {
        add_piece(world, object);
        return std::vector<Box>{bounds_of(world, static_cast<Index>(world.pieces.size() - 1))};
    };
    return refurnish(parts, change, context);
}

}  // namespace afterglow
