#include "recording/common/byte_source.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "base/files/descriptor.h"
#include "base/geodesy/gdal_file.h"
#include "emscape/base/error.h"
#include "emscape/base/work.h"

namespace emscape::interop {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void failReading(const std::string& file, const std::string& cause) {
  throw Error(ErrorCode::bad_input, {file, 0, 0}, "cannot read: " + cause);
}

/// @return size of the file
std::uintmax_t requireRegular(const std::string& file) {
  if (const std::string fault = gdal::faultOfName(file); !fault.empty()) failReading(file, fault);
  std::error_code failed;
  const std::uintmax_t size = fs::file_size(file, failed);
  if (failed) failReading(file, failed.message());
  return size;
}

class FileSource : public ByteSource {
 public:
  explicit FileSource(const std::string& file) : size_(requireRegular(file)) {
    errno = 0;
    stream_.open(file, std::ios::binary);
    if (!stream_) failReading(file, causeOf(errno));
  }
  std::size_t read(char* bytes, std::size_t size) override {
    stream_.read(bytes, static_cast<std::streamsize>(size));
    const auto count = static_cast<std::size_t>(stream_.gcount());
    if (stream_.bad()) failure_ = "the file cannot be read further";
    done_ += count;
    checkpoint();
    reportDone(fraction());
    return count;
  }
  double fraction() const override {
    return size_ == 0 ? 1 : std::min(1.0, static_cast<double>(done_) / static_cast<double>(size_));
  }
  std::string failure() const override { return failure_; }

 private:
  std::uintmax_t size_, done_ = 0;
  std::ifstream stream_;
  std::string failure_;
};

class TextSource : public ByteSource {
 public:
  explicit TextSource(std::string_view text) : text_(text) {}
  std::size_t read(char* bytes, std::size_t size) override {
    const std::size_t count = std::min(size, text_.size() - done_);
    std::memcpy(bytes, text_.data() + done_, count);
    done_ += count;
    return count;
  }

 private:
  std::string_view text_;
  std::size_t done_ = 0;
};

}  // namespace

std::unique_ptr<ByteSource> openFile(const std::string& file) {
  return std::make_unique<FileSource>(file);
}

std::unique_ptr<ByteSource> openText(std::string_view text) {
  return std::make_unique<TextSource>(text);
}

std::string readAll(ByteSource& source, const std::string& name, std::size_t most) {
  std::string text;
  std::vector<char> piece(std::size_t{1} << 16);
  while (const std::size_t count = source.read(piece.data(), piece.size())) {
    text.append(piece.data(), count);
    if (text.size() > most)
      failReading(name, "the file has more than " + std::to_string(most >> 20) + " MiB; cut it into parts");
  }
  return text;
}

bool LineReader::fill() {
  begin_ = 0;
  end_ = source_.read(buffer_.data(), buffer_.size());
  if (end_sign_ == '\0') {
    const std::string_view piece(buffer_.data(), end_);
    end_sign_ = piece.find('\n') == piece.npos && piece.find('\r') != piece.npos ? '\r' : '\n';
  }
  return end_ > 0;
}

bool LineReader::next(std::string_view& line) {
  joined_.clear();
  is_cut_ = false;
  is_terminated_ = true;
  bool is_joined = false;
  for (;;) {
    if (begin_ == end_ && !fill()) {
      if (!is_joined) return false;
      is_terminated_ = false;
      break;
    }
    const char* const from = buffer_.data() + begin_;
    const auto* const found = static_cast<const char*>(std::memchr(from, end_sign_, end_ - begin_));
    const std::size_t count = found == nullptr ? end_ - begin_ : static_cast<std::size_t>(found - from);
    begin_ += count + (found == nullptr ? 0 : 1);
    if (found != nullptr && !is_joined) {
      line = {from, std::min(count, kLongest)};
      is_cut_ = count > kLongest;
      ++line_;
      if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
      return true;
    }
    is_joined = true;
    is_cut_ = is_cut_ || joined_.size() + count > kLongest;
    joined_.append(from, std::min(count, kLongest - joined_.size()));
    if (found != nullptr) break;
  }
  ++line_;
  line = joined_;
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  return true;
}

bool RecordReader::read(std::size_t size, std::vector<std::uint8_t>& bytes) {
  bytes.resize(size);
  std::size_t done = 0;
  while (done < size) {
    const std::size_t count = source_.read(reinterpret_cast<char*>(bytes.data()) + done, size - done);
    if (count == 0) break;
    done += count;
  }
  bytes.resize(done);
  offset_ += done;
  return done == size;
}

bool RecordReader::skip(std::uint64_t size) {
  std::array<char, 4096> piece{};
  while (size > 0) {
    const std::size_t count =
        source_.read(piece.data(), static_cast<std::size_t>(std::min<std::uint64_t>(size, piece.size())));
    if (count == 0) return false;
    offset_ += count;
    size -= count;
  }
  return true;
}

}  // namespace emscape::interop
