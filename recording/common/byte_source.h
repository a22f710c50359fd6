/// Bytes of a file, one piece after another.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace emscape::interop {

/// A file that is read from its begin to its end.
class ByteSource {
 public:
  virtual ~ByteSource() = default;
  /// Reads up to `size` bytes. @return their number; 0 at the end
  virtual std::size_t read(char* bytes, std::size_t size) = 0;
  /// Part of the file that has been read, 0..1.
  virtual double fraction() const { return 0; }
  /// Describes why reading ended before the end of the file; empty if it did not.
  virtual std::string failure() const { return ""; }
};

/// Opens a regular file. @throws Error (bad_input) that names it and the cause
std::unique_ptr<ByteSource> openFile(const std::string& file);
/// Opens a file from its begin; may be called several times.
using Opener = std::function<std::unique_ptr<ByteSource>()>;
/// Opens the recording in a zip file: the first file in it whose name ends in .acmi or .kml, else the only
/// one, else the only one with an ending of recordings. Folders and hidden files do not count.
/// @param name  of the zip file, for messages
/// @param endings  of recordings, in lower case
/// The directory at the end of the zip file is not needed, so that one that was cut is read to the cut.
/// @throws Error (bad_input)
std::unique_ptr<ByteSource> openZip(const Opener& open, const std::string& name,
                                    const std::vector<std::string>& endings);
/// What a file holds that gzip packed. @param name  of the file, for messages
std::unique_ptr<ByteSource> openGzip(std::unique_ptr<ByteSource> packed, const std::string& name);
/// A text in memory, which must outlive the source.
std::unique_ptr<ByteSource> openText(std::string_view text);

/// All bytes of a source.
/// @param name  of the file, for messages  @throws Error (bad_input) if there are more than `most`
std::string readAll(ByteSource& source, const std::string& name, std::size_t most);

/// Reads lines. They end in LF or CRLF; in CR where the first 64 KiB have no LF.
class LineReader {
 public:
  /// @param source  must outlive the reader
  explicit LineReader(ByteSource& source) : source_(source) {}

  /// Longest line that is kept (bytes); the rest of a longer one is dropped.
  static constexpr std::size_t kLongest = std::size_t{1} << 20;

  /// Reads the next line, valid until the next call. @return false at the end
  bool next(std::string_view& line);
  /// False for a last line without a line end.
  bool isTerminated() const { return is_terminated_; }
  /// True if the line was longer than kLongest.
  bool isCut() const { return is_cut_; }
  long long line() const { return line_; }  ///< number of the line, from 1

 private:
  bool fill();

  ByteSource& source_;
  std::vector<char> buffer_ = std::vector<char>(std::size_t{1} << 16);
  std::size_t begin_ = 0, end_ = 0;
  std::string joined_;  ///< a line that continues in the next piece
  bool is_terminated_ = true, is_cut_ = false;
  char end_sign_ = '\0';  ///< of a line; '\0' before the first piece
  long long line_ = 0;
};

/// Reads records of bytes.
class RecordReader {
 public:
  explicit RecordReader(ByteSource& source) : source_(source) {}

  /// Reads exactly `size` bytes. @return false if the file has fewer; `bytes` has then what it has
  bool read(std::size_t size, std::vector<std::uint8_t>& bytes);
  /// Skips bytes. @return false if the file has fewer
  bool skip(std::uint64_t size);
  std::uint64_t offset() const { return offset_; }

 private:
  ByteSource& source_;
  std::uint64_t offset_ = 0;
};

}  // namespace emscape::interop
