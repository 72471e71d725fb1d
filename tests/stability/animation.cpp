#include "tests/stability/animation.h"

namespace afterglow::test {

Animation::Animation(std::uint32_t seed, std::size_t patches, float largest_reflectance)
    : problem(random_problem(seed, patches, Closure::closed, largest_reflectance)),
      random(seed),
      open_(patches, std::vector<double>(patches, 0.0)),
      changed_(patches, 0) {
    for (std::size_t i = 0; i < patches; ++i)
        for (std::uint64_t e = problem.matrix.row_begin[i]; e < problem.matrix.row_begin[i + 1]; ++e)
            open_[i][problem.matrix.column[e]] += static_cast<double>(problem.matrix.value[e]);
    rows_ = open_;
}

void Animation::look_elsewhere(Index row) {
    std::uniform_real_distribution<double> uniform(0, 1);
    std::vector<double>& now = rows_[row];
    double sum = 0;
    for (double& f : now) sum += f = uniform(random) < 0.5 ? uniform(random) : 0;
    if (sum == 0) sum = now[row] = 1;
    for (double& f : now) f /= sum;
    open_[row] = now;
    changed_[row] = 1;
}

void Animation::occlude(Index receivers, Index occluders, double share) {
    const std::size_t patches = rows_.size();
    for (Index i = 0; i < receivers; ++i) {
        double taken = 0;
        for (std::size_t j = 0; j < patches; ++j) {
            rows_[i][j] = open_[i][j] * (1 - share);
            taken += open_[i][j] * share;
        }
        for (std::size_t j = patches - occluders; j < patches; ++j) rows_[i][j] += taken / occluders;
        changed_[i] = 1;
    }
}

std::vector<Index> Animation::take_rows() {
    std::vector<Index> rows;
    for (std::size_t i = 0; i < changed_.size(); ++i)
        if (changed_[i] != 0) rows.push_back(static_cast<Index>(i));
    changed_.assign(changed_.size(), 0);
    problem.matrix = matrix_of(rows_);
    return rows;
}

}  // namespace afterglow::test
