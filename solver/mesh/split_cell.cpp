#include "solver/mesh/split_cell.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace afterglow {

namespace {

// Cuts are drawn a little long, and what sticks out beyond the next one is no reason to split on.
constexpr float stub_per_tolerance = 50;

class Splitter {
  public:
    explicit Splitter(const CellSquare& square) : square_(square) {}

    SplitCell run(std::vector<ClipPolygon> pieces, std::span<const CellCut> cuts) {
        std::vector<CellCut> within;
        for (const CellCut& cut : cuts) {
            const auto part = clip(cut.segment, square_.low, square_.low + square_.size);
            if (part && is_long(*part)) within.push_back({*part, cut.line, cut.kerf_m});
        }
        std::stable_sort(within.begin(), within.end(), [&](const CellCut& a, const CellCut& b) {
            return length_m(a.segment) > length_m(b.segment);
        });
        out_.root = split({std::move(pieces), {}}, within, CellTree::most_splits);
        return std::move(out_);
    }

  private:
    [[nodiscard]] float length_m(const GridSegment& s) const {
        return glm::length(square_.cell_m * (s.to - s.from));
    }
    [[nodiscard]] bool is_long(const GridSegment& s) const { return length_m(s) > square_.tolerance_m; }

    /// How far the surface of a part reaches to either side of a line, metres: least and greatest distance.
    static std::pair<float, float> reach(const CellPart& part, const GridLine& line) {
        float low = 0, high = 0;
        for (const ClipPolygon& piece : part.pieces) {
            for (int k = 0; k < piece.count; ++k) {
                const float d = line.distance(piece[k].cell);
                low = std::min(low, d);
                high = std::max(high, d);
            }
        }
        return {low, high};
    }

    Index split(CellPart part, std::span<const CellCut> cuts, int splits_left) {
        for (std::size_t k = 0; k < cuts.size() && splits_left > 0; ++k) {
            const GridLine& line = cuts[k].line;
            const auto [low, high] = reach(part, line);
            const float stub_m = stub_per_tolerance * square_.tolerance_m;
            const bool is_stub = length_m(cuts[k].segment) <= stub_m;
            const float least_m = is_stub ? stub_m : square_.tolerance_m;
            if (high > least_m && low < -least_m) {
                if (is_stub) continue;
                return split_by(part, cuts[k], cuts.subspan(k + 1), splits_left - 1);
            }
            // All the surface that counts is on one side already, but may touch the line.
            part.bounds.push_back({line, high > -low ? Keep::above : Keep::below, cuts[k].kerf_m});
        }
        if (part.pieces.empty()) return no_index;
        out_.parts.push_back(std::move(part));
        return static_cast<Index>(out_.parts.size() - 1);
    }

    Index split_by(const CellPart& whole, const CellCut& cut, std::span<const CellCut> others,
                   int splits_left) {
        const auto number = static_cast<Index>(out_.splits.size());
        out_.splits.push_back({cut.line, {}});
        for (const Keep keep : {Keep::below, Keep::above}) {
            CellPart part{{}, whole.bounds};
            part.bounds.push_back({cut.line, keep, cut.kerf_m});
            for (const ClipPolygon& piece : whole.pieces)
                if (const ClipPolygon rest = clip(piece, cut.line, 0, keep); rest.count >= 3)
                    part.pieces.push_back(rest);
            const Index entry = split(std::move(part), on_side(others, cut.line, keep), splits_left);
            out_.splits[number].part[keep == Keep::above ? 1 : 0] = entry;
        }
        return CellTree::split | number;
    }

    /// What of the cuts lies on one side of a line; those along it are done with.
    [[nodiscard]] std::vector<CellCut> on_side(std::span<const CellCut> cuts, const GridLine& line,
                                               Keep keep) const {
        const float sign = keep == Keep::above ? 1.0F : -1.0F;
        std::vector<CellCut> out;
        for (CellCut cut : cuts) {
            const float from = sign * line.distance(cut.segment.from);
            const float to = sign * line.distance(cut.segment.to);
            if (from <= square_.tolerance_m && to <= square_.tolerance_m) continue;
            if (from < 0)
                cut.segment.from = cut.segment.at(from / (from - to));
            else if (to < 0)
                cut.segment.to = cut.segment.at(from / (from - to));
            if (is_long(cut.segment)) out.push_back(cut);
        }
        return out;
    }

    const CellSquare& square_;
    SplitCell out_;
};

}  // namespace

SplitCell split_cell(std::vector<ClipPolygon> pieces, std::span<const CellCut> cuts,
                     const CellSquare& square) {
    return Splitter(square).run(std::move(pieces), cuts);
}

}  // namespace afterglow
