#pragma once

#include <cstdint>
#include <functional>

#include "solver/base/json.h"
#include "solver/scene/world.h"

namespace afterglow {

/// What a part of the solver is measured on. Every measure prints a row, a JSON object, for each way there is
/// to do the part's work; all ways in one process, one after the other.
struct PartScene {
    World world;
    float patch_size_m = 0.25F;
    Index rays = 128;
    std::uint64_t seed = 1;
};
using PartRows = std::function<void(const Json& row)>;

/// Sight lines as packets of neighbours, packets of directions and single rays, against the furniture.
void measure_lines(const PartScene& scene, const PartRows& print);
/// Rows of form factors by each method beside rows of very many lines.
void measure_factors(const PartScene& scene, const PartRows& print);
/// One frame's light by each shooting order, cold.
void measure_orders(const PartScene& scene, const PartRows& print);
/// What is promised of a solution beside what it is off by, cold and over following frames.
void measure_certificates(const PartScene& scene, const PartRows& print);

}  // namespace afterglow
