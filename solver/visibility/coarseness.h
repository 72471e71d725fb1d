#pragma once

#include <cstdint>
#include <vector>

#include "solver/base/sampling.h"
#include "solver/mesh/patch_mesh.h"
#include "solver/visibility/ray_caster.h"

namespace afterglow {

struct CoarsenessConfig {
    int rays = 32;  ///< looked along from each part, 4 to 256
    /// A part is too coarse where its edge over the distance of what it sees has a root mean square above
    /// this.
    float size_per_distance = 0.5F;
    std::uint64_t seed = 1;  ///< of the rays
};

/// An actor where it passes at some moment.
struct PassingActor {
    Index body = 0;
    Pose pose;
    Box bounds;  ///< in the body's frame
};

/// All actors at moments spread evenly over a world's duration, its ends among them; those at rest once.
/// Thread-safety: pure.
std::vector<PassingActor> passing_actors(const World& world, int moments);

/// Tells where patches must be small: irradiance bends where something is near compared with the patch (Ward,
/// Rubinstein and Clear 1988: its gradient goes with 1 / distance), and jumps where a patch is partly buried
/// in something that stands on it. Furniture is judged among furniture and by each actor that passes near by;
/// an actor as it stands among everything. A CoarsenessTest. Thread-safety: calls are const; the caster must
/// not move its actors meanwhile.
class Coarseness {
  public:
    /// `reached` tells the sides that light can reach: a ray that meets another one starts buried. All
    /// arguments but the last two must outlive this.
    Coarseness(const RayCaster& placed, const Surfaces& surfaces, const SideMask& reached, float lift_m,
               const CoarsenessConfig& config, std::vector<PassingActor> passing = {});

    bool operator()(const PatchShape& part, Index body, Side side) const;

  private:
    /// What a part's rays meet: how far, infinity where nothing, and whether the ray started in it.
    struct Seen {
        std::vector<Ray> rays;
        std::vector<float> distance_m;
        std::vector<char> is_buried;
    };
    [[nodiscard]] Seen look_from(const PatchShape& part, Index body, Side side) const;
    void look_again(const PassingActor& actor, Seen& seen) const;
    void note(const Hit& hit, std::size_t ray, Seen& seen) const;
    [[nodiscard]] bool is_uneven(const Seen& seen, float edge_m) const;

    const RayCaster* placed_;
    const Surfaces* surfaces_;
    const SideMask* reached_;
    float lift_m_;
    CoarsenessConfig config_;
    SobolPoints points_;
    std::vector<PassingActor> passing_;
};

}  // namespace afterglow
