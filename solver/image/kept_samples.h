#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "solver/image/camera_samples.h"
#include "solver/image/picture_tiles.h"
#include "solver/image/pixel_sum.h"
#include "solver/image/seen_point.h"
#include "solver/image/shadow_lines.h"
#include "solver/image/shadow_region.h"

namespace afterglow {

/// A shadow line that gets past the furniture, from its sample's position on.
struct KeptLine {
    Vec3 direction{0};
    float far_m = 0;  ///< as in ShadowLinePacket, likewise
    Rgb gain{0};
};

/// One camera sample of a picture that is kept: what it would show without actors, which stays, and how that
/// is lit now. Its ray follows from the pixel and is not stored.
struct KeptSample {
    enum class Known : std::uint8_t {
        nothing,  ///< never looked at
        hit,      ///< which surface of the furniture it meets; an actor has covered it ever since
        light,    ///< all below
    };
    /// Shadow lines whose way past the furniture is remembered; those beyond are traced anew.
    static constexpr std::size_t remembered_lines = 32;

    Rgb direct_now{0};          ///< irradiance by its shadow lines, W/m²
    Index on_actor = no_index;  ///< while its tile is being updated: what it meets there, if an actor

    float distance = 0;  ///< to the furniture, metres
    Index triangle = no_index;
    float u = 0, v = 0;  ///< as in Hit
    Vec3 position{0};    ///< as in SeenPoint, likewise
    Rgb reflectance{0};
    Rgb direct{0};                ///< irradiance by its shadow lines past the furniture, W/m²
    std::uint32_t unblocked = 0;  ///< bit i: shadow line i brings light past the furniture
    std::uint32_t first_weight = 0;
    Index first_line =
        no_index;  ///< where the lines that bring light stand; no_index: not looked at again yet
    std::uint8_t weights = 0;
    Side side = Side::front;
    Known known = Known::nothing;
    bool emits = false;  ///< of itself, by its material

    [[nodiscard]] Hit hit() const {
        return {triangle == no_index ? no_index : furniture, triangle, side, distance, u, v};
    }
};

/// What a pixel's samples add up to; its shares stand in its tile's, those of the first samples before
/// others.
struct KeptPixel {
    PixelTotals first, further;
    std::uint32_t begin = 0, first_end = 0, end = 0;
};

/// The samples of a tile's pixels; pixels row by row, those outside the picture unused.
struct KeptTile {
    static constexpr std::size_t pixels = PictureTiles::edge * PictureTiles::edge;

    std::array<KeptPixel, pixels> sums;
    std::vector<PatchShare> shares;             ///< of all pixels
    std::vector<KeptSample> first;              ///< of all pixels, pixel by pixel
    std::vector<KeptSample> further;            ///< of those that ever were noisy
    std::array<Index, pixels> first_further{};  ///< where a pixel's begin; no_index: none
    std::array<bool, pixels> shows_further{};   ///< whether they are in the picture, and up to date
    std::vector<PatchWeight> weights;           ///< of all samples
    std::vector<Index> patches;                 ///< that `weights` name, rising
    std::vector<KeptLine> lines;                ///< of samples that actors' shadows may reach
    Box positions;                              ///< of samples that take light

    KeptTile() { first_further.fill(no_index); }
    /// After samples have become known.
    void note_patches();
    [[nodiscard]] std::size_t bytes() const;
};

/// Actors as one tile's samples may see them.
struct TileActors {
    bool may_cover = false;                    ///< camera rays may meet one
    std::vector<const ShadowRegion*> shadows;  ///< that may reach its points
};

/// A sample to be looked at.
struct SampleTask {
    KeptSample* sample = nullptr;
    CameraSample which;
};

/// Brings samples up to date, sixteen at a time: each is traced against the furniture once, and from then on
/// against the actors only, where these may come between. One thread at a time.
class SampleUpdater {
  public:
    SampleUpdater(const LitWorld& lit, const CameraSamples& camera, const ShadowLines& lines);

    /// To be called before another tile's samples are updated.
    void begin_tile() { actor_points_.clear(); }
    /// What the samples see now, whatever it was. Some are done only by `finish`.
    void update(KeptTile& tile, const TileActors& actors, std::span<const SampleTask> tasks);
    /// To be called before what has been updated is read, with the tile that was.
    void finish(KeptTile& tile);
    /// What a sample gives to its pixel: one that has been updated since its tile began, or that sees the
    /// furniture as it did before.
    [[nodiscard]] SampleLight light(const KeptTile& tile, const KeptSample& sample) const;
    [[nodiscard]] std::uint64_t rays_traced() const { return rays_traced_; }

  private:
    static constexpr std::size_t lanes = 16;
    /// What is known of a point's shadow lines.
    enum class Lines { unknown, past_furniture, none_kept };
    /// A point whose shadow lines are to be traced.
    struct Point {
        SampleTask task;
        Vec3 position{0}, normal{0};
        bool in_reach = true;  ///< of actors' shadows
    };
    /// What a sample meets on an actor.
    struct ActorPoint {
        SeenPoint seen;
        Rgb direct{0};
    };
    /// Points that wait until sixteen can be traced together, all of one kind.
    struct Queue {
        Lines lines = Lines::unknown;
        std::array<Point, lanes> points;
        std::size_t count = 0;
    };
    void meet(KeptTile& tile, const TileActors& actors, std::span<const SampleTask> tasks);
    void meet_furniture(std::span<const SampleTask> tasks, const RayPacket& rays);
    void look_at_furniture(KeptTile& tile, const TileActors& actors, const SampleTask& task, const Ray& ray);
    void recall(KeptTile& tile, const TileActors& actors, const SampleTask& task);
    void look_at_actor(KeptTile& tile, const SampleTask& task, const Ray& ray, const Hit& hit);

    void add(KeptTile& tile, Queue& queue, const Point& point);
    void flush(KeptTile& tile, Queue& queue);
    void make_room_for_lines(KeptTile& tile, const Queue& queue) const;
    void add_lines(const KeptTile& tile, KeptSample& sample);
    void flush_lines();
    [[nodiscard]] std::uint32_t worth_tracing(const Queue& queue, std::size_t i) const;
    std::uint32_t occluded(const ShadowLinePacket& lines, Scope scope);
    std::uint32_t occluded_by_actors(const Queue& queue, const ShadowLinePacket& all, std::uint32_t among);

    const LitWorld& lit_;
    const CameraSamples& camera_;
    const ShadowLines& lines_;
    Queue on_furniture_, on_actors_, remembered_;
    ShadowLinePacket kept_lines_{};  // that wait likewise, of any samples
    std::array<KeptSample*, lanes> sample_of_line_{};
    ShadowPacket shadows_;
    std::vector<ActorPoint> actor_points_;  // of the tile at hand
    std::uint64_t rays_traced_ = 0;
};

}  // namespace afterglow
