#include "base/parallel.h"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>

#include <memory>

namespace emscape {
namespace {

std::unique_ptr<tbb::global_control> thread_limit;

}  // namespace

void setThreadLimit(int threads) {
  thread_limit.reset();
  if (threads > 0) {
    thread_limit = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                         static_cast<std::size_t>(threads));
  }
}

int threadCount() {
  return static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}

void parallelFor(int count, int grain, const std::function<void(int begin, int end)>& body) {
  if (count <= 0) return;
  tbb::parallel_for(tbb::blocked_range<int>(0, count, static_cast<std::size_t>(grain > 0 ? grain : 1)),
                    [&](const tbb::blocked_range<int>& piece) { body(piece.begin(), piece.end()); });
}

}  // namespace emscape
