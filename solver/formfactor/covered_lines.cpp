#include "solver/formfactor/covered_lines.h"

#include <algorithm>
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

/// Merges what changed into a block's covered lines. Whether a line is covered before or after is a toss-up,
/// so that asking costs more than doing: what may be wanted is read and written, and only counted if it is.
void CoverUpdate::show_sight(std::size_t b, std::span<const LineChange> changes) {
    if (changes.empty()) return;
    const PatchBlock& block = scene_.sight.blocks()[b];
    const auto first_line = static_cast<Index>(scene_.sight.line(block, 0, 0));
    CoveredBlock& covered = matrix_.sight.covered[b];
    // A line beyond all others, so that the next one can always be looked at.
    covered.lines.push_back({no_index, 0, 0});
    covered.entries.emplace_back();
    const std::size_t most = covered.entries.size() + changes.size();
    if (merged_.entries.size() < most) {
        merged_.entries.resize(most);
        merged_.lines.resize(most);
    }
    Merge merge;
    const auto keep_before = [&](Index line) {
        for (; covered.lines[merge.next].line < line; ++merge.next) {
            merged_.lines[merge.kept] = covered.lines[merge.next];
            merged_.entries[merge.kept++] = covered.entries[merge.next];
        }
    };
    for (std::size_t c = 0; c < changes.size();) {
        LineChange change = changes[c];
        for (++c; c < changes.size() && changes[c].line == change.line; ++c) change.to = changes[c].to;
        keep_before(change.line);
        note(block.first, (change.line - first_line) % block.count, change, covered, merge);
    }
    keep_before(no_index);
    const auto kept = static_cast<std::ptrdiff_t>(merge.kept);
    covered.entries.assign(merged_.entries.begin(), merged_.entries.begin() + kept);
    covered.lines.assign(merged_.lines.begin(), merged_.lines.begin() + kept);
    changes_.lines += changes.size();
}

/// Puts one line where it belongs in tally, layer and list.
void CoverUpdate::note(Index first_row, Index lane, const LineChange& change, const CoveredBlock& covered,
                       Merge& merge) {
    const Index row = first_row + lane;
    const CoveredLine& line = covered.lines[merge.next];
    const CoveredEntry& entry = covered.entries[merge.next];
    const bool known = line.line == change.line;
    merge.next += known ? 1 : 0;
    // An open line comes from its background.
    const Index background = known ? line.background : change.from;
    const Index base = column_of(matrix_, scene_.lamps, row, background);
    const Index before = known ? entry.now : base;
    const Index now = column_of(matrix_, scene_.lamps, row, change.to);
    LineTally& tally = matrix_.ledger.tally[row];
    --tallied(tally, change.from, before != matrix_.nowhere());
    ++tallied(tally, change.to, now != matrix_.nowhere());
    if (before != now) changes_.sight.push_back({row, before, now, 1});
    merged_.lines[merge.kept] = {change.line, background, change.to};
    merged_.entries[merge.kept] = {base, lane, now};
    merge.kept += change.to != background ? 1 : 0;
}

void CoverUpdate::show_light(Index line, float contribution) {
    const float value = scene_.background.light_contribution[line];
    const Index lines = scene_.light.lines_per_patch();
    const Index row = row_of(scene_, line, lines);
    const PatchBlock& block = scene_.sight.blocks()[row / block_size];
    const Index k = (line - static_cast<Index>(scene_.light.line(block, 0, 0))) / block.count;
    const Index lamp_patch = scene_.light.lamp_patch(row / block_size, k);
    if (!(value > 0) || column_of(matrix_, scene_.lamps, row, lamp_patch) != matrix_.nowhere()) return;
    CoveredBlock& dark = matrix_.light.covered[row / block_size];
    const auto at = std::lower_bound(dark.lines.begin(), dark.lines.end(), line,
                                     [](const CoveredLine& a, Index b) { return a.line < b; });
    const bool was_covered = at != dark.lines.end() && at->line == line, is_covered = !(contribution > 0);
    if (was_covered == is_covered) return;
    const Index nowhere = matrix_.nowhere();
    const auto place = at - dark.lines.begin();
    if (is_covered) {
        dark.entries.insert(dark.entries.begin() + place, {lamp_patch, row % block_size, nowhere});
        dark.value.insert(dark.value.begin() + place, value);
        dark.lines.insert(at, {line, lamp_patch, sees_inside});
        changes_.light.push_back({row, lamp_patch, nowhere, value});
    } else {
        dark.entries.erase(dark.entries.begin() + place);
        dark.value.erase(dark.value.begin() + place);
        dark.lines.erase(at);
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
