#include "playback/series/series_journal.h"

#include <fmt/core.h>

#include <algorithm>
#include <limits>

#include "base/files/file_reading.h"
#include "base/files/json_reading.h"
#include "base/files/json_writing.h"
#include "base/text/failure_text.h"
#include "emscape/base/error.h"
#include "playback/series/series_state.h"

namespace emscape::playback {
namespace {

Json rangesToJson(const std::vector<ValueRange>& ranges) {
  Json json = Json::array();
  for (const ValueRange& range : ranges) json.push_back(toJson(range));
  return json;
}

std::vector<ValueRange> rangesFromJson(const Json& json, std::size_t channels) {
  if (!json.is_array() || json.size() != channels)
    throw std::invalid_argument("one range per quantity is needed");
  std::vector<ValueRange> ranges;
  for (const Json& range : json) ranges.push_back(rangeFromJson(range));
  return ranges;
}

/// The checksum of a record, without the member "crc32" that contains it.
std::uint32_t checksumOf(Json record) {
  record.erase("crc32");
  FileDigest digest;
  addToDigest(dumpJson(record), digest);
  return digest.crc32;
}

std::string lineOf(const StepRecord& record) {
  Json files = Json::array();
  for (const StepRecord::File& file : record.files) {
    files.push_back({{"name", file.name}, {"bytes", file.digest.bytes}, {"crc32", file.digest.crc32}});
  }
  Json json{{"step", record.step + 1},
            {"range", rangesToJson(record.own)},
            {"stored_range", rangesToJson(record.stored)},
            {"files", files}};
  json["crc32"] = checksumOf(json);
  return dumpJson(json) + "\n";
}

/// A count that fits into the type.
template <class Count>
Count countFrom(const Json& file, const char* key) {
  const Json& value = file.at(key);
  if (!value.is_number_unsigned() || value.get<std::uint64_t>() > std::numeric_limits<Count>::max()) {
    throw std::invalid_argument(
        fmt::format("{} is not a whole number in 0..{}", key, std::numeric_limits<Count>::max()));
  }
  return value.get<Count>();
}

StepRecord::File fileFrom(const Json& file) {
  return {file.at("name").get<std::string>(),
          {countFrom<std::uint64_t>(file, "bytes"), countFrom<std::uint32_t>(file, "crc32")}};
}

StepRecord recordFrom(const Json& json, int steps, std::size_t channels) {
  if (json.contains("crc32") && json["crc32"] != checksumOf(json))  // lines of earlier versions have none
    throw std::invalid_argument("it was changed since it was written");
  StepRecord record;
  const auto number = json.at("step").get<double>();
  if (!(number >= 1 && number <= steps)) {
    throw std::invalid_argument(fmt::format("step {} is outside 1..{}", number, steps));
  }
  record.step = static_cast<int>(number) - 1;
  record.own = rangesFromJson(json.at("range"), channels);
  record.stored = rangesFromJson(json.at("stored_range"), channels);
  for (const Json& file : json.at("files")) record.files.push_back(fileFrom(file));
  return record;
}

/// Bytes up to the end of the last complete line.
std::size_t wholeLines(const std::vector<std::uint8_t>& bytes) {
  const auto last = std::find(bytes.rbegin(), bytes.rend(), '\n');
  return static_cast<std::size_t>(bytes.rend() - last);
}

}  // namespace

SeriesJournal::SeriesJournal(const std::filesystem::path& folder) : file_(folder / "series.steps") {}

std::vector<std::optional<StepRecord>> SeriesJournal::read(int steps, std::size_t channels) const {
  std::vector<std::optional<StepRecord>> records(static_cast<std::size_t>(steps));
  if (!std::filesystem::exists(file_)) return records;
  const std::vector<std::uint8_t> bytes = readWhole(file_);
  const auto end = bytes.begin() + static_cast<std::ptrdiff_t>(wholeLines(bytes));
  int line = 1;
  const auto fail = [&](const std::string& fault) {
    throw Error(
        ErrorCode::bad_input, {file_.string(), line},
        "not a step of the series (" + fault + "); move the file away: then all steps are computed again");
  };
  for (auto at = bytes.begin(); at != end; ++line) {
    const auto line_end = std::find(at, end, '\n');
    try {
      StepRecord record = recordFrom(Json::parse(at, line_end), steps, channels);
      const auto step = static_cast<std::size_t>(record.step);
      records[step] = std::move(record);
    } catch (const nlohmann::json::parse_error&) {
      fail("no JSON");
    } catch (const nlohmann::json::exception& error) {
      fail(faultOf(error));
    } catch (const std::exception& error) {
      fail(failureText(error));
    }
    at = line_end + 1;
  }
  return records;
}

std::map<std::string, FileDigest> SeriesJournal::files() const {
  std::map<std::string, FileDigest> listed;
  if (!std::filesystem::is_regular_file(file_)) return listed;
  const auto bytes = readWhole(file_);
  for (auto begin = bytes.begin(); begin != bytes.end();) {
    const auto end = std::find(begin, bytes.end(), '\n');
    const Json line = Json::parse(begin, end, nullptr, /*allow_exceptions=*/false);
    const Json files = line.is_object() ? line.value("files", Json()) : Json();
    for (const Json& file : files.is_array() ? files : Json::array()) {
      try {
        const StepRecord::File found = fileFrom(file);
        listed[found.name] = found.digest;
      } catch (const std::exception&) {
        continue;  // of another form
      }
    }
    begin = end == bytes.end() ? end : end + 1;
  }
  return listed;
}

void SeriesJournal::requireOwn() const {
  if (std::filesystem::is_symlink(file_))
    throw Error(ErrorCode::usage, {file_.string()}, "is a link, which is not followed; remove it");
  if (!std::filesystem::exists(file_)) return;
  const auto bytes = readWhole(file_);
  const auto end = bytes.begin() + static_cast<std::ptrdiff_t>(wholeLines(bytes));
  int line = 1;
  for (auto at = bytes.begin(); at != end; ++line) {
    const auto line_end = std::find(at, end, '\n');
    const Json json = Json::parse(at, line_end, nullptr, /*allow_exceptions=*/false);
    // Lines of earlier versions have no checksum.
    if (!json.is_object() || !json.contains("files") ||
        (json.contains("crc32") && json["crc32"] != checksumOf(json))) {
      throw Error(ErrorCode::usage, {file_.string(), line},
                  "is no line that emscape wrote, or was changed since; move the file away, or use another "
                  "folder");
    }
    at = line_end + 1;
  }
}

void SeriesJournal::append(const StepRecord& record) {
  if (!open_) {
    open_.emplace(file_);
    open_->cut(wholeLines(readWhole(file_)));
  }
  open_->append(lineOf(record));
  open_->sync();
}

}  // namespace emscape::playback
