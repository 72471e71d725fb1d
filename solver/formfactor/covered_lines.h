#pragma once

#include <span>
#include <vector>

#include "solver/formfactor/layered_matrix.h"

namespace afterglow {

// How a LayeredMatrix comes to know what its static patches' lines see; `make_layered_matrix` and `show` are
// made of this.

/// The column that a sight line of a static row counts in, by what it sees; `nowhere` where in none: it sees
/// no patch, or a lamp that light lines count.
Index column_of(const LayeredMatrix& matrix, const Lamps& lamps, Index row, Index target);

/// The kind of target that a sight line meets, in its row's tally. `counts`: it has a column.
Index& tallied(LineTally& tally, Index target, bool counts);

/// Brings rows from what they showed last to what their lines show, and lists what changed. One thread at a
/// time; others may update other rows of the same matrix.
class CoverUpdate {
  public:
    /// Empties `changes`; keeps references to its arguments.
    CoverUpdate(LayeredMatrix& matrix, const LayerScene& scene, RowChanges& changes);

    /// Sight lines of one block, by number and time.
    void show_sight(std::size_t block, std::span<const LineChange> changes);
    /// One light line and what it brings now, 0 where it is blocked.
    void show_light(Index line, float contribution);

  private:
    /// Which of the covered lines in hand are dealt with, and how many are kept.
    struct Merge {
        std::size_t next = 0, kept = 0;
    };
    void note(Index first_row, Index lane, const LineChange& change, const CoveredBlock& covered,
              Merge& merge);

    LayeredMatrix& matrix_;
    const LayerScene& scene_;
    RowChanges& changes_;
    CoveredBlock merged_;  // room for a block's covered lines as they will be
};

/// Looks for what lines show otherwise than the layers do, block by block. Thread-safety: const.
class CoverComparison {
  public:
    /// Keeps references to its arguments.
    CoverComparison(const LayeredMatrix& matrix, const LayerScene& scene, const VisibleLines& visible)
        : matrix_(matrix), scene_(scene), visible_(visible) {}

    /// Appends the sight lines of a block, by number.
    void find_sight(std::size_t block, std::vector<LineChange>& found) const;
    /// Appends the light lines that are open or dark otherwise than the layers have it.
    void find_light(std::size_t block, std::vector<Index>& found) const;

  private:
    const LayeredMatrix& matrix_;
    const LayerScene& scene_;
    const VisibleLines& visible_;
};

}  // namespace afterglow
