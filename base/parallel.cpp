#include "emscape/base/parallel.h"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

namespace emscape {
namespace {

std::mutex thread_limit_mutex;
std::unique_ptr<tbb::global_control> thread_limit;

}  // namespace

void setThreadLimit(int threads) {
  const std::lock_guard<std::mutex> lock(thread_limit_mutex);
  thread_limit.reset();
  if (threads > 0) {
    thread_limit = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                         static_cast<std::size_t>(threads));
  }
}

int threadCount() {
  const auto allowed =
      static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
  return std::min(allowed, tbb::this_task_arena::max_concurrency());
}

#if defined(__SANITIZE_THREAD__)

// The thread sanitizer does not see the synchronisation inside libtbb and would report every loop. It does
// see that of plain threads.
void parallelFor(int count, int grain, const std::function<void(int begin, int end)>& body) {
  const long long piece = std::max(grain, 1);
  std::atomic<long long> next{0};
  std::mutex failure_mutex;
  std::exception_ptr failure;
  const auto work = [&] {
    for (long long begin; (begin = next.fetch_add(piece)) < count;) {
      try {
        body(static_cast<int>(begin), static_cast<int>(std::min<long long>(begin + piece, count)));
      } catch (...) {
        std::lock_guard<std::mutex> lock(failure_mutex);
        if (!failure) failure = std::current_exception();
        next = count;
      }
    }
  };
  std::vector<std::thread> helpers;
  for (int i = 1; i < threadCount() && i * piece < count; ++i) helpers.emplace_back(work);
  work();
  for (std::thread& helper : helpers) helper.join();
  if (failure) std::rethrow_exception(failure);
}

#else

void parallelFor(int count, int grain, const std::function<void(int begin, int end)>& body) {
  if (count <= 0) return;
  tbb::parallel_for(tbb::blocked_range<int>(0, count, static_cast<std::size_t>(std::max(grain, 1))),
                    [&](const tbb::blocked_range<int>& piece) { body(piece.begin(), piece.end()); });
}

#endif

}  // namespace emscape
