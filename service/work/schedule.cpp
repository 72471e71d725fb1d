#include "service/work/schedule.h"

#include <algorithm>

namespace afterglow {

Schedule::Schedule(std::size_t max_resident) : max_resident_(std::max<std::size_t>(max_resident, 1)) {}

void Schedule::add(const std::string& job) {
    waiting_.push_back(job);
}

void Schedule::remove(const std::string& job) {
    std::erase(waiting_, job);
    std::erase(resident_, job);
}

std::optional<std::string> Schedule::next() {
    if (!waiting_.empty() && resident_.size() < max_resident_) {
        resident_.push_front(waiting_.front());
        waiting_.pop_front();
    }
    if (resident_.empty()) return std::nullopt;
    std::string job = resident_.front();
    resident_.pop_front();
    resident_.push_back(job);
    return job;
}

}  // namespace afterglow
