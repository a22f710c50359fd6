#include "scenario/terrain/file_notes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "emscape/base/geodesy/geoid.h"
#include "scenario/terrain/place.h"

namespace emscape::scenario {

void FileNotes::add(const std::string& file, const std::string& note, const std::string& effect) {
  const auto known =
      std::find_if(notes_.begin(), notes_.end(), [&](const Note& other) { return other.text == note; });
  if (known == notes_.end()) {
    notes_.push_back({note, effect, file, file, 1});
    return;
  }
  if (known->last_file != file) ++known->files;
  known->last_file = file;
}

std::vector<std::string> FileNotes::texts() const {
  std::vector<std::string> all;
  for (const Note& note : notes_) {
    const std::string others = note.files > 1 ? fmt::format(" and {} more", note.files - 1) : "";
    all.push_back(fmt::format("elevation file {}{}: {}{}", note.first_file, others, note.text, note.effect));
  }
  return all;
}

std::string fillText(const FillValues::Found& fill) {
  return fmt::format(
      "{} post{} of {:g} m {} more than {:g} m below all posts around: a fill value that the file "
      "does not declare; void",
      fill.posts, fill.posts == 1 ? "" : "s", fill.height_m, fill.posts == 1 ? "is" : "are",
      FillValues::kStep_m);
}

Assumption assumptionOf(const TerrainFile& file) {
  const HeightMeaning& meaning = file.head().meaning;
  const bool is_datum_assumed =
      meaning.origin == DatumOrigin::assumed && meaning.datum_text == "EGM96 (assumed)";
  if (!is_datum_assumed) {
    if (!meaning.is_unit_assumed) return {};
    return {"states no unit: its heights are taken as metres",
            "; `height_unit: m` (or ft, us_ft, dm, cm) states it"};
  }
  const GeoBox box = geographicBoxOf(file);
  const double latitude_deg = std::clamp(0.5 * (box.south_deg + box.north_deg), -90.0, 90.0);
  const double undulation_m = geoidUndulation_m(latitude_deg, 0.5 * (box.west_deg + box.east_deg));
  return {meaning.is_unit_assumed
              ? "states no vertical datum and no unit: its heights are taken as metres above EGM96"
              : "states no vertical datum: its heights are taken as above EGM96",
          fmt::format("; if they are above the ellipsoid, the ground is {:.1f} m too {} there. "
                      "`vertical_datum: egm96` (or ellipsoid, egm2008, navd88) states it{}",
                      std::abs(undulation_m), undulation_m > 0 ? "high" : "low",
                      meaning.is_unit_assumed ? ", `height_unit: m` (or ft, us_ft, dm, cm) the unit" : "")};
}

}  // namespace emscape::scenario
