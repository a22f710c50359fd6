/// Files of what a stream brings.
#pragma once

#include <cstdint>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "base/files/appended_file.h"
#include "base/files/unfinished_file.h"
#include "recording/dis/datagrams.h"

namespace emscape::playback {

/// Writes datagrams as .pcap, or text as it is. A disk that is full ends the recording, not the stream.
class StreamRecorder {
 public:
  /// @throws Error (usage) for another ending or a file that exists, (other)
  StreamRecorder(const std::string& file, const std::string& ending, bool replaces);
  void write(const std::uint8_t* bytes, std::size_t size, double time_s);
  /// Publishes the file, unless nothing of it could be written.
  /// @throws Error (other), also if the recording ended early
  void finish();
  /// Why the recording ended early; empty: it did not.
  const std::string& failure() const { return failure_; }

 private:
  /// Whole records, so that a file which ends early ends with one.
  void append();

  UnfinishedFile file_;
  AppendedFile disk_;
  std::uintmax_t written_bytes_ = 0;
  std::ostringstream stream_;  ///< what is not on the disk yet
  std::unique_ptr<interop::dis::CaptureWriter> capture_;
  std::vector<std::uint8_t> datagram_;
  std::string failure_;
  bool is_finished_ = false;
};

}  // namespace emscape::playback
