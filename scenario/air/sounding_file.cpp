// From soundings to a profile of refractivity.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string_view>

#include "base/files/file_reading.h"
#include "base/text/unended_line.h"
#include "document/csv.h"
#include "document/text_lines.h"
#include "emscape/base/error.h"
#include "propagation/air/moist_air.h"
#include "scenario/air/refractivity_file.h"
#include "scenario/air/sounding.h"
#include "scenario/terrain/file_names.h"
#include "scenario/terrain/gdal_messages.h"

namespace emscape::scenario {
namespace {

using namespace propagation;
using document::numberIn;

constexpr double kHighest_m = 10000;
constexpr double kMinStep_m = 1;  ///< between levels
constexpr double kGravity_m_s2 = 9.80665, kDryGas_j_kg_k = 287.05;
constexpr double kGeopotentialRadius_m = 6356766;

using Open = std::unique_ptr<SoundingArchive> (*)(const std::string&);

/// The text in a packed file; none if the file is not packed, or holds something else.
std::optional<ElevationSource> packedText(const std::string& file) {
  const auto isText = [](const std::string& name) {
    return lowerEnding(name) == ".txt" || lowerEnding(name) == ".csv";
  };
  const std::string stem = std::filesystem::path(file).stem().string();
  if (lowerEnding(file) == ".gz" && isText(stem)) return ElevationSource{file, stem};
  if (lowerEnding(file) != ".zip") return std::nullopt;
  const GdalMessages quiet;
  const std::vector<std::string> members = membersOfZip(file);
  return members.size() == 1 && isText(members[0]) ? std::optional(ElevationSource{file, members[0]})
                                                   : std::nullopt;
}

/// The reader of a file by its beginning; null: it has no soundings.
Open readerOf(const std::string& file) {
  std::string begin(4096, '\0');
  if (packedText(file)) {
    begin = soundingText(file).substr(0, begin.size());
  } else {
    std::ifstream stream(file, std::ios::binary);
    stream.read(begin.data(), std::streamsize(begin.size()));
    begin.resize(std::size_t(stream.gcount()));
  }
  if (begin.size() >= 36 && begin.front() == '#' && begin[12] == ' ' && begin[17] == ' ' &&
      numberIn(std::string_view(begin).substr(13, 4))) {
    return openIgra;
  }
  if (begin.find("%TITLE%") != std::string::npos && begin.find("%RAW%") != std::string::npos) return openSpc;
  if (begin.find("pressure_hPa,") != std::string::npos) return openWyomingCsv;
  if (begin.find(" Observations at ") != std::string::npos && begin.find("PRES") != std::string::npos)
    return openWyomingList;
  return nullptr;
}

/// Levels without humidity are left out below the highest one that has it, and are dry above.
void completeHumidity(std::vector<SoundingLevel>& levels) {
  std::size_t known = levels.size();
  while (known > 0 && std::isnan(levels[known - 1].vapour_hpa)) --known;
  std::vector<SoundingLevel> kept;
  for (std::size_t i = 0; i < levels.size(); ++i) {
    if (i >= known && known > 0) levels[i].vapour_hpa = 0;
    if (!std::isnan(levels[i].vapour_hpa)) kept.push_back(levels[i]);
  }
  levels = std::move(kept);
}

/// Missing heights by the hydrostatic equation. @return false if no level has a height
bool completeHeights(std::vector<SoundingLevel>& levels) {
  const auto thickness_m = [](const SoundingLevel& lower, const SoundingLevel& upper) {
    const auto virtual_k = [](const SoundingLevel& level) {
      return level.temperature_k / (1 - 0.37802 * level.vapour_hpa / level.pressure_hpa);
    };
    return kDryGas_j_kg_k / kGravity_m_s2 * (virtual_k(lower) + virtual_k(upper)) / 2 *
           std::log(lower.pressure_hpa / upper.pressure_hpa);
  };
  std::size_t known = 0;
  while (known < levels.size() && std::isnan(levels[known].height_msl_m)) ++known;
  if (known == levels.size()) return false;
  for (std::size_t i = known; i > 0; --i) {
    levels[i - 1].height_msl_m = levels[i].height_msl_m - thickness_m(levels[i - 1], levels[i]);
  }
  for (std::size_t i = known + 1; i < levels.size(); ++i) {
    if (std::isnan(levels[i].height_msl_m)) {
      levels[i].height_msl_m = levels[i - 1].height_msl_m + thickness_m(levels[i - 1], levels[i]);
    }
  }
  return true;
}

/// What a file that was cut in its last sounding shows of it; empty: nothing.
std::string cutOf(const std::string& text) {
  const std::size_t raw = text.rfind("%RAW%");
  if (raw != std::string::npos && text.find("%END%", raw) == std::string::npos)
    return "its last sounding has no %END%: the file was cut there, and levels may be missing or wrong";
  const std::vector<std::string_view> lines = soundingLines(text);
  const std::string_view last = lines.empty() ? "" : document::withoutBlanks(lines.back());
  if (last.empty() || last.find_first_of("0123456789-") != 0) return "";
  return unendedLineTextOf(text, "a level");
}

class Sounding {
 public:
  Sounding(const SoundingArchive& archive, SoundingRecord record, const std::string& file)
      : record_(std::move(record)), levels_(archive.levelsOf(record_)), file_(file) {
    const bool is_downwards = !levels_.empty() && levels_.front().pressure_hpa < levels_.back().pressure_hpa;
    if (is_downwards) std::reverse(levels_.begin(), levels_.end());
    const std::string contradiction = contradictionOfLevels();
    completeHumidity(levels_);
    if (levels_.empty()) {
      obstacle_ = "the sounding has no level with pressure, temperature and humidity";
    } else if (!completeHeights(levels_)) {
      obstacle_ = "the sounding has no level with pressure, temperature, humidity and height";
    } else if (!contradiction.empty()) {
      obstacle_ = contradiction;
    } else {
      makeProfile();
    }
  }

  /// Why it cannot be used; empty: it can.
  const std::string& obstacle() const { return obstacle_; }
  SourceLocation location() const { return {file_, record_.line, 1}; }
  const SoundingRecord& record() const { return record_; }
  std::size_t usedLevels() const { return levels_.size(); }
  const std::vector<RefractivityLevel>& refractivity() const { return refractivity_; }

 private:
  /// What columns that contradict each other have in common: exchanged ones, heights in feet; empty: none.
  std::string contradictionOfLevels() const {
    constexpr double kDewPointRange_k = 0.5;
    std::size_t wet = 0, known = 0;
    std::vector<SoundingLevel> stated;
    for (const SoundingLevel& level : levels_) {
      if (!std::isnan(level.height_msl_m)) stated.push_back(level);
      if (std::isnan(level.vapour_hpa)) continue;
      ++known;
      if (level.vapour_hpa > saturationPressure_hpa(level.temperature_k + kDewPointRange_k)) ++wet;
    }
    if (2 * wet > known)
      return fmt::format(
          "the dew point is above the temperature on {} of {} levels of the sounding; are their columns "
          "exchanged?",
          wet, known);
    return contradictionOfThickness(stated);
  }

  void makeProfile() {
    for (const SoundingLevel& level : levels_) {
      if (level.height_msl_m > kHighest_m) break;
      if (!refractivity_.empty() && level.height_msl_m < refractivity_.back().height_msl_m + kMinStep_m)
        continue;
      refractivity_.push_back(
          {level.height_msl_m, refractivity_n(level.pressure_hpa, level.temperature_k, level.vapour_hpa) +
                                   kFlatteningGradient_m * level.height_msl_m});
      if (const std::string fault = faultOfLevel(refractivity_, refractivity_.size() - 1); !fault.empty())
        throw Error(ErrorCode::bad_input, {file_, level.line, 1}, fault);
    }
    if (refractivity_.size() < 2) {
      obstacle_ = fmt::format(
          "the sounding has {} levels with pressure, temperature and humidity; expected 2 or more",
          refractivity_.size());
    }
  }

  SoundingRecord record_;
  std::vector<SoundingLevel> levels_;
  std::vector<RefractivityLevel> refractivity_;
  std::string file_, obstacle_;
};

}  // namespace

std::string soundingText(const std::string& file) {
  const std::optional<ElevationSource> packed = packedText(file);
  if (!packed) return readWholeText(file, kMaxSoundingBytes);
  try {
    return unpackedContent(*packed, kMaxSoundingBytes);
  } catch (const Error& error) {
    throw Error(error.code(), {file, 0, 0}, error.message());
  }
}

std::vector<std::string_view> soundingLines(std::string_view text) {
  std::vector<std::string_view> lines;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    std::string_view line = text.substr(begin, end - begin);
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    lines.push_back(line);
    begin = end + 1;
  }
  return lines;
}

void requireAtmosphere(const SoundingLevel& level, const std::string& file) {
  if (level.temperature_k >= 150 && level.temperature_k <= 350 && level.pressure_hpa > 0 &&
      level.pressure_hpa <= 1100) {
    return;
  }
  throw Error(
      ErrorCode::bad_input, {file, level.line, 1},
      fmt::format("{} hPa and {} K are not of the atmosphere", level.pressure_hpa, level.temperature_k));
}

std::string contradictionOfThickness(const std::vector<SoundingLevel>& stated) {
  constexpr double kMaxThicknessError = 0.2, kMinThickness_m = 500;
  if (stated.size() < 2) return "";
  std::vector<SoundingLevel> by_pressure = stated;
  for (SoundingLevel& level : by_pressure) {
    if (std::isnan(level.vapour_hpa)) level.vapour_hpa = 0;
    if (&level != &by_pressure.front()) level.height_msl_m = std::nan("");
  }
  completeHeights(by_pressure);
  const double rise_m = stated.back().height_msl_m - stated.front().height_msl_m;
  const double thickness_m = by_pressure.back().height_msl_m - by_pressure.front().height_msl_m;
  if (!(thickness_m > kMinThickness_m) || std::abs(rise_m - thickness_m) <= kMaxThicknessError * thickness_m)
    return "";
  return fmt::format(
      "the heights rise by {:.0f} m from {} to {} hPa, which are {:.0f} m apart by pressure and "
      "temperature; are the heights in feet?",
      rise_m, stated.front().pressure_hpa, stated.back().pressure_hpa, thickness_m);
}

double geometricHeight_m(double geopotential_m) {
  return geopotential_m * kGeopotentialRadius_m / (kGeopotentialRadius_m - geopotential_m);
}

RefractivityFile readSounding(const std::string& file, std::optional<std::int64_t> time_ms) {
  const Open open = readerOf(file);
  if (const std::string packed = open == nullptr ? packedFileText(file) : ""; !packed.empty())
    throw Error(ErrorCode::bad_input, {file, 0, 0}, "soundings are read from one .txt or .csv: " + packed);
  const std::unique_ptr<SoundingArchive> archive = (open != nullptr ? open : openIgra)(file);
  std::vector<SoundingRecord> records = archive->records();
  if (records.empty())
    throw Error(ErrorCode::bad_input, {file, 1, 1},
                "no soundings of IGRA 2 (a header begins with #), the University of Wyoming (a heading has "
                "'Observations at') or the Storm Prediction Center (%TITLE% and %RAW%)");
  const int last_line = records.back().line;
  // The nearest comes first; without a time the last.
  std::reverse(records.begin(), records.end());
  const auto distance = [&](const SoundingRecord& record) {
    return time_ms ? std::llabs(record.time_ms - *time_ms) : 0;
  };
  std::stable_sort(records.begin(), records.end(), [&](const SoundingRecord& a, const SoundingRecord& b) {
    return distance(a) < distance(b);
  });
  std::optional<Sounding> first;
  for (std::size_t i = 0; i < records.size(); ++i) {
    const Sounding sounding(*archive, records[i], file);
    if (!sounding.obstacle().empty()) {
      if (!first) first.emplace(sounding);
      continue;
    }
    const SoundingRecord& record = sounding.record();
    RefractivityFile result;
    ThinnedLevels few = thinnedToLimit(sounding.refractivity());
    result.description = fmt::format("sounding of {}, {} ({} of {} levels{}; {} sounding{} in the file)",
                                     record.station, record.time_utc, sounding.usedLevels(), record.levels,
                                     few.text(), records.size(), records.size() == 1 ? "" : "s");
    if (i > 0) {
      result.warnings.push_back(fmt::format(
          "{}:{}: the {} of {} cannot be used: {}; {} taken instead", file, first->location().line,
          time_ms ? "sounding nearest in time, that" : "last sounding, that", first->record().time_utc,
          first->obstacle(), i == 1 ? "the next one is" : fmt::format("{} were tried, the next one is", i)));
    }
    if (const std::string cut = record.line == last_line ? cutOf(soundingText(file)) : ""; !cut.empty())
      result.warnings.push_back(fmt::format("{}: {}", file, cut));
    result.sounding = SoundingOrigin{record.station, record.time_utc, record.time_ms, record.position};
    result.field.profiles = {profileOfLevels(std::move(few.levels))};
    return result;
  }
  throw Error(ErrorCode::bad_input, first->location(),
              records.size() == 1 ? first->obstacle()
                                  : fmt::format("{}; none of the {} others in the file can be used either",
                                                first->obstacle(), records.size() - 1));
}

bool isSoundingFile(const std::string& file) {
  return readerOf(file) != nullptr;
}

}  // namespace emscape::scenario
