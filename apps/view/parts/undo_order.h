/// Undo across several histories, latest step first.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

namespace emscape::view {

enum class History { scenario, transfer, planes };

/// Keeps the order of the steps of several histories.
class UndoOrder {
 public:
  /// @param steps_made  number of steps of this history so far; new ones are the latest of all
  /// @param steps_back  number of them that can be undone; older ones are forgotten
  void note(History history, long long steps_made, std::size_t steps_back) {
    long long& noted = noted_[static_cast<std::size_t>(history)];
    for (; noted < steps_made; ++noted) {
      done_.push_back(history);
      undone_.clear();
    }
    auto kept = static_cast<std::size_t>(std::count(done_.begin(), done_.end(), history));
    const auto isForgotten = [&](History one) { return one == history && kept > steps_back && kept-- > 0; };
    done_.erase(std::remove_if(done_.begin(), done_.end(), isForgotten), done_.end());
  }
  /// A history was reset: none of its steps can be undone or redone.
  void forget(History history) {
    noted_[static_cast<std::size_t>(history)] = 0;
    for (auto* list : {&done_, &undone_}) {
      std::vector<History> others;
      for (const History one : *list) {
        if (one != history) others.push_back(one);
      }
      *list = others;
    }
  }
  bool canUndo() const { return !done_.empty(); }
  bool canRedo() const { return !undone_.empty(); }
  /// The history whose last step is to be undone or redone; empty if there is none.
  std::optional<History> undo() { return move(done_, undone_); }
  std::optional<History> redo() { return move(undone_, done_); }

 private:
  static std::optional<History> move(std::vector<History>& from, std::vector<History>& to) {
    if (from.empty()) return std::nullopt;
    to.push_back(from.back());
    from.pop_back();
    return to.back();
  }

  std::array<long long, 3> noted_{};
  std::vector<History> done_, undone_;
};

}  // namespace emscape::view
