#include "client/backoff.h"

namespace afterglow::client {

std::optional<std::chrono::milliseconds> Backoff::next() {
    if (failures_ >= config_.attempts) return std::nullopt;
    std::chrono::milliseconds wait = config_.first;
    // Stops at the longest wait, so that the doubling cannot overflow however many attempts are allowed.
    for (int i = 0; i < failures_ && wait < config_.longest; ++i) wait *= 2;
    ++failures_;
    return wait < config_.longest ? wait : config_.longest;
}

}  // namespace afterglow::client
