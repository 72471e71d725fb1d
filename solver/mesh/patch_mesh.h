#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "solver/base/context.h"
#include "solver/mesh/cell_tree.h"
#include "solver/mesh/surface.h"

namespace afterglow {

/// A surface has two sides and both reflect.
enum class Side : std::uint8_t { front = 0, back = 1 };

/// Patches that stand together in memory: 16 neighbours share the directions of their sight lines.
inline constexpr Index block_size = 16;

/// Part of a patch that is not a whole rectangle: a triangle with its corner and two edges.
struct Fragment {
    Vec3 corner, edge_a, edge_b;
    Vec3 normal;             ///< unit, on the patch's side
    float cumulative_share;  ///< of the patch's area up to and including this fragment, the last is 1
};

/// A point of a patch and the normal there, in the body's frame.
struct PatchPoint {
    Vec3 position, normal;
};

/// A patch before it has a number; normals are those of the front. All geometry is in the body's frame.
struct PatchShape {
    float area_m2 = 0;
    Vec3 centre{0}, normal{0};
    Vec3 origin{0}, edge_u{0}, edge_v{0};  ///< a rectangle: all of it, or around its fragments
    std::vector<Fragment> fragments;       ///< where it is no rectangle
    Rgb texture_mean{1};

    /// As PatchMesh::point_on.
    [[nodiscard]] PatchPoint point_on(float s, float t) const;
};

/// How one surface is divided. Flat: a grid of cells in its plane. Curved: clusters of triangles.
struct SurfaceGrid {
    Vec3 origin{0};  ///< corner of cell (0, 0), body frame
    Vec3 per_metre_u{
        0};  ///< cells along u in one metre, as a vector: dot with an offset gives the cell coordinate
    Vec3 per_metre_v{0};
    int cells_u = 0, cells_v = 0;  ///< 0 for curved surfaces

    /// Cell coordinates of a point.
    [[nodiscard]] Vec2 cell_at(const Vec3& point) const {
        const Vec3 d = point - origin;
        return {glm::dot(d, per_metre_u), glm::dot(d, per_metre_v)};
    }
};

/// The patches of a world, as arrays over patches. Static patches come first, then those of each actor in
/// turn; neighbours stand together, so that block k of a body is its patches 16k … 16k+15. All geometry is in
/// the body's frame.
struct PatchMesh {
    std::vector<float> area_m2;
    std::vector<Vec3> centre;
    std::vector<Vec3> normal;  ///< unit, of the patch's own side; the mean where curved
    std::vector<Index> body;
    std::vector<Index> surface;
    std::vector<Side> side;
    std::vector<Rgb> texture_mean;            ///< mean texture colour over the patch, 1 without a texture
    std::vector<Vec3> origin;                 ///< of a whole rectangle, or of one around the rest
    std::vector<Vec3> edge_u, edge_v;         ///< likewise
    std::vector<std::size_t> first_fragment;  ///< size patches + 1; whole rectangles have none
    std::vector<Fragment> fragments;

    Surfaces surfaces;
    float lift_m = 0;                            ///< see lift_for
    std::vector<SurfaceGrid> grids;              ///< by surface
    std::vector<std::array<CellTree, 2>> trees;  ///< [surface][side] of flat ones: patches; empty where none
    std::vector<std::array<std::vector<Index>, 2>>
        patch_of_triangle;                   ///< [body][side][triangle]; curved surfaces only
    std::vector<Index> first_patch_of_body;  ///< size bodies + 1

    [[nodiscard]] Index size() const { return static_cast<Index>(area_m2.size()); }
    [[nodiscard]] Index static_size() const { return first_patch_of_body[1]; }
    [[nodiscard]] Index material(Index patch) const { return surfaces.list[surface[patch]].material; }

    /// The patch at a point of a triangle's side, or no_index on sides without patches. `position` in the
    /// body's frame.
    [[nodiscard]] Index patch_at(Index body_index, Index triangle, Side on, const Vec3& position) const;

    /// Where a ray was just before it met a surface: far enough off it that nothing which touches the surface
    /// can lie between the two places but what the ray has passed. `direction` unit, all in the body's frame.
    [[nodiscard]] Vec3 just_before(Index on_surface, const Vec3& position, const Vec3& direction) const;

    /// Whether something that stands on a surface's side divides a place where a ray met it from where the
    /// ray was just before: the ray slipped through where the two touch, and no patch can be told.
    [[nodiscard]] bool slipped(Index on_surface, Side on, const Vec3& position, const Vec3& direction) const;

    /// Whether a patch is a rectangle.
    [[nodiscard]] bool is_whole(Index patch) const {
        return first_fragment[patch] == first_fragment[patch + 1];
    }
    /// The point that (s, t) in [0,1)² stands for; uniform over the area but for what touches a cut.
    [[nodiscard]] PatchPoint point_on(Index patch, float s, float t) const {
        // Asked for every line; most patches are whole.
        if (!is_whole(patch)) return point_on_part(patch, s, t);
        return {origin[patch] + s * edge_u[patch] + t * edge_v[patch], normal[patch]};
    }

  private:
    [[nodiscard]] PatchPoint point_on_part(Index patch, float s, float t) const;
};

/// Which sides of which surfaces get patches.
using SideMask = std::vector<std::array<bool, 2>>;  ///< [surface][side]

/// Whether a part of a body's side is too coarse a patch. Called from several threads; the same answer for
/// the same part.
using CoarsenessTest = std::function<bool(const PatchShape& part, Index body, Side side)>;

struct MeshConfig {
    float patch_size_m = 0.2F;  ///< target edge; large faces are divided into cells no longer than this
    float finest_m = 0;         ///< no cell is halved to an edge below it
    CoarsenessTest is_too_coarse = {};  ///< which cells are; empty: none
};

/// Divides the wanted sides of all surfaces into patches. Same result for any number of threads.
/// Errors: too_large past 4 million patches, naming the patch size; cancelled. Thread-safety: pure.
PatchMesh make_patches(const World& world, Surfaces surfaces, const SideMask& wanted,
                       const MeshConfig& config, const Context& context = Context(1));

}  // namespace afterglow
