#include "base/geodesy/netcdf_header.h"

#include <array>
#include <cstdint>
#include <fstream>
#include <stdexcept>

namespace emscape {
namespace {

/// Walks through the lists of a header; throws std::runtime_error at the first fault.
class NetcdfHeader {
 public:
  NetcdfHeader(std::istream& stream, std::uint64_t file_bytes) : stream_(stream), left_(file_bytes) {}

  void check() {
    std::array<char, 4> magic{};
    read(magic.data(), magic.size());
    if (magic[0] != 'C' || magic[1] != 'D' || magic[2] != 'F') return;
    version_ = magic[3];
    if (version_ != 1 && version_ != 2 && version_ != 5) return;  // GDAL refuses it
    count();                                                      // of records; all bits set: unknown
    const std::uint64_t dimensions = listOf(kDimension);
    for (std::uint64_t i = 0; i < dimensions; ++i) {
      checkName();
      count();  // its length
    }
    checkAttributes();
    const std::uint64_t variables = listOf(kVariable);
    for (std::uint64_t i = 0; i < variables; ++i) {
      checkName();
      const std::uint64_t rank = count();
      for (std::uint64_t d = 0; d < rank; ++d) {
        if (count() >= dimensions) throw std::runtime_error("a variable has a dimension that does not exist");
      }
      checkAttributes();
      bytesOfType();
      count();                      // its size
      skip(version_ == 1 ? 4 : 8);  // its place
    }
  }

 private:
  static constexpr std::uint32_t kDimension = 10, kVariable = 11, kAttribute = 12;

  void read(char* bytes, std::uint64_t size) {
    if (size > left_ || !stream_.read(bytes, static_cast<std::streamsize>(size)))
      throw std::runtime_error("the file ends within its header");
    left_ -= size;
  }
  void skip(std::uint64_t size) {
    if (size > left_ || !stream_.seekg(static_cast<std::streamoff>(size), std::ios::cur))
      throw std::runtime_error("the file ends within its header");
    left_ -= size;
  }
  std::uint64_t number(int bytes) {
    std::array<char, 8> text{};
    read(text.data(), static_cast<std::uint64_t>(bytes));
    std::uint64_t value = 0;
    for (int i = 0; i < bytes; ++i)
      value = value << 8 | static_cast<std::uint8_t>(text[static_cast<std::size_t>(i)]);
    return value;
  }
  std::uint64_t count() { return number(version_ == 5 ? 8 : 4); }

  /// @return the number of items of a list, 0 for an absent one
  std::uint64_t listOf(std::uint32_t tag) {
    const std::uint64_t found = number(4), items = count();
    if (found == 0 && items == 0) return 0;
    if (found != tag) throw std::runtime_error("a list of the header has another kind");
    // The least item has a name of no letters and a number.
    if (items > left_ / 8) throw std::runtime_error("a list of the header is longer than the file");
    return items;
  }
  static std::uint64_t padded(std::uint64_t bytes) { return (bytes + 3) / 4 * 4; }
  void checkName() {
    const std::uint64_t length = count();
    if (length == 0 || length > left_)
      throw std::runtime_error("a name of the header is longer than the file");
    skip(padded(length));
  }
  std::uint64_t bytesOfType() {
    static constexpr std::array<std::uint64_t, 12> kBytes{0, 1, 1, 2, 4, 4, 8, 1, 2, 4, 8, 8};
    const std::uint64_t type = number(4);
    if (type < 1 || type > (version_ == 5 ? 11U : 6U)) throw std::runtime_error("a type that does not exist");
    return kBytes[type];
  }
  void checkAttributes() {
    const std::uint64_t attributes = listOf(kAttribute);
    for (std::uint64_t i = 0; i < attributes; ++i) {
      checkName();
      const std::uint64_t bytes = bytesOfType(), values = count();
      if (values > left_) throw std::runtime_error("an attribute is longer than the file");
      skip(padded(bytes * values));
    }
  }

  std::istream& stream_;
  std::uint64_t left_;
  int version_ = 0;
};

}  // namespace

std::string netcdfHeaderFault(const std::filesystem::path& file) {
  std::error_code failed;
  const std::uintmax_t bytes = std::filesystem::file_size(file, failed);
  std::ifstream stream(file, std::ios::binary);
  if (failed || !stream || bytes < 4) return "";
  try {
    NetcdfHeader(stream, bytes).check();
  } catch (const std::runtime_error& fault) {
    return fault.what();
  }
  return "";
}

}  // namespace emscape
