#include "base/geodesy/netcdf_header.h"

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <vector>

namespace emscape {
namespace {

struct BadHeader {};

/// Reads a header; throws BadHeader where it does not follow the format.
class NetcdfHeader {
 public:
  NetcdfHeader(std::istream& stream, std::uintmax_t size, int version)
      : stream_(stream), size_(size), version_(version) {}

  void check() {
    count();  // of records
    const std::uint64_t dimensions = listOf(10);
    for (std::uint64_t k = 0; k < dimensions; ++k) {
      name();
      const std::uint64_t length = count();
      if (length == 0 && ++unlimited_ > 1) throw BadHeader();
      lengths_.push_back(length);
    }
    attributes();
    const std::uint64_t variables = listOf(11);
    std::vector<std::uint64_t> begins;
    for (std::uint64_t k = 0; k < variables; ++k) begins.push_back(variable());
    const std::uint64_t end = static_cast<std::uint64_t>(stream_.tellg());
    for (const std::uint64_t begin : begins) {
      if (begin < end || begin > size_) throw BadHeader();
    }
  }

 private:
  std::uint64_t bigEndian(int bytes) {
    unsigned char read[8];
    if (!stream_.read(reinterpret_cast<char*>(read), bytes)) throw BadHeader();
    std::uint64_t value = 0;
    for (int k = 0; k < bytes; ++k) value = value << 8 | read[k];
    return value;
  }
  std::uint64_t count() {
    const std::uint64_t value = bigEndian(version_ == 5 ? 8 : 4);
    if (value >> (version_ == 5 ? 63 : 31) != 0) throw BadHeader();
    return value;
  }
  /// Number of elements of a list with a tag.
  std::uint64_t listOf(std::uint64_t tag) {
    const std::uint64_t own = bigEndian(4), elements = count();
    if ((own != tag && (own != 0 || elements != 0)) || elements > size_) throw BadHeader();
    return elements;
  }
  void skipPadded(std::uint64_t bytes) {
    const std::uint64_t padded = (bytes + 3) / 4 * 4;
    if (padded > size_ || static_cast<std::uint64_t>(stream_.tellg()) + padded > size_) throw BadHeader();
    stream_.seekg(static_cast<std::streamoff>(padded), std::ios::cur);
  }
  void name() {
    const std::uint64_t length = count();
    if (length == 0 || length > 256) throw BadHeader();
    std::string text(static_cast<std::size_t>((length + 3) / 4 * 4), '\0');
    if (!stream_.read(text.data(), static_cast<std::streamsize>(text.size()))) throw BadHeader();
    for (std::size_t k = 0; k < text.size(); ++k) {
      const auto c = static_cast<unsigned char>(text[k]);
      if (k < length ? c < 0x20 || c >= 0x7F || c == '/' : c != 0) throw BadHeader();
    }
  }
  std::uint64_t type() {
    static constexpr std::uint64_t kBytes[] = {0, 1, 1, 2, 4, 4, 8, 1, 2, 4, 8, 8};
    const std::uint64_t type = bigEndian(4);
    if (type == 0 || type > (version_ == 5 ? 11 : 6)) throw BadHeader();
    return kBytes[type];
  }
  void attributes() {
    const std::uint64_t attributes = listOf(12);
    for (std::uint64_t k = 0; k < attributes; ++k) {
      name();
      const std::uint64_t bytes = type(), values = count();
      if (values > size_) throw BadHeader();
      skipPadded(values * bytes);
    }
  }
  /// @return where its values begin
  std::uint64_t variable() {
    name();
    const std::uint64_t rank = count();
    if (rank > 1024) throw BadHeader();
    for (std::uint64_t k = 0; k < rank; ++k) {
      const std::uint64_t dimension = count();
      if (dimension >= lengths_.size() || (k > 0 && lengths_[dimension] == 0)) throw BadHeader();
    }
    attributes();
    type();
    bigEndian(version_ == 5 ? 8 : 4);  // of its values
    return bigEndian(version_ == 1 ? 4 : 8);
  }

  std::istream& stream_;
  std::uintmax_t size_;
  int version_, unlimited_ = 0;
  std::vector<std::uint64_t> lengths_;
};

}  // namespace

std::string faultOfNetcdfHeader(const std::string& file) {
  std::error_code failed;
  const std::uintmax_t size = std::filesystem::file_size(file, failed);
  std::ifstream stream(file, std::ios::binary);
  return failed ? "" : faultOfNetcdfHeader(stream, size);
}

std::string faultOfNetcdfHeader(std::istream& stream, std::uintmax_t size) {
  char magic[4] = {};
  if (!stream.read(magic, sizeof magic) || std::memcmp(magic, "CDF", 3) != 0) return "";
  const int version = magic[3];
  const char* const fault = "its netCDF header is damaged";
  if (version != 1 && version != 2 && version != 5) return fault;
  try {
    NetcdfHeader(stream, size, version).check();
  } catch (const BadHeader&) {
    return fault;
  }
  return "";
}

}  // namespace emscape
