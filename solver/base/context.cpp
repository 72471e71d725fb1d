#include "solver/base/context.h"

#include <algorithm>
#include <thread>
#include <utility>

#include "solver/base/error.h"
#include "solver/base/threads.h"

namespace afterglow {

struct Context::Shared {
    Threads threads;
    std::stop_token stop;
    ProgressSink sink;
    std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();

    Shared(int count, std::stop_token token, ProgressSink progress)
        : threads(count), stop(std::move(token)), sink(std::move(progress)) {}
};

namespace {
int resolve_threads(int threads) {
    if (threads < 0) throw Error(ErrorKind::invalid_input, "threads", "must be 0 (one a core) or more");
    return threads > 0 ? threads : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}
}  // namespace

Context::Context(int threads, std::stop_token stop, ProgressSink sink)
    : shared_(std::make_shared<Shared>(resolve_threads(threads), std::move(stop), std::move(sink))) {}

int Context::threads() const {
    return shared_->threads.count();
}

void Context::check_stop() const {
    if (shared_->stop.stop_requested()) throw Error(ErrorKind::cancelled, "", "stopped on request");
}

std::stop_token Context::stop_token() const {
    return shared_->stop;
}

void Context::report(double fraction, std::string_view doing) const {
    check_stop();
    if (!shared_->sink) return;
    const double whole = from_ + (to_ - from_) * std::clamp(fraction, 0.0, 1.0);
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - shared_->start;
    const auto remaining = whole > 0 ? spent * ((1 - whole) / whole) : std::chrono::duration<double>(0);
    shared_->sink(Progress{whole, doing, remaining});
}

Context Context::part(double from, double to) const {
    Context sub = *this;
    sub.from_ = from_ + (to_ - from_) * from;
    sub.to_ = from_ + (to_ - from_) * to;
    return sub;
}

void Context::for_chunks(std::size_t count, std::size_t chunk,
                         const std::function<void(std::size_t, std::size_t)>& body) const {
    if (count == 0) return;
    const std::size_t chunks = (count + chunk - 1) / chunk;
    const auto run_chunk = [&](std::size_t c) {
        check_stop();
        body(c * chunk, std::min(count, (c + 1) * chunk));
    };
    if (chunks == 1) {
        run_chunk(0);
        return;
    }
    shared_->threads.for_each(chunks, run_chunk);
}

}  // namespace afterglow
