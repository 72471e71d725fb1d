#include "service/jobs/event_log.h"

#include <algorithm>
#include <set>
#include <utility>

#include "service/http/http_message.h"
#include "solver/base/json.h"

namespace afterglow {

std::string_view name_of(EventKind kind) {
    switch (kind) {
        case EventKind::job:
            return "job";
        case EventKind::progress:
            return "progress";
        case EventKind::image:
        case EventKind::final_image:
            return "image";
        case EventKind::edit:
            return "edit";
        case EventKind::reused:
            return "reused";
        case EventKind::warning:
            return "warning";
        case EventKind::error:
            return "error";
        case EventKind::end:
            return "end";
    }
    return "";
}

EventLog::EventLog(EventLogConfig config, std::uint64_t first) : config_(config), last_id_(first) {}

EventLog::EventLog(EventLogConfig config, const std::string& kept) : config_(config) {
    try {
        const Json log = parse_json(kept, "event record");
        lost_id_ = log.at("lost").get<std::uint64_t>();
        last_id_ = log.at("last").get<std::uint64_t>();
        for (const Json& event : log.at("events")) {
            const auto id = event.at(0).get<std::uint64_t>();
            events_[id] = {id, static_cast<EventKind>(event.at(1).get<int>()), event.at(2).get<int>(),
                           event.at(3).get<std::string>()};
            if (events_[id].kind == EventKind::image) preliminary_[events_[id].frame].push_back(id);
        }
    } catch (const Json::exception& e) {
        throw Error(ErrorKind::invalid_input, "event record", e.what());
    }
    closed_ = !events_.empty() && events_.rbegin()->second.kind == EventKind::end;
}

std::string EventLog::kept() const {
    const std::lock_guard lock(mutex_);
    Json events = Json::array();
    const std::set<std::uint64_t> dropped(superseded_.begin(), superseded_.end());
    for (const auto& [id, event] : events_)
        if (event.kind != EventKind::progress && !dropped.contains(id))
            events.push_back({id, static_cast<int>(event.kind), event.frame, event.data});
    return dump({{"lost", lost_id_}, {"last", last_id_}, {"events", std::move(events)}});
}

void EventLog::append(EventKind kind, std::string data, int frame) {
    {
        const std::lock_guard lock(mutex_);
        if (closed_) return;
        const std::uint64_t id = ++last_id_;
        supersede(id, kind, frame);
        events_.emplace(id, Event{id, kind, frame, std::move(data)});
        make_room();
        closed_ = kind == EventKind::end;
    }
    changed_.notify_all();
}

void EventLog::close() {
    {
        const std::lock_guard lock(mutex_);
        closed_ = true;
    }
    changed_.notify_all();
}

void EventLog::reopen() {
    const std::lock_guard lock(mutex_);
    closed_ = false;
    // It is no longer the last one.
    std::erase_if(events_, [](const auto& known) { return known.second.kind == EventKind::end; });
}

void EventLog::forget() {
    const std::lock_guard lock(mutex_);
    if (!closed_ || events_.empty()) return;
    const auto last = std::prev(events_.end());
    if (last != events_.begin()) lost_id_ = std::prev(last)->first;
    events_.erase(events_.begin(), last);
    preliminary_.clear();
    superseded_.clear();
}

/// Notes what the event `id` makes superfluous.
void EventLog::supersede(std::uint64_t id, EventKind kind, int frame) {
    if (kind == EventKind::progress) {
        events_.erase(progress_id_);
        progress_id_ = id;
    } else if (kind == EventKind::image) {
        preliminary_[frame].push_back(id);
    } else if (kind == EventKind::final_image) {
        const auto earlier = preliminary_.extract(frame);
        if (!earlier.empty())
            superseded_.insert(superseded_.end(), earlier.mapped().begin(), earlier.mapped().end());
    }
}

void EventLog::make_room() {
    while (events_.size() > config_.capacity) {
        if (!superseded_.empty()) {
            // It may be gone already if it was the oldest of all once.
            events_.erase(superseded_.front());
            superseded_.pop_front();
            continue;
        }
        const auto oldest = events_.begin();
        if (oldest->second.kind != EventKind::progress) lost_id_ = oldest->first;
        events_.erase(oldest);
    }
}

EventLog::Batch EventLog::wait_after(std::uint64_t id, std::chrono::milliseconds timeout) const {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, timeout, [&] { return closed_ || last_id_ > id; });
    if (id < lost_id_) return {Status::too_old, Fill::partial, {}};
    Batch batch;
    for (auto it = events_.upper_bound(id); it != events_.end() && batch.events.size() < config_.batch; ++it)
        batch.events.push_back(it->second);
    if (batch.events.size() == config_.batch) batch.fill = Fill::full;
    if (batch.events.empty() && closed_) batch.status = Status::ended;
    return batch;
}

std::uint64_t EventLog::last_id() const {
    const std::lock_guard lock(mutex_);
    return last_id_;
}

std::size_t EventLog::size() const {
    const std::lock_guard lock(mutex_);
    return events_.size();
}

std::optional<Event> EventLog::end() const {
    const std::lock_guard lock(mutex_);
    if (events_.empty() || events_.rbegin()->second.kind != EventKind::end) return std::nullopt;
    return events_.rbegin()->second;
}

}  // namespace afterglow
