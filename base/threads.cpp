#include "base/threads.h"

#include <atomic>
#include <chrono>
#include <exception>
#include <future>
#include <system_error>
#include <thread>
#include <vector>

namespace emscape {
namespace {

std::atomic<bool> are_spared{false};

}  // namespace

int startableThreads(int count) {
  std::promise<void> end;
  const std::shared_future<void> ends = end.get_future().share();
  std::vector<std::thread> threads;
  threads.reserve(static_cast<std::size_t>(count));
  std::exception_ptr failure;
  try {
    while (static_cast<int>(threads.size()) < count) threads.emplace_back([ends] { ends.wait(); });
  } catch (const std::system_error&) {
  } catch (...) {
    failure = std::current_exception();
  }
  end.set_value();
  for (std::thread& thread : threads) thread.join();
  if (failure) std::rethrow_exception(failure);
  return static_cast<int>(threads.size());
}

void requireThreads(int count) {
  constexpr std::chrono::milliseconds kPause{10};
  for (int attempt = 0; attempt < 100; ++attempt) {
    if (startableThreads(count) == count) return;
    std::this_thread::sleep_for(kPause);
  }
  throw std::system_error(std::make_error_code(std::errc::resource_unavailable_try_again));
}

void spareThreads() {
  are_spared = true;
}

bool sparesThreads() {
  return are_spared;
}

}  // namespace emscape
