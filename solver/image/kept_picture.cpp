#include "solver/image/kept_picture.h"

#include <algorithm>
#include <atomic>

#include "solver/image/picture_changes.h"
#include "solver/image/pixel_tally.h"

namespace afterglow {

namespace {

constexpr std::size_t tiles_per_chunk = 16;

/// Of noisy pixels besides those of every pixel.
std::size_t further_count(const PictureConfig& config) {
    return most_samples(config) - static_cast<std::size_t>(config.samples_per_pixel);
}

/// Brings one tile after the other up to date.
class TileUpdater {
  public:
    TileUpdater(KeptPictureState& state, const LitWorld& lit, const PictureChanges& changes,
                const SobolPoints& camera_points, const ShadowLines& lines)
        : state_(state),
          changes_(changes),
          samples_(state.view, lit, state.config, camera_points, lines),
          few_(static_cast<std::size_t>(state.config.samples_per_pixel)),
          more_(further_count(state.config)) {}

    void update(Index tile) {
        KeptTile& kept = state_.tiles[tile];
        if (!changes_.touch(tile, kept)) return;
        ++changed_tiles;
        find_actors(tile, kept);
        const std::size_t weights = kept.weights.size();
        changed_.fill(false);
        update_first(tile, kept);
        update_further(tile, kept);
        for_pixels(tile, [&](std::size_t pixel, int x, int y) {
            if (changed_[pixel]) state_.picture.at(x, y) = tally_of(kept, pixel).mean();
        });
        if (kept.weights.size() != weights) kept.note_patches();
    }
    [[nodiscard]] std::uint64_t rays_traced() const { return samples_.rays_traced(); }

    std::uint64_t samples = 0, changed_tiles = 0;  ///< looked at so far

  private:
    template <class Visit>
    void for_pixels(Index tile, const Visit& visit) const {
        const int left = state_.tiling.left(tile), top = state_.tiling.top(tile);
        for (std::size_t pixel = 0; pixel < KeptTile::pixels; ++pixel) {
            const int x = left + static_cast<int>(pixel) % PictureTiles::edge;
            const int y = top + static_cast<int>(pixel) / PictureTiles::edge;
            if (x < state_.view.width && y < state_.view.height) visit(pixel, x, y);
        }
    }

    void find_actors(Index tile, const KeptTile& kept) {
        const auto find = [&](const std::vector<ShadowRegion>& all, std::vector<const ShadowRegion*>& here) {
            here.clear();
            for (const ShadowRegion& region : all)
                if (region.meets(kept.positions)) here.push_back(&region);
        };
        find(changes_.changed_shadows, changed_shadows_);
        actors_.may_cover = changes_.covered[tile] != 0;
        // Points that come to light only now can be anywhere.
        if (changes_.everything || changes_.changed_cover[tile] != 0)
            take_all_shadows();
        else
            find(changes_.shadows, actors_.shadows);
    }

    void take_all_shadows() {
        actors_.shadows.clear();
        for (const ShadowRegion& region : changes_.shadows) actors_.shadows.push_back(&region);
    }

    void update_first(Index tile, KeptTile& kept) {
        if (kept.first.empty()) kept.first.resize(KeptTile::pixels * few_);
        for_pixels(tile, [&](std::size_t pixel, int x, int y) {
            for (std::size_t k = 0; k < few_; ++k) {
                KeptSample& sample = kept.first[pixel * few_ + k];
                if (changes_.touch(tile, kept, sample, changed_shadows_))
                    look_again(tile, kept, pixel, {&sample, x, y, k});
            }
        });
        finish(kept);
    }

    /// The further samples of pixels whose first ones ask for them.
    void update_further(Index tile, KeptTile& kept) {
        std::array<bool, KeptTile::pixels> outdated{};
        const std::size_t before = kept.further.size();
        for_pixels(tile, [&](std::size_t pixel, int, int) {
            if (!changed_[pixel]) return;
            const bool noisy = more_ > 0 && first_tally(kept, pixel).is_noisy(state_.config.noise);
            outdated[pixel] = noisy && !kept.shows_further[pixel];
            kept.shows_further[pixel] = noisy;
            if (!noisy || kept.first_further[pixel] != no_index) return;
            kept.first_further[pixel] = static_cast<Index>(kept.further.size());
            kept.further.resize(kept.further.size() + more_);
        });
        if (kept.further.size() != before) take_all_shadows();
        for_pixels(tile, [&](std::size_t pixel, int x, int y) {
            if (!kept.shows_further[pixel]) return;
            for (std::size_t k = 0; k < more_; ++k) {
                KeptSample& sample = kept.further[kept.first_further[pixel] + k];
                if (outdated[pixel] || changes_.touch(tile, kept, sample, changed_shadows_))
                    look_again(tile, kept, pixel, {&sample, x, y, few_ + k});
            }
        });
        finish(kept);
    }

    void look_again(Index tile, const KeptTile& kept, std::size_t pixel, const SampleTask& task) {
        changed_[pixel] = true;
        ++samples;
        const bool sees_furniture = !actors_.may_cover && changes_.changed_cover[tile] == 0;
        if (sees_furniture && task.sample->known == KeptSample::Known::light)
            samples_.relight(kept, actors_, task);
        else
            tasks_.push_back(task);
    }

    void finish(KeptTile& kept) {
        samples_.update(kept, actors_, tasks_);
        samples_.finish();
        tasks_.clear();
    }

    [[nodiscard]] PixelTally first_tally(const KeptTile& kept, std::size_t pixel) const {
        PixelTally tally;
        for (std::size_t k = 0; k < few_; ++k) {
            const KeptSample& sample = kept.first[pixel * few_ + k];
            tally.add(sample.radiance, sample.surface);
        }
        return tally;
    }

    [[nodiscard]] PixelTally tally_of(const KeptTile& kept, std::size_t pixel) const {
        PixelTally tally = first_tally(kept, pixel);
        if (!kept.shows_further[pixel]) return tally;
        for (std::size_t k = 0; k < more_; ++k) {
            const KeptSample& sample = kept.further[kept.first_further[pixel] + k];
            tally.add(sample.radiance, sample.surface);
        }
        return tally;
    }

    KeptPictureState& state_;
    const PictureChanges& changes_;
    SampleUpdater samples_;
    TileActors actors_;
    std::vector<const ShadowRegion*> changed_shadows_;
    std::vector<SampleTask> tasks_;
    std::size_t few_, more_;                        // samples of every pixel, and of noisy ones besides
    std::array<bool, KeptTile::pixels> changed_{};  // pixels of the tile at hand
};

/// All that is kept, so that memory is known before it is asked for: as many pixels are noisy as usual.
bool fits(const CameraView& view, const KeptPictureConfig& config) {
    constexpr double noisy_share = 0.4, bytes_per_sample = 130;
    const double samples =
        config.picture.samples_per_pixel + noisy_share * static_cast<double>(further_count(config.picture));
    return samples * bytes_per_sample * view.width * view.height <= static_cast<double>(config.most_bytes);
}

void begin(KeptPictureState& state, const CameraView& view, const PictureConfig& config) {
    state.whole = false;
    state.view = view;
    state.config = config;
    state.tiling = PictureTiles(view.width, view.height);
    state.picture = Picture(view.width, view.height);
    state.tiles.clear();
    state.tiles.resize(state.tiling.count());
}

}  // namespace

PictureUpdate step(KeptPictureState& state, const CameraView& view, const LitWorld& lit,
                   const KeptPictureConfig& config, const Context& context) {
    PictureUpdate update;
    if (!fits(view, config)) {
        state = {};
        update.anew = true;
        state.picture = render_picture(view, lit, config.picture, update.rays_traced, context);
        return update;
    }
    update.anew = !can_be_kept(state, view, lit, config.picture);
    if (update.anew) begin(state, view, config.picture);
    const PictureChanges changes = take_over(state, lit, config.tolerance);
    state.whole = false;
    if (changes.any()) {
        LitWorld shown = lit;
        shown.irradiance = state.irradiance;
        shown.confidence = state.confidence;
        const SobolPoints camera_points(most_samples(config.picture));
        const ShadowLines lines(shown, config.picture);
        std::atomic<std::uint64_t> rays = 0, samples = 0, tiles = 0;
        context.for_chunks(state.tiles.size(), tiles_per_chunk, [&](std::size_t begin, std::size_t end) {
            TileUpdater updater(state, shown, changes, camera_points, lines);
            for (std::size_t t = begin; t < end; ++t) updater.update(static_cast<Index>(t));
            rays += updater.rays_traced();
            samples += updater.samples;
            tiles += updater.changed_tiles;
        });
        update.rays_traced = rays;
        update.samples = samples;
        update.changed_tiles = tiles;
    }
    state.whole = true;
    return update;
}

}  // namespace afterglow
