#include "solver/visibility/changed_events.h"

#include <algorithm>
#include <atomic>
#include <iterator>

#include "solver/visibility/block_lines.h"
#include "solver/visibility/line_tests.h"

namespace afterglow {

namespace {

constexpr std::size_t blocks_per_chunk = 4;

bool meets_any(LinePacket& packet, std::span<const Box> boxes) {
    packet.prepare();
    return std::any_of(boxes.begin(), boxes.end(),
                       [&](const Box& box) { return lanes_through(packet, box) != 0; });
}

/// Asks `in_block(b)`, of every static block, which of packets [first, last) of its `width` are met.
template <class InBlock>
MetPackets packets_where(const EventScene& scene, Index first, Index last, Index width,
                         const Context& context, const InBlock& in_block) {
    const std::size_t blocks = scene.sight.static_blocks();
    MetPackets out{PacketMask(blocks * width, 0), 0, blocks * (last - first)};
    std::atomic<std::size_t> met = 0;
    context.for_chunks(blocks, blocks_per_chunk, [&](std::size_t begin, std::size_t end) {
        LinePacket packet;
        std::size_t here = 0;
        for (std::size_t b = begin; b < end; ++b) {
            const auto meets = in_block(b);
            for (Index d = first; d < last; ++d)
                if (meets(d, packet)) {
                    out.mask[b * width + d] = 1;
                    ++here;
                }
        }
        met += here;
    });
    out.met = met;
    return out;
}

}  // namespace

MetPackets sight_packets_meeting(const EventScene& scene, const DirectionRange& range,
                                 std::span<const Box> boxes, const Context& context) {
    const auto in_block = [&](std::size_t b) {
        const PatchBlock& block = scene.sight.blocks()[b];
        return [&, block, lines = BlockLines(scene.sight, b, Pose{})](Index d, LinePacket& packet) {
            lines.rays(d, packet.rays);
            std::copy_n(scene.background.background.distance.begin() +
                            static_cast<std::ptrdiff_t>(scene.sight.line(block, d, 0)),
                        block.count, packet.rays.far.begin());
            return meets_any(packet, boxes);
        };
    };
    return packets_where(scene, range.first, range.last, scene.sight.lines_per_patch(), context, in_block);
}

MetPackets light_packets_meeting(const EventScene& scene, std::span<const Box> boxes,
                                 const Context& context) {
    const auto in_block = [&](std::size_t b) {
        const PatchBlock& block = scene.sight.blocks()[b];
        return [&, block, b](Index k, LinePacket& packet) {
            if (scene.mesh.body[scene.light.lamp_patch(b, k)] != furniture) return false;
            std::array<float, 16> unused;
            scene.light.rays(b, k, scene.placed, packet.rays, unused);
            const std::size_t line = scene.light.line(block, k, 0);
            for (std::size_t lane = 0; lane < block.count; ++lane)
                if (!(scene.background.light_contribution[line + lane] > 0)) packet.rays.far[lane] = -1;
            return meets_any(packet, boxes);
        };
    };
    return packets_where(scene, 0, scene.light.lines_per_patch(), scene.light.lines_per_patch(), context,
                         in_block);
}

LineEvents replace_events(const SightLines& sight, Index lines, const LineEvents& old,
                          const PacketMask& replaced, const LineEvents& fresh) {
    const auto is_replaced = [&](const LineEvent& event) {
        const Index patch = event.line / lines, b = patch / block_size;
        const PatchBlock& block = sight.blocks()[b];
        return replaced[std::size_t{b} * lines + (event.line - block.first * lines) / block.count] != 0;
    };
    const auto by_line = [](const LineEvent& a, const LineEvent& b) { return a.line < b.line; };
    LineEvents out;
    std::vector<LineEvent> stay;
    for (int f = 0; f + 1 < static_cast<int>(old.first_of_frame.size()); ++f) {
        out.first_of_frame.push_back(out.list.size());
        stay.clear();
        const auto before = old.at(f), now = fresh.at(f);
        std::copy_if(before.begin(), before.end(), std::back_inserter(stay),
                     [&](const LineEvent& event) { return !is_replaced(event); });
        std::merge(stay.begin(), stay.end(), now.begin(), now.end(), std::back_inserter(out.list), by_line);
    }
    out.first_of_frame.push_back(out.list.size());
    return out;
}

}  // namespace afterglow
