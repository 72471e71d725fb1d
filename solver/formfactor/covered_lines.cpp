#include "solver/formfactor/covered_lines.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace afterglow {

namespace {

/// The static patch that a line belongs to, by its number. Static blocks follow each other, all full but the
/// last.
Index row_of(const LayerScene& scene, std::size_t line, Index lines_per_patch) {
    const auto some_patch = static_cast<Index>(line / lines_per_patch);
    const Index first = some_patch - some_patch % block_size;
    const Index count = std::min(block_size, scene.mesh.static_size() - first);
    return first + static_cast<Index>((line - std::size_t{first} * lines_per_patch) % count);
}

/// Walks covered lines as their numbers come by.
struct Cursor {
    std::span<const CoveredLine> left;

    const CoveredLine* take(Index line) {
        if (left.empty() || left.front().line != line) return nullptr;
        const CoveredLine* taken = left.data();
        left = left.subspan(1);
        return taken;
    }
};

}  // namespace

Index column_of(const LayeredMatrix& matrix, const Lamps& lamps, Index row, Index target) {
    if (target == sees_nothing || target == sees_inside) return matrix.nowhere();
    const Index lamp = lamps.lamp_of_patch[target];
    if (lamp != no_index && matrix.ledger.by_light_lines[row * lamps.list.size() + lamp] != 0)
        return matrix.nowhere();
    return target;
}

Index& tallied(LineTally& tally, Index target, bool counts) {
    if (target == sees_nothing) return tally.outside;
    if (target == sees_inside) return tally.buried;
    return counts ? tally.on_others : tally.on_lamps;
}

CoverUpdate::CoverUpdate(LayeredMatrix& matrix, const LayerScene& scene, RowChanges& changes)
    : matrix_(matrix), scene_(scene), changes_(changes) {
    changes_.sight.clear();
    changes_.light.clear();
    changes_.lines = 0;
}

/// Merges what changed into a block's covered lines.
void CoverUpdate::show_sight(std::size_t b, std::span<const LineChange> changes) {
    if (changes.empty()) return;
    const PatchBlock& block = scene_.sight.blocks()[b];
    const auto first_line = static_cast<Index>(scene_.sight.line(block, 0, 0));
    CoveredBlock& covered = matrix_.sight.covered[b];
    merged_.entries.resize(covered.entries.size() + changes.size());
    merged_.lines.resize(merged_.entries.size());
    Merge merge;
    const auto keep_before = [&](std::size_t line) {
        for (; merge.next < covered.lines.size() && covered.lines[merge.next].line < line; ++merge.next)
            keep(covered.lines[merge.next], covered.entries[merge.next], merge);
    };
    for (std::size_t c = 0; c < changes.size();) {
        LineChange change = changes[c];
        for (++c; c < changes.size() && changes[c].line == change.line; ++c) change.to = changes[c].to;
        keep_before(change.line);
        note(block.first + (change.line - first_line) % block.count, change, covered, merge);
    }
    keep_before(std::numeric_limits<std::size_t>::max());
    merged_.entries.resize(merge.kept);
    merged_.lines.resize(merge.kept);
    std::swap(covered, merged_);
    changes_.lines += changes.size();
}

void CoverUpdate::keep(const CoveredLine& line, const CoveredEntry& entry, Merge& merge) {
    merged_.lines[merge.kept] = line;
    merged_.entries[merge.kept] = entry;
    ++merge.kept;
}

/// Puts one line where it belongs in tally, layer and list.
void CoverUpdate::note(Index row, const LineChange& change, CoveredBlock& covered, Merge& merge) {
    const std::size_t place = merge.next;
    const bool known = place < covered.lines.size() && covered.lines[place].line == change.line;
    // An open line comes from its background, so that need not be looked up.
    const Index background = known ? covered.lines[place].background : change.from;
    const Index base =
        known ? covered.entries[place].base : column_of(matrix_, scene_.lamps, row, background);
    const Index before = known ? covered.entries[place].now : base;
    if (known) ++merge.next;
    const Index now = column_of(matrix_, scene_.lamps, row, change.to);
    LineTally& tally = matrix_.ledger.tally[row];
    --tallied(tally, change.from, before != matrix_.nowhere());
    ++tallied(tally, change.to, now != matrix_.nowhere());
    if (before != now) changes_.sight.push_back({row, before, now, 1});
    if (change.to != background) keep({change.line, background, change.to}, {row, base, now, 1}, merge);
}

void CoverUpdate::show_light(Index line, float contribution) {
    const float value = scene_.background.light_contribution[line];
    const Index lines = scene_.light.lines_per_patch();
    const Index row = row_of(scene_, line, lines);
    const PatchBlock& block = scene_.sight.blocks()[row / block_size];
    const Index k = (line - static_cast<Index>(scene_.light.line(block, 0, 0))) / block.count;
    const Index lamp_patch = scene_.light.lamp_patch(row / block_size, k);
    if (!(value > 0) || column_of(matrix_, scene_.lamps, row, lamp_patch) != matrix_.nowhere()) return;
    std::vector<CoveredLine>& dark = matrix_.light.covered[row / block_size].lines;
    std::vector<CoveredEntry>& entries = matrix_.light.covered[row / block_size].entries;
    const auto at = std::lower_bound(dark.begin(), dark.end(), line,
                                     [](const CoveredLine& a, Index b) { return a.line < b; });
    const bool was_covered = at != dark.end() && at->line == line, is_covered = !(contribution > 0);
    if (was_covered == is_covered) return;
    const Index nowhere = matrix_.nowhere();
    if (is_covered) {
        entries.insert(entries.begin() + (at - dark.begin()), {row, lamp_patch, nowhere, value});
        dark.insert(at, {line, lamp_patch, sees_inside});
        changes_.light.push_back({row, lamp_patch, nowhere, value});
    } else {
        entries.erase(entries.begin() + (at - dark.begin()));
        dark.erase(at);
        changes_.light.push_back({row, nowhere, lamp_patch, value});
    }
}

void CoverComparison::find_sight(std::size_t b, std::vector<LineChange>& found) const {
    const PatchBlock& block = scene_.sight.blocks()[b];
    Cursor next{matrix_.sight.covered[b].lines};
    for (Index d = 0; d < scene_.sight.lines_per_patch(); ++d)
        for (Index lane = 0; lane < block.count; ++lane) {
            const auto line = static_cast<Index>(scene_.sight.line(block, d, lane));
            const CoveredLine* covered = next.take(line);
            const Index from =
                covered != nullptr ? covered->target : scene_.background.background.patch[line];
            if (visible_.patch[line] != from) found.push_back({line, from, visible_.patch[line]});
        }
}

void CoverComparison::find_light(std::size_t b, std::vector<Index>& found) const {
    const PatchBlock& block = scene_.sight.blocks()[b];
    Cursor next{matrix_.light.covered[b].lines};
    for (Index k = 0; k < scene_.light.lines_per_patch(); ++k)
        for (Index lane = 0; lane < block.count; ++lane) {
            const auto line = static_cast<Index>(scene_.light.line(block, k, lane));
            const bool covered = next.take(line) != nullptr;
            const bool open = visible_.light_contribution[line] > 0;
            if (covered == open && scene_.background.light_contribution[line] > 0) found.push_back(line);
        }
}

}  // namespace afterglow
