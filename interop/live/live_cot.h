/// The present state of a stream of Cursor on Target.
#pragma once

#include <list>
#include <map>
#include <string>
#include <unordered_map>

#include "interop/live/live_state.h"
#include "recording/cot/cot_event.h"

namespace emscape::interop {

/// Keeps the last event of each uid, until its stale time: as long after its arrival as the sender says, so
/// that clocks need not agree.
class LiveCot : public LiveState {
 public:
  /// @param is_text  the bytes are one text, as TCP brings them; else each call of take() brings a datagram
  explicit LiveCot(bool is_text) : is_text_(is_text) {}

  void take(const std::uint8_t* bytes, std::size_t size, double arrival_s) override;
  void expire(double now_s) override;
  LiveRecording recording(double now_s) override;
  std::vector<LivePose> poses(double now_s) const override;
  std::size_t objectCount() const override;

 private:
  struct Kept {
    CotEvent event;
    std::uint64_t key = 0;
    double until_s = 0;
    std::size_t structure = 0;
    std::list<std::string>::iterator recent;
  };

  void takeEvent(std::string_view xml, double arrival_s);
  void keep(CotEvent event, double arrival_s);
  void forget(const std::string& uid);
  std::size_t structureOf(const CotEvent& event) const;

  const bool is_text_;
  CotSplitter splitter_;
  std::unordered_map<std::string, Kept> kept_;
  std::map<std::uint64_t, const Kept*> by_key_;    ///< the same, in the order in which they came first
  std::list<std::string> recent_;                  ///< uids, the last heard of first
  std::unordered_map<std::string, int> carriers_;  ///< uids that sensors belong to: how many
  std::uint64_t last_key_ = 0;
};

}  // namespace emscape::interop
