#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "solver/radiosity/roles.h"
#include "solver/sequence/parts.h"

namespace afterglow {

/// What the patches of a frame are to its observer and its motion: PatchRoles that own their lists.
struct PatchRoleLists {
    std::vector<std::uint8_t> seen, moving;
    std::vector<Index> object, surface;

    [[nodiscard]] PatchRoles view() const { return {seen, moving, object, surface}; }
};

/// Calls `see` for each of 160 × 90 rays of a frame's camera and what it meets, the bodies standing where the
/// caster has them. Returns the number of rays. Errors: cancelled.
std::uint64_t look_through_camera(const SequenceState::Parts& parts, int frame, const Context& context,
                                  const std::function<void(const Ray&, const Hit&)>& see);

/// Roles at a frame for which the caster has placed the bodies. A patch is seen if one of 160 × 90 camera
/// rays meets it; smaller ones may be missed, which delays what they shoot and costs nothing else. Moving: on
/// an actor that has a path. Adds the number of rays to `rays_traced`. Errors: cancelled.
PatchRoleLists roles_at(const SequenceState::Parts& parts, int frame, std::uint64_t& rays_traced,
                        const Context& context);

}  // namespace afterglow
