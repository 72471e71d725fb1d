#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <stop_token>
#include <string_view>

namespace afterglow {

/// How far a long step has come.
struct Progress {
    double fraction = 0;     ///< of the whole step, in [0, 1]
    std::string_view doing;  ///< what is being done, for people; valid during the call only
    std::chrono::duration<double> remaining{};  ///< estimated from the pace so far
};
using ProgressSink = std::function<void(const Progress&)>;

/// What every long step is given: threads to work with, a way to be stopped, a way to say how far it is.
/// Purpose: cancellation, progress and parallel loops in one argument. Copies share the same threads.
/// Thread-safety: const calls may come from any thread; the sink is called from the thread that calls
/// `report`.
class Context {
  public:
    /// `threads`: 1 or more, 0 for one a core. Without a stop token or a sink the step cannot be stopped and
    /// is silent.
    explicit Context(int threads = 0, std::stop_token stop = {}, ProgressSink sink = {});

    [[nodiscard]] int threads() const;

    /// Throws Error{cancelled} once a stop has been asked for.
    void check_stop() const;

    /// For whoever has to be told of a stop while it waits for something else.
    [[nodiscard]] std::stop_token stop_token() const;

    /// Says that `fraction` of this context's part is done; also checks for a stop.
    void report(double fraction, std::string_view doing) const;

    /// A context for a sub-step that covers [from, to] of this one's progress.
    [[nodiscard]] Context part(double from, double to) const;

    /// Calls `body(begin, end)` for consecutive chunks of [0, count), `chunk` elements each (the last may be
    /// shorter), on all threads, in any order. The chunks do not depend on the number of threads, so a caller
    /// that writes a result per chunk and then reduces them in order gets the same bits on any machine.
    /// Errors: checks for a stop before each chunk; the first exception of a body is thrown on.
    void for_chunks(std::size_t count, std::size_t chunk,
                    const std::function<void(std::size_t begin, std::size_t end)>& body) const;

  private:
    struct Shared;
    std::shared_ptr<Shared> shared_;
    double from_ = 0;
    double to_ = 1;
};

}  // namespace afterglow
