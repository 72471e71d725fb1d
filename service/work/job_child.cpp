#include "service/work/job_child.h"

#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <deque>
#include <memory>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>

#include "service/work/job_run.h"
#include "service/work/worker_message.h"

namespace afterglow {

namespace {

constexpr std::chrono::milliseconds progress_interval{20};

/// Tells of progress, not oftener than anybody reads.
ProgressSink progress_to(const MessageChannel& channel) {
    using Clock = std::chrono::steady_clock;
    struct Told {
        Clock::time_point time;
        std::string doing;
    };
    return [&channel, told = std::make_shared<Told>()](const Progress& progress) {
        const auto now = Clock::now();
        if (progress.doing == told->doing && now - told->time < progress_interval) return;
        *told = {now, std::string(progress.doing)};
        channel.send(message_of(progress));
    };
}

/// What has been asked for, received on a thread of its own so that a stop is heard while something is being
/// computed. When the channel closes the process ends at once, whatever it does.
class Inbox {
  public:
    struct Request {
        Message message;
        std::stop_source stop = {};
    };
    /// `first`: of what was asked for before.
    Inbox(const MessageChannel& channel, const std::stop_source& first) {
        std::thread([this, &channel, first] { receive_all(channel, first); }).detach();
    }
    /// Waits for the next request.
    Request take() {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [&] { return !waiting_.empty(); });
        Request request = std::move(waiting_.front());
        waiting_.pop_front();
        return request;
    }

  private:
    /// `last`: of the last request, which is what a stop is always meant for.
    [[noreturn]] void receive_all(const MessageChannel& channel, std::stop_source last) {
        for (;;) {
            Message message;
            try {
                message = channel.receive();
            } catch (...) {
                std::_Exit(0);
            }
            if (message.kind == MessageKind::stop) {
                last.request_stop();
                continue;
            }
            last = std::stop_source();
            {
                const std::lock_guard lock(mutex_);
                waiting_.push_back({std::move(message), last});
            }
            changed_.notify_all();
        }
    }

    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<Request> waiting_;
};

/// Does the work of a request and replies; a failure leaves the run as it is.
template <class Work>
void answer(const MessageChannel& channel, int threads, const std::stop_source& stop, const Work& work) {
    Message reply;
    try {
        reply = message_of(work(Context(threads, stop.get_token(), progress_to(channel))));
    } catch (const ChannelClosed&) {
        throw;
    } catch (...) {
        reply = failure(std::current_exception());
    }
    channel.send(reply);
}

}  // namespace

void run_job_child(const MessageChannel& channel, const Message& first) {
    const StartMessage start = start_of(first);
    // It outlives this function with its thread, which ends the process.
    const std::stop_source stop;
    Inbox& inbox = *new Inbox(channel, stop);
    std::unique_ptr<JobRun> run;
    answer(channel, start.threads, stop, [&](const Context& context) {
        run = solver_run(start.job, read_world(start.source, usual_reader()), start.cache_folder, context);
        return DoneMessage{{}, {}, run->statistics(), run->warnings()};
    });
    const auto on_revision = [&](const Revision& revision) { channel.send(message_of(revision)); };
    while (run) {
        const Inbox::Request request = inbox.take();
        answer(channel, start.threads, request.stop, [&](const Context& context) {
            DoneMessage done;
            if (request.message.kind == MessageKind::edit)
                done.edit = run->apply(edit_of(request.message), context);
            else
                done.frame = run->step(frame_of_step(request.message), on_revision, context);
            done.sequence = run->statistics();
            done.warnings = run->warnings();
            return done;
        });
    }
}

}  // namespace afterglow
