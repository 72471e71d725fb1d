#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "solver/base/math.h"

namespace afterglow {

/// What patches are to the observer and to the motion, as far as the caller knows. The spans belong to the
/// caller; each has one element a patch, or none where nothing is known. They decide what is done first, and
/// in active-passive solutions what is left out; never what the exact solution is.
/// Source: Tost and Pueyo 1993, section 3, "Heuristic for choosing the shooting patch".
struct PatchRoles {
    std::span<const std::uint8_t> seen;    ///< not 0: some of it is in the picture; none known: all are
    std::span<const std::uint8_t> moving;  ///< not 0: moves at this time; none known: none does
    std::span<const Index> object;         ///< number of the body, below the number of patches
    std::span<const Index> surface;        ///< number of the surface, below the number of patches

    [[nodiscard]] bool is_seen(std::size_t patch) const { return seen.empty() || seen[patch] != 0; }
    [[nodiscard]] bool is_moving(std::size_t patch) const { return !moving.empty() && moving[patch] != 0; }
};

/// Throws Error{invalid_input}, naming the field, unless every span is empty or has one element a patch and
/// all numbers are below the number of patches.
void check(const PatchRoles& roles, std::size_t patches);

}  // namespace afterglow
