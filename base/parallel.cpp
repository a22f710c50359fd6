#include "emscape/base/parallel.h"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "emscape/base/work.h"

namespace emscape {
namespace {

std::mutex thread_limit_mutex;
std::unique_ptr<tbb::global_control> thread_limit;

/// Runs a range of a loop in parts, with a checkpoint of the work before each. Parts grow from `grain` until
/// one takes about a millisecond.
void runRange(Work* work, int begin, int end, int grain, const std::function<void(int, int)>& body) {
  using Clock = std::chrono::steady_clock;
  constexpr std::chrono::milliseconds kLongEnough{1};
  if (work == nullptr) return body(begin, end);
  const WorkScope scope(work);  // of the thread that oneTBB has chosen
  for (long long length = std::max(grain, 1), first = begin; first < end;) {
    checkpoint();
    const long long last = std::min<long long>(first + length, end);
    const Clock::time_point started = Clock::now();
    body(static_cast<int>(first), static_cast<int>(last));
    first = last;
    if (first < end && Clock::now() - started < kLongEnough) length *= 2;
  }
}

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
  Work* const current = currentWork();
  const auto work = [&] {
    for (long long begin; (begin = next.fetch_add(piece)) < count;) {
      try {
        runRange(current, static_cast<int>(begin),
                 static_cast<int>(std::min<long long>(begin + piece, count)), grain, body);
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
                    [&, work = currentWork()](const tbb::blocked_range<int>& piece) {
                      runRange(work, piece.begin(), piece.end(), grain, body);
                    });
}

#endif

}  // namespace emscape
