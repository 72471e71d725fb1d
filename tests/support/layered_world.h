#pragma once

#include "solver/formfactor/layered_matrix.h"
#include "tests/support/lined_world.h"

namespace afterglow::testing {

/// A world whose matrix in layers follows its actors, all lines being traced anew each time.
struct LayeredWorld {
    LinedWorld lined;
    StaticLines background;
    VisibleLines visible;
    LayeredMatrix matrix;

    LayeredWorld(World world, float patch_size_m, Index lines, Index light_lines = 16, int threads = 2)
        : lined(std::move(world), patch_size_m, lines, light_lines),
          background(background_of(lined)),
          visible(make_visible_lines(lined.mesh, lined.sight, lined.light)) {
        lined.caster.set_poses(poses_at(lined.world, 0));
        matrix = make_layered_matrix(scene(), Context(threads));
    }

    [[nodiscard]] LayerScene scene() const {
        return {lined.mesh, lined.sight, lined.light, lined.lamps, lined.caster, background};
    }
    /// Traces everything at a time; the matrix is not brought there.
    void look(double time_s) {
        lined.caster.set_poses(poses_at(lined.world, time_s));
        make_retrace()->update({lined.mesh, lined.sight, lined.light, lined.caster, background},
                               {0, lined.sight.lines_per_patch()}, visible, Context(2));
    }
    std::span<const RowChanges> show_at(double time_s, int threads = 2) {
        look(time_s);
        return show(matrix, scene(), visible, Context(threads));
    }
    /// The matrix of this moment, compiled from nothing: the slow oracle.
    [[nodiscard]] FormFactors compiled() const {
        return compile_rows(lined.mesh, lined.sight, lined.light, lined.lamps, lined.caster,
                            {visible.patch, lined.sight.lines_per_patch(), visible.light_contribution},
                            Context(2));
    }
};

/// All layers together, as one dense row; its last element is what counts nowhere.
inline std::vector<double> dense_row(const LayeredMatrix& matrix, std::size_t row) {
    std::vector<double> sum(matrix.rows() + 1, 0);
    for (const LayeredRows* layer : {&matrix.sight, &matrix.light}) {
        const double scale = layer->scale[row];
        for (auto e = layer->base.row_begin[row]; e < layer->base.row_begin[row + 1]; ++e)
            sum[layer->base.column[e]] += scale * static_cast<double>(layer->base.value[e]);
        if (row / block_size >= layer->covered.size()) continue;
        for_covered(*layer, row / block_size, [&](std::size_t of, Index base, Index now, float value) {
            if (of != row) return;
            sum[base] -= scale * static_cast<double>(value);
            sum[now] += scale * static_cast<double>(value);
        });
    }
    for (std::size_t k = 0; k < matrix.whole_rows.size(); ++k)
        if (matrix.whole_rows[k] == row)
            for (auto e = matrix.whole.row_begin[k]; e < matrix.whole.row_begin[k + 1]; ++e)
                sum[matrix.whole.column[e]] += static_cast<double>(matrix.whole.value[e]);
    return sum;
}

}  // namespace afterglow::testing
