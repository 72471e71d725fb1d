#include "solver/radiosity/exchange.h"

namespace afterglow {

namespace {

constexpr std::size_t rows_a_chunk = 256;
constexpr std::size_t patches_between_checks = 1024;

}  // namespace

DoubleLanes gather_row(const FormFactorMatrix& matrix, std::size_t row, std::span<const Lanes> radiosity) {
    const Index* const column = matrix.column.data();
    const float* const value = matrix.value.data();
    const std::uint64_t end = matrix.row_begin[row + 1];
    std::uint64_t e = matrix.row_begin[row];
    const auto light = [&](std::uint64_t entry) { return value[entry] * radiosity[column[entry]].v; };
    DoubleLanes sum;
    for (; e + 4 <= end; e += 4) {
        const Lanes::Vector run = (light(e) + light(e + 1)) + (light(e + 2) + light(e + 3));
        sum.v += __builtin_convertvector(run, DoubleLanes::Vector);
    }
    for (; e < end; ++e) sum.v += __builtin_convertvector(light(e), DoubleLanes::Vector);
    return sum;
}

void gather(const FormFactorMatrix& matrix, std::span<const Lanes> radiosity, std::span<Lanes> irradiance,
            const Context& context) {
    context.for_chunks(matrix.rows(), rows_a_chunk, [&](std::size_t first, std::size_t last) {
        for (std::size_t row = first; row < last; ++row)
            irradiance[row].v = __builtin_convertvector(gather_row(matrix, row, radiosity).v, Lanes::Vector);
    });
}

void gather_rows(const FormFactorMatrix& matrix, std::span<const Index> rows,
                 std::span<const Lanes> radiosity, std::span<Lanes> irradiance, const Context& context) {
    context.for_chunks(rows.size(), rows_a_chunk, [&](std::size_t first, std::size_t last) {
        for (std::size_t k = first; k < last; ++k)
            irradiance[k].v =
                __builtin_convertvector(gather_row(matrix, rows[k], radiosity).v, Lanes::Vector);
    });
}

void shoot(const FormFactorColumns& columns, std::span<const Index> patches, std::span<const Rgb> shot,
           std::span<Lanes> irradiance, const Context& context) {
    Lanes* const receivers = irradiance.data();
    const Index* const row = columns.row.data();
    const float* const value = columns.value.data();
    for (std::size_t k = 0; k < patches.size(); ++k) {
        if (k % patches_between_checks == 0) context.check_stop();
        const Index i = patches[k];
        const Lanes::Vector light = to_lanes(shot[i]).v;
        const std::uint64_t end = columns.column_begin[i + 1];
        for (std::uint64_t e = columns.column_begin[i]; e < end; ++e) receivers[row[e]].v += value[e] * light;
    }
}

std::uint64_t shoot_to_active(const FormFactorColumns& columns, std::span<const Index> patches,
                              std::span<const Rgb> shot, std::span<const std::uint8_t> active,
                              std::span<Lanes> irradiance, const Context& context) {
    std::uint64_t used = 0;
    for (std::size_t k = 0; k < patches.size(); ++k) {
        if (k % patches_between_checks == 0) context.check_stop();
        const Index i = patches[k];
        const Lanes::Vector light = to_lanes(shot[i]).v;
        for (std::uint64_t e = columns.column_begin[i]; e < columns.column_begin[i + 1]; ++e) {
            const Index receiver = columns.row[e];
            if (active[receiver] == 0) continue;
            irradiance[receiver].v += columns.value[e] * light;
            ++used;
        }
    }
    return used;
}

}  // namespace afterglow
