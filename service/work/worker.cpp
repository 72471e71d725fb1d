#include "service/work/worker.h"

#include <chrono>
#include <future>
#include <utility>

namespace afterglow {

namespace {
/// Early revisions of a job's first frame are never skipped: whoever waits for a job sees at once that it
/// lives.
constexpr int early_revisions = 4;

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
    std::map<std::string, std::stop_source> runs;
    {
        const std::lock_guard lock(mutex_);
        stopping_ = true;
        in_hand = in_hand_;
        runs = abandon_;
    }
    changed_.notify_all();
    for (auto& [id, stop] : runs) stop.request_stop();
    if (!in_hand.empty()) jobs_.interrupt(in_hand);
}

void Worker::submit(const std::string& job) {
    {
        const std::lock_guard lock(mutex_);
        if (const auto known = jobs_.find(job)) schedule_.set_priority(job, known->priority);
        schedule_.remove(job);
        schedule_.add(job);
        submitted_.insert(job);
    }
    changed_.notify_all();
}

bool Worker::set_priority(const std::string& job, int priority) {
    // One change after the other, so that the schedule ends with what the job shows.
    const std::lock_guard lock(mutex_);
    if (!jobs_.set_priority(job, priority)) return false;
    // Of others it is asked for when they are added.
    if (schedule_.contains(job)) schedule_.set_priority(job, priority);
    return true;
}

void Worker::take_edits(const std::string& job) {
    {
        const std::lock_guard lock(mutex_);
        if (const auto known = jobs_.find(job)) schedule_.set_priority(job, known->priority);
        if (!schedule_.contains(job)) schedule_.add(job);
        edited_.insert(job);
    }
    changed_.notify_all();
}

bool Worker::pause(const std::string& job) {
    const bool paused = jobs_.pause(job);
    if (paused) abandon(job);
    changed_.notify_all();
    return paused;
}

bool Worker::cancel(const std::string& job) {
    const bool ended = jobs_.end(job, JobState::cancelled);
    if (ended) abandon(job);
    encoder_.forget(job);
    // The job keeps its place in the schedule until the compute thread meets it there and frees its state.
    changed_.notify_all();
    return ended;
}

/// Nobody wants the job's run any more.
void Worker::abandon(const std::string& id) {
    std::stop_source stop(std::nostopstate);
    {
        const std::lock_guard lock(mutex_);
        if (const auto it = abandon_.find(id); it != abandon_.end()) stop = it->second;
    }
    stop.request_stop();
}

std::stop_token Worker::new_abandon_token(const std::string& id) {
    const std::lock_guard lock(mutex_);
    std::stop_source stop;
    if (stopping_) stop.request_stop();
    return abandon_.insert_or_assign(id, stop).first->second.get_token();
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
    edited_.erase(*next);
    // Those that gave way to a higher priority begin anew after their last finished frame.
    std::erase_if(running_, [&](const auto& running) { return !schedule_.is_resident(running.first); });
    return next;
}

void Worker::take_turn(const std::string& id) {
    // Asked for first, so that whatever changes the job from here on stops the work.
    const std::stop_token stop = jobs_.stop_token(id);
    const auto job = jobs_.find(id);
    bool goes_on = false;
    try {
        if (job && is_active(job->state)) {
            advance(*job, stop);
            goes_on = running_.contains(id);
        }
    } catch (const ChildDied& death) {
        goes_on = strike(id, death);
    } catch (...) {
        // Whoever stopped the work has said what becomes of the job; where that was an edit, it goes on.
        if (is_cancellation(std::current_exception())) {
            const auto now = jobs_.find(id);
            goes_on = now && is_active(now->state) && now->revision() > job->revision();
        } else {
            jobs_.end(id, JobState::failed, problem_of(std::current_exception()));
        }
    }
    if (goes_on) return;
    running_.erase(id);
    leave(id);
}

/// A process that computed the job has ended: whether the job may have another.
bool Worker::strike(const std::string& id, const ChildDied& death) {
    const int frame = running_.at(id).next_frame;
    running_.erase(id);
    const int strikes = jobs_.note_strike(id, frame);
    const std::string told = death.what();
    const char* code = death.cause() == ChildDied::Cause::memory ? "job_out_of_memory" : "worker_died";
    const std::string place = "frame " + std::to_string(frame);
    if (strikes >= config_.max_strikes) {
        jobs_.end(id, JobState::failed,
                  Problem{500, code, told + ", " + std::to_string(strikes) + " times in all", place});
        return false;
    }
    jobs_.note_warnings(id, {{place, told + " and begins anew (" + std::to_string(strikes) + ")"}});
    return true;
}

/// The job has no more turns, unless it was submitted or edited while its computation came to a stop.
void Worker::leave(const std::string& id) {
    const std::lock_guard lock(mutex_);
    abandon_.erase(id);
    if (!submitted_.contains(id) && !edited_.contains(id)) schedule_.forget(id);
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
void Worker::advance(const Job& job, const std::stop_token& stop) {
    auto it = running_.find(job.id);
    const bool is_edited = it != running_.end() && it->second.revision < job.revision();
    if (it == running_.end()) it = running_.emplace(job.id, Running{nullptr, first_frame_of(job)}).first;
    Running& running = it->second;
    if (is_edited) running.next_frame = first_frame_of(job);
    const int frame = running.next_frame;
    const int frames_before = frame - job.frames.first;
    const Context context(config_.threads, stop, [&](const Progress& progress) {
        jobs_.note_progress(job.id, frame, frames_before, progress);
    });
    // Preparing counts as the first twentieth of the first frame.
    jobs_.start(job.id);
    if (frame <= job.frames.last) {
        context.check_stop();
        if (!running.run) {
            running.run = make_run_(job, context.part(0, 0.05), new_abandon_token(job.id));
            running.revision = job.revision();
            for (int revision = 1; revision <= running.revision; ++revision)
                jobs_.note_reused(job.id, revision, 0);
        }
        take_over(job, running, context.part(0, 0.05));
        compute_frame(job, running, context.part(0.05, 1));
    }
    if (running.next_frame <= job.frames.last) return;
    encoder_.after_pictures(
        [&jobs = jobs_, id = job.id, revision = job.revision()] { jobs.succeed(id, revision); });
    running_.erase(it);
}

/// Brings a run up to the job as it is, edit by edit: what is interrupted goes on behind the last one taken.
void Worker::take_over(const Job& job, Running& running, const Context& context) {
    while (running.revision < job.revision()) {
        const std::vector<Edit>& edits = job.edits[static_cast<std::size_t>(running.revision)].edits;
        for (; running.applied < edits.size(); ++running.applied)
            running.kept *= running.run->apply(edits[running.applied], context).lines_reused;
        ++running.revision;
        jobs_.note_reused(job.id, running.revision, running.kept);
        running.applied = 0;
        running.kept = 1;
    }
}

void Worker::compute_frame(const Job& job, Running& running, const Context& context) {
    // The final picture waits here for the error bound, which is known only at the end of the step.
    std::optional<PictureTask> final_picture;
    const auto sink = [&](const Revision& revision) {
        PictureTask task{job.id, revision, std::nullopt, keep_of(job, revision), 0, running.revision};
        if (revision.final)
            final_picture = std::move(task);
        else
            encoder_.submit(std::move(task));
    };
    const auto began = std::chrono::steady_clock::now();
    const FrameStatistics statistics = running.run->step(running.next_frame, sink, context);
    // Warnings first: a job that is taken up again with what its statistics tell does not find all of them
    // again.
    jobs_.note_warnings(job.id, running.run->warnings());
    jobs_.note_statistics(job.id, running.run->statistics());
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
