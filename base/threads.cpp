#include "base/threads.h"

#include <future>
#include <thread>
#include <vector>

namespace emscape {

void requireThreads(int count) {
  std::promise<void> end;
  const std::shared_future<void> ends = end.get_future().share();
  std::vector<std::thread> threads;
  const auto finish = [&] {
    end.set_value();
    for (std::thread& thread : threads) thread.join();
  };
  try {
    while (static_cast<int>(threads.size()) < count) threads.emplace_back([ends] { ends.wait(); });
  } catch (...) {
    finish();
    throw;
  }
  finish();
}

}  // namespace emscape
