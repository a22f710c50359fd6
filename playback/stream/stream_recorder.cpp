#include "playback/stream/stream_recorder.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "base/files/whole_file.h"
#include "emscape/base/error.h"
#include "emscape/base/log.h"
#include "playback/stream/steady_time.h"

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
    : file_(checked(file, ending, replaces), replaces ? Replaces::any : Replaces::nothing),
      replaces_(replaces),
      disk_(file_.temporary()),
      appended_s_(steadyTime_s()) {
  if (ending == ".pcap") capture_ = std::make_unique<interop::dis::CaptureWriter>(stream_);
  if (!replaces_) publish();
}

StreamRecorder::~StreamRecorder() {
  if (!is_finished_ && is_published_ && written_bytes_ == 0) file_.withdraw();
}

void StreamRecorder::publish() {
  if (!std::exchange(is_published_, true)) file_.publish();
}

void StreamRecorder::write(const std::uint8_t* bytes, std::size_t size, double time_s) {
  if (!failure_.empty() || is_finished_) return;
  has_record_ = true;
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

void StreamRecorder::keepUp() {
  if (steadyTime_s() - appended_s_ >= 1) flush();
}

void StreamRecorder::flush() {
  if (failure_.empty() && stream_.tellp() > 0) append();
}

void StreamRecorder::append() {
  if (replaces_ && !has_record_) return;  // the head of a file is no reason to replace another one
  const std::string bytes = stream_.str();
  stream_.str("");
  appended_s_ = steadyTime_s();
  try {
    disk_.append(bytes);
    written_bytes_ += bytes.size();
    publish();
  } catch (const Error& error) {
    endBecauseOf(error);
  }
}

void StreamRecorder::endBecauseOf(const Error& error) {
  const std::string text = error.what();  // of the temporary file
  failure_ = file_.file().string() + ": the recording ends here: " +
             text.substr(std::min(text.find("cannot write"), text.rfind(": ") + 2));
  try {
    disk_.cut(written_bytes_);
  } catch (const Error&) {  // it ends with a part of a record
  }
  logWarning(failure_);
}

void StreamRecorder::finish() {
  if (std::exchange(is_finished_, true)) return;
  if (failure_.empty()) append();
  if (failure_.empty()) {
    try {
      disk_.sync();
      return;
    } catch (const Error& error) {
      endBecauseOf(error);
    }
  }
  if (is_published_ && written_bytes_ == 0) file_.withdraw();
  throw Error(ErrorCode::other, failure_);
}

}  // namespace emscape::playback
