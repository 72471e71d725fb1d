#pragma once

#include <vector>

#include "solver/image/item_buffer.h"
#include "solver/visibility/temporal_bsp.h"
#include "solver/visibility/temporal_graph.h"

namespace afterglow {

/// One face of the scene as an observer meets it.
struct SortedFace {
    Index body = 0;
    Index triangle = 0;
    Index object = 0;  ///< of ObserverSight: an actor, or one surface of the furniture
};

/// What the observer knows of a scene: every actor and every surface of the furniture is an object with a
/// temporal BSP tree; the objects stand in a temporal graph seen from wherever the camera is. Trees and graph
/// hold for all times; order and signs stand for one.
struct ObserverSight {
    struct Object {
        Index body = 0;
        BspTree tree;
        TemporalBsp temporal;
    };
    std::vector<Object> objects;
    std::vector<std::vector<SteadyView>> views;  ///< by body: how the camera moves as seen from it
    TemporalGraph graph;
    double time_s = 0;  ///< what order and signs stand for
};

struct ObserverConfig {
    /// How finely the extents of objects and camera follow time, seconds, and at most how many times it is
    /// halved: every pair of objects is compared in each slice.
    double slice_s = 0.25;
    int most_levels = 5;
    /// Grows all extents, metres: poses are interpolated in single precision.
    float slack_m = 1e-4F;
};

/// Sees the world at time 0 through a camera on a path. The surfaces must be those of the world.
/// Thread-safety: pure.
ObserverSight make_observer_sight(const World& world, const Surfaces& surfaces, const Path& camera,
                                  const ObserverConfig& config = {});

/// What an update had to do.
struct ObserverWork {
    GraphWork graph;
    TreeWork trees;
};

/// Brings graph and trees to another time. Where neither the camera nor anything else has come to an event,
/// nothing is done.
ObserverWork update(ObserverSight& sight, double time_s);

/// All faces front to back; each once, where its nearest part stands. Faces that hide each other in a circle
/// stand together in no particular order.
std::vector<SortedFace> sorted_faces(const ObserverSight& sight);

/// The faces where they stand at a time.
std::vector<PlacedTriangle> placed(const World& world, const std::vector<SortedFace>& faces, double time_s);

/// The faces that cover at least one pixel's centre, front to back: what is left to be shaded.
std::vector<SortedFace> visible_faces(const std::vector<SortedFace>& faces, const ItemBuffer& buffer);

}  // namespace afterglow
