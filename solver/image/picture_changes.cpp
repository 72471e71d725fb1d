#include "solver/image/picture_changes.h"

#include <algorithm>

namespace afterglow {

namespace {

bool same_view(const CameraView& a, const CameraView& b) {
    return a.position == b.position && a.right == b.right && a.up == b.up && a.forward == b.forward &&
           a.half_height == b.half_height && a.width == b.width && a.height == b.height;
}

bool same_material(const Material& a, const Material& b) {
    return a.reflectance == b.reflectance && a.emission == b.emission && a.shines == b.shines &&
           a.texture == b.texture;
}

bool same_light(const LightInPlace& a, const LightInPlace& b) {
    return a.pose == b.pose && a.light.kind == b.light.kind && a.light.intensity == b.light.intensity &&
           a.light.inner_cone_angle == b.light.inner_cone_angle &&
           a.light.outer_cone_angle == b.light.outer_cone_angle;
}

Box box_of(const Body& body, const Pose& pose) {
    Box box;
    for (const Vec3& position : body.positions) box.add(pose.point(position));
    return box;
}

float diagonal(const KeptPictureState& state) {
    Box all;
    for (const Box& box : state.boxes) all.add(box);
    return glm::length(all.extent());
}

/// Around each light. Light without a place comes from a point so far off that directions to it differ by
/// less than the slack that shadows have.
std::vector<Box> light_boxes(const KeptPictureState& state) {
    std::vector<Box> boxes;
    if (state.direct) boxes = state.direct->boxes();
    for (const LightInPlace& light : state.lights) {
        Vec3 at = light.pose.translation;
        if (light.light.kind == Light::Kind::directional)
            at = state.boxes[furniture].centre() +
                 1e4F * diagonal(state) * light.pose.direction(Vec3(0, 0, 1));
        boxes.push_back({at, at});
    }
    return boxes;
}

// Of the scene's diagonal: far above rounding, and above what directions to a distant light differ by.
constexpr float shadow_slack = 3e-4F;

/// Patches whose light is another than the one last used, which is replaced; empty where there are none.
std::vector<char> changed_patches(KeptPictureState& state, const LitWorld& lit, float tolerance) {
    double area = 0;
    glm::dvec3 power(0);
    for (std::size_t p = 0; p < lit.irradiance.size(); ++p) {
        const auto a = static_cast<double>(lit.mesh->area_m2[p]);
        area += a;
        power += a * glm::dvec3(lit.irradiance[p]);
    }
    const float allowed = tolerance * max_channel(Rgb(power / area));
    std::vector<char> changed(lit.irradiance.size(), 0);
    bool any = false;
    for (std::size_t p = 0; p < changed.size(); ++p) {
        const Rgb difference = glm::abs(lit.irradiance[p] - state.irradiance[p]);
        const float other_share = std::abs(lit.confidence[p] - state.confidence[p]);
        const bool lit_otherwise = max_channel(difference) > allowed,
                   counts_otherwise = other_share > tolerance;
        if (!lit_otherwise && !counts_otherwise) continue;
        if (counts_otherwise) state.confidence[p] = lit.confidence[p];
        state.irradiance[p] = lit.irradiance[p];
        changed[p] = static_cast<char>((lit_otherwise ? 1 : 0) | (counts_otherwise ? 2 : 0));
        any = true;
    }
    if (!any) changed.clear();
    return changed;
}

void mark(std::vector<char>& marks, std::span<const Index> tiles) {
    for (const Index tile : tiles) marks[tile] = 1;
}

/// Where an actor stood and stands.
struct Moved {
    bool moved = false;
    Box swept;
    std::vector<Index> covered_before;
};

std::vector<Moved> place_actors(KeptPictureState& state, const LitWorld& lit) {
    const auto& bodies = lit.world->bodies;
    std::vector<Moved> out(bodies.size());
    for (Index b = 1; b < bodies.size(); ++b) {
        const Pose& pose = lit.caster->pose(b);
        if (state.poses[b] == pose && !state.boxes[b].empty()) continue;
        const Box before = state.boxes[b];
        state.poses[b] = pose;
        state.boxes[b] = box_of(bodies[b], pose);
        out[b].moved = true;
        out[b].swept = state.boxes[b];
        out[b].swept.add(before);
        out[b].covered_before = std::move(state.covered[b]);
        state.covered[b] = tiles_covered(state.view, state.tiling, bodies[b], pose);
    }
    return out;
}

/// Whether an actor looks another without having moved: by its own light, or by others' shadows.
bool is_lit_otherwise(const KeptPictureState& state, const LitWorld& lit, Index body,
                      const PictureChanges& changes) {
    if (!changes.patches.empty()) {
        const auto first = changes.patches.begin();
        const auto& of_body = lit.mesh->first_patch_of_body;
        if (std::any_of(first + of_body[body], first + of_body[body + 1], [](char c) { return c != 0; }))
            return true;
    }
    return std::any_of(changes.changed_shadows.begin(), changes.changed_shadows.end(),
                       [&](const ShadowRegion& region) { return region.meets(state.boxes[body]); });
}

/// Everything known of another time is forgotten.
void begin_anew(KeptPictureState& state, const LitWorld& lit) {
    const std::size_t bodies = lit.world->bodies.size();
    state.irradiance.assign(lit.irradiance.begin(), lit.irradiance.end());
    state.confidence.assign(lit.confidence.begin(), lit.confidence.end());
    state.poses.assign(bodies, Pose{});
    state.boxes.assign(bodies, Box{});
    state.boxes[furniture] = box_of(lit.world->bodies[furniture], Pose{});
    state.covered.assign(bodies, {});
    state.materials.assign(lit.materials.begin(), lit.materials.end());
    state.lights.assign(lit.lights.begin(), lit.lights.end());
    state.direct.reset();
    if (lit.direct != nullptr) state.direct = *lit.direct;
}

}  // namespace

bool PictureChanges::any() const {
    return everything || !patches.empty() || !changed_shadows.empty() ||
           std::any_of(changed_cover.begin(), changed_cover.end(), [](char c) { return c != 0; });
}

bool PictureChanges::touch(Index tile, const KeptTile& kept) const {
    if (everything || changed_cover[tile] != 0) return true;
    if (!patches.empty() &&
        std::any_of(kept.patches.begin(), kept.patches.end(), [&](Index p) { return patches[p] != 0; }))
        return true;
    return std::any_of(changed_shadows.begin(), changed_shadows.end(),
                       [&](const ShadowRegion& region) { return region.meets(kept.positions); });
}

bool PictureChanges::weigh_otherwise(const KeptTile& kept) const {
    return !patches.empty() && std::any_of(kept.patches.begin(), kept.patches.end(),
                                           [&](Index p) { return (patches[p] & 2) != 0; });
}

bool can_be_kept(const KeptPictureState& state, const CameraView& view, const LitWorld& lit,
                 const PictureConfig& config) {
    const bool had_lamps = state.direct.has_value(), has_lamps = lit.direct != nullptr;
    return state.whole && same_view(state.view, view) && state.config == config &&
           state.irradiance.size() == lit.irradiance.size() &&
           std::equal(state.materials.begin(), state.materials.end(), lit.materials.begin(),
                      lit.materials.end(), same_material) &&
           std::equal(state.lights.begin(), state.lights.end(), lit.lights.begin(), lit.lights.end(),
                      same_light) &&
           had_lamps == has_lamps && (!has_lamps || state.direct->shines_like(*lit.direct));
}

PictureChanges take_over(KeptPictureState& state, const LitWorld& lit, float tolerance) {
    PictureChanges changes;
    changes.everything = !state.whole;
    if (changes.everything)
        begin_anew(state, lit);
    else
        changes.patches = changed_patches(state, lit, tolerance);
    const std::vector<Moved> moved = place_actors(state, lit);
    const std::vector<Box> lights = light_boxes(state);
    const float slack = shadow_slack * diagonal(state);
    changes.covered.assign(state.tiling.count(), 0);
    changes.changed_cover.assign(state.tiling.count(), 0);
    for (Index b = 1; b < moved.size(); ++b) {
        mark(changes.covered, state.covered[b]);
        for (const Box& light : lights) {
            changes.shadows.emplace_back(state.boxes[b], light, slack);
            if (moved[b].moved) changes.changed_shadows.emplace_back(moved[b].swept, light, slack);
        }
    }
    for (Index b = 1; b < moved.size(); ++b) {
        mark(changes.changed_cover, moved[b].covered_before);
        if (moved[b].moved || is_lit_otherwise(state, lit, b, changes))
            mark(changes.changed_cover, state.covered[b]);
    }
    return changes;
}

}  // namespace afterglow
