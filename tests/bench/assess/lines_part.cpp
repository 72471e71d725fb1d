#include <algorithm>
#include <random>

#include "tests/bench/assess/parts.h"
#include "tests/bench/room.h"
#include "tests/bench/timing.h"

namespace afterglow {
namespace {

constexpr std::size_t rays_measured = 1'000'000;

/// In which order lines stand.
enum class LineOrder {
    neighbours,  ///< one direction of sixteen neighbouring patches, and the next
    directions,  ///< one patch's directions, and the next patch
    any,         ///< by chance
};

/// Rays of blocks spread over the furniture.
std::vector<Ray> rays_in(const LinedRoom& room, LineOrder order) {
    const Index lines = room.sight.lines_per_patch();
    const std::size_t blocks = room.sight.static_blocks();
    const std::size_t stride = std::max<std::size_t>(1, blocks * block_size * lines / rays_measured);
    std::vector<Ray> all;
    RayPacket packet;
    for (std::size_t b = 0; b < blocks; b += stride) {
        const Index count = room.sight.blocks()[b].count;
        const std::size_t first = all.size();
        all.resize(first + std::size_t{count} * lines);
        for (Index d = 0; d < lines; ++d) {
            room.sight.rays(b, d, Pose{}, packet);
            for (Index lane = 0; lane < count; ++lane) {
                const std::size_t at = order == LineOrder::directions ? std::size_t{lane} * lines + d
                                                                      : std::size_t{d} * count + lane;
                all[first + at] = packet.ray(lane);
            }
        }
    }
    if (order == LineOrder::any) std::shuffle(all.begin(), all.end(), std::mt19937(1));
    return all;
}

double packets_ms(const RayCaster& caster, std::span<const Ray> rays, double& sum) {
    RayPacket packet;
    HitPacket hits;
    return ms_of([&] {
        for (std::size_t first = 0; first < rays.size(); first += 16) {
            packet.count = static_cast<Index>(std::min<std::size_t>(16, rays.size() - first));
            for (Index lane = 0; lane < packet.count; ++lane) packet.set(lane, rays[first + lane]);
            caster.nearest(packet, Scope::static_geometry, hits);
            sum += static_cast<double>(hits[0].distance);
        }
    });
}

double single_ms(const RayCaster& caster, std::span<const Ray> rays, double& sum) {
    return ms_of([&] {
        for (const Ray& ray : rays)
            sum += static_cast<double>(caster.nearest(ray, Scope::static_geometry).distance);
    });
}

}  // namespace

void measure_lines(const PartScene& scene, const PartRows& print) {
    const LinedRoom room(scene.world, scene.patch_size_m, scene.rays, 1);
    double sum = 0;
    for (const auto& [name, order] : {std::pair{"neighbours", LineOrder::neighbours},
                                      {"directions", LineOrder::directions},
                                      {"any", LineOrder::any}}) {
        const std::vector<Ray> rays = rays_in(room, order);
        std::vector<double> packets, single;
        for (int k = 0; k < 3; ++k) {
            packets.push_back(packets_ms(room.caster, rays, sum));
            single.push_back(single_ms(room.caster, rays, sum));
        }
        const double to_ns = 1e6 / static_cast<double>(rays.size());
        print({{"way", std::string("packets, ") + name}, {"ns_a_ray", to_ns * median(packets)}});
        print({{"way", std::string("single rays, ") + name}, {"ns_a_ray", to_ns * median(single)}});
    }
    // Looked at, so that no loop is left out.
    if (sum < 0) throw std::logic_error("distances are not negative");
}

}  // namespace afterglow
