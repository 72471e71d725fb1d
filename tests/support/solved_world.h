#pragma once

#include <memory>

#include "solver/formfactor/outside_light.h"
#include "solver/radiosity/progressive.h"
#include "solver/sequence/config.h"
#include "solver/visibility/strategy.h"
#include "tests/support/worlds.h"

namespace afterglow::testing {

struct SolvedWorldConfig {
    float patch_size_m = 0.3F;                    ///< see MeshConfig
    Index lines = 256;                            ///< sight lines of a patch
    Index light_lines = 64;                       ///< of a patch, to the lamps
    Visibility visibility = Visibility::retrace;  ///< see Visibility
    double asked_error = 1e-4;                    ///< certificate of the solution
    std::uint64_t seed = 1;                       ///< of all lines
};

/// A strategy's name as test names may hold it.
std::string test_name(Visibility visibility);

/// A world taken through the whole solver but the picture: reachable sides into patches, lines, rows, light.
/// What a frame of a sequence does, with everything in between open to be looked at. Not copied or moved:
/// its parts point at each other.
class SolvedWorld {
  public:
    explicit SolvedWorld(World w, const SolvedWorldConfig& config = {});
    SolvedWorld(const SolvedWorld&) = delete;
    SolvedWorld& operator=(const SolvedWorld&) = delete;

    /// Places the bodies and makes the rows; `solve` then finds the light as well.
    void look(double time_s);
    void solve(double time_s);

    [[nodiscard]] RadiosityProblem problem() const;
    /// B = E + ρH of a patch.
    [[nodiscard]] Rgb radiosity(Index patch) const;
    /// F from a patch to all patches of a surface.
    [[nodiscard]] double factor_to_surface(Index patch, Index surface) const;
    /// Patches of one side of a surface.
    [[nodiscard]] std::vector<Index> patches_of(Index surface, Side side) const;

    SolvedWorldConfig config;
    World world;
    RayCaster caster;
    PatchMesh mesh;
    Lamps lamps;
    SightLines sight;
    LightLines light;
    VisibleLines visible;
    FormFactors factors;
    std::vector<Material> materials;
    std::vector<LightInPlace> lights;
    std::vector<Rgb> emission, reflectance;  ///< by patch, W/m²
    std::vector<Rgb> from_lights;            ///< irradiance by lights without a surface
    std::vector<Rgb> external;               ///< and by the background
    ProgressiveSolution solution;

  private:
    StaticLines background_;
    std::unique_ptr<VisibilityStrategy> strategy_;
};

}  // namespace afterglow::testing
