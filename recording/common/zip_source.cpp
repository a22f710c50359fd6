#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cstring>
#include <optional>

#include "emscape/base/error.h"
#include "recording/common/byte_source.h"
#include "recording/common/text.h"

namespace emscape::interop {
namespace {

/// The head of a file in a zip file. @see PKWARE, APPNOTE.TXT, 4.3.7
struct ZipEntry {
  std::string name;
  int method = 0;  ///< 0 stored, 8 deflated
  bool is_encrypted = false;
  bool is_size_known = false;  ///< else it follows the data
  std::uint32_t packed_size = 0;
  std::uint32_t crc = 0;
};

constexpr int kStored = 0, kDeflated = 8;
/// The largest recording in a zip file (bytes).
constexpr std::uint64_t kMaxUnzipped = std::uint64_t{16} << 30;

std::uint32_t little(const std::vector<std::uint8_t>& bytes, std::size_t at, std::size_t size) {
  std::uint32_t value = 0;
  for (std::size_t i = size; i-- > 0;) value = value << 8 | bytes[at + i];
  return value;
}

bool endsWith(const std::string& name, std::string_view end) {
  return name.size() > end.size() && lowerCase(name.substr(name.size() - end.size())) == end;
}

/// A source to which bytes can be given back.
class ReturnSource : public ByteSource {
 public:
  explicit ReturnSource(std::unique_ptr<ByteSource> source) : source_(std::move(source)) {}

  std::size_t read(char* bytes, std::size_t size) override {
    if (returned_.empty()) return source_->read(bytes, size);
    const std::size_t count = std::min(size, returned_.size());
    std::copy_n(returned_.begin(), count, bytes);
    returned_.erase(0, count);
    return count;
  }
  /// The last bytes that were read are the next ones again.
  void giveBack(std::string_view bytes) { returned_.insert(0, bytes); }
  double fraction() const override { return source_->fraction(); }

 private:
  std::unique_ptr<ByteSource> source_;
  std::string returned_;
};

/// Unpacks what deflate packed.
class Inflater {
 public:
  /// @param file  must outlive the object  @param window_bits  of zlib's inflateInit2()
  Inflater(ByteSource& file, int window_bits) : file_(file) {
    if (inflateInit2(&stream_, window_bits) != Z_OK)
      throw Error(ErrorCode::other, "cannot unpack: out of memory");
  }
  ~Inflater() { inflateEnd(&stream_); }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;

  std::size_t read(char* bytes, std::size_t size) {
    stream_.next_out = reinterpret_cast<Bytef*>(bytes);
    stream_.avail_out = static_cast<uInt>(std::min<std::size_t>(size, 1u << 30));
    const uInt room = stream_.avail_out;
    while (stream_.avail_out == room && !is_at_end_) {
      if (stream_.avail_in == 0) fill();
      if (stream_.avail_in == 0) end("is cut");
      const int result = inflate(&stream_, Z_NO_FLUSH);
      if (result == Z_STREAM_END) {
        is_at_end_ = true;
      } else if (result != Z_OK && result != Z_BUF_ERROR) {
        end("is damaged");
      }
    }
    done_ += room - stream_.avail_out;
    if (done_ > kMaxUnzipped) end("unpacks to more than 16 GiB");
    return room - stream_.avail_out;
  }
  bool isAtEnd() const { return is_at_end_; }
  /// Goes on with what follows. @return false at the end of the file
  bool goesOn() {
    if (stream_.avail_in == 0) fill();
    if (stream_.avail_in == 0) return false;
    is_at_end_ = false;
    return inflateReset(&stream_) == Z_OK;
  }
  const std::string& failure() const { return failure_; }
  /// What was read of the file behind the packed bytes.
  std::string_view rest() const { return {reinterpret_cast<const char*>(stream_.next_in), stream_.avail_in}; }

 private:
  void fill() {
    stream_.next_in = reinterpret_cast<Bytef*>(packed_.data());
    stream_.avail_in = static_cast<uInt>(file_.read(packed_.data(), packed_.size()));
  }
  void end(const char* failure) {
    is_at_end_ = true;
    failure_ = failure;
  }

  ByteSource& file_;
  z_stream stream_{};
  std::vector<char> packed_ = std::vector<char>(std::size_t{1} << 16);
  std::uint64_t done_ = 0;
  bool is_at_end_ = false;
  std::string failure_;
};

/// One or several files in the format of gzip. @see RFC 1952
class GzipSource : public ByteSource {
 public:
  GzipSource(std::unique_ptr<ByteSource> packed, std::string name)
      : file_(std::move(packed)), name_(std::move(name)), inflater_(*file_, kGzipBits) {}

  std::size_t read(char* bytes, std::size_t size) override {
    if (size == 0) return 0;
    for (;;) {
      const std::size_t count = inflater_.read(bytes, size);
      done_ += count;
      if (!inflater_.failure().empty() && done_ == 0) {
        throw Error(ErrorCode::bad_input, {name_, 0, 0}, "cannot read: the gzip file " + inflater_.failure());
      }
      if (count > 0 || !inflater_.failure().empty() || !inflater_.goesOn()) return count;
    }
  }
  double fraction() const override { return file_->fraction(); }
  std::string failure() const override {
    return inflater_.failure().empty() ? "" : "the gzip file " + inflater_.failure();
  }

 private:
  static constexpr int kGzipBits = MAX_WBITS + 16;
  std::unique_ptr<ByteSource> file_;
  std::string name_;
  Inflater inflater_;
  std::uint64_t done_ = 0;
};

/// The files in a zip file, one after another.
class ZipFiles {
 public:
  explicit ZipFiles(std::unique_ptr<ByteSource> zip) : file_(std::move(zip)) {}

  /// Goes to the next file. @return false if there is none
  bool next() {
    if (has_entry_ && !skip()) return false;
    std::vector<std::uint8_t> head, name;
    if (!reader_.read(30, head) || std::memcmp(head.data(), "PK\x03\x04", 4) != 0) return false;
    const std::uint32_t flags = little(head, 6, 2);
    entry_.is_encrypted = (flags & 1) != 0;
    entry_.method = static_cast<int>(little(head, 8, 2));
    entry_.crc = little(head, 14, 4);
    entry_.packed_size = little(head, 18, 4);
    entry_.is_size_known = (flags & 8) == 0 && entry_.packed_size != 0xFFFFFFFF;
    if (!reader_.read(little(head, 26, 2), name) || !reader_.skip(little(head, 28, 2))) return false;
    entry_.name.assign(name.begin(), name.end());
    return has_entry_ = true;
  }
  const ZipEntry& entry() const { return entry_; }
  ByteSource& source() { return file_; }

 private:
  bool skip() {
    if (entry_.is_size_known) return reader_.skip(entry_.packed_size);
    if (entry_.method != kDeflated || entry_.is_encrypted) return false;
    Inflater inflater(file_, -MAX_WBITS);
    std::vector<char> unpacked(std::size_t{1} << 16);
    while (!inflater.isAtEnd()) inflater.read(unpacked.data(), unpacked.size());
    if (!inflater.failure().empty()) return false;
    file_.giveBack(inflater.rest());
    // Checksum and sizes follow in one of four forms.
    std::string bytes;
    constexpr std::size_t kLongest = 28;
    constexpr std::string_view kNext = "PK\x03\x04";
    for (char byte = 0; bytes.size() < kLongest && file_.read(&byte, 1) == 1;) {
      bytes += byte;
      if (bytes.size() < 4 || bytes.compare(bytes.size() - 4, 4, kNext) != 0) continue;
      file_.giveBack(kNext);
      return true;
    }
    return false;
  }

  ReturnSource file_;
  RecordReader reader_{file_};
  ZipEntry entry_;
  bool has_entry_ = false;
};

/// The number of the recording among the files in a zip file.
std::size_t recordingIn(const Opener& open, const std::string& zip, const std::vector<std::string>& endings) {
  const auto fail = [&zip](const std::string& cause) {
    throw Error(ErrorCode::bad_input, {zip, 0, 0}, "cannot read: " + cause);
  };
  struct Candidate {
    std::size_t number;
    std::string name;
  };
  std::vector<Candidate> all, recordings;
  bool is_document = false;
  ZipFiles files(open());
  for (std::size_t number = 0; files.next(); ++number) {
    const std::string& name = files.entry().name;
    const std::string base = name.substr(name.rfind('/') + 1);
    is_document = is_document || name == "[Content_Types].xml";
    if (base.empty() || base.front() == '.') continue;
    if (endsWith(name, ".acmi") || endsWith(name, ".kml")) return number;
    all.push_back({number, printableText(name)});
    if (std::any_of(endings.begin(), endings.end(), [&](const auto& end) { return endsWith(name, end); }))
      recordings.push_back(all.back());
  }
  if (is_document) fail("it is a document of a spreadsheet; save its table as CSV in UTF-8, and give that");
  if (all.size() == 1) return all.front().number;
  if (recordings.size() == 1) return recordings.front().number;
  if (all.empty()) fail("the zip file is damaged, or has no file in it");
  std::string names;
  const std::vector<Candidate>& told = recordings.empty() ? all : recordings;
  for (std::size_t i = 0; i < std::min<std::size_t>(told.size(), 5); ++i)
    names += (i == 0 ? "" : ", ") + told[i].name;
  fail(fmt::format(
      "the zip file has {} files that may be the recording ({}{}); unpack it, and give one of them",
      told.size(), names, told.size() > 5 ? ", ..." : ""));
  return 0;
}

class ZipSource : public ByteSource {
 public:
  ZipSource(std::unique_ptr<ByteSource> zip, const std::string& name, std::size_t number)
      : name_(name), files_(std::move(zip)) {
    for (std::size_t i = 0; i <= number; ++i) {
      if (!files_.next()) fail("the zip file is damaged");
    }
    if (entry_.is_encrypted) fail("the zip file is encrypted; unpack it, and give the recording in it");
    if (entry_.method != kDeflated && !(entry_.method == kStored && entry_.is_size_known)) {
      fail("the zip file is packed by method " + std::to_string(entry_.method) +
           "; only deflated and stored files are read: unpack it, and give the recording in it");
    }
    left_ = entry_.packed_size;
    if (entry_.method == kDeflated) inflater_.emplace(file_, -MAX_WBITS);
  }

  std::size_t read(char* bytes, std::size_t size) override {
    if (is_at_end_ || size == 0) return 0;
    const std::size_t count = entry_.method == kDeflated ? inflateInto(bytes, size) : copyInto(bytes, size);
    crc_ = crc32_z(crc_, reinterpret_cast<const Bytef*>(bytes), count);
    done_ += count;
    if (done_ > kMaxUnzipped) end("the zip file unpacks to more than 16 GiB");
    if (is_at_end_ && failure_.empty() && entry_.is_size_known && crc_ != entry_.crc)
      failure_ = "the zip file is damaged: its checksum is wrong";
    return count;
  }
  double fraction() const override { return file_.fraction(); }
  std::string failure() const override { return failure_; }

 private:
  [[noreturn]] void fail(const std::string& cause) const {
    throw Error(ErrorCode::bad_input, {name_, 0, 0}, "cannot read: " + cause);
  }
  void end(const std::string& failure) {
    is_at_end_ = true;
    failure_ = failure;
  }

  std::size_t copyInto(char* bytes, std::size_t size) {
    const std::size_t wanted = std::min<std::uint64_t>(size, left_);
    const std::size_t count = file_.read(bytes, wanted);
    left_ -= count;
    if (left_ == 0) is_at_end_ = true;
    if (count == 0 && left_ > 0) end("the zip file is cut");
    return count;
  }

  std::size_t inflateInto(char* bytes, std::size_t size) {
    const std::size_t count = inflater_->read(bytes, size);
    is_at_end_ = inflater_->isAtEnd();
    if (!inflater_->failure().empty()) failure_ = "the zip file " + inflater_->failure();
    return count;
  }

  std::string name_;
  ZipFiles files_;
  ByteSource& file_ = files_.source();
  const ZipEntry& entry_ = files_.entry();
  std::optional<Inflater> inflater_;
  bool is_at_end_ = false;
  std::uint64_t left_ = 0, done_ = 0;
  uLong crc_ = 0;
  std::string failure_;
};

}  // namespace

std::unique_ptr<ByteSource> openZip(const Opener& open, const std::string& name,
                                    const std::vector<std::string>& endings) {
  return std::make_unique<ZipSource>(open(), name, recordingIn(open, name, endings));
}

std::unique_ptr<ByteSource> openGzip(std::unique_ptr<ByteSource> packed, const std::string& name) {
  return std::make_unique<GzipSource>(std::move(packed), name);
}

}  // namespace emscape::interop
