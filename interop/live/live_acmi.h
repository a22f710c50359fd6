/// The present state of a real-time ACMI stream.
#pragma once

#include <string>

#include "interop/live/live_state.h"
#include "recording/acmi/acmi_lines.h"
#include "recording/acmi/acmi_reader.h"

namespace emscape::interop {

/// Takes the text that follows the handshake. Objects stay until the stream removes them.
class LiveAcmi : public LiveState {
 public:
  void take(const std::uint8_t* bytes, std::size_t size, double arrival_s) override;
  /// What was taken becomes the present state: poses at once, other changes at most every 0.2 s.
  void expire(double now_s) override;
  LiveRecording recording(double now_s) override;
  std::vector<LivePose> poses(double now_s) const override;
  std::size_t objectCount() const override { return latest_.objects.size(); }

 private:
  void takeLine();
  void countTooLong();
  void note();

  AcmiReader reader_;
  AcmiLines lines_;
  std::string line_;  ///< physical, not ended yet
  bool is_cut_ = false;
  bool is_noted_ = true;  ///< latest_ has all lines so far
  double noted_s_ = -1e18;
  long long reader_bad_ = 0;  ///< of the reader's tally, counted so far
  Recording latest_;
  std::size_t structure_ = 0;
};

}  // namespace emscape::interop
