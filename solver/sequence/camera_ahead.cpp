#include "solver/sequence/camera_ahead.h"

#include "solver/sequence/patch_roles.h"

namespace afterglow {

namespace {

// Enough that a room has several, so few that a pass over them costs a hundredth of one over all rows.
constexpr std::size_t groups_of_patches = 128;

GroupedRows grouped(const SequenceState::Parts& parts, const FormFactorMatrix& rows, const Context& context) {
    const PatchMesh& mesh = parts.mesh;
    std::vector<Vec3> centres;
    for (Index p = 0; p < mesh.size(); ++p)
        centres.push_back(parts.caster.pose(mesh.body[p]).point(mesh.centre[p]));
    return group_rows(rows, groups_of_neighbours(centres, groups_of_patches), context);
}

}  // namespace

KeptView look_ahead(const SequenceState::Parts& parts, const FormFactorMatrix& rows,
                    std::optional<KeptView> before, int frame, std::uint64_t& rays_traced,
                    const Context& context) {
    KeptView view;
    view.rows = before ? std::move(before->rows) : grouped(parts, rows, context);
    const int ahead = anything_moves(parts.world) ? 1 : parts.config.frames_looked_ahead;
    view.frames = {frame, frame + ahead - 1};
    view.seen.assign(view.rows.groups, 0);
    for (int f = frame; f < frame + ahead; ++f) {
        rays_traced += look_through_camera(parts, f, context, [&](const Ray& ray, const Hit& hit) {
            if (hit.body == no_index) return;
            const Pose& pose = parts.caster.pose(hit.body);
            const Vec3 at = ray.origin + hit.distance * ray.direction;
            const Stencil stencil = parts.interpolation->at(
                hit.body, hit.triangle, hit.side, glm::conjugate(pose.rotation) * (at - pose.translation));
            for (const PatchWeight& entry : stencil.patches()) view.seen[view.rows.group[entry.patch]] = 1;
        });
    }
    return view;
}

}  // namespace afterglow
