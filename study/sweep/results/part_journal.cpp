#include "study/sweep/results/part_journal.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>
#include <string_view>

#include "base/files/file_reading.h"
#include "base/files/json_reading.h"
#include "base/files/json_writing.h"
#include "emscape/base/error.h"
#include "study/sweep/results/part_rows.h"

namespace emscape::study {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kChecksumDigits = 8;

std::string checksumOf(std::string_view text) {
  return fmt::format("{:08x}", crc32_z(0, reinterpret_cast<const Bytef*>(text.data()), text.size()));
}

std::string hexOf(const std::string& bytes) {
  std::string text;
  for (const char byte : bytes) text += fmt::format("{:02x}", static_cast<unsigned char>(byte));
  return text;
}

std::string bytesOf(std::string_view hex) {
  std::string bytes;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2) {
    unsigned char byte = 0;
    if (std::from_chars(hex.data() + i, hex.data() + i + 2, byte, 16).ptr != hex.data() + i + 2)
      throw Error(ErrorCode::bad_input,
                  fmt::format("bits hold '{}', not a hexadecimal byte", hex.substr(i, 2)));
    bytes += static_cast<char>(byte);
  }
  return bytes;
}

/// @throws Error (bad_input) without a location
std::vector<std::uint8_t> pixelsOf(const Json& record) {
  const std::string bytes = bytesOf(record.at("bits").get_ref<const std::string&>());
  const Json& pixels = record.at("pixels");
  if (!pixels.is_number_unsigned() || pixels.get<std::uint64_t>() > 8 * bytes.size()) {
    throw Error(ErrorCode::bad_input,
                fmt::format("pixels is {}, not a whole number from 0 to {}, the number of bits",
                            pixels.dump(), 8 * bytes.size()));
  }
  return unpackedPixels(bytes, pixels);
}

}  // namespace

PartJournal::PartJournal(std::filesystem::path file, std::vector<std::size_t> variants, std::size_t measures)
    : file_(std::move(file)), open_(file_), variants_(std::move(variants)), measures_(measures) {
  read(readWholeText(file_));
}

void PartJournal::read(const std::string& text) {
  const std::set<std::size_t> own(variants_.begin(), variants_.end());
  const auto readRecord = [&](const Json& record) {
    VariantResult result = readRow(record.at("row").get_ref<const std::string&>(), measures_);
    if (own.count(result.variant) == 0) return;
    if (record.contains("pixels")) result.pixels = pixelsOf(record);
    machines_.insert(record.at("machine"));
    for (const std::string warning : record.at("warnings")) warnings_.insert(warning);
    const std::size_t variant = result.variant;
    finished_.emplace(variant, std::move(result));
  };
  int number = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line(text.data() + begin, end - begin);
    begin = end + 1;
    ++number;
    if (line.size() <= kChecksumDigits + 1) continue;
    const std::string_view content = line.substr(kChecksumDigits + 1);
    if (line.substr(0, kChecksumDigits) != checksumOf(content)) continue;
    try {
      readJson<Json>(content, "", readRecord);
    } catch (const Error& error) {
      throw Error(ErrorCode::bad_input, {file_.string(), number, 0},
                  "its checksum is right, but it is not a record of a variant: " + error.message());
    }
  }
}

std::vector<std::size_t> PartJournal::unfinished() const {
  std::vector<std::size_t> left;
  std::copy_if(variants_.begin(), variants_.end(), std::back_inserter(left),
               [&](std::size_t variant) { return finished_.count(variant) == 0; });
  return left;
}

void PartJournal::add(VariantResult result, const std::set<std::string>& warnings,
                      const std::string& machine) {
  Json record{{"row", rowOf(result)}, {"machine", machine}, {"warnings", Json::array()}};
  for (const std::string& warning : warnings) {
    if (reported_.insert(warning).second) record["warnings"].push_back(warning);
  }
  if (!result.pixels.empty()) {
    record["pixels"] = result.pixels.size();
    record["bits"] = hexOf(packedPixels(result.pixels));
  }
  const std::string content = dumpJson(record);
  // The previous line may be incomplete, so this one begins with a line end.
  open_.append('\n' + checksumOf(content) + ' ' + content + '\n');
  machines_.insert(machine);
  warnings_.insert(warnings.begin(), warnings.end());
  const std::size_t variant = result.variant;
  finished_.emplace(variant, std::move(result));
}

std::vector<VariantResult> PartJournal::results() const {
  std::vector<VariantResult> results;
  for (const std::size_t variant : variants_) results.push_back(finished_.at(variant));
  return results;
}

}  // namespace emscape::study
