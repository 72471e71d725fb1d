#include "solver/formfactor/layered_matrix.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>

#include "solver/base/error.h"

namespace afterglow {

namespace {

constexpr std::size_t blocks_per_chunk = 8;
constexpr std::size_t rows_per_chunk = 512;

/// What a sight line counts for in its row.
Index column_of(const LayeredMatrix& matrix, const Lamps& lamps, Index row, Index target) {
    if (target == sees_nothing || target == sees_inside) return matrix.nowhere();
    const Index lamp = lamps.lamp_of_patch[target];
    if (lamp != no_index && matrix.ledger.by_light_lines[row * lamps.list.size() + lamp] != 0)
        return matrix.nowhere();
    return target;
}

/// Which kind of target a sight line meets, as its row tallies it.
Index& tallied(LineTally& tally, Index target, bool counts) {
    if (target == sees_nothing) return tally.outside;
    if (target == sees_inside) return tally.buried;
    return counts ? tally.on_others : tally.on_lamps;
}

/// Collects rows in which a column may be named many times.
class Counter {
  public:
    explicit Counter(std::size_t columns) : sum_(columns, 0) {}

    void add(Index column, float value) {
        if (sum_[column] == 0) touched_.push_back(column);
        sum_[column] += value;
    }
    void end_row(FormFactorMatrix& matrix) {
        std::sort(touched_.begin(), touched_.end());
        for (const Index column : touched_) {
            matrix.column.push_back(column);
            matrix.value.push_back(sum_[column]);
            sum_[column] = 0;
        }
        touched_.clear();
        matrix.row_begin.push_back(matrix.column.size());
    }

  private:
    std::vector<float> sum_;
    std::vector<Index> touched_;
};

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

void count_block(LayeredMatrix& matrix, const LayerScene& scene, std::size_t b, Counter& counter,
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
        counter.end_row(rows.sight);
        for (Index k = 0; k < scene.light.lines_per_patch(); ++k) {
            const float value = scene.background.light_contribution[scene.light.line(block, k, lane)];
            const Index lamp_patch = scene.light.lamp_patch(b, k);
            if (!(value > 0) || column_of(matrix, scene.lamps, row, lamp_patch) != matrix.nowhere()) continue;
            counter.add(lamp_patch, value);
            matrix.ledger.from_lamps[row] += static_cast<double>(value);
        }
        counter.end_row(rows.light);
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
        Counter counter(matrix.rows());
        for (std::size_t b = begin; b < end; ++b)
            count_block(matrix, scene, b, counter, parts[begin / blocks_per_chunk]);
    });
    for (const BaseRows& part : parts) {
        append(matrix.sight.base, part.sight);
        append(matrix.light.base, part.light);
    }
}

/// Scales the layers of the static rows and says which rows must be compiled whole.
void scale_rows(LayeredMatrix& matrix, const LayerScene& scene) {
    matrix.whole_rows.clear();
    const auto lines = static_cast<float>(scene.sight.lines_per_patch());
    const Index layered = matrix.ledger.has_moving_lamps ? 0 : scene.mesh.static_size();
    for (Index row = 0; row < layered; ++row) {
        const LineTally& tally = matrix.ledger.tally[row];
        double lit = matrix.ledger.from_lamps[row];
        for (const CoveredLine& line : matrix.light.covered[row]) lit -= static_cast<double>(line.value);
        const Index valid = tally.valid(), others = tally.outside + tally.on_others;
        matrix.valid_share[row] = static_cast<float>(valid) / lines;
        matrix.sight.scale[row] = matrix.light.scale[row] = matrix.sky[row] = 0;
        matrix.row_sum[row] = 0;
        if (valid == 0) continue;
        const double from_lamps = std::max(lit, 0.0) / static_cast<double>(matrix.valid_share[row]);
        if (from_lamps >= 1 || others == 0) {
            matrix.whole_rows.push_back(row);
            continue;
        }
        const double weight = (1 - from_lamps) / others;
        matrix.sight.scale[row] = static_cast<float>(weight);
        matrix.light.scale[row] = 1 / matrix.valid_share[row];
        matrix.sky[row] = static_cast<float>(weight * tally.outside);
        matrix.row_sum[row] = from_lamps + weight * tally.on_others;
    }
    for (Index row = layered; row < matrix.rows(); ++row) matrix.whole_rows.push_back(row);
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

/// Puts a line where it belongs among a row's covered lines, or takes it away where its background shows.
/// Returns the column in which it counted before.
Index place_line(std::vector<CoveredLine>& covered, const CoveredLine& line, bool is_covered) {
    const auto at = std::lower_bound(covered.begin(), covered.end(), line.line,
                                     [](const CoveredLine& a, Index b) { return a.line < b; });
    const bool known = at != covered.end() && at->line == line.line;
    const Index before = known ? at->now : line.base;
    if (known && !is_covered)
        covered.erase(at);
    else if (known)
        *at = line;
    else if (is_covered)
        covered.insert(at, line);
    return before;
}

/// The static patch that a line belongs to, by its number. Static blocks follow each other, all full but the
/// last.
Index row_of(const LayerScene& scene, std::size_t line, Index lines_per_patch) {
    const auto some_patch = static_cast<Index>(line / lines_per_patch);
    const Index first = some_patch - some_patch % block_size;
    const Index count = std::min(block_size, scene.mesh.static_size() - first);
    return first + static_cast<Index>((line - std::size_t{first} * lines_per_patch) % count);
}

/// One line at a time, from what it showed last to what it shows.
class Layers {
  public:
    Layers(LayeredMatrix& matrix, const LayerScene& scene, RowChanges& changes)
        : matrix_(matrix), scene_(scene), changes_(changes) {}

    void show_sight(const LineChange& change) {
        const Index row = row_of(scene_, change.line, scene_.sight.lines_per_patch());
        const Index background = scene_.background.background.patch[change.line];
        const CoveredLine line{change.line, column_of(matrix_, scene_.lamps, row, background),
                               column_of(matrix_, scene_.lamps, row, change.to), change.to, 1};
        const Index before = place_line(matrix_.sight.covered[row], line, change.to != background);
        LineTally& tally = matrix_.ledger.tally[row];
        --tallied(tally, change.from, before != matrix_.nowhere());
        ++tallied(tally, change.to, line.now != matrix_.nowhere());
        if (before != line.now) changes_.sight.push_back({row, before, line.now, 1});
        ++changes_.lines;
    }

    void show_light(Index number, float contribution) {
        const float value = scene_.background.light_contribution[number];
        const Index lines = scene_.light.lines_per_patch();
        const Index row = row_of(scene_, number, lines);
        const PatchBlock& block = scene_.sight.blocks()[row / block_size];
        const Index k = (number - static_cast<Index>(scene_.light.line(block, 0, 0))) / block.count;
        const Index lamp_patch = scene_.light.lamp_patch(row / block_size, k);
        if (!(value > 0) || column_of(matrix_, scene_.lamps, row, lamp_patch) != matrix_.nowhere()) return;
        const bool is_covered = !(contribution > 0);
        const CoveredLine line{number, lamp_patch, is_covered ? matrix_.nowhere() : lamp_patch, no_index,
                               value};
        const Index before = place_line(matrix_.light.covered[row], line, is_covered);
        if (before != line.now) changes_.light.push_back({row, before, line.now, value});
    }

  private:
    LayeredMatrix& matrix_;
    const LayerScene& scene_;
    RowChanges& changes_;
};

/// Looks for what one block's lines show otherwise than the layers do.
class Comparison {
  public:
    Comparison(const LayeredMatrix& matrix, const LayerScene& scene, const VisibleLines& visible)
        : matrix_(matrix), scene_(scene), visible_(visible) {}

    /// Sight lines of a block, by direction and lane.
    void find_sight(std::size_t b, std::vector<LineChange>& found) const {
        const PatchBlock& block = scene_.sight.blocks()[b];
        Cursors next = first_covered(block, matrix_.sight);
        for (Index d = 0; d < scene_.sight.lines_per_patch(); ++d)
            for (Index lane = 0; lane < block.count; ++lane) {
                const auto line = static_cast<Index>(scene_.sight.line(block, d, lane));
                const CoveredLine* covered = next[lane].take(line);
                const Index from =
                    covered != nullptr ? covered->target : scene_.background.background.patch[line];
                if (visible_.patch[line] != from) found.push_back({line, from, visible_.patch[line]});
            }
    }

    /// Light lines that are open or dark otherwise than the layers have it.
    void find_light(std::size_t b, std::vector<Index>& found) const {
        const PatchBlock& block = scene_.sight.blocks()[b];
        Cursors next = first_covered(block, matrix_.light);
        for (Index k = 0; k < scene_.light.lines_per_patch(); ++k)
            for (Index lane = 0; lane < block.count; ++lane) {
                const auto line = static_cast<Index>(scene_.light.line(block, k, lane));
                const bool covered = next[lane].take(line) != nullptr;
                const bool open = visible_.light_contribution[line] > 0;
                if (covered == open && scene_.background.light_contribution[line] > 0) found.push_back(line);
            }
    }

  private:
    /// Walks a row's covered lines as their numbers come by.
    struct Cursor {
        std::span<const CoveredLine> left;

        const CoveredLine* take(Index line) {
            if (left.empty() || left.front().line != line) return nullptr;
            const CoveredLine* taken = left.data();
            left = left.subspan(1);
            return taken;
        }
    };
    using Cursors = std::array<Cursor, block_size>;  ///< by lane
    static Cursors first_covered(const PatchBlock& block, const LayeredRows& layer) {
        Cursors cursors;
        for (Index lane = 0; lane < block.count; ++lane) cursors[lane] = {layer.covered[block.first + lane]};
        return cursors;
    }

    const LayeredMatrix& matrix_;
    const LayerScene& scene_;
    const VisibleLines& visible_;
};

/// What is left to do once the layers show the lines that changed.
void finish(LayeredMatrix& matrix, const LayerScene& scene, const VisibleLines& visible,
            const Context& context) {
    scale_rows(matrix, scene);
    compile_whole(matrix, scene, visible, context);
}

void append(RowChanges& changes, const RowChanges& more) {
    changes.sight.insert(changes.sight.end(), more.sight.begin(), more.sight.end());
    changes.light.insert(changes.light.end(), more.light.begin(), more.light.end());
    changes.lines += more.lines;
}

}  // namespace

LayeredMatrix make_layered_matrix(const LayerScene& scene, const Context& context) {
    const std::size_t patches = scene.mesh.size();
    if (patches * std::max(scene.sight.lines_per_patch(), scene.light.lines_per_patch()) >= no_index)
        throw Error(ErrorKind::too_large, "rays", "more than 2^32 lines cannot be numbered");
    LayeredMatrix matrix;
    matrix.sky.assign(patches, 0);
    matrix.valid_share.assign(patches, 0);
    matrix.row_sum.assign(patches, 0);
    matrix.ledger.has_moving_lamps = std::any_of(scene.lamps.list.begin(), scene.lamps.list.end(),
                                                 [](const Lamp& lamp) { return lamp.body != furniture; });
    if (!matrix.ledger.has_moving_lamps) count_base(matrix, scene, context);
    for (LayeredRows* layer : {&matrix.sight, &matrix.light}) {
        layer->base.row_begin.resize(patches + 1, layer->base.column.size());
        layer->columns = columns_of(layer->base, context);
        layer->covered.resize(patches);
        layer->scale.assign(patches, 0);
    }
    return matrix;
}

RowChanges show(LayeredMatrix& matrix, const LayerScene& scene, const VisibleLines& visible,
                const Context& context) {
    RowChanges all;
    if (!matrix.ledger.has_moving_lamps) {
        const std::size_t blocks = scene.sight.static_blocks();
        std::vector<RowChanges> parts((blocks + blocks_per_chunk - 1) / blocks_per_chunk);
        context.for_chunks(blocks, blocks_per_chunk, [&](std::size_t begin, std::size_t end) {
            LineChanges found;
            const Comparison comparison(matrix, scene, visible);
            for (std::size_t b = begin; b < end; ++b) {
                comparison.find_sight(b, found.sight);
                comparison.find_light(b, found.light);
            }
            Layers layers(matrix, scene, parts[begin / blocks_per_chunk]);
            for (const LineChange& change : found.sight) layers.show_sight(change);
            for (const Index line : found.light) layers.show_light(line, visible.light_contribution[line]);
        });
        for (const RowChanges& part : parts) append(all, part);
    }
    finish(matrix, scene, visible, context);
    return all;
}

RowChanges show(LayeredMatrix& matrix, const LayerScene& scene, const VisibleLines& visible,
                const LineChanges& changes, const Context& context) {
    RowChanges all;
    if (!matrix.ledger.has_moving_lamps) {
        Layers layers(matrix, scene, all);
        for (const LineChange& change : changes.sight) layers.show_sight(change);
        for (const Index line : changes.light) layers.show_light(line, visible.light_contribution[line]);
    }
    finish(matrix, scene, visible, context);
    return all;
}

std::vector<Rgb> lamp_irradiance(const LayeredMatrix& matrix, const Lamps& lamps,
                                 std::span<const Rgb> emission, const Context& context) {
    std::vector<Rgb> irradiance(matrix.rows(), Rgb(0));
    // By columns: each lamp reaches the rows that have an entry for it, in whichever layer.
    for (const LayeredRows* layer : {&matrix.sight, &matrix.light})
        for (const Index lamp : lamps.patches)
            for (auto e = layer->columns.column_begin[lamp]; e < layer->columns.column_begin[lamp + 1]; ++e) {
                const Index row = layer->columns.row[e];
                irradiance[row] += layer->scale[row] * layer->columns.value[e] * emission[lamp];
            }
    const auto light_of = [&](Index column) {
        const bool is_lamp = column != matrix.nowhere() && lamps.lamp_of_patch[column] != no_index;
        return is_lamp ? emission[column] : Rgb(0);
    };
    context.for_chunks(matrix.rows(), rows_per_chunk, [&](std::size_t begin, std::size_t end) {
        for (std::size_t row = begin; row < end; ++row)
            for (const LayeredRows* layer : {&matrix.sight, &matrix.light})
                for (const CoveredLine& line : layer->covered[row])
                    irradiance[row] +=
                        layer->scale[row] * line.value * (light_of(line.now) - light_of(line.base));
    });
    for (std::size_t k = 0; k < matrix.whole_rows.size(); ++k)
        for (auto e = matrix.whole.row_begin[k]; e < matrix.whole.row_begin[k + 1]; ++e)
            irradiance[matrix.whole_rows[k]] += matrix.whole.value[e] * light_of(matrix.whole.column[e]);
    // Covered light is taken off again: what rounding leaves below zero is zero.
    for (Rgb& value : irradiance) value = glm::max(value, Rgb(0));
    return irradiance;
}

}  // namespace afterglow
