#include "service/work/encoder.h"

#include <algorithm>
#include <utility>

#include "solver/base/pixels.h"

namespace afterglow {

namespace {
bool must_stay(const PictureTask& task) {
    return task.revision.final || task.keep == PictureTask::Keep::always;
}
}  // namespace

Encoder::Encoder(FrameStore& frames, EncoderEvents events, EncoderConfig config)
    : frames_(frames), events_(std::move(events)), config_(config), thread_([this] { loop(); }) {}

Encoder::~Encoder() {
    {
        const std::lock_guard lock(mutex_);
        stopping_ = true;
    }
    changed_.notify_all();
    thread_.join();
}

std::size_t Encoder::kept_waiting() const {
    return static_cast<std::size_t>(std::count_if(
        items_.begin(), items_.end(), [](const Item& item) { return !item.action && must_stay(item.task); }));
}

void Encoder::submit(PictureTask task) {
    {
        std::unique_lock lock(mutex_);
        if (must_stay(task)) changed_.wait(lock, [&] { return kept_waiting() < config_.max_waiting; });
        const auto superseded = std::find_if(items_.begin(), items_.end(), [&](const Item& item) {
            return !item.action && !must_stay(item.task) && item.task.job == task.job &&
                   item.task.revision.frame == task.revision.frame;
        });
        if (superseded != items_.end()) items_.erase(superseded);
        items_.push_back({std::move(task), nullptr});
    }
    changed_.notify_all();
}

void Encoder::after_pictures(std::function<void()> action) {
    {
        const std::lock_guard lock(mutex_);
        items_.push_back({{}, std::move(action)});
    }
    changed_.notify_all();
}

void Encoder::forget(const std::string& job) {
    {
        const std::lock_guard lock(mutex_);
        std::erase_if(items_, [&](const Item& item) { return !item.action && item.task.job == job; });
    }
    changed_.notify_all();
}

void Encoder::loop() {
    std::unique_lock lock(mutex_);
    while (true) {
        changed_.wait(lock, [&] { return stopping_ || !items_.empty(); });
        if (items_.empty()) return;
        const Item item = std::move(items_.front());
        items_.pop_front();
        lock.unlock();
        changed_.notify_all();
        if (item.action) {
            frames_.flush();
            item.action();
        } else {
            store(item.task);
        }
        lock.lock();
    }
}

void Encoder::store(const PictureTask& task) {
    const Revision& revision = task.revision;
    const FrameInfo info{revision.frame,   revision_of_picture(task.job_revision, revision.revision),
                         revision.final,   revision.residual,
                         task.error_bound, revision.picture_error,
                         task.seconds,     task.job_revision};
    try {
        const EncodedPicture picture{
            encode_png(revision.radiance.width, revision.radiance.height, revision.srgb),
            encode_exr(revision.radiance)};
        frames_.put(task.job, info, picture);
    } catch (...) {
        events_.failed(task.job, std::current_exception());
        return;
    }
    events_.stored(task.job, info);
}

}  // namespace afterglow
