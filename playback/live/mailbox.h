/// A mailbox with a single slot, which keeps the latest request.
#pragma once

#include <chrono>
#include <mutex>
#include <optional>
#include <utility>

#include "base/event.h"

namespace emscape::playback {

/// Has at most one value. A value that was not taken is replaced by the next one, so that requests do not
/// accumulate. Threads may share it; nothing waits.
template <class T>
class Mailbox {
 public:
  using Time = std::chrono::steady_clock::time_point;
  struct Letter {
    T value;
    Time since;  ///< time of the oldest request that this value replaces, or its own
  };

  /// @param event  set by each put(); outlives this
  explicit Mailbox(Event& event) : event_(event) {}
  Mailbox(const Mailbox&) = delete;
  Mailbox& operator=(const Mailbox&) = delete;

  /// @param since  time of the request
  void put(T value, Time since = std::chrono::steady_clock::now()) {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (letter_ && letter_->since < since) since = letter_->since;
      letter_.emplace(Letter{std::move(value), since});
    }
    event_.set();
  }
  /// Empties the slot.
  std::optional<Letter> take() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return std::exchange(letter_, std::nullopt);
  }
  bool isEmpty() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return !letter_;
  }

 private:
  Event& event_;
  mutable std::mutex mutex_;
  std::optional<Letter> letter_;
};

}  // namespace emscape::playback
