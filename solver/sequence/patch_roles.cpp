#include "solver/sequence/patch_roles.h"

namespace afterglow {

namespace {

constexpr int looks_across = 160;
constexpr int looks_down = 90;

}  // namespace

std::uint64_t look_through_camera(const SequenceState::Parts& parts, int frame, const Context& context,
                                  const std::function<void(const Ray&, const Hit&)>& see) {
    const CameraView view = view_at(parts.camera, parts.time_of(frame), looks_across, looks_down);
    RayPacket rays;
    HitPacket hits;
    for (int y = 0; y < looks_down; ++y) {
        context.check_stop();
        for (int x = 0; x < looks_across; x += block_size) {
            rays.count = block_size;
            for (Index lane = 0; lane < block_size; ++lane)
                rays.set(lane, view.ray(static_cast<float>(x) + static_cast<float>(lane) + 0.5F,
                                        static_cast<float>(y) + 0.5F));
            parts.caster.nearest(rays, Scope::everything, hits);
            for (Index lane = 0; lane < block_size; ++lane) see(rays.ray(lane), hits[lane]);
        }
    }
    return looks_across * looks_down;
}

PatchRoleLists roles_at(const SequenceState::Parts& parts, int frame, std::uint64_t& rays_traced,
                        const Context& context) {
    const PatchMesh& mesh = parts.mesh;
    PatchRoleLists roles;
    roles.seen.assign(mesh.size(), 0);
    roles.object = mesh.body;
    roles.surface = mesh.surface;
    for (Index p = 0; p < mesh.size(); ++p)
        roles.moving.push_back(static_cast<std::uint8_t>(parts.world.bodies[mesh.body[p]].path.moves()));

    rays_traced += look_through_camera(parts, frame, context, [&](const Ray& ray, const Hit& hit) {
        const Index patch = target_of(hit, ray, mesh, parts.caster);
        if (patch < mesh.size()) roles.seen[patch] = 1;
    });
    return roles;
}

}  // namespace afterglow
