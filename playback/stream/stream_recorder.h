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

/// Writes datagrams as .pcap, or text as it is. The file has its name from the beginning, in place of another
/// one from the first record, and grows by whole records: what a killed process has recorded is there. A disk
/// that is full ends the recording, not the stream, and is warned of.
class StreamRecorder {
 public:
  /// @throws Error (usage) for another ending or a file that exists, (other)
  StreamRecorder(const std::string& file, const std::string& ending, bool replaces);
  /// Removes the file if finish() was not called and nothing is in it.
  ~StreamRecorder();
  StreamRecorder(const StreamRecorder&) = delete;
  StreamRecorder& operator=(const StreamRecorder&) = delete;

  void write(const std::uint8_t* bytes, std::size_t size, double time_s);
  /// Writes to the disk what has waited for a second. To be called at least that often.
  void keepUp();
  /// The same at once, before a time without keepUp().
  void flush();
  /// Leaves no file if nothing of it could be written.
  /// @throws Error (other), also if the recording ended early
  void finish();
  /// Why the recording ended early; empty: it did not.
  const std::string& failure() const { return failure_; }

 private:
  void publish();
  /// Whole records, so that a file which ends early ends with one.
  void append();
  void endBecauseOf(const Error& error);

  UnfinishedFile file_;
  const bool replaces_;
  bool is_published_ = false, has_record_ = false;
  AppendedFile disk_;
  double appended_s_;  ///< steadyTime_s()
  std::uintmax_t written_bytes_ = 0;
  std::ostringstream stream_;  ///< what is not on the disk yet
  std::unique_ptr<interop::dis::CaptureWriter> capture_;
  std::vector<std::uint8_t> datagram_;
  std::string failure_;
  bool is_finished_ = false;
};

}  // namespace emscape::playback
