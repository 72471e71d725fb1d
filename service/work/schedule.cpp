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

void Schedule::forget(const std::string& job) {
    remove(job);
    priorities_.erase(job);
}

bool Schedule::contains(const std::string& job) const {
    return is_resident(job) || std::find(waiting_.begin(), waiting_.end(), job) != waiting_.end();
}

void Schedule::set_priority(const std::string& job, int priority) {
    if (priority == 0)
        priorities_.erase(job);
    else
        priorities_[job] = priority;
}

int Schedule::priority_of(const std::string& job) const {
    const auto it = priorities_.find(job);
    return it == priorities_.end() ? 0 : it->second;
}

bool Schedule::is_resident(const std::string& job) const {
    return std::find(resident_.begin(), resident_.end(), job) != resident_.end();
}

/// The first of the highest priority.
Schedule::Line::iterator Schedule::first_in(Line& line) const {
    return std::max_element(line.begin(), line.end(), [&](const std::string& a, const std::string& b) {
        return priority_of(a) < priority_of(b);
    });
}

void Schedule::admit() {
    if (waiting_.empty()) return;
    const auto best = first_in(waiting_);
    if (resident_.size() >= max_resident_) {
        const auto worst = std::min_element(
            resident_.rbegin(), resident_.rend(),
            [&](const std::string& a, const std::string& b) { return priority_of(a) < priority_of(b); });
        if (priority_of(*worst) >= priority_of(*best)) return;
        std::string moved = std::move(*worst);
        resident_.erase(std::next(worst).base());
        resident_.push_front(*best);
        waiting_.erase(best);
        waiting_.push_front(std::move(moved));
        return;
    }
    resident_.push_front(*best);
    waiting_.erase(best);
}

std::optional<std::string> Schedule::next() {
    admit();
    if (resident_.empty()) return std::nullopt;
    const auto turn = first_in(resident_);
    std::string job = *turn;
    resident_.erase(turn);
    resident_.push_back(job);
    return job;
}

}  // namespace afterglow
