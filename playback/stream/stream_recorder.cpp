#include "playback/stream/stream_recorder.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "base/files/whole_file.h"
#include "emscape/base/error.h"

namespace emscape::playback {
namespace {

/// Checks the name before the file is begun.
const std::string& checked(const std::string& file, const std::string& ending, bool replaces) {
  if (std::filesystem::path(file).extension() != ending) {
    throw Error(ErrorCode::usage,
                fmt::format("--record '{}': the recording of this stream ends in {}", file, ending));
  }
  if (!replaces) requireNew({file});
  return file;
}

}  // namespace

StreamRecorder::StreamRecorder(const std::string& file, const std::string& ending, bool replaces)
    : file_(checked(file, ending, replaces)), stream_(file_.temporary(), std::ios::binary) {
  if (ending == ".pcap") capture_ = std::make_unique<interop::dis::CaptureWriter>(stream_);
}

void StreamRecorder::write(const std::uint8_t* bytes, std::size_t size, double time_s) {
  if (!failure_.empty() || is_finished_) return;
  if (capture_) {
    constexpr std::size_t kLargest = 65535 - 28;  // with its headers
    datagram_.assign(bytes, bytes + std::min(size, kLargest));
    capture_->write(time_s, datagram_);
  } else {
    stream_.write(reinterpret_cast<const char*>(bytes), static_cast<std::streamsize>(size));
  }
  if (!stream_) failure_ = file_.file().string() + ": cannot be written on; the recording ends here";
}

void StreamRecorder::finish() {
  if (std::exchange(is_finished_, true)) return;
  stream_.close();
  if (!stream_ && failure_.empty())
    failure_ = file_.file().string() + ": cannot be written; the end of the recording is missing";
  file_.publish();
  if (!failure_.empty()) throw Error(ErrorCode::other, failure_);
}

}  // namespace emscape::playback
