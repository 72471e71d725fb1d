#include "solver/sequence/quality.h"

namespace afterglow {

QualityLevel level_of(const SequenceConfig& config) {
    QualityLevel level;
    switch (config.quality) {
        case Quality::draft:
            level.finest_share = 1;
            level.rays_per_patch = 128;
            level.picture = {1, 4, 2, 0.1F};
            break;
        case Quality::preview:
            level.picture = {4, 16, 2, 0.05F};
            break;
        case Quality::final:
            level.cells = 6000;
            level.rays_per_patch = 512;
            level.picture = {8, 64, 4, 0.02F};
            break;
    }
    level.picture.seed = config.seed;
    if (config.rays_per_patch) level.rays_per_patch = *config.rays_per_patch;
    return level;
}

}  // namespace afterglow
