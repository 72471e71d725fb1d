#include "solver/visibility/ray_caster.h"

#include <cstring>
#include <new>
#include <string>
#include <utility>
#include <vector>

#include <embree3/rtcore.h>

#include "solver/base/error.h"
#include "solver/mesh/lift.h"
#include "solver/visibility/spacetime_extent.h"
#include "solver/visibility/tie.h"

namespace afterglow {

namespace {

/// Releases an Embree handle when its owner goes.
template <class Handle, void (*Release)(Handle)>
class Owned {
  public:
    Owned() = default;
    explicit Owned(Handle handle) : handle_(handle) {}
    Owned(Owned&& other) noexcept : handle_(std::exchange(other.handle_, nullptr)) {}
    Owned& operator=(Owned&& other) noexcept {
        std::swap(handle_, other.handle_);
        return *this;
    }
    ~Owned() {
        if (handle_ != nullptr) Release(handle_);
    }
    operator Handle() const { return handle_; }  // NOLINT: stands in for the handle everywhere

  private:
    Handle handle_ = nullptr;
};
using Device = Owned<RTCDevice, rtcReleaseDevice>;
using SceneHandle = Owned<RTCScene, rtcReleaseScene>;
using Geometry = Owned<RTCGeometry, rtcReleaseGeometry>;

void check(RTCDevice device) {
    const RTCError error = rtcGetDeviceError(device);
    if (error == RTC_ERROR_NONE) return;
    if (error == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
    throw Error(ErrorKind::io, "", "the ray tracer failed with error " + std::to_string(error));
}

/// An acceleration structure over one body, in the body's frame.
SceneHandle build_body(RTCDevice device, const Body& body) {
    SceneHandle scene(rtcNewScene(device));
    // Robust: rays must not slip between triangles that share an edge, or light leaks through walls.
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_HIGH);
    if (!body.triangles.empty()) {
        Geometry geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE));
        auto* vertices = static_cast<Vec3*>(rtcSetNewGeometryBuffer(
            geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3), body.positions.size()));
        auto* indices = static_cast<Index*>(rtcSetNewGeometryBuffer(
            geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(Index), body.triangles.size()));
        check(device);
        std::copy(body.positions.begin(), body.positions.end(), vertices);
        for (const Triangle& triangle : body.triangles)
            indices = std::copy(triangle.vertices.begin(), triangle.vertices.end(), indices);
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene, geometry);
    }
    rtcCommitScene(scene);
    check(device);
    return scene;
}

void to_embree(const RayPacket& in, RTCRay16& out, std::array<int, 16>& valid) {
    std::memcpy(out.org_x, in.origin_x.data(), sizeof(out.org_x));
    std::memcpy(out.org_y, in.origin_y.data(), sizeof(out.org_y));
    std::memcpy(out.org_z, in.origin_z.data(), sizeof(out.org_z));
    std::memcpy(out.dir_x, in.direction_x.data(), sizeof(out.dir_x));
    std::memcpy(out.dir_y, in.direction_y.data(), sizeof(out.dir_y));
    std::memcpy(out.dir_z, in.direction_z.data(), sizeof(out.dir_z));
    std::memcpy(out.tfar, in.far.data(), sizeof(out.tfar));
    // Embree computes with the lanes that are switched off, too: what happened to lie in memory there,
    // denormal numbers above all, made it fifteen times slower.
    for (std::size_t k = in.count; k < 16; ++k) {
        out.org_x[k] = out.org_y[k] = out.org_z[k] = 0;
        out.dir_x[k] = out.dir_y[k] = out.dir_z[k] = 1;
        out.tfar[k] = 0;
    }
    for (std::size_t k = 0; k < 16; ++k) {
        // A ray that ends where it starts can meet nothing.
        valid[k] = k < in.count && in.far[k] > 0 ? -1 : 0;
        out.tnear[k] = 0;
        out.time[k] = 0;
        out.mask[k] = ~0U;
        out.flags[k] = 0;
    }
}

RTCRay to_embree(const Ray& ray) {
    RTCRay out{};
    out.org_x = ray.origin.x;
    out.org_y = ray.origin.y;
    out.org_z = ray.origin.z;
    out.dir_x = ray.direction.x;
    out.dir_y = ray.direction.y;
    out.dir_z = ray.direction.z;
    out.tfar = ray.far;
    out.mask = ~0U;
    return out;
}

RTCRayHit to_query(const Ray& ray) {
    RTCRayHit out{to_embree(ray), {}};
    out.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    out.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    return out;
}

RTCIntersectContext make_context(RTCIntersectContextFlags flags) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = flags;
    return context;
}

}  // namespace

struct RayCaster::Scenes {
    Device device;
    std::vector<SceneHandle> bodies;  // furniture first
    std::vector<Geometry> instances;  // one an actor
    SceneHandle actors;               // of the instances
    std::vector<Pose> poses;
    std::vector<Box> local_boxes, boxes;          // by body, where it is made and where it stands
    std::vector<std::vector<Index>> near_before;  // by actor: those of lower numbers that its box meets
    float lift_m = 0;                             // of lines; boxes are larger by twice as much

    /// One lane of what Embree reports, and the ray's direction.
    struct Found {
        unsigned geometry, instance, triangle;
        float distance, u, v;
        Vec3 normal, direction;
    };

    [[nodiscard]] Hit found(const Found& lane) const {
        Hit out;
        if (lane.geometry == RTC_INVALID_GEOMETRY_ID) return out;
        // Only actors are instanced, in order after the furniture.
        out.body = lane.instance == RTC_INVALID_GEOMETRY_ID ? furniture : lane.instance + 1;
        out.triangle = lane.triangle;
        out.distance = lane.distance;
        out.u = lane.u;
        out.v = lane.v;
        // The normal comes in the body's frame.
        const Vec3 direction = out.body == furniture
                                   ? lane.direction
                                   : glm::conjugate(poses[out.body].rotation) * lane.direction;
        out.side = glm::dot(direction, lane.normal) < 0 ? Side::front : Side::back;
        return out;
    }

    void found(const RTCRayHit16& query, const RayPacket& rays, HitPacket& hits) const {
        for (std::size_t k = 0; k < rays.count; ++k) {
            const Vec3 normal(query.hit.Ng_x[k], query.hit.Ng_y[k], query.hit.Ng_z[k]);
            hits[k] =
                found({query.hit.geomID[k], query.hit.instID[0][k], query.hit.primID[k], query.ray.tfar[k],
                       query.hit.u[k], query.hit.v[k], normal, rays.ray(k).direction});
        }
    }

    /// Whether a ray meets an actor no farther off than `far_m`; if so, where.
    bool meets(Index actor, const Ray& ray, float far_m, Hit& hit) const {
        const Quat back = glm::conjugate(poses[actor].rotation);
        const Vec3 direction = back * ray.direction;
        RTCRayHit query = to_query({back * (ray.origin - poses[actor].translation), direction, far_m});
        RTCIntersectContext context = make_context(RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT);
        rtcIntersect1(bodies[actor], &context, &query);
        if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
        const Vec3 normal(query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z);
        const Side side = glm::dot(direction, normal) < 0 ? Side::front : Side::back;
        hit = {actor, query.hit.primID, side, query.ray.tfar, query.hit.u, query.hit.v};
        return true;
    }

    /// Makes of the nearest hit the one that tie.h says is seen.
    void settle_tie(const Ray& ray, Hit& hit) const {
        if (hit.body == no_index || near_before[hit.body].empty()) return;
        const Vec3 at = ray.origin + hit.distance * ray.direction;
        for (const Index other : near_before[hit.body])
            if (boxes[other].holds(at) && meets(other, ray, after_tie(hit.distance), hit)) return;
    }

    /// The same for a line of an actor, which hides what touches it.
    void settle_tie(Index home, const Ray& ray, Hit& hit) const {
        if (hit.body == no_index || hit.body == home) return;
        if (boxes[home].holds(ray.origin + hit.distance * ray.direction) &&
            meets(home, ray, hit.distance + lift_m, hit))
            return;
        settle_tie(ray, hit);
    }

    /// Finds out who may be in a tie with whom.
    void place_boxes() {
        boxes.resize(local_boxes.size());
        for (std::size_t b = 1; b < boxes.size(); ++b) {
            boxes[b] = placed_box(local_boxes[b], poses[b], 2 * lift_m);
            near_before[b].clear();
            for (Index other = 1; other < b; ++other)
                if (boxes[other].meets(boxes[b])) near_before[b].push_back(other);
        }
    }

    /// Calls `trace(scene, context)` for each scene that is meant. `flags` go for the furniture;
    /// Embree 3.13's coherent packets can loop for ever in a scene of instances when only some lanes are
    /// live, so actors never get them.
    template <class Trace>
    void for_scenes(Scope scope, RTCIntersectContextFlags flags, Trace trace) const {
        if (scope != Scope::actors) {
            RTCIntersectContext context = make_context(flags);
            trace(static_cast<RTCScene>(bodies[furniture]), &context);
        }
        if (scope != Scope::static_geometry && !instances.empty()) {
            RTCIntersectContext context = make_context(RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT);
            trace(static_cast<RTCScene>(actors), &context);
        }
    }
};

RayCaster::RayCaster(const World& world) : scenes_(std::make_unique<Scenes>()) {
    scenes_->device = Device(rtcNewDevice(nullptr));
    if (static_cast<RTCDevice>(scenes_->device) == nullptr) check(nullptr);
    for (const Body& body : world.bodies) {
        scenes_->bodies.push_back(build_body(scenes_->device, body));
        Box& box = scenes_->local_boxes.emplace_back();
        for (const Vec3& position : body.positions) box.add(position);
    }
    scenes_->near_before.resize(world.bodies.size());
    scenes_->lift_m = lift_for(world);
    scenes_->actors = SceneHandle(rtcNewScene(scenes_->device));
    rtcSetSceneFlags(scenes_->actors,
                     static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_DYNAMIC));
    for (std::size_t b = 1; b < world.bodies.size(); ++b) {
        Geometry instance(rtcNewGeometry(scenes_->device, RTC_GEOMETRY_TYPE_INSTANCE));
        rtcSetGeometryInstancedScene(instance, scenes_->bodies[b]);
        rtcAttachGeometryByID(scenes_->actors, instance, static_cast<unsigned>(b - 1));
        scenes_->instances.push_back(std::move(instance));
    }
    set_poses(poses_at(world, 0));
}

RayCaster::RayCaster(RayCaster&&) noexcept = default;
RayCaster& RayCaster::operator=(RayCaster&&) noexcept = default;
RayCaster::~RayCaster() = default;

void RayCaster::set_poses(std::span<const Pose> poses) {
    scenes_->poses.assign(poses.begin(), poses.end());
    for (std::size_t k = 0; k < scenes_->instances.size(); ++k) {
        const Mat4 matrix = poses[k + 1].matrix();
        rtcSetGeometryTransform(scenes_->instances[k], 0, RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR, &matrix[0][0]);
        rtcCommitGeometry(scenes_->instances[k]);
    }
    rtcCommitScene(scenes_->actors);
    check(scenes_->device);
    scenes_->place_boxes();
}

const Pose& RayCaster::pose(Index body) const {
    return scenes_->poses[body];
}

Hit RayCaster::nearest(const Ray& ray, Scope scope) const {
    RTCRayHit query = to_query(ray);
    // The second scene is traced only up to what the first has found, since tfar shrinks with each hit.
    scenes_->for_scenes(
        scope, RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT,
        [&](RTCScene scene, RTCIntersectContext* context) { rtcIntersect1(scene, context, &query); });
    Hit hit =
        scenes_->found({query.hit.geomID, query.hit.instID[0], query.hit.primID, query.ray.tfar, query.hit.u,
                        query.hit.v, Vec3(query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z), ray.direction});
    scenes_->settle_tie(ray, hit);
    return hit;
}

bool RayCaster::occluded(const Ray& ray, Scope scope) const {
    RTCRay query = to_embree(ray);
    scenes_->for_scenes(scope, RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT,
                        [&](RTCScene scene, RTCIntersectContext* context) {
                            if (query.tfar >= 0) rtcOccluded1(scene, context, &query);
                        });
    return query.tfar < 0;
}

namespace {

/// Sixteen rays as Embree takes them, and what it finds.
struct NearestQuery {
    RTCRayHit16 hit;
    alignas(64) std::array<int, 16> valid;

    explicit NearestQuery(const RayPacket& rays) {
        to_embree(rays, hit.ray, valid);
        for (std::size_t k = 0; k < 16; ++k) {
            hit.hit.geomID[k] = RTC_INVALID_GEOMETRY_ID;
            hit.hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;
        }
    }
    void trace(RTCScene scene, RTCIntersectContext* context) {
        rtcIntersect16(valid.data(), scene, context, &hit);
    }
};

}  // namespace

void RayCaster::nearest_in(const RayPacket& rays, Scope scope, HitPacket& hits) const {
    NearestQuery query(rays);
    scenes_->for_scenes(scope, RTC_INTERSECT_CONTEXT_FLAG_COHERENT,
                        [&](RTCScene scene, RTCIntersectContext* context) { query.trace(scene, context); });
    scenes_->found(query.hit, rays, hits);
}

void RayCaster::nearest(const RayPacket& rays, Scope scope, HitPacket& hits) const {
    nearest_in(rays, scope, hits);
    for (std::size_t k = 0; k < rays.count; ++k) scenes_->settle_tie(rays.ray(k), hits[k]);
}

void RayCaster::nearest_from(Index home, const RayPacket& rays, HitPacket& hits) const {
    nearest_in(rays, Scope::everything, hits);
    for (std::size_t k = 0; k < rays.count; ++k) scenes_->settle_tie(home, rays.ray(k), hits[k]);
}

void RayCaster::nearest(const RayPacket& rays, Index body, HitPacket& hits) const {
    NearestQuery query(rays);
    RTCIntersectContext context = make_context(RTC_INTERSECT_CONTEXT_FLAG_COHERENT);
    query.trace(scenes_->bodies[body], &context);
    scenes_->found(query.hit, rays, hits);
    // Without an instance everything looks like furniture.
    for (std::size_t k = 0; k < rays.count; ++k)
        if (hits[k].body != no_index) hits[k].body = body;
}

namespace {

/// Embree marks what is occluded by an end before the start.
std::uint32_t occluded_lanes(const RTCRay16& query, Index count) {
    std::uint32_t mask = 0;
    for (unsigned k = 0; k < count; ++k)
        if (query.tfar[k] < 0) mask |= 1U << k;
    return mask;
}

}  // namespace

std::uint32_t RayCaster::occluded(const RayPacket& rays, Scope scope) const {
    RTCRay16 query;
    alignas(64) std::array<int, 16> valid;
    to_embree(rays, query, valid);
    scenes_->for_scenes(scope, RTC_INTERSECT_CONTEXT_FLAG_COHERENT,
                        [&](RTCScene scene, RTCIntersectContext* context) {
                            rtcOccluded16(valid.data(), scene, context, &query);
                            for (unsigned k = 0; k < 16; ++k)
                                if (query.tfar[k] < 0) valid[k] = 0;
                        });
    return occluded_lanes(query, rays.count);
}

std::uint32_t RayCaster::occluded(const RayPacket& rays, Index body) const {
    RTCRay16 query;
    alignas(64) std::array<int, 16> valid;
    to_embree(rays, query, valid);
    RTCIntersectContext context = make_context(RTC_INTERSECT_CONTEXT_FLAG_COHERENT);
    rtcOccluded16(valid.data(), scenes_->bodies[body], &context, &query);
    return occluded_lanes(query, rays.count);
}

std::vector<Pose> poses_at(const World& world, double time_s) {
    std::vector<Pose> poses;
    poses.reserve(world.bodies.size());
    for (const Body& body : world.bodies) poses.push_back(body.path.at(time_s));
    return poses;
}

}  // namespace afterglow
