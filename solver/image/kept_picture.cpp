#include "solver/image/kept_picture.h"

#include <algorithm>
#include <atomic>

#include "solver/base/prefetch.h"
#include "solver/image/picture_changes.h"

namespace afterglow {

namespace {

constexpr std::size_t tiles_per_chunk = 48;

/// Of noisy pixels besides those of every pixel.
std::size_t further_count(const PictureConfig& config) {
    return most_samples(config) - static_cast<std::size_t>(config.samples_per_pixel);
}

/// Brings one tile after the other up to date.
class TileUpdater {
  public:
    TileUpdater(KeptPictureState& state, const LitWorld& lit, const PictureChanges& changes,
                const CameraSamples& camera, const ShadowLines& lines)
        : state_(state),
          lit_(lit),
          changes_(changes),
          samples_(lit, camera, lines),
          few_(static_cast<std::size_t>(state.config.samples_per_pixel)),
          more_(further_count(state.config)) {}

    void update(Index tile) {
        KeptTile& kept = state_.tiles[tile];
        if (!changes_.touch(tile, kept)) return;
        samples_.begin_tile();
        find_actors(tile, kept);
        const bool weighed = changes_.weigh_otherwise(kept);
        // What a sample met on an actor is not kept: where one is seen and sums change, all are looked at.
        look_at_all_ = changes_.everything || changes_.changed_cover[tile] != 0 ||
                       (actors_.may_cover && (weighed || !changed_shadows_.empty()));
        new_first_.fill(weighed);
        new_further_.fill(weighed);
        const std::size_t weights = kept.weights.size();
        update_first(tile, kept);
        update_further(tile, kept);
        put_together(kept);
        for_pixels(tile, [&](std::size_t pixel, int x, int y) { light(kept, pixel, x, y); });
        if (kept.weights.size() != weights) kept.note_patches();
    }
    [[nodiscard]] std::uint64_t rays_traced() const { return samples_.rays_traced(); }

    std::uint64_t samples = 0, pixels = 0;  ///< looked at, and lit, so far

  private:
    using PerPixel = std::array<bool, KeptTile::pixels>;

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

    /// Whether what any sample of the tile gives may be another; most tiles only have other light from
    /// patches.
    [[nodiscard]] bool may_touch_samples() const { return look_at_all_ || !changed_shadows_.empty(); }
    /// Whether what a sample gives may be another, of those that have been looked at.
    [[nodiscard]] bool is_touched(const KeptSample& sample) const {
        if (look_at_all_) return true;
        return sample.known == KeptSample::Known::light &&
               std::any_of(changed_shadows_.begin(), changed_shadows_.end(),
                           [&](const ShadowRegion* region) { return region->holds(sample.position); });
    }

    void update_first(Index tile, KeptTile& kept) {
        if (kept.first.empty()) kept.first.resize(KeptTile::pixels * few_);
        for_pixels(tile, [&](std::size_t pixel, int x, int y) {
            if (!may_touch_samples()) return;
            for (std::size_t k = 0; k < few_; ++k) {
                KeptSample& sample = kept.first[pixel * few_ + k];
                if (!is_touched(sample)) continue;
                new_first_[pixel] = true;
                tasks_.push_back({&sample, {x, y, k}});
            }
        });
        finish(kept);
        for_pixels(tile, [&](std::size_t pixel, int, int) {
            if (!new_first_[pixel]) return;
            add_up(kept, std::span(kept.first).subspan(pixel * few_, few_), first_[pixel]);
            kept.sums[pixel].first = first_[pixel].totals();
        });
    }

    /// The further samples of pixels whose first ones ask for them.
    void update_further(Index tile, KeptTile& kept) {
        PerPixel outdated{};
        TileTotals totals{};
        for_pixels(tile, [&](std::size_t pixel, int, int) { totals[pixel] = &kept.sums[pixel].first; });
        for_pixels(tile, [&](std::size_t pixel, int, int) {
            first_light_[pixel] = light_of(first_shares(kept, pixel), lit_.irradiance);
            const PixelTotals& first = kept.sums[pixel].first;
            const bool noisy = more_ > 0 && (first.is_noisy(state_.config.noise, first_light_[pixel]) ||
                                             may_miss_light(totals, pixel));
            outdated[pixel] = noisy && !kept.shows_further[pixel];
            if (noisy != kept.shows_further[pixel]) new_further_[pixel] = true;
            kept.shows_further[pixel] = noisy;
            if (!noisy || kept.first_further[pixel] != no_index) return;
            kept.first_further[pixel] = static_cast<Index>(kept.further.size());
            kept.further.resize(kept.further.size() + more_);
        });
        // What is looked at first or again may lie where none of the tile's other samples do.
        const bool shows_more = std::find(outdated.begin(), outdated.end(), true) != outdated.end();
        if (shows_more) take_all_shadows();
        for_pixels(tile, [&](std::size_t pixel, int x, int y) {
            if (!kept.shows_further[pixel] || (!outdated[pixel] && !may_touch_samples())) return;
            for (std::size_t k = 0; k < more_; ++k) {
                KeptSample& sample = kept.further[kept.first_further[pixel] + k];
                if (!outdated[pixel] && !is_touched(sample)) continue;
                new_further_[pixel] = true;
                tasks_.push_back({&sample, {x, y, few_ + k}});
            }
        });
        finish(kept);
        for_pixels(tile, [&](std::size_t pixel, int, int) {
            if (!new_further_[pixel]) return;
            further_[pixel].clear();
            if (kept.shows_further[pixel])
                add_up(kept, std::span(kept.further).subspan(kept.first_further[pixel], more_),
                       further_[pixel]);
            kept.sums[pixel].further = further_[pixel].totals();
        });
    }

    void finish(KeptTile& kept) {
        samples += tasks_.size();
        samples_.update(kept, actors_, tasks_);
        samples_.finish(kept);
        tasks_.clear();
    }

    void add_up(const KeptTile& kept, std::span<const KeptSample> of, PixelSum& sum) const {
        sum.clear();
        for (const KeptSample& sample : of) sum.add(samples_.light(kept, sample), lit_.confidence);
    }

    [[nodiscard]] std::span<const PatchShare> first_shares(const KeptTile& kept, std::size_t pixel) const {
        if (new_first_[pixel]) return first_[pixel].patches();
        const KeptPixel& sums = kept.sums[pixel];
        return std::span(kept.shares).subspan(sums.begin, sums.first_end - sums.begin);
    }
    [[nodiscard]] std::span<const PatchShare> further_shares(const KeptTile& kept, std::size_t pixel) const {
        if (new_further_[pixel]) return further_[pixel].patches();
        const KeptPixel& sums = kept.sums[pixel];
        return std::span(kept.shares).subspan(sums.first_end, sums.end - sums.first_end);
    }

    /// The tile's shares, where some are new.
    void put_together(KeptTile& kept) {
        const auto is_set = [](bool is) { return is; };
        if (std::none_of(new_first_.begin(), new_first_.end(), is_set) &&
            std::none_of(new_further_.begin(), new_further_.end(), is_set))
            return;
        shares_.clear();
        for (std::size_t pixel = 0; pixel < KeptTile::pixels; ++pixel) {
            const auto first = first_shares(kept, pixel), further = further_shares(kept, pixel);
            KeptPixel& sums = kept.sums[pixel];
            sums.begin = static_cast<std::uint32_t>(shares_.size());
            shares_.insert(shares_.end(), first.begin(), first.end());
            sums.first_end = static_cast<std::uint32_t>(shares_.size());
            shares_.insert(shares_.end(), further.begin(), further.end());
            sums.end = static_cast<std::uint32_t>(shares_.size());
        }
        kept.shares.assign(shares_.begin(), shares_.end());
        new_first_.fill(false);
        new_further_.fill(false);
    }

    void light(const KeptTile& kept, std::size_t pixel, int x, int y) {
        ++pixels;
        const KeptPixel& sums = kept.sums[pixel];
        state_.picture.at(x, y) = mean_of(sums.first, first_light_[pixel], sums.further,
                                          light_of(further_shares(kept, pixel), lit_.irradiance));
    }

    KeptPictureState& state_;
    const LitWorld& lit_;
    const PictureChanges& changes_;
    SampleUpdater samples_;
    TileActors actors_;
    std::vector<const ShadowRegion*> changed_shadows_;
    std::vector<SampleTask> tasks_;
    std::size_t few_, more_;  // samples of every pixel, and of noisy ones besides
    // Of the tile at hand.
    bool look_at_all_ = false;
    PerPixel new_first_{}, new_further_{};  // sums that are made anew
    std::array<PixelSum, KeptTile::pixels> first_, further_;
    std::array<Rgb, KeptTile::pixels> first_light_{};  // by patches
    std::vector<PatchShare> shares_;
};

/// What every tile is read for whose light changed; the rest is for the few whose samples are looked at.
void ask_for(const KeptTile& tile) {
    prefetch<KeptPixel>(tile.sums);
    prefetch<PatchShare>(tile.shares);
    prefetch<Index>(tile.patches);
}

/// All that is kept, so that memory is known before it is asked for: as many pixels are noisy as usual.
bool fits(const CameraView& view, const KeptPictureConfig& config) {
    constexpr double noisy_share = 0.4, bytes_per_sample = 160;
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
        const CameraSamples camera(state.view, config.picture);
        const ShadowLines lines(shown, config.picture);
        std::atomic<std::uint64_t> rays = 0, samples = 0, pixels = 0;
        context.for_chunks(state.tiles.size(), tiles_per_chunk, [&](std::size_t begin, std::size_t end) {
            TileUpdater updater(state, shown, changes, camera, lines);
            for (std::size_t t = begin; t < end; ++t) {
                if (t + 1 < end) ask_for(state.tiles[t + 1]);
                updater.update(static_cast<Index>(t));
            }
            rays += updater.rays_traced();
            samples += updater.samples;
            pixels += updater.pixels;
        });
        update.rays_traced = rays;
        update.samples = samples;
        update.pixels = pixels;
    }
    state.whole = true;
    return update;
}

}  // namespace afterglow
