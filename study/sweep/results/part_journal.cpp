#include "study/sweep/results/part_journal.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>
#include <string_view>

#include "base/files/file_digest.h"
#include "base/files/file_reading.h"
#include "base/files/json_reading.h"
#include "base/files/json_writing.h"
#include "base/files/own_file.h"
#include "emscape/base/error.h"
#include "study/sweep/results/part_rows.h"

namespace emscape::study {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kChecksumDigits = 8;
/// Of a record, after its checksum.
constexpr std::string_view kBegin = " {\"row\":";

std::string checksumOf(std::string_view text) {
  FileDigest digest;
  addToDigest(text, digest);
  return fmt::format("{:08x}", digest.crc32);
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

/// True for what is left of a line whose writing was interrupted: a disk without power leaves zeros.
/// @param after  what follows its line end: the next record begins with another one
bool isCutRecord(std::string_view line, std::string_view after) {
  const std::size_t zeros = line.find('\0');
  if (zeros == std::string_view::npos && (after.empty() || after.front() == '\n' || after.front() == '\r'))
    return line.empty();
  const std::string_view text = line.substr(0, zeros);
  const std::string_view checksum = text.substr(0, kChecksumDigits);
  const std::string_view begin = text.size() > kChecksumDigits ? text.substr(kChecksumDigits) : "";
  return checksum.find_first_not_of("0123456789abcdef") == std::string_view::npos &&
         begin.substr(0, kBegin.size()) == kBegin.substr(0, begin.size());
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
  bool has_record = false;
  int number = 0, changed = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line(text.data() + begin, end - begin);
    begin = end + 1;
    ++number;
    const std::string_view content = line.substr(std::min(kChecksumDigits + 1, line.size()));
    if (line.substr(0, kChecksumDigits) != checksumOf(content)) {
      const bool has_end = end < text.size();
      if (!isCutRecord(line, has_end ? std::string_view(text).substr(begin) : "-") && changed == 0)
        changed = number;
      continue;
    }
    has_record = true;
    try {
      readJson<Json>(content, "", readRecord);
    } catch (const Error& error) {
      throw Error(ErrorCode::bad_input, {file_.string(), number, 0},
                  "its checksum is right, but it is not a record of a variant: " + error.message());
    }
  }
  if (changed == 0) return;
  if (!has_record) throw Error(ErrorCode::usage, {file_.string()}, std::string("is ") + kForeignFile);
  throw Error(ErrorCode::bad_input, {file_.string(), changed, 0},
              "was changed since it was written; put it back as it was, or remove the line to compute its "
              "variant again");
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
