#pragma once

#include <span>
#include <vector>

#include "solver/formfactor/matrix.h"
#include "solver/visibility/light_lines.h"

namespace afterglow {

/// What the lines of all patches see at one time: everything a frame's form factors are made of.
struct SeenLines {
    std::span<const Index> visible;             ///< by sight line: patch, sees_nothing or sees_inside
    Index directions = 0;                       ///< only the first so many of each patch are used, 1 … D
    std::span<const float> light_contribution;  ///< by light line, 0 where blocked
};

/// What the sight lines of a patch meet.
struct LineTally {
    Index outside = 0, buried = 0, on_lamps = 0, on_others = 0;
    [[nodiscard]] Index valid() const { return outside + on_lamps + on_others; }
};

/// Form factors of all patches and what else their lines tell.
struct FormFactors {
    FormFactorMatrix matrix;
    std::vector<float> sky;  ///< share of what a patch would receive that comes from outside the scene
    std::vector<float> valid_share;  ///< share of a patch's lines whose origin is not buried, 0 … 1
};

/// Rows of the receiver-owned lines: lamps by light lines, everything else by cosine-weighted sight lines of
/// equal weight, scaled so that a row and its sky sum to 1. Lines with buried origins count for nothing: the
/// rest stand for the whole patch. Lamps near a patch, or that fill its view, count by its sight lines (see
/// LampConfig::near_share). A column stands once in a row. Same result for any number of threads. Errors:
/// cancelled.
FormFactors compile_rows(const PatchMesh& mesh, const SightLines& lines, const LightLines& light_lines,
                         const Lamps& lamps, const RayCaster& placed, const SeenLines& seen,
                         const Context& context);

/// The rows of some patches only, in the order given: row k of the matrix and element k of `sky` and
/// `valid_share` belong to patches[k].
FormFactors compile_rows_of(std::span<const Index> patches, const PatchMesh& mesh, const SightLines& lines,
                            const LightLines& light_lines, const Lamps& lamps, const RayCaster& placed,
                            const SeenLines& seen, const Context& context);

/// By lamp: 1 where it is so near a patch that sight lines count it and light lines do not.
std::vector<char> lamps_near(const PatchMesh& mesh, const Lamps& lamps, const RayCaster& placed, Index patch);

}  // namespace afterglow
