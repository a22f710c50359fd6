/// Files of what a stream brings.
#pragma once

#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "base/files/unfinished_file.h"
#include "recording/dis/datagrams.h"

namespace emscape::playback {

/// Writes datagrams as .pcap, or text as it is. A disk that is full ends the recording, not the stream.
class StreamRecorder {
 public:
  /// @throws Error (usage) for another ending or a file that exists, (other)
  StreamRecorder(const std::string& file, const std::string& ending, bool replaces);
  void write(const std::uint8_t* bytes, std::size_t size, double time_s);
  /// Publishes the file. @throws Error (other), also if the recording ended early
  void finish();
  /// Why the recording ended early; empty: it did not.
  const std::string& failure() const { return failure_; }

 private:
  UnfinishedFile file_;
  std::ofstream stream_;
  std::unique_ptr<interop::dis::CaptureWriter> capture_;
  std::vector<std::uint8_t> datagram_;
  std::string failure_;
  bool is_finished_ = false;
};

}  // namespace emscape::playback
