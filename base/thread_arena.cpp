#include "base/thread_arena.h"

#include <tbb/task_arena.h>
#include <tbb/task_scheduler_observer.h>

#ifdef __linux__
#include <sys/resource.h>
#include <unistd.h>
#endif

#include <algorithm>
#include <optional>
#include <utility>

namespace emscape {
namespace {

/// Sets the nice value of each thread that enters an arena.
class NiceThreads : public tbb::task_scheduler_observer {
 public:
  NiceThreads(tbb::task_arena& arena, int niceness)
      : tbb::task_scheduler_observer(arena), niceness_(niceness) {
    observe(true);
  }
  ~NiceThreads() override { observe(false); }

  void on_scheduler_entry(bool) override {
#ifdef __linux__
    thread_local int reached = 0;
    if (reached >= niceness_) return;
    const int already = std::exchange(reached, niceness_);
    const auto thread = static_cast<id_t>(gettid());
    const int before = getpriority(PRIO_PROCESS, thread) - already;
    setpriority(PRIO_PROCESS, thread, std::min(before + niceness_, 19));  // a failure only affects speed
#endif
  }

 private:
  const int niceness_;
};

}  // namespace

struct ThreadArena::Impl {
  tbb::task_arena arena;
  std::optional<NiceThreads> nice;

  Impl(int threads, int niceness) : arena(std::max(threads, 1)) {
    if (niceness > 0) nice.emplace(arena, niceness);
  }
};

ThreadArena::ThreadArena(int threads, int niceness) : impl_(std::make_unique<Impl>(threads, niceness)) {}

ThreadArena::~ThreadArena() = default;

void ThreadArena::run(const std::function<void()>& body) {
  impl_->arena.execute([&] { body(); });
}

}  // namespace emscape
