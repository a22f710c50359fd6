#include <zlib.h>

#include <algorithm>
#include <cstring>

#include "emscape/base/error.h"
#include "recording/common/byte_source.h"

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
  return name.size() > end.size() && name.compare(name.size() - end.size(), end.size(), end) == 0;
}

class ZipSource : public ByteSource {
 public:
  ZipSource(std::unique_ptr<ByteSource> zip, const std::string& name)
      : name_(name), file_(std::move(zip)), reader_(*file_) {
    chooseEntry();
    if (entry_.method == kDeflated && inflateInit2(&stream_, -MAX_WBITS) != Z_OK) fail("out of memory");
    is_initialised_ = entry_.method == kDeflated;
  }
  ~ZipSource() override {
    if (is_initialised_) inflateEnd(&stream_);
  }
  ZipSource(const ZipSource&) = delete;
  ZipSource& operator=(const ZipSource&) = delete;

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
  double fraction() const override { return file_->fraction(); }
  std::string failure() const override { return failure_; }

 private:
  [[noreturn]] void fail(const std::string& cause) const {
    throw Error(ErrorCode::bad_input, {name_, 0, 0}, "cannot read: " + cause);
  }
  void end(const std::string& failure) {
    is_at_end_ = true;
    failure_ = failure;
  }

  bool readEntry() {
    std::vector<std::uint8_t> head, name;
    if (!reader_.read(30, head) || std::memcmp(head.data(), "PK\x03\x04", 4) != 0) return false;
    const std::uint32_t flags = little(head, 6, 2);
    entry_.is_encrypted = (flags & 1) != 0;
    entry_.is_size_known = (flags & 8) == 0;
    entry_.method = static_cast<int>(little(head, 8, 2));
    entry_.crc = little(head, 14, 4);
    entry_.packed_size = little(head, 18, 4);
    if (!reader_.read(little(head, 26, 2), name) || !reader_.skip(little(head, 28, 2))) return false;
    entry_.name.assign(name.begin(), name.end());
    return true;
  }

  void chooseEntry() {
    for (;;) {
      if (!readEntry()) fail("the zip file is damaged, or has no recording in it");
      const bool is_folder = !entry_.name.empty() && entry_.name.back() == '/';
      const bool is_recording = endsWith(entry_.name, ".acmi") || endsWith(entry_.name, ".kml");
      const bool can_be_skipped = entry_.is_size_known && entry_.packed_size != 0xFFFFFFFF;
      if (is_recording || (!is_folder && !can_be_skipped)) break;
      if (!can_be_skipped || !reader_.skip(entry_.packed_size))
        fail("the zip file has no file that ends in .acmi or .kml");
    }
    if (entry_.is_encrypted) fail("the zip file is encrypted; unpack it, and give the recording in it");
    const bool is_size_told = entry_.is_size_known && entry_.packed_size != 0xFFFFFFFF;
    if (entry_.method != kDeflated && !(entry_.method == kStored && is_size_told)) {
      fail("the zip file is packed by method " + std::to_string(entry_.method) +
           "; only deflated and stored files are read: unpack it, and give the recording in it");
    }
    left_ = entry_.packed_size;
  }

  std::size_t copyInto(char* bytes, std::size_t size) {
    const std::size_t wanted = std::min<std::uint64_t>(size, left_);
    const std::size_t count = file_->read(bytes, wanted);
    left_ -= count;
    if (left_ == 0) is_at_end_ = true;
    if (count == 0 && left_ > 0) end("the zip file is cut");
    return count;
  }

  std::size_t inflateInto(char* bytes, std::size_t size) {
    stream_.next_out = reinterpret_cast<Bytef*>(bytes);
    stream_.avail_out = static_cast<uInt>(std::min<std::size_t>(size, 1u << 30));
    const uInt room = stream_.avail_out;
    while (stream_.avail_out == room && !is_at_end_) {
      if (stream_.avail_in == 0) {
        stream_.next_in = reinterpret_cast<Bytef*>(packed_.data());
        stream_.avail_in = static_cast<uInt>(file_->read(packed_.data(), packed_.size()));
        if (stream_.avail_in == 0) end("the zip file is cut");
      }
      const int result = inflate(&stream_, Z_NO_FLUSH);
      if (result == Z_STREAM_END) {
        is_at_end_ = true;
      } else if (result != Z_OK && result != Z_BUF_ERROR) {
        end("the zip file is damaged");
      }
    }
    return room - stream_.avail_out;
  }

  std::string name_;
  std::unique_ptr<ByteSource> file_;
  RecordReader reader_;
  ZipEntry entry_;
  z_stream stream_{};
  bool is_initialised_ = false, is_at_end_ = false;
  std::vector<char> packed_ = std::vector<char>(std::size_t{1} << 16);
  std::uint64_t left_ = 0, done_ = 0;
  uLong crc_ = 0;
  std::string failure_;
};

}  // namespace

std::unique_ptr<ByteSource> openZip(std::unique_ptr<ByteSource> zip, const std::string& name) {
  return std::make_unique<ZipSource>(std::move(zip), name);
}

}  // namespace emscape::interop
