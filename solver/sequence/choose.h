#pragma once

#include <memory>
#include <string>

#include "solver/scene/world.h"
#include "solver/sequence/config.h"
#include "solver/visibility/strategy.h"

namespace afterglow {

/// A visibility and a solution, and why.
struct MethodChoice {
    Visibility visibility = Visibility::retrace;
    Solution solution = Solution::progressive;
    std::string reason;  ///< a sentence for people; empty where both were asked for by name
};

/// Fills in what the settings leave to the scene, so that no more is built than pays: nothing that outlasts a
/// frame for a single one, no temporal structure where nothing moves, no events ahead for a few frames,
/// nothing at all where much of what there is moves and events would not pay. Thread-safety: pure.
MethodChoice choose_method(const World& world, const SequenceConfig& config);

/// A strategy that knows nothing yet. Keeps a reference to the world. Errors: invalid_input for
/// Visibility::automatic, which must have been chosen for.
std::unique_ptr<VisibilityStrategy> make_strategy(Visibility visibility, const World& world,
                                                  const FrameClock& clock);

}  // namespace afterglow
