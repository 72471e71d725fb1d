#include "service/work/worker.h"

#include <chrono>
#include <future>
#include <utility>

namespace afterglow {

namespace {
/// Early revisions of a job's first frame are never skipped: whoever waits for a job sees at once that it
/// lives.
constexpr int early_revisions = 3;

bool is_active(JobState state) {
    return state == JobState::queued || state == JobState::running;
}

bool is_cancellation(const std::exception_ptr& caught) {
    try {
        std::rethrow_exception(caught);
    } catch (const Error& e) {
        return e.kind() == ErrorKind::cancelled;
    } catch (...) {
        return false;
    }
}

PictureTask::Keep keep_of(const Job& job, const Revision& revision) {
    const bool early = revision.frame == job.frames.first && revision.revision <= early_revisions;
    return early ? PictureTask::Keep::always : PictureTask::Keep::until_superseded;
}
}  // namespace

Worker::Worker(JobStore& jobs, Encoder& encoder, RunFactory make_run, WorkerConfig config)
    : jobs_(jobs),
      encoder_(encoder),
      make_run_(std::move(make_run)),
      config_(config),
      schedule_(config.max_resident),
      thread_([this] { loop(); }) {}

Worker::~Worker() {
    halt();
    thread_.join();
}

void Worker::halt() {
    std::string in_hand;
    {
        const std::lock_guard lock(mutex_);
        stopping_ = true;
        in_hand = in_hand_;
    }
    changed_.notify_all();
    if (!in_hand.empty()) jobs_.interrupt(in_hand);
}

void Worker::submit(const std::string& job) {
    {
        const std::lock_guard lock(mutex_);
        schedule_.remove(job);
        schedule_.add(job);
        submitted_.insert(job);
    }
    changed_.notify_all();
}

bool Worker::pause(const std::string& job) {
    const bool paused = jobs_.pause(job);
    changed_.notify_all();
    return paused;
}

bool Worker::cancel(const std::string& job) {
    const bool ended = jobs_.end(job, JobState::cancelled);
    encoder_.forget(job);
    // The job keeps its place in the schedule until the compute thread meets it there and frees its state.
    changed_.notify_all();
    return ended;
}

void Worker::loop() {
    while (const auto id = wait_for_turn()) {
        take_turn(*id);
        drop_ended();
    }
    running_.clear();
}

std::optional<std::string> Worker::wait_for_turn() {
    std::unique_lock lock(mutex_);
    in_hand_.clear();
    std::optional<std::string> next;
    changed_.wait(lock, [&] { return stopping_ || (next = schedule_.next()).has_value(); });
    if (stopping_) return std::nullopt;
    in_hand_ = *next;
    if (submitted_.erase(*next) > 0) running_.erase(*next);
    return next;
}

void Worker::take_turn(const std::string& id) {
    const auto job = jobs_.find(id);
    bool goes_on = false;
    try {
        if (job && is_active(job->state)) {
            advance(*job);
            goes_on = running_.contains(id);
        }
    } catch (...) {
        // Whoever stopped the work has said what becomes of the job.
        if (!is_cancellation(std::current_exception()))
            jobs_.end(id, JobState::failed, problem_of(std::current_exception()));
    }
    if (goes_on) return;
    running_.erase(id);
    leave(id);
}

/// The job has no more turns, unless it was submitted again while its computation came to a stop.
void Worker::leave(const std::string& id) {
    const std::lock_guard lock(mutex_);
    if (!submitted_.contains(id)) schedule_.remove(id);
}

/// Where to go on after a pause, a failure or a restart, once frames that wait to be stored have been. Those
/// finished behind a missing one are computed again.
int Worker::first_frame_of(const Job& job) {
    if (!job.started) return job.frames.first;
    std::promise<void> stored;
    encoder_.after_pictures([&] { stored.set_value(); });
    stored.get_future().wait();
    return jobs_.first_unfinished(job.id);
}

/// Computes the job's next frame; a job that is through is no longer in `running_`.
void Worker::advance(const Job& job) {
    auto it = running_.find(job.id);
    if (it == running_.end()) it = running_.emplace(job.id, Running{nullptr, first_frame_of(job)}).first;
    Running& running = it->second;
    const int frame = running.next_frame;
    const int frames_before = frame - job.frames.first;
    const Context context(config_.threads, jobs_.stop_token(job.id), [&](const Progress& progress) {
        jobs_.note_progress(job.id, frame, frames_before, progress);
    });
    // Preparing counts as the first twentieth of the first frame.
    if (frame > job.frames.last) {
        jobs_.start(job.id);
    } else if (!running.run) {
        if (!jobs_.start(job.id)) throw Error(ErrorKind::cancelled, "", "stopped on request");
        running.run = make_run_(job, context.part(0, 0.05));
        compute_frame(job, running, context.part(0.05, 1));
    } else {
        compute_frame(job, running, context);
    }
    if (running.next_frame <= job.frames.last) return;
    encoder_.after_pictures([&jobs = jobs_, id = job.id] { jobs.end(id, JobState::succeeded); });
    running_.erase(it);
}

void Worker::compute_frame(const Job& job, Running& running, const Context& context) {
    // The final picture waits here for the error bound, which is known only at the end of the step.
    std::optional<PictureTask> final_picture;
    const auto sink = [&](const Revision& revision) {
        PictureTask task{job.id, revision, std::nullopt, keep_of(job, revision)};
        if (revision.final)
            final_picture = std::move(task);
        else
            encoder_.submit(std::move(task));
    };
    const auto began = std::chrono::steady_clock::now();
    const FrameStatistics statistics = running.run->step(running.next_frame, sink, context);
    jobs_.note_statistics(job.id, running.run->statistics());
    jobs_.note_warnings(job.id, running.run->warnings());
    if (final_picture) {
        final_picture->error_bound = statistics.error_bound;
        final_picture->seconds =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
        encoder_.submit(*std::move(final_picture));
    }
    ++running.next_frame;
}

/// Frees the state of jobs that were cancelled while another had its turn.
void Worker::drop_ended() {
    for (auto it = running_.begin(); it != running_.end();) {
        const auto job = jobs_.find(it->first);
        if (job && is_active(job->state)) {
            ++it;
            continue;
        }
        leave(it->first);
        it = running_.erase(it);
    }
}

}  // namespace afterglow
