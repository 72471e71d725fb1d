#include "solver/formfactor/layered_matrix.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "solver/base/error.h"
#include "solver/formfactor/covered_lines.h"
#include "solver/formfactor/row_counter.h"

namespace afterglow {

namespace {

constexpr std::size_t blocks_per_chunk = 8;
constexpr std::size_t rows_per_chunk = 512;

void end_row(RowCounter& counter, FormFactorMatrix& matrix) {
    counter.end_row([&](Index column, float value) {
        matrix.column.push_back(column);
        matrix.value.push_back(value);
    });
    matrix.row_begin.push_back(matrix.column.size());
}

/// Appends the rows of one matrix to another.
void append(FormFactorMatrix& matrix, const FormFactorMatrix& rows) {
    const std::uint64_t before = matrix.column.size();
    matrix.column.insert(matrix.column.end(), rows.column.begin(), rows.column.end());
    matrix.value.insert(matrix.value.end(), rows.value.begin(), rows.value.end());
    for (std::size_t r = 1; r < rows.row_begin.size(); ++r)
        matrix.row_begin.push_back(before + rows.row_begin[r]);
}

/// Rows of consecutive blocks.
struct BaseRows {
    FormFactorMatrix sight, light;
};

void count_block(LayeredMatrix& matrix, const LayerScene& scene, std::size_t b, RowCounter& counter,
                 BaseRows& rows) {
    const PatchBlock& block = scene.sight.blocks()[b];
    for (Index lane = 0; lane < block.count; ++lane) {
        const Index row = block.first + lane;
        LineTally& tally = matrix.ledger.tally[row];
        for (Index d = 0; d < scene.sight.lines_per_patch(); ++d) {
            const Index target = scene.background.background.patch[scene.sight.line(block, d, lane)];
            const Index column = column_of(matrix, scene.lamps, row, target);
            ++tallied(tally, target, column != matrix.nowhere());
            if (column != matrix.nowhere()) counter.add(column, 1);
        }
        end_row(counter, rows.sight);
        for (Index k = 0; k < scene.light.lines_per_patch(); ++k) {
            const float value = scene.background.light_contribution[scene.light.line(block, k, lane)];
            const Index lamp_patch = scene.light.lamp_patch(b, k);
            if (!(value > 0) || column_of(matrix, scene.lamps, row, lamp_patch) != matrix.nowhere()) continue;
            counter.add(lamp_patch, value);
            matrix.ledger.from_lamps[row] += static_cast<double>(value);
        }
        end_row(counter, rows.light);
    }
}

/// Which lamps each static patch samples by light lines.
void tell_lamps(LayeredMatrix& matrix, const LayerScene& scene, const Context& context) {
    const std::size_t lamps = scene.lamps.list.size();
    matrix.ledger.by_light_lines.resize(scene.mesh.static_size() * lamps);
    context.for_chunks(scene.mesh.static_size(), rows_per_chunk, [&](std::size_t begin, std::size_t end) {
        for (std::size_t row = begin; row < end; ++row) {
            const std::vector<char> near =
                lamps_near(scene.mesh, scene.lamps, scene.placed, static_cast<Index>(row));
            for (std::size_t l = 0; l < lamps; ++l)
                matrix.ledger.by_light_lines[row * lamps + l] = static_cast<char>(near[l] == 0);
        }
    });
}

void count_base(LayeredMatrix& matrix, const LayerScene& scene, const Context& context) {
    tell_lamps(matrix, scene, context);
    matrix.ledger.tally.resize(scene.mesh.static_size());
    matrix.ledger.from_lamps.assign(scene.mesh.static_size(), 0);
    const std::size_t blocks = scene.sight.static_blocks();
    std::vector<BaseRows> parts((blocks + blocks_per_chunk - 1) / blocks_per_chunk);
    context.for_chunks(blocks, blocks_per_chunk, [&](std::size_t begin, std::size_t end) {
        RowCounter counter(matrix.rows());
        for (std::size_t b = begin; b < end; ++b)
            count_block(matrix, scene, b, counter, parts[begin / blocks_per_chunk]);
    });
    for (const BaseRows& part : parts) {
        append(matrix.sight.base, part.sight);
        append(matrix.light.base, part.light);
    }
}

/// Scales the layers of a static row whose light lines add up to `lit`; false where it must be compiled
/// whole.
bool scale_row(LayeredMatrix& matrix, const SightLines& sight, std::size_t row, double lit) {
    const LineTally& tally = matrix.ledger.tally[row];
    const Index valid = tally.valid(), others = tally.outside + tally.on_others;
    matrix.valid_share[row] = static_cast<float>(valid) / static_cast<float>(sight.lines_per_patch());
    matrix.sight.scale[row] = matrix.light.scale[row] = matrix.sky[row] = 0;
    matrix.row_sum[row] = 0;
    if (valid == 0) return true;
    const double from_lamps = lit / static_cast<double>(matrix.valid_share[row]);
    if (from_lamps >= 1 || others == 0) return false;
    const double weight = (1 - from_lamps) / others;
    matrix.sight.scale[row] = static_cast<float>(weight);
    matrix.light.scale[row] = 1 / matrix.valid_share[row];
    matrix.sky[row] = static_cast<float>(weight * tally.outside);
    matrix.row_sum[row] = from_lamps + weight * tally.on_others;
    return true;
}

/// Scales the layers of the static rows and says which rows must be compiled whole.
void scale_rows(LayeredMatrix& matrix, const LayerScene& scene, const Context& context) {
    matrix.whole_rows.clear();
    const Index layered = matrix.ledger.has_moving_lamps ? 0 : scene.mesh.static_size();
    std::vector<char> is_whole(layered);
    context.for_chunks(layered, rows_per_chunk, [&](std::size_t begin, std::size_t end) {
        std::array<double, rows_per_chunk> lit;
        std::copy(matrix.ledger.from_lamps.begin() + static_cast<std::ptrdiff_t>(begin),
                  matrix.ledger.from_lamps.begin() + static_cast<std::ptrdiff_t>(end), lit.begin());
        for (std::size_t b = begin / block_size; b * block_size < end; ++b)
            for_covered(matrix.light, b, [&](std::size_t row, Index, Index, float value) {
                lit[row - begin] -= static_cast<double>(value);
            });
        for (std::size_t row = begin; row < end; ++row)
            is_whole[row] = scale_row(matrix, scene.sight, row, std::max(lit[row - begin], 0.0)) ? 0 : 1;
    });
    for (Index row = 0; row < matrix.rows(); ++row)
        if (row >= layered || is_whole[row] != 0) matrix.whole_rows.push_back(row);
}

void compile_whole(LayeredMatrix& matrix, const LayerScene& scene, const VisibleLines& visible,
                   const Context& context) {
    const SeenLines seen{visible.patch, scene.sight.lines_per_patch(), visible.light_contribution};
    FormFactors rows = compile_rows_of(matrix.whole_rows, scene.mesh, scene.sight, scene.light, scene.lamps,
                                       scene.placed, seen, context);
    for (std::size_t k = 0; k < matrix.whole_rows.size(); ++k) {
        const Index row = matrix.whole_rows[k];
        matrix.sky[row] = rows.sky[k];
        matrix.valid_share[row] = rows.valid_share[k];
        const auto begin = rows.matrix.value.begin();
        matrix.row_sum[row] =
            std::accumulate(begin + static_cast<std::ptrdiff_t>(rows.matrix.row_begin[k]),
                            begin + static_cast<std::ptrdiff_t>(rows.matrix.row_begin[k + 1]), 0.0);
    }
    matrix.whole = std::move(rows.matrix);
}

/// What is left to do once the layers show the lines that changed.
void finish(LayeredMatrix& matrix, const LayerScene& scene, const VisibleLines& visible,
            const Context& context) {
    scale_rows(matrix, scene, context);
    compile_whole(matrix, scene, visible, context);
}

CountColumns counted(const FormFactorColumns& columns) {
    CountColumns packed{{0}, {}};
    packed.entry.reserve(columns.row.size());
    for (std::size_t column = 0; column + 1 < columns.column_begin.size(); ++column) {
        for (auto e = columns.column_begin[column]; e < columns.column_begin[column + 1]; ++e) {
            auto lines = static_cast<std::uint32_t>(columns.value[e]);
            for (; lines > CountColumns::most_lines; lines -= CountColumns::most_lines)
                packed.entry.push_back(columns.row[e] << CountColumns::row_shift | CountColumns::most_lines);
            packed.entry.push_back(columns.row[e] << CountColumns::row_shift | lines);
        }
        packed.column_begin.push_back(packed.entry.size());
    }
    return packed;
}

template <class Take>
void for_row(const FormFactorMatrix& matrix, std::size_t row, const Take& take) {
    for (std::uint64_t e = matrix.row_begin[row]; e < matrix.row_begin[row + 1]; ++e)
        take(matrix.column[e], matrix.value[e]);
}

/// Whether sight lines of any patch of a static block count for lamps.
bool counts_lamps(const LayeredMatrix& matrix, const Lamps& lamps, std::size_t block) {
    const std::span<const char> all = matrix.ledger.by_light_lines;
    const std::size_t of_block = block_size * lamps.list.size(),
                      first = std::min(block * of_block, all.size());
    const auto here = all.subspan(first, std::min(of_block, all.size() - first));
    return std::find(here.begin(), here.end(), 0) != here.end();
}

bool by_line(const LineChange& a, const LineChange& b) {
    return a.line < b.line;
}

/// Calls `work(b, layers)` for every static block, chunk by chunk, each with a list of changes of its own.
template <class Work>
void for_blocks(LayeredMatrix& matrix, const LayerScene& scene, const Context& context, const Work& work) {
    const std::size_t blocks = matrix.ledger.has_moving_lamps ? 0 : scene.sight.static_blocks();
    std::vector<RowChanges>& parts = matrix.ledger.changes;
    parts.resize((blocks + blocks_per_chunk - 1) / blocks_per_chunk);
    context.for_chunks(blocks, blocks_per_chunk, [&](std::size_t begin, std::size_t end) {
        CoverUpdate layers(matrix, scene, parts[begin / blocks_per_chunk]);
        for (std::size_t b = begin; b < end; ++b) work(b, layers);
    });
}

}  // namespace

LayeredMatrix make_layered_matrix(const LayerScene& scene, const Context& context) {
    const std::size_t patches = scene.mesh.size();
    if (patches * std::max(scene.sight.lines_per_patch(), scene.light.lines_per_patch()) >= no_index)
        throw Error(ErrorKind::too_large, "rays", "more than 2^32 lines cannot be numbered");
    if (patches >= CountColumns::most_rows)
        throw Error(ErrorKind::too_large, "patches", "the layers count 16 million at most");
    LayeredMatrix matrix;
    matrix.sky.assign(patches, 0);
    matrix.valid_share.assign(patches, 0);
    matrix.row_sum.assign(patches, 0);
    matrix.ledger.has_moving_lamps = std::any_of(scene.lamps.list.begin(), scene.lamps.list.end(),
                                                 [](const Lamp& lamp) { return lamp.body != furniture; });
    if (!matrix.ledger.has_moving_lamps) count_base(matrix, scene, context);
    for (LayeredRows* layer : {&matrix.sight, &matrix.light}) {
        layer->base.row_begin.resize(patches + 1, layer->base.column.size());
        layer->covered.resize(scene.sight.static_blocks());
        layer->scale.assign(patches, 0);
    }
    matrix.sight_columns = counted(columns_of(matrix.sight.base, context));
    matrix.light_columns = columns_of(matrix.light.base, context);
    return matrix;
}

std::span<const RowChanges> show(LayeredMatrix& matrix, const LayerScene& scene, const VisibleLines& visible,
                                 const Context& context) {
    const CoverComparison comparison(matrix, scene, visible);
    for_blocks(matrix, scene, context, [&](std::size_t b, CoverUpdate& layers) {
        LineChanges found;
        comparison.find_sight(b, found.sight);
        comparison.find_light(b, found.light);
        layers.show_sight(b, found.sight);
        for (const Index line : found.light) layers.show_light(line, visible.light_contribution[line]);
    });
    finish(matrix, scene, visible, context);
    return matrix.ledger.changes;
}

std::span<const RowChanges> show(LayeredMatrix& matrix, const LayerScene& scene, const VisibleLines& visible,
                                 LineChanges changes, const Context& context) {
    // In most frames they are sorted already.
    if (!std::is_sorted(changes.sight.begin(), changes.sight.end(), by_line))
        std::stable_sort(changes.sight.begin(), changes.sight.end(), by_line);
    std::sort(changes.light.begin(), changes.light.end());
    for_blocks(matrix, scene, context, [&](std::size_t b, CoverUpdate& layers) {
        const PatchBlock& block = scene.sight.blocks()[b];
        const auto from = [&](Index direction) {
            const LineChange first{static_cast<Index>(scene.sight.line(block, direction, 0)), 0, 0};
            return std::lower_bound(changes.sight.begin(), changes.sight.end(), first, by_line);
        };
        layers.show_sight(b, {from(0), from(scene.sight.lines_per_patch())});
        const auto light_from = [&](Index k) {
            return std::lower_bound(changes.light.begin(), changes.light.end(),
                                    static_cast<Index>(scene.light.line(block, k, 0)));
        };
        for (auto line = light_from(0); line != light_from(scene.light.lines_per_patch()); ++line)
            layers.show_light(*line, visible.light_contribution[*line]);
    });
    finish(matrix, scene, visible, context);
    return matrix.ledger.changes;
}

std::uint64_t lines_changed(std::span<const RowChanges> changes) {
    std::uint64_t lines = 0;
    for (const RowChanges& part : changes) lines += part.lines;
    return lines;
}

std::vector<Rgb> lamp_irradiance(const LayeredMatrix& matrix, const Lamps& lamps,
                                 std::span<const Rgb> emission, const Context& context) {
    std::vector<Rgb> irradiance(matrix.rows(), Rgb(0));
    // Sight lines count lamps in few rows, so by columns; light lines count nothing else, so by rows.
    for (const Index lamp : lamps.patches)
        for_column(matrix.sight_columns, lamp, [&](Index row, float lines) {
            irradiance[row] += matrix.sight.scale[row] * lines * emission[lamp];
        });
    const auto light_of = [&](Index column) {
        const bool is_lamp = column != matrix.nowhere() && lamps.lamp_of_patch[column] != no_index;
        return is_lamp ? emission[column] : Rgb(0);
    };
    const auto uncover = [&](const LayeredRows& layer, std::size_t block) {
        for_covered(layer, block, [&](std::size_t row, Index base, Index now, float value) {
            irradiance[row] += layer.scale[row] * value * (light_of(now) - light_of(base));
        });
    };
    context.for_chunks(
        matrix.sight.covered.size(), blocks_per_chunk, [&](std::size_t begin, std::size_t end) {
            for (std::size_t row = begin * block_size; row < std::min(end * block_size, matrix.rows()); ++row)
                for_row(matrix.light.base, row, [&](Index column, float value) {
                    irradiance[row] += matrix.light.scale[row] * value * emission[column];
                });
            for (std::size_t b = begin; b < end; ++b) {
                if (counts_lamps(matrix, lamps, b)) uncover(matrix.sight, b);
                uncover(matrix.light, b);
            }
        });
    context.for_chunks(matrix.whole_rows.size(), rows_per_chunk, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k)
            for_row(matrix.whole, k, [&](Index column, float value) {
                irradiance[matrix.whole_rows[k]] += value * light_of(column);
            });
    });
    // Covered light is taken off again: what rounding leaves below zero is zero.
    for (Rgb& value : irradiance) value = glm::max(value, Rgb(0));
    return irradiance;
}

}  // namespace afterglow
