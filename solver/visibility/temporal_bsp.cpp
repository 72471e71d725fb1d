#include "solver/visibility/temporal_bsp.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace afterglow {

namespace {

constexpr double never = std::numeric_limits<double>::infinity();

/// Looks at a tree at one time.
class Visit {
  public:
    Visit(TemporalBsp& temporal, const BspTree& tree, const SteadyView& view, const Viewpoint& viewpoint,
          double time_s)
        : temporal_(temporal),
          tree_(tree),
          view_(view),
          viewpoint_(viewpoint),
          time_s_(time_s),
          place_(view.place(viewpoint.offset_m, time_s)),
          turns_(view.body.motion == Motion::turning),
          velocity_(turns_ ? Vec3d(0) : view.velocity()),
          greatest_speed_(turns_ ? view.greatest_speed(viewpoint.offset_m, time_s) : 0) {}

    /// Brings a subtree, whose faces stand from `start` on in the order, up to date.
    enum class Ask {
        where_due,   ///< only what may have changed, and write the order of what has
        sides_only,  ///< the same, but somebody above writes the order
        all,         ///< every node, somebody above writes the order
    };
    void bring(Index index, Index start, Ask ask) {
        TemporalBsp::Node& node = temporal_.nodes[index];
        if (ask != Ask::all && node.earliest_s > time_s_) return;
        ++work.nodes_visited;
        const PlaneSide before = node.side;
        if (ask == Ask::all || node.change_s <= time_s_) look(node, tree_.nodes[index].plane);
        const bool changed = node.side != before;
        if (changed && ask != Ask::all) ++work.sides_changed;
        node.earliest_s = node.change_s;
        if (node.side != PlaneSide::across) {
            // What was below `across` has not been kept up to date.
            const bool anew = ask == Ask::all || (changed && before == PlaneSide::across);
            bring_children(index, start, anew ? Ask::all : changed ? Ask::sides_only : ask);
        }
        if (changed && ask == Ask::where_due) write(index, start);
    }

    /// Writes the order of a subtree.
    void write(Index index, Index start) {
        const BspTree::Node& node = tree_.nodes[index];
        if (temporal_.nodes[index].side == PlaneSide::across) {
            run(node.first_face, node.subtree_faces, start);
            return;
        }
        const auto [near, far] = near_and_far(index);
        if (near != no_index) {
            write(near, start);
            start += tree_.nodes[near].subtree_faces;
        }
        run(node.first_face, node.own_faces, start);
        if (far != no_index) write(far, start + node.own_faces);
    }

    TreeWork work;

  private:
    struct Children {
        Index near, far;
    };
    [[nodiscard]] Children near_and_far(Index index) const {
        const BspTree::Node& node = tree_.nodes[index];
        return temporal_.nodes[index].side == PlaneSide::front ? Children{node.front, node.back}
                                                               : Children{node.back, node.front};
    }

    void bring_children(Index index, Index start, Ask ask) {
        const auto [near, far] = near_and_far(index);
        TemporalBsp::Node& node = temporal_.nodes[index];
        if (near != no_index) {
            bring(near, start, ask);
            node.earliest_s = std::min(node.earliest_s, temporal_.nodes[near].earliest_s);
            start += tree_.nodes[near].subtree_faces;
        }
        if (far != no_index) {
            bring(far, start + tree_.nodes[index].own_faces, ask);
            node.earliest_s = std::min(node.earliest_s, temporal_.nodes[far].earliest_s);
        }
    }

    void run(Index first_face, Index count, Index start) {
        for (Index k = 0; k < count; ++k) temporal_.order[start + k] = {first_face + k, k == 0};
    }

    /// Finds the side of a plane and until when it holds.
    void look(TemporalBsp::Node& node, const Plane& plane) const {
        const double above = plane.above(place_), reach = reach_across(plane);
        node.side = above >= reach ? PlaneSide::front : above <= -reach ? PlaneSide::back : PlaneSide::across;
        double until = never;
        if (turns_) {
            const double room = std::abs(std::abs(above) - reach);
            // A plane just reached would be asked again and again at the same time; the clock moves on.
            if (greatest_speed_ > 0) until = time_s_ + room / greatest_speed_;
        } else if (const double speed = glm::dot(plane.normal, velocity_); speed != 0) {
            until = time_s_ + (border_ahead(node.side, speed, reach) - above) / speed;
        }
        // A border left behind lies in the past.
        if (!turns_ && until < time_s_) until = never;
        node.change_s = std::min(until, view_.end_s);
    }

    /// How far the viewpoint reaches to both sides along a plane's normal.
    [[nodiscard]] double reach_across(const Plane& plane) const {
        if (turns_) return viewpoint_.radius_m;
        const Vec3d normal = glm::abs(view_.in_world(plane.normal));
        return std::min(viewpoint_.radius_m, glm::dot(normal, viewpoint_.half_extent_m));
    }

    /// The distance at which a viewpoint on a side, moving with a speed, comes to another side.
    static double border_ahead(PlaneSide side, double speed, double reach) {
        if (side == PlaneSide::front) return reach;
        if (side == PlaneSide::back) return -reach;
        return speed > 0 ? reach : -reach;
    }

    TemporalBsp& temporal_;
    const BspTree& tree_;
    const SteadyView& view_;
    const Viewpoint& viewpoint_;
    double time_s_;
    Vec3d place_;
    bool turns_;
    Vec3d velocity_;
    double greatest_speed_;
};

}  // namespace

double TemporalBsp::next_change_s() const {
    return nodes.empty() ? never : nodes.front().earliest_s;
}

TemporalBsp make_temporal_bsp(const BspTree& tree, std::span<const SteadyView> views,
                              const Viewpoint& viewpoint, double time_s) {
    TemporalBsp temporal;
    temporal.since_s = time_s;
    if (tree.nodes.empty()) return temporal;
    temporal.nodes.resize(tree.nodes.size());
    temporal.order.resize(tree.faces.size());
    Visit visit(temporal, tree, view_at(views, time_s), viewpoint, time_s);
    visit.bring(0, 0, Visit::Ask::all);
    visit.write(0, 0);
    return temporal;
}

TreeWork update(TemporalBsp& temporal, const BspTree& tree, std::span<const SteadyView> views,
                const Viewpoint& viewpoint, double time_s) {
    if (time_s < temporal.since_s) {
        temporal = make_temporal_bsp(tree, views, viewpoint, time_s);
        return {tree.nodes.size(), 0};
    }
    if (temporal.next_change_s() > time_s) return {};
    temporal.since_s = time_s;
    Visit visit(temporal, tree, view_at(views, time_s), viewpoint, time_s);
    visit.bring(0, 0, Visit::Ask::where_due);
    return visit.work;
}

}  // namespace afterglow
