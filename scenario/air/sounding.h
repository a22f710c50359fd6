/// Soundings as archives give them, before their levels become a profile.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "emscape/base/error.h"
#include "emscape/base/geodesy/geo_frame.h"

namespace emscape::scenario {

/// Largest size of a file of soundings.
constexpr std::size_t kMaxSoundingBytes = std::size_t{64} << 20;

/// A level with pressure and temperature.
struct SoundingLevel {
  int line = 0;
  double pressure_hpa = 0, temperature_k = 0;
  double vapour_hpa = std::numeric_limits<double>::quiet_NaN();    ///< NaN: not known
  double height_msl_m = std::numeric_limits<double>::quiet_NaN();  ///< geometric; NaN: not known
};

struct SoundingRecord {
  int line = 0;  ///< of its header
  std::string station, time_utc;
  std::int64_t time_ms = 0;
  std::optional<GeodeticPosition> position;
  std::size_t first = 0, levels = 0;  ///< rows, for levelsOf()
};

/// A file of soundings, read whole.
class SoundingArchive {
 public:
  virtual ~SoundingArchive() = default;
  /// All soundings, in the order of the file. @throws Error (bad_input) with line and column
  virtual std::vector<SoundingRecord> records() const = 0;
  /// Its levels with pressure and temperature, in the order of the file.
  /// @throws Error (bad_input) with line and column
  virtual std::vector<SoundingLevel> levelsOf(const SoundingRecord& record) const = 0;
};

/// Integrated Global Radiosonde Archive, version 2: fixed columns, according to NOAA's "IGRA v2 Format
/// Description: Sounding Data".
std::unique_ptr<SoundingArchive> openIgra(const std::string& file);
/// University of Wyoming, lists ("TEXT:LIST", with the titles PRES, HGHT, TEMP, DWPT, RELH), as text or as
/// the page that has them.
std::unique_ptr<SoundingArchive> openWyomingList(const std::string& file);
/// University of Wyoming, "CSV": one sounding, with a position and a time in each row.
std::unique_ptr<SoundingArchive> openWyomingCsv(const std::string& file);
/// Storm Prediction Center, the text with %TITLE% and %RAW% that SHARPpy reads and writes.
std::unique_ptr<SoundingArchive> openSpc(const std::string& file);

/// The text of a file, or of the only .txt or .csv in a .zip or .gz, as the archives give them.
/// @throws Error (bad_input)
std::string soundingText(const std::string& file);

/// The lines of a text, without CR at their ends.
std::vector<std::string_view> soundingLines(std::string_view text);
/// @throws Error (bad_input) at a row with a pressure or a temperature that is not of the atmosphere
void requireAtmosphere(const SoundingLevel& level, const std::string& file);
/// The contradiction between heights and pressures, as of heights in feet; empty: none.
/// @param levels  upwards
std::string contradictionOfThickness(const std::vector<SoundingLevel>& levels);
/// Geometric height of a geopotential height (m); NaN stays.
double geometricHeight_m(double geopotential_m);

}  // namespace emscape::scenario
