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
    : file_(checked(file, ending, replaces)), disk_(file_.temporary()) {
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
  constexpr std::streamoff kAtOnce_bytes = 1 << 16;
  if (stream_.tellp() >= kAtOnce_bytes) append();
}

void StreamRecorder::append() {
  const std::string bytes = stream_.str();
  stream_.str("");
  try {
    disk_.append(bytes);
    written_bytes_ += bytes.size();
  } catch (const Error& error) {
    const std::string text = error.what();  // of the temporary file
    failure_ = file_.file().string() + ": the recording ends here: " + text.substr(text.find("cannot write"));
    disk_.cut(written_bytes_);
  }
}

void StreamRecorder::finish() {
  if (std::exchange(is_finished_, true)) return;
  if (failure_.empty()) append();
  if (failure_.empty() || written_bytes_ > 0) file_.publish();
  if (!failure_.empty()) throw Error(ErrorCode::other, failure_);
}

}  // namespace emscape::playback
