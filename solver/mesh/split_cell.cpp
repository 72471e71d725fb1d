#include "solver/mesh/split_cell.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace afterglow {

namespace {

// Cuts are drawn a little long, and what sticks out beyond the next one is no reason to split on.
constexpr float stub_per_tolerance = 20;

class Splitter {
  public:
    explicit Splitter(const CellSquare& square) : square_(square) {}

    SplitCell run(std::vector<ClipPolygon> pieces, std::span<const CellCut> cuts) {
        std::vector<CellCut> within;
        const Vec2 tolerance = square_.tolerance_m / square_.cell_m;
        for (const CellCut& cut : cuts) {
            const auto part =
                clip(cut.segment, square_.low - tolerance, square_.low + square_.size + tolerance);
            if (part && is_long(*part)) within.push_back({*part, cut.line, cut.kerf_m, cut.on_border});
        }
        std::sort(within.begin(), within.end(), [&](const CellCut& a, const CellCut& b) {
            return length_m(a.segment) > length_m(b.segment);
        });
        within.resize(std::min(within.size(), most_cuts_in_cell));
        out_.root = split({std::move(pieces), {}}, within, CellTree::most_splits);
        return std::move(out_);
    }

  private:
    [[nodiscard]] float length_m(const GridSegment& s) const {
        return glm::length(square_.cell_m * (s.to - s.from));
    }
    [[nodiscard]] bool is_long(const GridSegment& s) const { return length_m(s) > square_.tolerance_m; }

    /// How far the surface of a part reaches to either side of a line, and along it, metres.
    struct Reach {
        float below = 0, above = 0;
        float first = std::numeric_limits<float>::infinity(), last = -first;
        [[nodiscard]] float along() const { return last - first; }
    };
    [[nodiscard]] Reach reach_of(const CellPart& part, const CellCut& cut) const {
        const Vec2 along = glm::normalize(square_.cell_m * (cut.segment.to - cut.segment.from));
        Reach reach;
        for (const ClipPolygon& piece : part.pieces) {
            for (int k = 0; k < piece.count; ++k) {
                const Vec2 &a = piece[k].cell, &b = piece[(k + 1) % piece.count].cell;
                const float da = cut.line.distance(a), db = cut.line.distance(b);
                reach.below = std::max(reach.below, -da);
                reach.above = std::max(reach.above, da);
                if ((da < 0) == (db < 0)) continue;
                const Vec2 crossing = glm::mix(a, b, da / (da - db));
                const float place = glm::dot(along, square_.cell_m * (crossing - cut.line.through));
                reach.first = std::min(reach.first, place);
                reach.last = std::max(reach.last, place);
            }
        }
        return reach;
    }

    Index split(CellPart part, std::span<const CellCut> cuts, int splits_left) {
        const float stub_m = stub_per_tolerance * square_.tolerance_m;
        for (std::size_t k = 0; k < cuts.size() && splits_left > 0; ++k) {
            const Reach reach = reach_of(part, cuts[k]);
            if (std::min(reach.below, reach.above) > square_.tolerance_m) {
                if (length_m(cuts[k].segment) <= stub_m && reach.along() > 2 * stub_m) continue;
                return split_by(part, cuts[k], cuts.subspan(k + 1), splits_left - 1);
            }
            // All the surface is on one side already, but may touch the line.
            const Keep keep = reach.above > reach.below ? Keep::above : Keep::below;
            part.bounds.push_back({cuts[k].line, keep, cuts[k].kerf_m});
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
