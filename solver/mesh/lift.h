#pragma once

#include "solver/scene/world.h"

namespace afterglow {

/// How far the origins of a world's lines are lifted off their surfaces, metres; 0 for an empty world. What
/// comes nearer to a surface than that touches it. Thread-safety: pure.
float lift_for(const World& world);

}  // namespace afterglow
