#include "service/work/child_run.h"

#include <functional>
#include <new>
#include <stop_token>
#include <utility>

#include "service/work/worker_message.h"

namespace afterglow {

namespace {

ChildDied out_of_memory() {
    return {ChildDied::Cause::memory, "its computation took more memory than it may have"};
}

class ChildRun : public JobRun {
  public:
    ChildRun(const StartMessage& start, const ChildRunConfig& config, const Context& context,
             const std::stop_token& abandoned)
        : abandoned_(abandoned),
          child_(config.limits, config.program),
          channel_(child_.socket()),
          kill_(abandoned, [this] { child_.kill(); }) {
        ask(message_of(start), {}, context);
    }

    FrameStatistics step(int frame, const RevisionSink& on_revision, const Context& context) override {
        ask(step_message(frame), on_revision, context);
        return last_.frame;
    }
    EditOutcome apply(const Edit& edit, const Context& context) override {
        ask(edit_message(edit), {}, context);
        return last_.edit;
    }
    [[nodiscard]] SequenceStatistics statistics() const override { return last_.sequence; }
    [[nodiscard]] Warnings warnings() const override { return last_.warnings; }

  private:
    void ask(const Message& request, const RevisionSink& on_revision, const Context& context) {
        try {
            channel_.send(request);
            const std::stop_callback at_stop(context.stop_token(), [this] { tell_stop(); });
            while (!is_answered(channel_.receive(), on_revision, context)) {
            }
        } catch (const ChannelClosed&) {
            const ChildEnd end = child_.end();
            if (abandoned_.stop_requested()) throw Error(ErrorKind::cancelled, "", "stopped on request");
            if (end.signal == 0 && end.status == status_out_of_memory) throw out_of_memory();
            throw ChildDied(ChildDied::Cause::ended, "its computation ended with " + description_of(end));
        }
    }

    void tell_stop() const {
        try {
            channel_.send({MessageKind::stop, nullptr});
        } catch (const ChannelClosed&) {  // whoever waits for the reply finds out
        }
    }

    bool is_answered(const Message& message, const RevisionSink& on_revision, const Context& context) {
        switch (message.kind) {
            case MessageKind::progress:
                tell(progress_of(message), context);
                return false;
            case MessageKind::revision:
                on_revision(revision_of(message));
                return false;
            case MessageKind::done:
                last_ = done_of(message);
                return true;
            case MessageKind::failed:
                fail(message);
            default:
                throw ChannelClosed();
        }
    }

    /// What the solver kept may be half done then: another process begins anew.
    [[noreturn]] static void fail(const Message& message) {
        try {
            throw_failure(message);
        } catch (const std::bad_alloc&) {
            throw out_of_memory();
        }
    }

    /// Also checks for a stop, after which the reply is still to come.
    static void tell(const Progress& progress, const Context& context) {
        try {
            context.report(progress.fraction, progress.doing);
        } catch (const Error& e) {
            if (e.kind() != ErrorKind::cancelled) throw;
        }
    }

    std::stop_token abandoned_;
    ChildProcess child_;
    MessageChannel channel_;
    DoneMessage last_;
    std::stop_callback<std::function<void()>> kill_;  ///< goes first
};

}  // namespace

RunFactory child_runs(const SceneStore& scenes, ChildRunConfig config) {
    return [&scenes, config = std::move(config)](const Job& job, const Context& context,
                                                 const std::stop_token& abandoned) {
        const StartMessage start{job, scenes.source(job.scene, job.paths, job.settings.background),
                                 config.cache_folder, context.threads()};
        return std::make_unique<ChildRun>(start, config, context, abandoned);
    };
}

}  // namespace afterglow
