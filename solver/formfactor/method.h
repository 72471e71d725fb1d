#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "solver/formfactor/hemicube.h"
#include "solver/visibility/sight_lines.h"

namespace afterglow {

/// Patches and where they stand: actors at RayCaster::pose.
struct PlacedPatches {
    const PatchMesh& mesh;
    const RayCaster& placed;
};

/// The form factors of one patch.
struct FormFactorRow {
    std::vector<double> factor;  ///< F_ij ≥ 0 by patch j, curved patches also to themselves
    double sky = 0;              ///< share that leaves an open scene: what the row lacks to 1
    /// Share of the samples that met a side without patches, as from a point inside a solid. They are left
    /// out: the others stand for the whole patch. The analytic method does not tell them apart (0): what
    /// blocks them counts as blocked.
    double buried = 0;
};

/// One way of computing form factors: the report's three, to be compared and to check each other. The
/// solver's own rows are `compile_rows`. Thread-safety: const calls from any number of threads.
class FormFactorMethod {
  public:
    virtual ~FormFactorMethod() = default;
    /// "analytic", "hemicube" or "ray-cast".
    [[nodiscard]] virtual std::string_view name() const = 0;
    /// The row of one patch. Factors and sky sum to 1, or all are 0 where everything is buried; the analytic
    /// row may exceed 1 by the sampling error of partly hidden pairs, with sky 0. Errors: invalid_input where
    /// there is no such patch.
    [[nodiscard]] virtual FormFactorRow row(const PlacedPatches& scene, Index patch) const = 0;
};

struct AnalyticConfig {
    Index lines_per_pair = 32;  ///< sample lines that look for what is in between; 0: nothing ever is
    std::uint64_t seed = 1;     ///< of the sample lines
};

/// The closed polygon–polygon value where no sample line of the pair is blocked: exact, touching pairs
/// included, unless all lines missed a small occluder. Otherwise that value times the seen share of the
/// sample lines, each weighted by cos θ cos θ′ / r² as it counts in the integral. Lines run between
/// stratified points of both patches and are the same both ways, so A_i F_ij = A_j F_ji to rounding. Curved
/// patches are the sum over their triangles. Cost: O(patches) a row, 10 µs a pair and more where they nearly
/// touch.
std::unique_ptr<FormFactorMethod> make_analytic(const AnalyticConfig& config = {});

struct HemicubeMethodConfig {
    HemicubeConfig hemicube = {};
    /// Hemicubes stand at the cells' centres of a grid with this many cells along an edge; their mean is the
    /// patch's row. With 1, near pairs get the value of the patch's centre. 1 … 64.
    Index points_per_edge = 1;
};

/// The mean over a grid of points. Everything that has patches blocks, from both sides. Errors: invalid_input
/// where an option is out of range.
std::unique_ptr<FormFactorMethod> make_hemicube(const HemicubeMethodConfig& config = {});

/// The given sight lines of the patch, traced anew: the same estimate as `compile_rows` for patches that see
/// no lamp. `lines` must be of the mesh that rows are asked for and must outlive the method.
std::unique_ptr<FormFactorMethod> make_ray_cast(const SightLines& lines);

}  // namespace afterglow
