#include "service/http/elastic_threads.h"

#include <system_error>
#include <thread>
#include <utility>

namespace afterglow {

ElasticThreads::ElasticThreads(std::size_t max_threads)
    : max_threads_(max_threads), shared_(std::make_shared<Shared>()) {}

bool ElasticThreads::run(std::function<void()> task) {
    {
        const std::lock_guard lock(shared_->mutex);
        if (shared_->active >= max_threads_) return false;
        ++shared_->active;
    }
    const auto leave = [](Shared& shared) {
        const std::lock_guard lock(shared.mutex);
        --shared.active;
        shared.changed.notify_all();
    };
    try {
        std::thread([shared = shared_, task = std::move(task), leave]() mutable {
            task();
            task = nullptr;  // what it holds goes before the thread counts as gone
            leave(*shared);
        }).detach();
    } catch (const std::system_error&) {
        leave(*shared_);
        return false;
    }
    return true;
}

std::size_t ElasticThreads::active() const {
    const std::lock_guard lock(shared_->mutex);
    return shared_->active;
}

bool ElasticThreads::wait_until_idle(std::chrono::milliseconds limit) const {
    std::unique_lock lock(shared_->mutex);
    return shared_->changed.wait_for(lock, limit, [&] { return shared_->active == 0; });
}

}  // namespace afterglow
