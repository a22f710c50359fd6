#include "document/text_file.h"

#include <fmt/format.h>

#include <utility>

#include "base/text/utf8.h"

namespace emscape::document {

namespace {

bool isForbiddenControl(unsigned char c) {
  return (c < 0x20 && c != '\t' && c != '\n' && c != '\r') || c == 0x7F;
}

/// What a file holds that begins with the signature of another format; empty: none that is known.
std::string_view otherContent(std::string_view bytes) {
  using namespace std::string_view_literals;
  static constexpr std::pair<std::string_view, std::string_view> kSignatures[] = {
      {"\x89PNG"sv, "a picture (PNG)"},
      {"\xFF\xD8\xFF"sv, "a picture (JPEG)"},
      {"GIF8"sv, "a picture (GIF)"},
      {"II*\0"sv, "a raster (TIFF)"},
      {"MM\0*"sv, "a raster (TIFF)"},
      {" BDV"sv, "a volume (OpenVDB)"},
      {"NanoVDB"sv, "a volume (NanoVDB)"},
      {"\x89HDF"sv, "data (HDF5 or netCDF)"},
      {"CDF\x01"sv, "data (netCDF)"},
      {"SQLite format 3"sv, "a database (GeoPackage or SQLite)"},
      {"PK\x03\x04"sv, "an archive (ZIP, KMZ or a document)"},
      {"\x1F\x8B"sv, "compressed data (gzip)"},
      {"%PDF"sv, "a document (PDF)"}};
  for (const auto& [signature, content] : kSignatures)
    if (bytes.substr(0, signature.size()) == signature) return content;
  const bool is_video = bytes.size() > 8 && bytes.substr(4, 4) == "ftyp";
  return is_video ? "a video (MP4)" : "";
}

}  // namespace

std::string checkedUtf8(const std::string& file, std::string bytes, const std::string& expected) {
  if (const std::string_view content = otherContent(bytes); !content.empty())
    throw Error(ErrorCode::bad_input, {file, 0, 0}, fmt::format("this is {}, not {}", content, expected));
  if (bytes.compare(0, 3, "\xEF\xBB\xBF") == 0) bytes.erase(0, 3);
  int line = 1, column = 1;
  for (std::size_t i = 0; i < bytes.size();) {
    const std::size_t length = utf8SequenceLength(std::string_view(bytes).substr(i));
    const unsigned char byte = static_cast<unsigned char>(bytes[i]);
    if (length == 0) {
      throw Error(ErrorCode::bad_input, {file, line, column},
                  fmt::format("byte 0x{:02x} is not UTF-8; save the file as UTF-8", byte));
    }
    if (isForbiddenControl(byte)) {
      throw Error(ErrorCode::bad_input, {file, line, column},
                  fmt::format("control character 0x{:02x}", byte));
    }
    i += length;
    ++column;
    if (byte == '\n') {
      ++line;
      column = 1;
    }
  }
  return bytes;
}

std::size_t characterCount(std::string_view text) {
  std::size_t count = 0;
  for (const char c : text) count += (static_cast<unsigned char>(c) & 0xC0) != 0x80;
  return count;
}

void ContentHash::add(std::string_view bytes) {
  constexpr std::uint64_t kPrime = 1099511628211ull;
  for (const char c : bytes) state_ = (state_ ^ static_cast<unsigned char>(c)) * kPrime;
}

std::string ContentHash::hex() const {
  return fmt::format("{:016x}", state_);
}

}  // namespace emscape::document
