#include "solver/base/threads.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

// The thread sanitizer cannot see how oneTBB hands work over: the library is not built for it. So this source
// is not either (see CMakeLists.txt), and it tells instead: what was done before `tell` on an address has
// happened for whoever calls `see` on it later. Nothing in other builds.
#ifdef AFTERGLOW_THREAD_SANITIZER
extern "C" {
void __tsan_acquire(void* address);  // NOLINT(bugprone-reserved-identifier): the sanitizer's own names
void __tsan_release(void* address);  // NOLINT(bugprone-reserved-identifier)
}
#endif

namespace afterglow {
namespace {
void tell([[maybe_unused]] char& handover) {
#ifdef AFTERGLOW_THREAD_SANITIZER
    __tsan_release(&handover);
#endif
}

void see([[maybe_unused]] char& handover) {
#ifdef AFTERGLOW_THREAD_SANITIZER
    __tsan_acquire(&handover);
#endif
}

// Does it when a scope ends, however it ends.
template <void (*Do)(char&)>
class AtEnd {
  public:
    explicit AtEnd(char& handover) : handover_(handover) {}
    ~AtEnd() { Do(handover_); }
    AtEnd(const AtEnd&) = delete;
    AtEnd& operator=(const AtEnd&) = delete;

  private:
    char& handover_;
};
}  // namespace

struct Threads::Arena {
    tbb::task_arena arena;
    explicit Arena(int threads) : arena(threads) {}
};

Threads::Threads(int count) : arena_(std::make_shared<Arena>(count)) {}

int Threads::count() const {
    return arena_->arena.max_concurrency();
}

void Threads::for_each(std::size_t tasks, const std::function<void(std::size_t)>& task) const {
    char begun = 0;
    char ended = 0;
    const auto run = [&](std::size_t index) {
        see(begun);
        const AtEnd<tell> end(ended);
        task(index);
    };
    tell(begun);
    const AtEnd<see> all(ended);
    arena_->arena.execute([&] { tbb::parallel_for(std::size_t{0}, tasks, run); });
}

}  // namespace afterglow
