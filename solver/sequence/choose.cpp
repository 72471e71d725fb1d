#include "solver/sequence/choose.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "solver/base/error.h"
#include "solver/visibility/events.h"

namespace afterglow {

namespace {

// Looking ahead pays from about this many frames on (solver/visibility/README.md).
constexpr int frames_worth_events = 8;

// And up to about this many faces of all that moves.
constexpr std::size_t faces_worth_events = 1000;

// Where so much of all surface moves, most lines begin or end on what does: tracing all of them is quicker
// than finding out which ones may stay (tests/bench/ASSESSMENT.md).
constexpr double share_worth_keeping = 1.0 / 3;

bool moves(const Body& body) {
    return std::any_of(body.path.keys.begin(), body.path.keys.end(),
                       [&](const Key<Pose>& key) { return key.value != body.path.keys.front().value; });
}

double area_m2(const Body& body) {
    double sum = 0;
    for (const Triangle& triangle : body.triangles) {
        const auto& v = triangle.vertices;
        const Vec3 a = body.positions[v[0]];
        sum += 0.5 * static_cast<double>(
                         glm::length(glm::cross(body.positions[v[1]] - a, body.positions[v[2]] - a)));
    }
    return sum;
}

/// Which share of all surface moves.
double moving_share(const World& world) {
    double moving = 0, all = 0;
    for (const Body& body : world.bodies) {
        const double area = area_m2(body);
        all += area;
        moving += moves(body) ? area : 0;
    }
    return all > 0 ? moving / all : 0;
}

/// Where nothing is worth being found ahead: what is kept from frame to frame, if anything.
MethodChoice choose_by_share(const World& world, const std::string& why_not_events) {
    const double share = moving_share(world);
    if (share < share_worth_keeping) return {Visibility::back_buffer, Solution::residual, why_not_events};
    return {Visibility::retrace, Solution::progressive,
            why_not_events + "; and " + std::to_string(static_cast<int>(std::lround(100 * share))) +
                " % of all surface moves, so that keeping the rest would not pay either"};
}

MethodChoice choose_freely(const World& world, int frames) {
    // The first body is the furniture.
    const auto movers = std::count_if(world.bodies.begin() + 1, world.bodies.end(), moves);
    if (frames == 1)
        return {Visibility::retrace, Solution::progressive, "a single frame has nothing to reuse"};
    if (movers == 0)
        return {Visibility::back_buffer, Solution::residual,
                "nothing moves, so all lines are traced once and no temporal structure is built"};
    const auto faces = std::accumulate(
        world.bodies.begin() + 1, world.bodies.end(), std::size_t{0},
        [](std::size_t sum, const Body& body) { return sum + (moves(body) ? body.triangles.size() : 0); });
    const std::string actors = std::to_string(movers) + (movers == 1 ? " actor" : " actors");
    if (frames > 0 && frames < frames_worth_events)
        return choose_by_share(
            world, actors + " but few frames: looking ahead for events would cost more than it saves");
    if (faces > faces_worth_events)
        return choose_by_share(
            world,
            actors + " of " + std::to_string(faces) +
                " faces: looking ahead for events takes them one by one, tracing frame by frame does not");
    return {Visibility::events, Solution::residual,
            actors + ": what lines come to see is found ahead, and only what changes is solved"};
}

}  // namespace

MethodChoice choose_method(const World& world, const SequenceConfig& config) {
    const bool both_named =
        config.visibility != Visibility::automatic && config.solution != Solution::automatic;
    if (both_named) return {config.visibility, config.solution, {}};
    MethodChoice choice = choose_freely(world, config.frames_expected);
    if (config.visibility != Visibility::automatic) choice.visibility = config.visibility;
    if (config.solution != Solution::automatic) choice.solution = config.solution;
    return choice;
}

std::unique_ptr<VisibilityStrategy> make_strategy(Visibility visibility, const World& world,
                                                  const FrameClock& clock) {
    switch (visibility) {
        case Visibility::automatic:
            break;
        case Visibility::retrace:
            return make_retrace();
        case Visibility::back_buffer:
            return make_back_buffer(world, clock);
        case Visibility::temporal_graph:
            return make_temporal_graph(world, clock);
        case Visibility::events:
            return make_events(world, clock);
    }
    throw Error(ErrorKind::invalid_input, "visibility", "is not one of the strategies there are");
}

}  // namespace afterglow
