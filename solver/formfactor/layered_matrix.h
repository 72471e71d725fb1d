#pragma once

#include <span>
#include <vector>

#include "solver/formfactor/rows.h"
#include "solver/visibility/strategy.h"

namespace afterglow {

/// What a line of a static patch counts for while it does not see its background. The columns of lines that
/// count for no patch are `nowhere`. Small, since all of them are read again and again.
struct CoveredEntry {
    std::uint32_t base_and_lane =
        0;          ///< the column that the base counts it in, times 256, and its row's lane
    Index now = 0;  ///< the column that it counts in at this time

    CoveredEntry() = default;
    CoveredEntry(Index base, Index lane, Index now_) : base_and_lane(base << 8 | lane), now(now_) {}
    [[nodiscard]] Index base() const { return base_and_lane >> 8; }
    [[nodiscard]] Index lane() const { return base_and_lane & 255; }
};

/// Which line that is.
struct CoveredLine {
    Index line = 0;
    Index background = 0;  ///< what it sees without actors, for light lines their lamp patch
    Index target = 0;      ///< what it sees at this time: patch, sees_nothing or sees_inside
};

/// The covered lines of a block of patches, by number. Neighbours' lines stand together, and are read and
/// rewritten in one stream.
struct CoveredBlock {
    std::vector<CoveredEntry> entries;
    std::vector<CoveredLine> lines;  ///< likewise: which line each entry is
    std::vector<float> value;        ///< likewise, of light lines; a sight line counts 1
};

/// Columns of a matrix of counted lines: an entry is its row times 256 plus a count of 1 to 255; of more
/// lines there are more entries. Half the bytes of FormFactorColumns, and bytes are what pushing waits for.
struct CountColumns {
    std::vector<std::uint64_t> column_begin;  ///< size columns + 1
    std::vector<std::uint32_t> entry;         ///< by row within a column

    static constexpr std::uint32_t most_lines = 255;
    static constexpr int row_shift = 8;
    static constexpr std::size_t most_rows = std::size_t{1} << (32 - row_shift);
};

/// The entries of a column.
inline std::span<const std::uint32_t> column_entries(const CountColumns& columns, Index column) {
    const std::uint64_t begin = columns.column_begin[column];
    return {columns.entry.data() + begin, static_cast<std::size_t>(columns.column_begin[column + 1] - begin)};
}

/// Calls `take(row, value)` for each entry of a column, in order.
template <class Take>
void for_column(const CountColumns& columns, Index column, const Take& take) {
    for (const std::uint32_t entry : column_entries(columns, column))
        take(entry >> CountColumns::row_shift,
             static_cast<float>(static_cast<int>(entry & CountColumns::most_lines)));
}
template <class Take>
void for_column(const FormFactorColumns& columns, Index column, const Take& take) {
    const std::uint64_t end = columns.column_begin[column + 1];
    for (std::uint64_t e = columns.column_begin[column]; e < end; ++e) take(columns.row[e], columns.value[e]);
}

/// Rows of one kind of lines before they are scaled: what is there without actors, which never changes, and
/// what actors cover. Row i of F gets scale[i] (base_i + Σ value (column now − column base)).
struct LayeredRows {
    FormFactorMatrix base;
    std::vector<CoveredBlock> covered;  ///< by block of static patches
    std::vector<float> scale;           ///< by row
};

/// Calls `take(row, base column, column now, value)` for each covered line of a block, by number.
template <class Take>
void for_covered(const LayeredRows& layer, std::size_t block, const Take& take) {
    const CoveredBlock& covered = layer.covered[block];
    const std::size_t first = block * block_size;
    const auto value = [&](std::size_t k) { return covered.value.empty() ? 1.0F : covered.value[k]; };
    for (std::size_t k = 0; k < covered.entries.size(); ++k) {
        const CoveredEntry& entry = covered.entries[k];
        take(first + entry.lane(), entry.base(), entry.now, value(k));
    }
}

/// A line of a row that counted in one column and counts in another.
struct RowChange {
    Index row = 0, from = 0, to = 0;
    float value = 0;
};

/// What changed in some rows, unscaled.
struct RowChanges {
    std::vector<RowChange> sight, light;
    std::uint64_t lines = 0;  ///< sight lines that see something else, whether or not their columns differ
};

/// F of one moment as layers, so that the next moment costs what changes: static patches keep rows over which
/// actors lie; rows of moving patches, and of those that lamps fill the view of, are compiled whole. In a
/// scene with a lamp that moves all rows are: each of them changes at every frame. Meant to be read;
/// `make_layered_matrix` and `show` write it.
struct LayeredMatrix {
    LayeredRows sight, light;
    CountColumns sight_columns;       ///< of the base
    FormFactorColumns light_columns;  ///< likewise
    std::vector<Index> whole_rows;    ///< which rows are whole, increasing; the layers scale them by 0
    FormFactorMatrix whole;           ///< row k belongs to patch whole_rows[k]
    std::vector<float> sky;           ///< as in FormFactors
    std::vector<float> valid_share;
    std::vector<double> row_sum;  ///< Σ_j F_ij by row

    /// For `show` and `lamp_irradiance` only.
    struct Ledger {
        bool has_moving_lamps = false;
        std::vector<LineTally> tally;      ///< by static patch
        std::vector<double> from_lamps;    ///< by static patch: Σ of its light lines' values, none covered
        std::vector<char> by_light_lines;  ///< by static patch and lamp
        std::vector<RowChanges> changes;   ///< made by the latest `show`; no two parts change the same row
    } ledger;

    [[nodiscard]] std::size_t rows() const { return sky.size(); }
    /// The column of lines that count in no column: one past the last patch.
    [[nodiscard]] Index nowhere() const { return static_cast<Index>(sky.size()); }
};

/// What the layers are made of. `background` must be traced in all directions; `placed` has the bodies where
/// they are at the moment shown.
struct LayerScene {
    const PatchMesh& mesh;
    const SightLines& sight;
    const LightLines& light;
    const Lamps& lamps;
    const RayCaster& placed;
    const StaticLines& background;
};

/// The layers with all actors away; the rows of moving patches are still missing. Errors: too_large past 2³²
/// lines or 2²⁴ patches; cancelled.
LayeredMatrix make_layered_matrix(const LayerScene& scene, const Context& context);

/// Brings the layers to what lines see now, comparing all static ones with what is shown. F is then that of
/// compile_rows, up to rounding. Returns what changed in the layers, in parts of which no two change the same
/// row; they belong to the matrix until the next `show`. The same for any number of threads. Errors:
/// cancelled; the matrix is then of no more use.
std::span<const RowChanges> show(LayeredMatrix& matrix, const LayerScene& scene, const VisibleLines& visible,
                                 const Context& context);

/// The same where the lines that changed since the last `show` are known: all of them, once for each time
/// they changed, and those of one line in the order of time. Cheaper where sight lines come by number.
std::span<const RowChanges> show(LayeredMatrix& matrix, const LayerScene& scene, const VisibleLines& visible,
                                 LineChanges changes, const Context& context);

/// How many sight lines came to see something else.
std::uint64_t lines_changed(std::span<const RowChanges> changes);

/// Irradiance that lamps alone give every patch, W/m²: Σ over their patches of F_ij E_j. `emission` by patch.
std::vector<Rgb> lamp_irradiance(const LayeredMatrix& matrix, const Lamps& lamps,
                                 std::span<const Rgb> emission, const Context& context);

}  // namespace afterglow
