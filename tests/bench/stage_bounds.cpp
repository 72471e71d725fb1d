// How far the stages of a frame are from what bounds them: each beside a loop that does no more than what
// cannot be left out, on the same data and in the same run, one thread. Living room, 10,074 patches × 512
// lines. Prints one table of medians. Usage: stage_bounds [rounds]

#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <random>

#include "solver/radiosity/residual.h"
#include "solver/radiosity/residual_sums.h"
#include "solver/scene/load.h"
#include "solver/visibility/events.h"
#include "tests/bench/room.h"
#include "tests/bench/timing.h"

namespace afterglow {
namespace {

const FrameClock frame_clock{24};

/// What loops come to, so that no compiler leaves them out.
double checksum = 0;

/// CPU times of a stage and of what bounds it, run by run.
struct Row {
    const char* stage;
    const char* bound;
    std::vector<double> stage_ms, bound_ms;

    void print() const {
        std::printf("| %s | %.2f | %s | %.2f | %.2f |\n", stage, median(stage_ms), bound, median(bound_ms),
                    median(stage_ms) / median(bound_ms));
    }
};

/// All sight lines of the furniture: packets traced and nothing done with what they meet.
double trace_alone(const LitRoom& room) {
    const Index lines = room.sight.lines_per_patch();
    std::vector<RayPacket> packets(lines);
    HitPacket hits;
    double ms = 0;
    for (std::size_t b = 0; b < room.sight.static_blocks(); ++b) {
        for (Index d = 0; d < lines; ++d) room.sight.rays(b, d, Pose{}, packets[d]);
        ms += ms_of([&] {
            for (const RayPacket& packet : packets) {
                room.caster.nearest(packet, Scope::static_geometry, hits);
                checksum += static_cast<double>(hits[0].distance);
            }
        });
    }
    return ms;
}

void measure_lines(LitRoom& room, const Context& context, Row& row) {
    StaticLines seen = make_static_lines(room.mesh, room.sight, room.light);
    const LineRange all{0, room.sight.static_blocks(), 0, room.sight.lines_per_patch()};
    row.stage_ms.push_back(ms_of([&] {
        trace_lines(room.sight, room.mesh, room.caster, Scope::static_geometry, all,
                    {seen.background.patch, seen.background.distance}, context);
    }));
    row.bound_ms.push_back(trace_alone(room));
}

/// A sweep: every entry read, and of each column as much light as an entry needs, without their products.
void measure_gather(const FormFactorMatrix& matrix, const Context& context, Row& by_stream, Row& by_light) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> unit(0, 1);
    std::vector<Lanes> radiosity(matrix.rows()), irradiance(matrix.rows());
    for (Lanes& b : radiosity) b.v = Lanes::Vector{unit(random), unit(random), unit(random), 0};
    const double ms = ms_of([&] { gather(matrix, radiosity, irradiance, context); });
    by_stream.stage_ms.push_back(ms);
    by_light.stage_ms.push_back(ms);
    checksum += static_cast<double>(irradiance[0].v[0]);
    by_stream.bound_ms.push_back(ms_of([&] {
        Index columns = 0;
        for (const Index column : matrix.column) columns ^= column;
        std::array<float, 32> values{};
        for (std::size_t e = 0; e + values.size() <= matrix.value.size(); e += values.size())
            for (std::size_t k = 0; k < values.size(); ++k) values[k] += matrix.value[e + k];
        checksum += static_cast<double>(values[0]) + columns;
    }));
    by_light.bound_ms.push_back(ms_of([&] {
        std::array<Lanes::Vector, 4> sum{};
        for (std::size_t e = 0; e + sum.size() <= matrix.column.size(); e += sum.size())
            for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += radiosity[matrix.column[e + k]].v;
        checksum += static_cast<double>(sum[0][0] + sum[1][1] + sum[2][2] + sum[3][0]);
    }));
}

/// Covered lines are rewritten in one stream, so at best as quickly as they are copied there and back.
double copy_covered(const LayeredMatrix& matrix) {
    std::vector<CoveredEntry> entries;
    std::vector<CoveredLine> lines;
    return ms_of([&] {
        for (const CoveredBlock& block : matrix.sight.covered) {
            entries.resize(std::max(entries.size(), block.entries.size()));
            lines.resize(std::max(lines.size(), block.lines.size()));
            std::copy(block.entries.begin(), block.entries.end(), entries.begin());
            std::copy(block.lines.begin(), block.lines.end(), lines.begin());
            if (!block.entries.empty()) checksum += entries[0].now + lines[0].line;
        }
    });
}

/// Both lights of every change read, and its row's sum written.
double touch_changes(std::span<const RowChanges> changes, const ResidualState& state,
                     std::vector<DoubleLanes>& sums) {
    return ms_of([&] {
        for (const RowChanges& part : changes)
            for (const RowChange& change : part.sight)
                sums[change.row].v += __builtin_convertvector(
                    state.radiosity[change.to].v + state.radiosity[change.from].v, DoubleLanes::Vector);
    });
}

/// As many entries of columns added to as many rows, and nothing else, as pushes went along; every k-th
/// patch's columns.
double add_entries(const LayeredMatrix& matrix, std::uint64_t entries, std::vector<DoubleLanes>& sums) {
    constexpr Index stride = 7;
    return ms_of([&] {
        const DoubleLanes light{{1, 1, 1, 1}};
        Index patch = 0;
        for (std::uint64_t added = 0; added < entries; patch = (patch + stride) % matrix.nowhere()) {
            const auto column = column_entries(matrix.sight_columns, patch);
            added += column.size() + 1;
            for (const std::uint32_t entry : column)
                add_light(sums[entry >> CountColumns::row_shift], 1, light.v);
        }
    });
}

struct FollowingRows {
    Row look{"`events`: lines of a frame brought to what they see", "events copied", {}, {}};
    Row show{"rows of a frame", "covered lines copied", {}, {}};
    Row follow{"what changed, added to sums", "both lights read, sums written", {}, {}};
    Row step{"residuals pushed, 5 %", "entries of their columns added up", {}, {}};
};

void measure_following(LitRoom& room, const Context& context, int frames, FollowingRows& rows) {
    VisibleLines visible = make_visible_lines(room.mesh, room.sight, room.light);
    const auto events = make_events(room.world, frame_clock);
    LayeredMatrix matrix;
    ResidualState state;
    std::vector<DoubleLanes> sums(room.mesh.size() + 1);
    for (int f = 0; f < frames; ++f) {
        room.caster.set_poses(poses_at(room.world, frame_clock.time_of(f)));
        const double look = ms_of([&] { events->update(room.lines(f), room.all(), visible, context); });
        auto listed = events->take_changes();
        if (f == 0) matrix = make_layered_matrix(room.layers(), context);
        std::vector<LineChange> copy(listed ? listed->sight.size() : 0);
        const double copied = ms_of([&] {
            if (listed) std::copy(listed->sight.begin(), listed->sight.end(), copy.begin());
        });
        std::span<const RowChanges> changes;
        const double show_ms = ms_of([&] {
            changes = listed ? show(matrix, room.layers(), visible, std::move(*listed), context)
                             : show(matrix, room.layers(), visible, context);
        });
        const ResidualProblem problem{matrix, room.mesh.area_m2, room.emission, room.reflectance,
                                      room.external};
        if (f == 0) state = make_residual_state(problem, context);
        const double follow_ms = ms_of([&] { follow(state, problem, changes, context); });
        const std::uint64_t before = state.entries;
        const double step_ms = ms_of([&] { step(state, problem, {.asked_error = 0.05}, context); });
        // The first frames of a window look ahead as well.
        if (f < 8 || look > 20) continue;
        rows.look.stage_ms.push_back(look);
        rows.look.bound_ms.push_back(copied);
        rows.show.stage_ms.push_back(show_ms);
        rows.show.bound_ms.push_back(copy_covered(matrix));
        rows.follow.stage_ms.push_back(follow_ms);
        rows.follow.bound_ms.push_back(touch_changes(changes, state, sums));
        rows.step.stage_ms.push_back(step_ms);
        rows.step.bound_ms.push_back(add_entries(matrix, state.entries - before, sums));
    }
    checksum += sums[0].v[0];
}

void run(int rounds) {
    const Context context(1);
    LitRoom room(assemble(load_scene(AFTERGLOW_TEST_DATA "/living-room.glb")), 0.14F, 512, 64);
    extend_static_lines(room.background, room.mesh, room.sight, room.light, room.caster,
                        room.sight.lines_per_patch(), context);
    VisibleLines visible = make_visible_lines(room.mesh, room.sight, room.light);
    const auto retrace = make_retrace();
    room.caster.set_poses(poses_at(room.world, 0));
    retrace->update(room.lines(0), room.all(), visible, context);
    const SeenLines seen{visible.patch, room.sight.lines_per_patch(), visible.light_contribution};
    const FormFactors factors =
        compile_rows(room.mesh, room.sight, room.light, room.lamps, room.caster, seen, context);
    Row lines{"static pass, sight lines", "its packets traced", {}, {}};
    Row stream{"sweep by rows", "entries read", {}, {}},
        light{"sweep by rows", "light of columns read", {}, {}};
    FollowingRows following;
    for (int k = 0; k < rounds; ++k) {
        measure_lines(room, context, lines);
        for (int again = 0; again < 10; ++again) measure_gather(factors.matrix, context, stream, light);
        measure_following(room, context, 32, following);
    }
    std::printf("%u patches, %zu entries; medians in ms of CPU time\n\n", room.mesh.size(),
                static_cast<std::size_t>(factors.matrix.entries()));
    std::printf("| stage | ms | bound | ms | ratio |\n|---|---|---|---|---|\n");
    for (const Row* row :
         {&lines, &stream, &light, &following.look, &following.show, &following.follow, &following.step})
        row->print();
    std::printf("\n(%g)\n", checksum);
}

}  // namespace
}  // namespace afterglow

int main(int count, char** arguments) {
    afterglow::run(count > 1 ? std::atoi(arguments[1]) : 3);
}
