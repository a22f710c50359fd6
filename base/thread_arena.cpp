#include "emscape/base/thread_arena.h"

#include <tbb/task_arena.h>

#include <algorithm>

namespace emscape {

struct ThreadArena::Impl {
  tbb::task_arena arena;
};

ThreadArena::ThreadArena(int threads)
    : impl_(std::make_unique<Impl>(Impl{tbb::task_arena(std::max(threads, 1))})) {}

ThreadArena::~ThreadArena() = default;

void ThreadArena::run(const std::function<void()>& body) {
  impl_->arena.execute([&] { body(); });
}

}  // namespace emscape
