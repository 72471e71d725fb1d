#include <algorithm>
#include <cmath>

#include "solver/image/camera.h"
#include "solver/radiosity/progressive.h"
#include "solver/radiosity/residual.h"
#include "solver/visibility/events.h"
#include "tests/bench/assess/parts.h"
#include "tests/bench/room.h"
#include "tests/bench/timing.h"

namespace afterglow {
namespace {

const Context one_thread(1);
constexpr FrameClock frame_clock{24};
constexpr double exact_error = 1e-5;

/// A room with what its lines see at a frame, found by the events strategy.
struct SeenRoom : LitRoom {
    std::unique_ptr<VisibilityStrategy> events;
    VisibleLines visible;

    explicit SeenRoom(const PartScene& scene)
        : LitRoom(scene.world, scene.patch_size_m, scene.rays, 64),
          events(make_events(world, frame_clock)),
          visible(make_visible_lines(mesh, sight, light)) {
        extend_static_lines(background, mesh, sight, light, caster, sight.lines_per_patch(), one_thread);
    }
    void look(int frame) {
        caster.set_poses(poses_at(world, frame_clock.time_of(frame)));
        events->update(lines(frame), all(), visible, one_thread);
    }
    [[nodiscard]] FormFactors rows() const {
        return compile_rows(mesh, sight, light, lamps, caster,
                            {visible.patch, sight.lines_per_patch(), visible.light_contribution}, one_thread);
    }
};

/// How far a solution is off, relative to the mean reflected light.
struct Off {
    double rms = 0;  ///< over area
    double most = 0;
};

Off off_by(const RadiosityProblem& problem, std::span<const Rgb> shown, std::span<const Rgb> exact) {
    Off off;
    double square = 0, area = 0;
    for (std::size_t i = 0; i < shown.size(); ++i) {
        const Rgb d = problem.reflectance[i] * (shown[i] - exact[i]);
        square += static_cast<double>(problem.area[i] * glm::dot(d, d)) / 3;
        area += static_cast<double>(problem.area[i]);
        off.most = std::max(off.most, static_cast<double>(max_channel(glm::abs(d))));
    }
    const double mean = mean_reflected(problem, exact);
    return {std::sqrt(square / area) / mean, off.most / mean};
}

ProgressiveSolution solved(const RadiosityProblem& problem, const FormFactorColumns& columns, double error) {
    ProgressiveConfig config;
    config.asked_error = error;
    return solve_progressive(problem, columns, config, one_thread);
}

/// Which patches the first camera sees at time 0, and which move.
struct Roles {
    std::vector<std::uint8_t> seen, moving;
    std::vector<Index> object, surface;

    explicit Roles(const LinedRoom& room) : seen(room.mesh.size(), 0) {
        constexpr int edge = 256;
        const CameraView view = view_at(room.world.cameras.front(), 0, edge, edge);
        for (int y = 0; y < edge; ++y)
            for (int x = 0; x < edge; ++x) {
                const Ray ray = view.ray(static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F);
                const Index patch =
                    target_of(room.caster.nearest(ray, Scope::everything), ray, room.mesh, room.caster);
                if (patch < room.mesh.size()) seen[patch] = 1;
            }
        for (Index p = 0; p < room.mesh.size(); ++p) moving.push_back(room.mesh.body[p] != furniture ? 1 : 0);
        object.assign(room.mesh.body.begin(), room.mesh.body.end());
        surface.assign(room.mesh.surface.begin(), room.mesh.surface.end());
    }
    [[nodiscard]] PatchRoles view() const { return {seen, moving, object, surface}; }
};

/// What a following solution is held against while its frames go by.
void print_promise(const PartRows& print, const char* solution, int frame, double asked,
                   const Certificate& promised, const Off& off) {
    print({{"way", solution},
           {"frame", frame},
           {"asked", asked},
           {"certificate", promised.error_bound},
           {"rms", off.rms},
           {"most", off.most}});
}

/// Light as residual follows it, frame by frame, and cold; both against exact light.
void follow_with(SeenRoom& room, double asked, int frames, const PartRows& print) {
    LayeredMatrix matrix;
    ResidualState state;
    ResidualConfig config;
    config.asked_error = asked;
    for (int f = 0; f < frames; ++f) {
        room.look(f);
        const ResidualProblem problem{matrix, room.mesh.area_m2, room.emission, room.reflectance,
                                      room.external};
        if (f == 0) {
            matrix = make_layered_matrix(room.layers(), one_thread);
            show(matrix, room.layers(), room.visible, one_thread);
            state = make_residual_state(problem, one_thread);
        } else {
            follow(state, problem, show(matrix, room.layers(), room.visible, one_thread), one_thread);
        }
        const Certificate promised = step(state, problem, config, one_thread);
        const FormFactors rows = room.rows();
        const FormFactorColumns columns = columns_of(rows.matrix, one_thread);
        const auto exact = solved(room.problem(rows.matrix), columns, exact_error);
        const auto& light = exact.state.irradiance;
        print_promise(print, "residual", f, asked, promised,
                      off_by(room.problem(rows.matrix), state.irradiance, light));
        if (f > 0) continue;
        const auto cold = solved(room.problem(rows.matrix), columns, asked);
        print_promise(print, "progressive", f, asked, cold.certificate,
                      off_by(room.problem(rows.matrix), cold.state.irradiance, light));
    }
}

}  // namespace

void measure_orders(const PartScene& scene, const PartRows& print) {
    SeenRoom room(scene);
    room.look(0);
    const FormFactors rows = room.rows();
    const FormFactorColumns columns = columns_of(rows.matrix, one_thread);
    const RadiosityProblem problem = room.problem(rows.matrix);
    const Roles roles(room);
    const auto exact = solved(problem, columns, exact_error);
    for (const auto& [name, order] : {std::pair{"threshold-scan", ShootingOrder::threshold_scan},
                                      {"estimated", ShootingOrder::estimated},
                                      {"report", ShootingOrder::report},
                                      {"largest-first", ShootingOrder::largest_first}})
        for (const double share : {0.25, 2.0}) {
            ProgressiveConfig config;
            config.order = order;
            config.sweep_share = share;
            config.roles = roles.view();
            ProgressiveSolution made;
            const double ms = ms_of([&] { made = solve_progressive(problem, columns, config, one_thread); });
            const Off off = off_by(problem, made.state.irradiance, exact.state.irradiance);
            print({{"way", std::string(name) + (share > 1 ? ", shots alone" : ", with sweeps")},
                   {"patches", room.mesh.size()},
                   {"ms", ms},
                   {"shots", made.state.shots},
                   {"work",
                    static_cast<double>(made.state.entries) / static_cast<double>(rows.matrix.entries())},
                   {"certificate", made.certificate.error_bound},
                   {"rms", off.rms}});
        }
}

void measure_certificates(const PartScene& scene, const PartRows& print) {
    for (const double asked : {0.1, 0.05, 0.02, 0.01, 0.005}) {
        SeenRoom room(scene);
        follow_with(room, asked, 6, print);
    }
}

}  // namespace afterglow
