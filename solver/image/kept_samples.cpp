#include "solver/image/kept_samples.h"

#include <algorithm>

#include "solver/image/seen_point.h"
#include "solver/image/surface_light.h"

namespace afterglow {

namespace {

Index surface_of(const LitWorld& lit, const KeptSample& sample) {
    if (sample.triangle == no_index) return no_index;
    return 2 * lit.mesh->surfaces.of_triangle[furniture][sample.triangle] + static_cast<Index>(sample.side);
}

Rgb emitted_by(const LitWorld& lit, const KeptSample& sample) {
    if (!sample.emits) return Rgb(0);
    if (sample.triangle == no_index) return lit.world->background;
    const Index material = lit.world->bodies[furniture].triangles[sample.triangle].material;
    return emitted_by(lit.materials[material], sample.side);
}

/// As Interpolation::value, to the bit.
Rgb interpolated(const LitWorld& lit, std::span<const PatchWeight> weights) {
    Rgb sum(0);
    float weight = 0;
    for (const PatchWeight& entry : weights) {
        const float w = entry.weight * lit.confidence[entry.patch];
        sum += w * lit.irradiance[entry.patch];
        weight += w;
    }
    return weight > 0 ? sum / weight : Rgb(0);
}

bool any_holds(const TileActors& actors, const Vec3& position) {
    return std::any_of(actors.shadows.begin(), actors.shadows.end(),
                       [&](const ShadowRegion* region) { return region->holds(position); });
}

}  // namespace

void KeptTile::note_patches() {
    patches.clear();
    for (const PatchWeight& entry : weights) patches.push_back(entry.patch);
    std::sort(patches.begin(), patches.end());
    patches.erase(std::unique(patches.begin(), patches.end()), patches.end());
    patches.shrink_to_fit();
}

std::size_t KeptTile::bytes() const {
    return sizeof(KeptTile) + (first.capacity() + further.capacity()) * sizeof(KeptSample) +
           weights.capacity() * sizeof(PatchWeight) + patches.capacity() * sizeof(Index);
}

SampleUpdater::SampleUpdater(const CameraView& view, const LitWorld& lit, const PictureConfig& config,
                             const SobolPoints& camera_points, const ShadowLines& lines)
    : view_(view), lit_(lit), config_(config), camera_(camera_points), lines_(lines) {
    on_actors_.lines = Lines::none_kept;
    remembered_.lines = Lines::past_furniture;
}

void SampleUpdater::update(KeptTile& tile, const TileActors& actors, std::span<const SampleTask> tasks) {
    for (std::size_t begin = 0; begin < tasks.size(); begin += lanes)
        meet(tile, actors, tasks.subspan(begin, std::min(lanes, tasks.size() - begin)));
}

void SampleUpdater::finish() {
    for (Queue* queue : {&on_furniture_, &on_actors_, &remembered_}) flush(*queue);
}

SampleNumber SampleUpdater::number_of(const SampleTask& task) const {
    const auto pixel = static_cast<std::uint64_t>(task.y) * static_cast<std::uint64_t>(view_.width) +
                       static_cast<std::uint64_t>(task.x);
    return {mixed(config_.seed, pixel), task.k};
}

Ray SampleUpdater::ray_of(const SampleTask& task) const {
    const Sample4 s = camera_.at(task.k, number_of(task).pixel_seed);
    return view_.ray(static_cast<float>(task.x) + s[0], static_cast<float>(task.y) + s[1]);
}

/// What up to sixteen samples meet: each goes on to a queue, or is done.
void SampleUpdater::meet(KeptTile& tile, const TileActors& actors, std::span<const SampleTask> tasks) {
    const bool all_known = std::all_of(tasks.begin(), tasks.end(), [](const SampleTask& t) {
        return t.sample->known == KeptSample::Known::light;
    });
    if (all_known && !actors.may_cover) {
        for (const SampleTask& task : tasks) recall(tile, actors, task);
        return;
    }
    RayPacket rays;
    rays.count = static_cast<Index>(tasks.size());
    for (std::size_t lane = 0; lane < tasks.size(); ++lane) rays.set(lane, ray_of(tasks[lane]));
    meet_furniture(tasks, rays);
    HitPacket hits{};
    if (actors.may_cover) {
        RayPacket up_to_furniture = rays;
        for (std::size_t lane = 0; lane < tasks.size(); ++lane)
            up_to_furniture.far[lane] = tasks[lane].sample->distance;
        lit_.caster->nearest(up_to_furniture, Scope::actors, hits);
        rays_traced_ += tasks.size();
    }
    for (std::size_t lane = 0; lane < tasks.size(); ++lane) {
        if (hits[lane].body != no_index)
            look_at_actor(tasks[lane], rays.ray(lane), hits[lane]);
        else if (tasks[lane].sample->known == KeptSample::Known::light)
            recall(tile, actors, tasks[lane]);
        else
            look_at_furniture(tile, actors, tasks[lane], rays.ray(lane));
    }
}

/// The background of samples that do not know it yet.
void SampleUpdater::meet_furniture(std::span<const SampleTask> tasks, const RayPacket& rays) {
    RayPacket unknown = rays;
    std::size_t count = 0;
    for (std::size_t lane = 0; lane < tasks.size(); ++lane) {
        const bool is_new = tasks[lane].sample->known == KeptSample::Known::nothing;
        if (!is_new) unknown.far[lane] = 0;
        count += is_new ? 1 : 0;
    }
    if (count == 0) return;
    HitPacket hits{};
    lit_.caster->nearest(unknown, Scope::static_geometry, hits);
    rays_traced_ += count;
    for (std::size_t lane = 0; lane < tasks.size(); ++lane) {
        KeptSample& sample = *tasks[lane].sample;
        if (sample.known != KeptSample::Known::nothing) continue;
        const Hit& hit = hits[lane];
        sample.triangle = hit.body == no_index ? no_index : hit.triangle;
        sample.side = hit.side;
        sample.distance = hit.distance;
        sample.u = hit.u;
        sample.v = hit.v;
        sample.known = KeptSample::Known::hit;
    }
}

void SampleUpdater::look_at_furniture(KeptTile& tile, const TileActors& actors, const SampleTask& task,
                                      const Ray& ray) {
    KeptSample& sample = *task.sample;
    const SeenPoint seen = look_at(lit_, ray, sample.hit());
    sample.known = KeptSample::Known::light;
    sample.emits = seen.emitted != Rgb(0);
    sample.reflectance = seen.reflectance;
    sample.surface = seen.surface;
    sample.first_weight = static_cast<std::uint32_t>(tile.weights.size());
    sample.weights = static_cast<std::uint8_t>(seen.stencil.count);
    for (std::size_t k = 0; k < seen.stencil.count; ++k)
        tile.weights.push_back({seen.stencil.patch[k], seen.stencil.weight[k]});
    if (!seen.takes_light()) {
        sample.radiance = seen.emitted;
        return;
    }
    sample.position = seen.position;
    tile.positions.add(seen.position);
    add(on_furniture_, {task, seen.emitted, seen.reflectance,
                        Interpolation::value(seen.stencil, lit_.irradiance, lit_.confidence), seen.position,
                        seen.normal, any_holds(actors, seen.position)});
}

/// A sample that sees the furniture again, or still.
void SampleUpdater::recall(const KeptTile& tile, const TileActors& actors, const SampleTask& task) {
    task.sample->surface = surface_of(lit_, *task.sample);
    relight(tile, actors, task);
}

void SampleUpdater::relight(const KeptTile& tile, const TileActors& actors, const SampleTask& task) {
    KeptSample& sample = *task.sample;
    const Rgb emitted = emitted_by(lit_, sample);
    if (max_channel(sample.reflectance) <= 0) {
        sample.radiance = emitted;
        return;
    }
    const Rgb indirect =
        interpolated(lit_, std::span(tile.weights).subspan(sample.first_weight, sample.weights));
    const bool has_lines = sample.unblocked != 0 || lines_.count() > KeptSample::remembered_lines;
    if (has_lines && any_holds(actors, sample.position))
        add(remembered_, {task, emitted, sample.reflectance, indirect, sample.position,
                          shading_normal(lit_, sample.hit()), true});
    else
        sample.radiance = radiance_of(emitted, sample.reflectance, indirect, sample.direct);
}

void SampleUpdater::look_at_actor(const SampleTask& task, const Ray& ray, const Hit& hit) {
    const SeenPoint seen = look_at(lit_, ray, hit);
    task.sample->surface = seen.surface;
    if (!seen.takes_light()) {
        task.sample->radiance = seen.emitted;
        return;
    }
    add(on_actors_, {task, seen.emitted, seen.reflectance,
                     Interpolation::value(seen.stencil, lit_.irradiance, lit_.confidence), seen.position,
                     seen.normal, true});
}

void SampleUpdater::add(Queue& queue, const Point& point) {
    queue.points[queue.count++] = point;
    if (queue.count == lanes) flush(queue);
}

/// Traces the shadow lines of a queue's points and so completes their samples.
void SampleUpdater::flush(Queue& queue) {
    if (queue.count == 0) return;
    std::array<Rgb, lanes> now{}, alone{};
    std::array<std::uint32_t, lanes> unblocked{};
    for (std::size_t lane = 0; lane < queue.count; ++lane)
        lines_.look_from(queue.points[lane].position, queue.points[lane].normal, lamps_[lane]);
    for (std::size_t i = 0; i < lines_.count(); ++i) {
        const LinePacket lines = shadow_lines(queue, i);
        if (lines.alive == 0) continue;
        const bool past_furniture = queue.lines == Lines::past_furniture && i < KeptSample::remembered_lines;
        // Where nothing is to be remembered, one look at everything does.
        const Scope scope = queue.lines == Lines::none_kept ? Scope::everything : Scope::static_geometry;
        const std::uint32_t past = past_furniture ? lines.alive : lines.alive & ~occluded(lines, scope);
        const std::uint32_t free =
            scope == Scope::everything ? past : past & ~occluded_by_actors(queue, lines, past);
        for (std::size_t lane = 0; lane < queue.count; ++lane) {
            if (((past >> lane) & 1U) != 0) {
                alone[lane] += lines.gain[lane];
                if (i < KeptSample::remembered_lines) unblocked[lane] |= 1U << i;
            }
            if (((free >> lane) & 1U) != 0) now[lane] += lines.gain[lane];
        }
    }
    for (std::size_t lane = 0; lane < queue.count; ++lane) {
        const Point& point = queue.points[lane];
        KeptSample& sample = *point.task.sample;
        sample.radiance = radiance_of(point.emitted, point.reflectance, point.interpolated, now[lane]);
        if (queue.lines != Lines::unknown) continue;
        sample.direct = alone[lane];
        sample.unblocked = unblocked[lane];
    }
    queue.count = 0;
}

SampleUpdater::LinePacket SampleUpdater::shadow_lines(const Queue& queue, std::size_t i) {
    LinePacket lines;
    lines.rays.count = static_cast<Index>(queue.count);
    for (std::size_t lane = 0; lane < queue.count; ++lane) {
        const Point& point = queue.points[lane];
        const bool blocked = queue.lines == Lines::past_furniture && i < KeptSample::remembered_lines &&
                             ((point.task.sample->unblocked >> i) & 1U) == 0;
        const ShadowLine line = blocked ? ShadowLine{} : lines_.at(i, number_of(point.task), lamps_[lane]);
        lines.gain[lane] = line.irradiance;
        const bool lit = line.brings_light();
        // A ray that ends where it starts is switched off.
        lines.rays.set(lane, {point.position, lit ? line.direction : Vec3(0, 0, 1), lit ? line.far_m : 0.0F});
        if (lit) lines.alive |= 1U << lane;
    }
    return lines;
}

std::uint32_t SampleUpdater::occluded(const LinePacket& lines, Scope scope) {
    rays_traced_ += static_cast<std::uint64_t>(std::popcount(lines.alive));
    return lit_.caster->occluded(lines.rays, scope);
}

/// Of the lines `among` those that end on an actor.
std::uint32_t SampleUpdater::occluded_by_actors(const Queue& queue, const LinePacket& all,
                                                std::uint32_t among) {
    LinePacket lines = all;
    lines.alive = 0;
    for (std::size_t lane = 0; lane < queue.count; ++lane) {
        if (((among >> lane) & 1U) != 0 && queue.points[lane].in_reach)
            lines.alive |= 1U << lane;
        else
            lines.rays.far[lane] = 0;
    }
    return lines.alive == 0 ? 0 : occluded(lines, Scope::actors);
}

}  // namespace afterglow
