#pragma once

#include "solver/visibility/placed_actors.h"
#include "solver/visibility/strategy.h"

namespace afterglow {

/// The light lines that move from frame to frame: of actors' patches, and those that end on an actor's lamp.
/// Exact at every frame, without memory of how it was reached. First what hides them of the furniture and of
/// the two bodies they join, anew where one of these or a lamp has moved; then the other actors where a line
/// meets their boxes. What stands as it stood is not traced. One thread at a time.
class OwnLightLines {
  public:
    /// Keeps no reference to the world.
    explicit OwnLightLines(const World& world) : actors_(world) {}

    /// Brings them up to date in `visible`. Returns the number of rays. Always asked for the same lines.
    /// Errors: cancelled, after which the next call goes on.
    std::uint64_t update(const LineScene& scene, VisibleLines& visible, const Context& context);

  private:
    /// How much of a block's lines is known.
    enum class Known : char { nothing, background, all };
    void begin(const LineScene& scene);
    void forget_what_moved(const LineScene& scene);
    std::uint64_t learn(const LineScene& scene, std::size_t block, Index k, bool background_is_known);

    PlacedActors actors_;
    std::vector<char> has_lamp_;   ///< by body
    std::size_t first_block_ = 0;  ///< with lines that move
    std::size_t first_line_ = 0;   ///< its first
    std::vector<Known> known_;     ///< by block, from the first
    std::vector<float> background_, all_;
};

}  // namespace afterglow
