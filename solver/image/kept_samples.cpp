#include "solver/image/kept_samples.h"

#include <algorithm>

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

bool any_holds(const TileActors& actors, const Vec3& position) {
    return std::any_of(actors.shadows.begin(), actors.shadows.end(),
                       [&](const ShadowRegion* region) { return region->holds(position); });
}

/// Remembers line i of a sample that there is room for.
void keep_line(KeptTile& tile, const KeptSample& sample, std::size_t i, const ShadowLinePacket& lines,
               std::size_t lane) {
    if (sample.first_line == no_index) return;
    const auto before = static_cast<Index>(std::popcount(sample.unblocked & ((1U << i) - 1)));
    const Ray ray = lines.rays.ray(lane);
    tile.lines[sample.first_line + before] = {ray.direction, ray.far, lines.gain[lane]};
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
           weights.capacity() * sizeof(PatchWeight) + shares.capacity() * sizeof(PatchShare) +
           patches.capacity() * sizeof(Index) + lines.capacity() * sizeof(KeptLine);
}

SampleUpdater::SampleUpdater(const LitWorld& lit, const CameraSamples& camera, const ShadowLines& lines)
    : lit_(lit), camera_(camera), lines_(lines), shadows_(lines) {
    on_actors_.lines = Lines::none_kept;
    remembered_.lines = Lines::past_furniture;
}

SampleLight SampleUpdater::light(const KeptTile& tile, const KeptSample& sample) const {
    if (sample.on_actor == no_index)
        return {emitted_by(lit_, sample), sample.reflectance, sample.direct_now, surface_of(lit_, sample),
                std::span(tile.weights).subspan(sample.first_weight, sample.weights)};
    const ActorPoint& point = actor_points_[sample.on_actor];
    return {point.seen.emitted, point.seen.reflectance, point.direct, point.seen.surface,
            point.seen.stencil.patches()};
}

void SampleUpdater::update(KeptTile& tile, const TileActors& actors, std::span<const SampleTask> tasks) {
    for (std::size_t begin = 0; begin < tasks.size(); begin += lanes)
        meet(tile, actors, tasks.subspan(begin, std::min(lanes, tasks.size() - begin)));
}

void SampleUpdater::finish(KeptTile& tile) {
    for (Queue* queue : {&on_furniture_, &on_actors_, &remembered_}) flush(tile, *queue);
    flush_lines();
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
    std::array<CameraSample, lanes> samples;
    std::array<SampleNumber, lanes> numbers;
    for (std::size_t lane = 0; lane < tasks.size(); ++lane) samples[lane] = tasks[lane].which;
    camera_.rays(samples, tasks.size(), rays, numbers);
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
            look_at_actor(tile, tasks[lane], rays.ray(lane), hits[lane]);
        else if (tasks[lane].sample->known == KeptSample::Known::light)
            recall(tile, actors, tasks[lane]);
        else
            look_at_furniture(tile, actors, tasks[lane], rays.ray(lane));
    }
}

/// The background of samples that do not know it yet.
void SampleUpdater::meet_furniture(std::span<const SampleTask> tasks, const RayPacket& rays) {
    const auto is_new = [](const SampleTask& task) {
        return task.sample->known == KeptSample::Known::nothing;
    };
    const auto count = std::count_if(tasks.begin(), tasks.end(), is_new);
    if (count == 0) return;
    RayPacket unknown = rays;
    for (std::size_t lane = 0; lane < tasks.size(); ++lane)
        if (!is_new(tasks[lane])) unknown.far[lane] = 0;
    HitPacket hits{};
    lit_.caster->nearest(unknown, Scope::static_geometry, hits);
    rays_traced_ += static_cast<std::uint64_t>(count);
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
    sample.on_actor = no_index;
    sample.emits = seen.emitted != Rgb(0);
    sample.reflectance = seen.reflectance;
    sample.first_weight = static_cast<std::uint32_t>(tile.weights.size());
    sample.weights = static_cast<std::uint8_t>(seen.stencil.count);
    const auto weights = seen.stencil.patches();
    tile.weights.insert(tile.weights.end(), weights.begin(), weights.end());
    if (!seen.takes_light()) return;
    sample.position = seen.position;
    tile.positions.add(seen.position);
    add(tile, on_furniture_, {task, seen.position, seen.normal, any_holds(actors, seen.position)});
}

/// A sample that sees the furniture again, or still.
void SampleUpdater::recall(KeptTile& tile, const TileActors& actors, const SampleTask& task) {
    KeptSample& sample = *task.sample;
    sample.on_actor = no_index;
    sample.direct_now = sample.direct;
    if (max_channel(sample.reflectance) <= 0) return;
    const bool has_lines = sample.unblocked != 0 || lines_.count() > KeptSample::remembered_lines;
    if (!has_lines || !any_holds(actors, sample.position)) return;
    if (sample.first_line == no_index)
        add(tile, remembered_, {task, sample.position, shading_normal(lit_, sample.hit()), true});
    else
        add_lines(tile, sample);
}

void SampleUpdater::look_at_actor(KeptTile& tile, const SampleTask& task, const Ray& ray, const Hit& hit) {
    task.sample->on_actor = static_cast<Index>(actor_points_.size());
    const ActorPoint& point = actor_points_.emplace_back(ActorPoint{look_at(lit_, ray, hit)});
    if (point.seen.takes_light()) add(tile, on_actors_, {task, point.seen.position, point.seen.normal, true});
}

void SampleUpdater::add(KeptTile& tile, Queue& queue, const Point& point) {
    queue.points[queue.count++] = point;
    if (queue.count == lanes) flush(tile, queue);
}

/// Traces the shadow lines of a queue's points and so completes their samples.
void SampleUpdater::flush(KeptTile& tile, Queue& queue) {
    if (queue.count == 0) return;
    make_room_for_lines(tile, queue);
    std::array<Rgb, lanes> now{}, alone{};
    std::array<std::uint32_t, lanes> unblocked{};
    for (std::size_t lane = 0; lane < queue.count; ++lane)
        shadows_.set(lane, queue.points[lane].position, queue.points[lane].normal,
                     camera_.number(queue.points[lane].task.which));
    shadows_.look(queue.count);
    ShadowLinePacket lines;
    for (std::size_t i = 0; i < lines_.count(); ++i) {
        shadows_.at(i, worth_tracing(queue, i), lines);
        if (lines.alive == 0) continue;
        const bool past_furniture = queue.lines == Lines::past_furniture && i < KeptSample::remembered_lines;
        // Where nothing is to be remembered, one look at everything does.
        const Scope scope = queue.lines == Lines::none_kept ? Scope::everything : Scope::static_geometry;
        const std::uint32_t past = past_furniture ? lines.alive : lines.alive & ~occluded(lines, scope);
        const std::uint32_t free =
            scope == Scope::everything ? past : past & ~occluded_by_actors(queue, lines, past);
        for (std::size_t lane = 0; lane < queue.count; ++lane) {
            if (((past >> lane) & 1U) != 0) {
                if (past_furniture) keep_line(tile, *queue.points[lane].task.sample, i, lines, lane);
                alone[lane] += lines.gain[lane];
                if (i < KeptSample::remembered_lines) unblocked[lane] |= 1U << i;
            }
            if (((free >> lane) & 1U) != 0) now[lane] += lines.gain[lane];
        }
    }
    for (std::size_t lane = 0; lane < queue.count; ++lane) {
        KeptSample& sample = *queue.points[lane].task.sample;
        if (queue.lines == Lines::none_kept)
            actor_points_[sample.on_actor].direct = now[lane];
        else
            sample.direct_now = now[lane];
        if (queue.lines != Lines::unknown) continue;
        sample.direct = alone[lane];
        sample.unblocked = unblocked[lane];
    }
    queue.count = 0;
}

/// For samples that are looked at a second time: others never are, and need none.
void SampleUpdater::make_room_for_lines(KeptTile& tile, const Queue& queue) const {
    if (queue.lines != Lines::past_furniture || lines_.count() > KeptSample::remembered_lines) return;
    for (std::size_t lane = 0; lane < queue.count; ++lane) {
        KeptSample& sample = *queue.points[lane].task.sample;
        sample.first_line = static_cast<Index>(tile.lines.size());
        tile.lines.resize(tile.lines.size() + static_cast<std::size_t>(std::popcount(sample.unblocked)));
    }
}

void SampleUpdater::add_lines(const KeptTile& tile, KeptSample& sample) {
    sample.direct_now = Rgb(0);
    const auto count = static_cast<std::size_t>(std::popcount(sample.unblocked));
    for (const KeptLine& line : std::span(tile.lines).subspan(sample.first_line, count)) {
        const std::size_t lane = kept_lines_.rays.count++;
        kept_lines_.rays.set(lane, {sample.position, line.direction, line.far_m});
        kept_lines_.gain[lane] = line.gain;
        kept_lines_.alive |= 1U << lane;
        sample_of_line_[lane] = &sample;
        if (kept_lines_.rays.count == lanes) flush_lines();
    }
}

/// A sample's lines are taken in their order, so that it comes to the same sum as with others between.
void SampleUpdater::flush_lines() {
    if (kept_lines_.rays.count == 0) return;
    const std::uint32_t hidden = occluded(kept_lines_, Scope::actors);
    for (std::size_t lane = 0; lane < kept_lines_.rays.count; ++lane)
        if (((hidden >> lane) & 1U) == 0) sample_of_line_[lane]->direct_now += kept_lines_.gain[lane];
    kept_lines_.rays.count = 0;
    kept_lines_.alive = 0;
}

/// Lanes whose line i does not end on the furniture, as far as is known.
std::uint32_t SampleUpdater::worth_tracing(const Queue& queue, std::size_t i) const {
    std::uint32_t lanes_wanted = (1U << queue.count) - 1;
    if (queue.lines != Lines::past_furniture || i >= KeptSample::remembered_lines) return lanes_wanted;
    for (std::size_t lane = 0; lane < queue.count; ++lane)
        if (((queue.points[lane].task.sample->unblocked >> i) & 1U) == 0) lanes_wanted &= ~(1U << lane);
    return lanes_wanted;
}

std::uint32_t SampleUpdater::occluded(const ShadowLinePacket& lines, Scope scope) {
    rays_traced_ += static_cast<std::uint64_t>(std::popcount(lines.alive));
    return lit_.caster->occluded(lines.rays, scope);
}

/// Of the lines `among` those that end on an actor.
std::uint32_t SampleUpdater::occluded_by_actors(const Queue& queue, const ShadowLinePacket& all,
                                                std::uint32_t among) {
    ShadowLinePacket lines = all;
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
