#pragma once

// The two loops in which all solving time is spent: irradiance gathered by rows, light shot by columns.

#include <cstdint>
#include <span>

#include "solver/base/context.h"
#include "solver/base/math.h"
#include "solver/formfactor/matrix.h"

namespace afterglow {

/// Three channels and an unused fourth: one 16-byte load, multiply and add an entry, without branches.
/// A compiler's vector type because plain loops over channels vectorise with some compilers and flags only.
struct Lanes {
    using Vector = float __attribute__((vector_size(16)));
    Vector v{};
};

/// The same in double, for sums that many small terms are added to one by one.
struct DoubleLanes {
    using Vector = double __attribute__((vector_size(32)));
    Vector v{};
};

inline DoubleLanes to_double(const Lanes& lanes) {
    return {__builtin_convertvector(lanes.v, DoubleLanes::Vector)};
}

inline Lanes to_single(const DoubleLanes& lanes) {
    return {__builtin_convertvector(lanes.v, Lanes::Vector)};
}

inline Lanes to_lanes(const Rgb& c) {
    return {Lanes::Vector{c.r, c.g, c.b, 0.0F}};
}
inline Rgb to_rgb(const Lanes& lanes) {
    return {lanes.v[0], lanes.v[1], lanes.v[2]};
}

/// Irradiance gathered is exact but for this share of itself: at most 8 roundings of 2⁻²⁴ from reflectance ×
/// irradiance to the stored sum (2 for B, 1 a product, 2 in a run of four, 2 for the result and H0), however
/// long the row is.
inline constexpr double gather_rounding = 8 * 0x1p-24;

/// H_i = Σ_j F_ij B_j for every row, W/m². Sums runs of four entries in float and the runs in double: as
/// exact as double where it matters, and nearly as quick as float. `radiosity` and `irradiance`: one value a
/// row, not overlapping. Same bits for any number of threads.
void gather(const FormFactorMatrix& matrix, std::span<const Lanes> radiosity, std::span<Lanes> irradiance,
            const Context& context);

/// Σ_j F_ij B_j of one row, before it is rounded to float.
DoubleLanes gather_row(const FormFactorMatrix& matrix, std::size_t row, std::span<const Lanes> radiosity);

/// The same sums for some rows only: `irradiance[k]` is that of row `rows[k]`.
void gather_rows(const FormFactorMatrix& matrix, std::span<const Index> rows,
                 std::span<const Lanes> radiosity, std::span<Lanes> irradiance, const Context& context);

/// Adds F_ji ΔB_i to `irradiance[j]` for every receiver j of every shooting patch i, in the order given.
/// `shot`: ΔB by patch, W/m². One thread: large batches are better gathered.
void shoot(const FormFactorColumns& columns, std::span<const Index> patches, std::span<const Rgb> shot,
           std::span<Lanes> irradiance, const Context& context);

/// The same for those receivers only for which `active` is not 0. Returns how many form factors were used.
std::uint64_t shoot_to_active(const FormFactorColumns& columns, std::span<const Index> patches,
                              std::span<const Rgb> shot, std::span<const std::uint8_t> active,
                              std::span<Lanes> irradiance, const Context& context);

}  // namespace afterglow
