#include "study/sweep/results/part_rows.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "emscape/base/error.h"
#include "study/sweep/results/result_files.h"

namespace emscape::study {
namespace {

[[noreturn]] void failRow(const std::string& why) {
  throw Error(ErrorCode::bad_input, why);
}

}  // namespace

std::string rowOf(const VariantResult& result) {
  std::string row = fmt::format("{}", result.variant);
  for (const double value : result.values) row += ',' + csvNumber(value);
  return row;
}

VariantResult readRow(std::string_view row, std::size_t measures) {
  VariantResult result;
  const char* const end = row.data() + row.size();
  auto read = std::from_chars(row.data(), end, result.variant);
  if (read.ec != std::errc()) failRow("the number of a variant is expected");
  const char* at = read.ptr;
  for (std::size_t m = 0; m < measures; ++m) {
    double value = NAN;
    if (at == end || *at++ != ',') failRow(fmt::format("has less than {} measures", m + 1));
    if (at != end && *at != ',') {
      read = std::from_chars(at, end, value);
      if (read.ec != std::errc()) failRow("holds text that is not a number");
      at = read.ptr;
    }
    result.values.push_back(value);
  }
  if (at != end) failRow("does not end after its last measure");
  return result;
}

std::string packedPixels(const std::vector<std::uint8_t>& pixels) {
  std::string bytes((pixels.size() + 7) / 8, '\0');
  for (std::size_t p = 0; p < pixels.size(); ++p) {
    if (pixels[p] != 0)
      bytes[p / 8] = static_cast<char>(static_cast<unsigned char>(bytes[p / 8]) | 1u << p % 8);
  }
  return bytes;
}

std::vector<std::uint8_t> unpackedPixels(std::string_view bytes, std::size_t pixels) {
  std::vector<std::uint8_t> unpacked(pixels);
  for (std::size_t p = 0; p < pixels; ++p) {
    unpacked[p] = static_cast<unsigned char>(bytes[p / 8]) >> (p % 8) & 1u;
  }
  return unpacked;
}

}  // namespace emscape::study
