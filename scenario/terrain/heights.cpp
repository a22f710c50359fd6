#include "scenario/terrain/heights.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>

#include "base/text/shell_word.h"
#include "emscape/base/error.h"

namespace emscape::scenario {
namespace {

constexpr double kFoot_m = 0.3048;
constexpr double kUsSurveyFoot_m = 1200.0 / 3937.0;

[[noreturn]] void refuse(const std::string& problem) {
  throw Error(ErrorCode::bad_input, problem);
}

/// Metres of a unit; 0 if it is unknown.
double metresNamed(const std::string& unit) {
  struct Unit {
    const char* name;
    double metres;
  };
  static constexpr Unit kUnits[] = {{"m", 1.0},
                                    {"metre", 1.0},
                                    {"metres", 1.0},
                                    {"meter", 1.0},
                                    {"meters", 1.0},
                                    {"cm", 0.01},
                                    {"centimetre", 0.01},
                                    {"dm", 0.1},
                                    {"decimetre", 0.1},
                                    {"km", 1000.0},
                                    {"kilometre", 1000.0},
                                    {"ft", kFoot_m},
                                    {"foot", kFoot_m},
                                    {"feet", kFoot_m},
                                    {"international foot", kFoot_m},
                                    {"us-ft", kUsSurveyFoot_m},
                                    {"us_ft", kUsSurveyFoot_m},
                                    {"ft-us", kUsSurveyFoot_m},
                                    {"ftus", kUsSurveyFoot_m},
                                    {"us ft", kUsSurveyFoot_m},
                                    {"sft", kUsSurveyFoot_m},
                                    {"us survey foot", kUsSurveyFoot_m},
                                    {"us survey feet", kUsSurveyFoot_m},
                                    {"u.s. survey foot", kUsSurveyFoot_m},
                                    {"foot_us", kUsSurveyFoot_m}};
  for (const Unit& known : kUnits) {
    if (EQUAL(unit.c_str(), known.name)) return known.metres;
  }
  return 0.0;
}

std::string textOf(HeightUnit unit) {
  static constexpr const char* kTexts[] = {"metres", "feet", "US survey feet", "decimetres", "centimetres"};
  return kTexts[static_cast<int>(unit)];
}

/// Letters and digits of a name, in capitals.
std::string plain(const std::string& name) {
  std::string text;
  for (const unsigned char c : name) {
    if (std::isalnum(c) != 0) text += static_cast<char>(std::toupper(c));
  }
  return text;
}

bool has(const std::string& text, const char* part) {
  return text.find(part) != std::string::npos;
}

/// The datum of a vertical system; empty: another one, such as that of a country.
std::optional<VerticalDatum> datumNamed(const std::string& name) {
  const std::string text = plain(name);
  if (has(text, "EGM2008") || has(text, "EGM08")) return VerticalDatum::egm2008;
  if (has(text, "EGM96") || has(text, "EGM1996")) return VerticalDatum::egm96;
  if (has(text, "NAVD88") || has(text, "NAVD1988") || has(text, "NORTHAMERICANVERTICALDATUM1988"))
    return VerticalDatum::navd88;
  if (has(text, "ELLIPSOID") || text == "WGS84" || text == "WGS1984" || text == "DWGS1984" ||
      text == "NAD83" || text == "GRS80")
    return VerticalDatum::ellipsoid;
  return std::nullopt;
}

/// What a file states of the vertical part of its coordinate system.
struct Stated {
  bool any = false;
  std::optional<VerticalDatum> datum;
  std::string name;
  std::string unit;
  double unit_m = 0;
};

Stated statedIn(OGRSpatialReferenceH system) {
  Stated stated;
  if (system == nullptr) return stated;
  const char* const vertical = OSRGetAttrValue(system, "VERT_CS", 0);
  if (vertical == nullptr) {
    stated.any = OSRGetAxesCount(system) == 3 && OSRIsGeocentric(system) == 0;
    if (!stated.any) return stated;
    stated.datum = VerticalDatum::ellipsoid;
    stated.name = std::string("ellipsoidal height of ") + OSRGetName(system);
    return stated;
  }
  stated.any = true;
  stated.name = vertical;
  const char* const of_datum = OSRGetAttrValue(system, "VERT_DATUM", 0);
  stated.datum = datumNamed(stated.name);
  if (!stated.datum && of_datum != nullptr) stated.datum = datumNamed(of_datum);
  char* unit = nullptr;
  stated.unit_m = OSRGetTargetLinearUnits(system, "VERT_CS", &unit);
  if (unit != nullptr) stated.unit = unit;
  OGRAxisOrientation direction = OAO_Other;
  if (OSRGetAxis(system, "VERT_CS", 0, &direction) != nullptr && direction == OAO_Down)
    refuse("states depths, downwards ('" + stated.name +
           "'); gdal_translate -a_scale -1 -a_srs EPSG:4326+5714 makes a copy of heights, for latitudes and "
           "longitudes");
  return stated;
}

/// Products whose files state no vertical datum: what a name begins with, and their documented datum.
struct Product {
  const char* prefix;
  const char* part;  ///< of the name
  VerticalDatum datum;
  const char* name;
};
constexpr Product kProducts[] = {
    {"COPERNICUSDSM", "", VerticalDatum::egm2008, "Copernicus DEM"},
    {"", "FABDEM", VerticalDatum::egm2008, "FABDEM"},
    {"", "TDM1DEM", VerticalDatum::ellipsoid, "TanDEM-X DEM"},
    {"ASTGTM", "", VerticalDatum::egm96, "ASTER GDEM"},
    {"ALPSMLC30", "", VerticalDatum::egm96, "ALOS World 3D"},
    {"NASADEM", "HGT", VerticalDatum::egm96, "NASADEM"},
    {"SRTM", "", VerticalDatum::egm96, "SRTM"},
    {"", "ARCTICDEM", VerticalDatum::ellipsoid, "ArcticDEM"},
    {"SETSM", "", VerticalDatum::ellipsoid, "ArcticDEM or REMA"},
    {"USGS1", "", VerticalDatum::navd88, "USGS 3D Elevation Program"},
    {"USGS13", "", VerticalDatum::navd88, "USGS 3D Elevation Program"},
};

const Product* productOf(const std::string& file) {
  const std::string name = plain(std::filesystem::path(file).stem().string());
  for (const Product& product : kProducts) {
    if (name.rfind(product.prefix, 0) == 0 && has(name, product.part)) return &product;
  }
  return nullptr;
}

void setDatum(const HeightFacts& facts, const Stated& stated, HeightMeaning& meaning) {
  const std::optional<VerticalDatum>& key = facts.keys.vertical_datum;
  const Product* const product = productOf(facts.own_name);
  const bool is_tile = facts.driver == "SRTMHGT" || facts.driver == "DTED";
  if (stated.datum) {
    meaning.datum = *stated.datum;
    meaning.origin = DatumOrigin::file;
    meaning.datum_text = fmt::format("{} (stated by the file: {})", textOf(meaning.datum), stated.name);
    if (key && *key != meaning.datum)
      refuse(fmt::format(
          "'vertical_datum: {}' of the scenario contradicts the file, which states {} ('{}'). Leave out the "
          "key "
          "to use what the file states; if the file is wrong, gdal_translate -a_srs makes a copy that "
          "states another system (EPSG:4326+5773: latitudes, longitudes and EGM96; EPSG:4979: "
          "heights above the ellipsoid)",
          toString(*key), textOf(meaning.datum), stated.name));
  } else if (key) {
    meaning.datum = *key;
    meaning.origin = DatumOrigin::key;
    meaning.datum_text = textOf(meaning.datum) + " (of the scenario)";
    if (stated.any)
      meaning.notes.push_back("states that its heights are of '" + stated.name + "'; the scenario says " +
                              toString(*key));
    if (is_tile && *key != VerticalDatum::egm96)
      meaning.warnings.push_back(
          fmt::format("its format is defined with heights above EGM96, the scenario says "
                      "'vertical_datum: {}', which is used",
                      toString(*key)));
  } else if (is_tile) {
    meaning.origin = DatumOrigin::format;
    meaning.datum_text = textOf(meaning.datum) + " (of its format)";
  } else if (stated.any) {
    meaning.datum_text = fmt::format("EGM96 (assumed: the file states {})", stated.name);
    meaning.warnings.push_back(fmt::format(
        "states heights of '{}', which are taken as above EGM96; datums of mean sea level differ by up to 2 "
        "m. "
        "gdalwarp -t_srs EPSG:4979 brings them to the ellipsoid where PROJ has the grid of that datum",
        stated.name));
  } else if (product != nullptr) {
    meaning.datum = product->datum;
    meaning.origin = DatumOrigin::product;
    meaning.datum_text = fmt::format("{} (by its name: {})", textOf(meaning.datum), product->name);
    meaning.notes.push_back(
        fmt::format("by its name is of {}: heights above {}", product->name, textOf(meaning.datum)));
  } else {
    meaning.datum_text = "EGM96 (assumed)";
  }
  if (meaning.datum == VerticalDatum::navd88)
    meaning.warnings.push_back(
        "its heights above NAVD88 are taken as above EGM96, from which they differ by less than 2 m. "
        "gdalwarp "
        "-t_srs EPSG:4979 brings them to the ellipsoid where PROJ has the grid of NAVD88");
}

/// True for m2 s-2 in its spellings: m**2 s**-2, m^2/s^2, ...
bool isGeopotential(std::string unit) {
  for (const char c : {'*', '^', ' ', '.'}) unit.erase(std::remove(unit.begin(), unit.end(), c), unit.end());
  return unit == "m2s-2" || unit == "m2/s2" || unit == "J/kg" || unit == "Jkg-1";
}

void setUnit(const HeightFacts& facts, const Stated& stated, HeightMeaning& meaning) {
  const std::optional<HeightUnit>& key = facts.keys.height_unit;
  // Some formats write so instead of leaving it out.
  const bool is_nothing =
      EQUAL(facts.band_unit.c_str(), "unspecified") || EQUAL(facts.band_unit.c_str(), "unknown");
  const bool of_band = !facts.band_unit.empty() && !is_nothing;
  if (of_band || stated.unit_m > 0) {
    meaning.unit = of_band ? facts.band_unit : stated.unit;
    meaning.unit_m = of_band ? metresNamed(facts.band_unit) : stated.unit_m;
    if (meaning.unit_m == 0.0 && !key && isGeopotential(meaning.unit))
      refuse(
          fmt::format("is a geopotential ('{}'), not heights: gdal_translate -ot Float32 -a_scale 0.10197162 "
                      "-a_offset 0 {} "
                      "HEIGHTS.tif makes heights of it; then `height_unit: m` of that file states their unit",
                      meaning.unit, shellWord(facts.own_name)));
    if (meaning.unit_m == 0.0 && !key)
      refuse(
          "heights are in '" + meaning.unit +
          "', a unit that is not known; known are m, km, cm, ft and US survey ft. `height_unit: m` (or ft, "
          "us_ft, dm, cm) of the file in the scenario states it");
    const bool differs = key && meaning.unit_m != 0.0 && std::abs(meaning.unit_m / metresOf(*key) - 1) > 1e-7;
    if (differs)
      refuse(fmt::format(
          "'height_unit: {}' of the scenario contradicts the file, which states '{}'. Leave out the "
          "key to use what the file states; if the file is wrong, gdal_translate -of VRT makes a "
          "text file whose UnitType can be corrected",
          toString(*key), meaning.unit));
    if (of_band && stated.unit_m > 0 && metresNamed(facts.band_unit) > 0 && !key &&
        std::abs(stated.unit_m / metresNamed(facts.band_unit) - 1) > 1e-7)
      meaning.warnings.push_back(fmt::format(
          "states '{}' as the unit of its heights, and '{}' as that of its vertical system '{}': the "
          "first is used. If it is wrong, `height_unit` cannot change it: gdal_translate -of VRT makes a "
          "text file "
          "whose UnitType can be corrected",
          facts.band_unit, stated.unit, stated.name));
  }
  if (key) {
    meaning.unit_m = metresOf(*key);
    meaning.unit = textOf(*key);
  } else if (meaning.unit.empty()) {
    meaning.unit = "metres, assumed";
    meaning.is_unit_assumed =
        stated.datum != VerticalDatum::ellipsoid && productOf(facts.own_name) == nullptr;
    char* unit = nullptr;
    const double of_plane_m =
        facts.system != nullptr && OSRIsProjected(facts.system) ? OSRGetLinearUnits(facts.system, &unit) : 1;
    if (facts.scale == 1 && std::abs(of_plane_m - kFoot_m) < 1e-5) {
      meaning.is_unit_assumed = false;
      meaning.warnings.push_back(fmt::format(
          "its coordinates are in '{}', and it has no unit of heights: they are taken as metres. If they are "
          "feet, ground is 3.3 times too high: `height_unit: {}` of the file in the scenario states it, as m "
          "does",
          unit, of_plane_m == kFoot_m ? "ft" : "us_ft"));
    }
  }
  if (meaning.unit_m != 1.0)
    meaning.notes.push_back("heights in '" + meaning.unit + "' are converted to metres");
}

}  // namespace

double metresOf(HeightUnit unit) {
  return metresNamed(std::string(toString(unit)));
}

std::string textOf(VerticalDatum datum) {
  switch (datum) {
    case VerticalDatum::egm96:
      return "EGM96";
    case VerticalDatum::ellipsoid:
      return "the ellipsoid";
    case VerticalDatum::egm2008:
      return "EGM2008";
    case VerticalDatum::navd88:
      return "NAVD88";
  }
  return "";
}

HeightMeaning heightMeaningOf(const HeightFacts& facts) {
  HeightMeaning meaning;
  Stated stated = statedIn(facts.system);
  if (facts.is_ellipsoidal && !stated.any) {
    stated.any = true;
    stated.datum = VerticalDatum::ellipsoid;
    stated.name = "height above the reference ellipsoid";
  }
  setUnit(facts, stated, meaning);
  setDatum(facts, stated, meaning);
  return meaning;
}

}  // namespace emscape::scenario
