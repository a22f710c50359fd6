#include "study/files/netcdf.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "base/files/unfinished_file.h"
#include "emscape/base/error.h"
#include "study/files/map_metadata.h"
#include "study/maps/gdal_arrays.h"
#include "study/maps/gdal_support.h"
#include "study/picture/map_objects.h"

namespace emscape::study {
namespace {

constexpr std::int16_t kNoNumber = -32768;

/// A unit in the notation of UDUNITS, which has no symbols for logarithmic units.
std::string udunitOf(const std::string& unit) {
  static const std::map<std::string, std::string> kUnits{{"", "1"},
                                                         {"dB", "0.1 lg(re 1)"},
                                                         {"dBW/m2", "0.1 lg(re 1 W m-2)"},
                                                         {"dBm", "0.1 lg(re 1 mW)"},
                                                         {"dBuV/m", "0.05 lg(re 1e-6 V m-1)"}};
  const auto found = kUnits.find(unit);
  return found == kUnits.end() ? unit : found->second;
}

/// A word of flag_meanings.
std::string flagWord(const std::string& label) {
  std::string word;
  for (const char c : label) {
    const bool is_plain = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '.';
    word += is_plain ? c : '_';
  }
  return word.empty() ? "_" : word;
}

class NetCdf : public MapCollection {
 public:
  NetCdf(const std::filesystem::path& file, const MapStudy& study) : file_(file), study_(study) {
    const scenario::GdalMessages messages;
    try {
      create(messages);
    } catch (...) {
      close();  // in the scope, which holds back GDAL's messages
      throw;
    }
  }

  ~NetCdf() override {
    const scenario::GdalMessages messages;
    close();
  }

  void add(const Map& map) override {
    const scenario::GdalMessages messages;
    const MapGrid& grid = *study_.grid;
    const gdal::Array& variable = variableOf(messages, map);
    std::vector<GUInt64> start;
    std::vector<std::size_t> count;
    if (map.time_s) start.push_back(indexIn(study_.times_s, *map.time_s));
    if (map.height) start.push_back(indexIn(heightsOf(map.height->reference), map.height->metres));
    count.assign(start.size(), 1);
    start.insert(start.end(), {0, 0});
    count.insert(count.end(), {static_cast<std::size_t>(grid.height), static_cast<std::size_t>(grid.width)});
    bool is_written = false;
    if (isWhole(map.kind)) {
      std::vector<std::int16_t> numbers(map.values.size(), kNoNumber);
      for (std::size_t p = 0; p < numbers.size(); ++p) {
        if (!std::isnan(map.values[p])) numbers[p] = static_cast<std::int16_t>(map.values[p]);
      }
      is_written = writeArray(variable, start, count, numberType(GDT_Int16), numbers.data());
    } else {
      is_written = writeArray(variable, start, count, numberType(GDT_Float32), map.values.data());
    }
    check(messages, is_written);
  }

  void finish() override {
    {
      const scenario::GdalMessages messages;
      close();
      check(messages, true);
    }
    file_.publish(kAuxiliary);
  }

 private:
  void check(const scenario::GdalMessages& messages, bool is_done) const {
    if (!is_done || messages.hasFailure()) failWriting(messages, file_.file());
  }

  void create(const scenario::GdalMessages& messages) {
    const char* const options[] = {"FORMAT=NC4", "CONVENTIONS=CF-1.8", nullptr};
    dataset_ = createArrayFile(file_.temporary(), options);
    root_ = rootOf(dataset_);
    check(messages, root_ != nullptr);
    setText(root_, "title", study_.title);
    setText(root_, "source",
            fmt::format("emscape {}, computed from the scenario {}", EMSCAPE_VERSION,
                        study_.scenarios.front()->name));
    setText(root_, "history", "emscape " + study_.command);
    setText(root_, "comment", "Radars look at the target, wherever their scan points.");
    for (const auto& [name, value] : metadataOf(study_, {})) {
      if (name != "EMSCAPE_PRODUCT") setText(root_, name.c_str(), value);
    }
    addCoordinates(messages);
  }

  void close() {
    variables_.clear();
    dimensions_.clear();
    root_.reset();
    dataset_.reset();
  }

  std::size_t indexIn(const std::vector<double>& values, double value) const {
    const auto found = std::find(values.begin(), values.end(), value);
    if (found == values.end()) {
      throw Error(ErrorCode::other, fmt::format("{}: {} is neither a time nor a height of the study",
                                                file_.file().string(), value));
    }
    return static_cast<std::size_t>(found - values.begin());
  }

  std::vector<double> heightsOf(emfield::HeightReference reference) const {
    std::vector<double> heights_m;
    for (const MapHeight& height : study_.heights) {
      if (height.reference == reference) heights_m.push_back(height.metres);
    }
    std::sort(heights_m.begin(), heights_m.end());
    heights_m.erase(std::unique(heights_m.begin(), heights_m.end()), heights_m.end());
    return heights_m;
  }

  using Attributes = std::vector<std::pair<const char*, std::string>>;

  void addCoordinate(const scenario::GdalMessages& messages, const std::string& name, const char* type,
                     const std::vector<double>& values, const std::string& unit,
                     const Attributes& attributes) {
    if (values.empty()) return;
    gdal::Dimension& dimension = dimensions_[name];
    dimension = addDimension(root_, name, type, values.size());
    check(messages, dimension != nullptr);
    const gdal::ValueType real = numberType(GDT_Float64);
    const gdal::Array array = addArray(root_, name, {dimension.get()}, real);
    check(messages, array != nullptr);
    for (const auto& [key, value] : attributes) setText(array, key, value);
    GDALMDArraySetUnit(array.get(), unit.c_str());
    check(messages, writeArray(array, {0}, {values.size()}, real, values.data()));
  }

  void addCoordinates(const scenario::GdalMessages& messages) {
    const MapGrid& grid = *study_.grid;
    addCoordinate(
        messages, "time", GDAL_DIM_TYPE_TEMPORAL, study_.times_s, "seconds since " + utcOf(study_, 0),
        {{"standard_name", "time"}, {"long_name", "time"}, {"calendar", "standard"}, {"axis", "T"}});
    addCoordinate(messages, "height_agl", GDAL_DIM_TYPE_VERTICAL, heightsOf(emfield::HeightReference::ground),
                  "m",
                  {{"standard_name", "height"},
                   {"long_name", "height above ground"},
                   {"positive", "up"},
                   {"axis", "Z"}});
    addCoordinate(messages, "height_msl", GDAL_DIM_TYPE_VERTICAL,
                  heightsOf(emfield::HeightReference::mean_sea_level), "m",
                  {{"standard_name", "altitude"},
                   {"long_name", "height above mean sea level (EGM96)"},
                   {"positive", "up"},
                   {"axis", "Z"}});
    std::vector<double> x, y;
    for (int i = 0; i < grid.width; ++i) x.push_back(grid.left_m + (i + 0.5) * grid.cell_m);
    for (int j = 0; j < grid.height; ++j) y.push_back(grid.top_m - (j + 0.5) * grid.cell_m);
    addCoordinate(messages, "y", GDAL_DIM_TYPE_HORIZONTAL_Y, y, "m",
                  {{"standard_name", "projection_y_coordinate"}, {"long_name", "northing"}, {"axis", "Y"}});
    addCoordinate(messages, "x", GDAL_DIM_TYPE_HORIZONTAL_X, x, "m",
                  {{"standard_name", "projection_x_coordinate"}, {"long_name", "easting"}, {"axis", "X"}});
    // Single precision, for half the size; accurate to 2 m. x and y are exact.
    std::vector<float> latitudes, longitudes;
    for (const emfield::Surface::Position& position : grid.positions) {
      latitudes.push_back(static_cast<float>(position.latitude_deg));
      longitudes.push_back(std::isnan(position.latitude_deg) ? NAN
                                                             : static_cast<float>(position.longitude_deg));
    }
    addPositions(messages, "lat", "latitude", "degrees_north", latitudes);
    addPositions(messages, "lon", "longitude", "degrees_east", longitudes);
  }

  void addPositions(const scenario::GdalMessages& messages, const char* name, const char* standard_name,
                    const char* unit, const std::vector<float>& values) {
    const char* const options[] = {"COMPRESS=DEFLATE", nullptr};
    const gdal::ValueType real = numberType(GDT_Float32);
    const gdal::Array array =
        addArray(root_, name, {dimensions_.at("y").get(), dimensions_.at("x").get()}, real, options);
    check(messages, array != nullptr);
    GDALMDArraySetNoDataValueAsDouble(array.get(), NAN);
    setText(array, "standard_name", standard_name);
    setText(array, "long_name", standard_name + std::string(" of the pixel's centre"));
    GDALMDArraySetUnit(array.get(), unit);
    const std::vector<std::size_t> count{static_cast<std::size_t>(study_.grid->height),
                                         static_cast<std::size_t>(study_.grid->width)};
    check(messages, writeArray(array, {0, 0}, count, real, values.data()));
  }

  /// The variable of a map, made for the first map of its product and reference of height.
  const gdal::Array& variableOf(const scenario::GdalMessages& messages, const Map& map) {
    std::string name = map.name, z;
    if (map.height) {
      const bool is_above_ground = map.height->reference == emfield::HeightReference::ground;
      z = is_above_ground ? "height_agl" : "height_msl";
      name += is_above_ground ? "_agl" : "_msl";
    }
    gdal::Array& variable = variables_[name];
    if (variable != nullptr) return variable;
    ArrayDimensions dimensions;
    if (map.time_s) dimensions.push_back(dimensions_.at("time").get());
    if (map.height) dimensions.push_back(dimensions_.at(z).get());
    dimensions.push_back(dimensions_.at("y").get());
    dimensions.push_back(dimensions_.at("x").get());
    const bool is_whole = isWhole(map.kind);
    const char* const options[] = {"COMPRESS=DEFLATE", nullptr};
    variable = addArray(root_, name, dimensions, numberType(is_whole ? GDT_Int16 : GDT_Float32), options);
    check(messages, variable != nullptr);
    setText(variable, "long_name", map.subject + (map.unit.empty() ? "" : " (" + map.unit + ")"));
    setText(variable, "coordinates", "lat lon");
    if (map.floor) setText(variable, "floor", fmt::format("{}", *map.floor));
    if (const std::string text = noValueText(map); !text.empty()) setText(variable, "no_value", text);
    if (is_whole) {
      GDALMDArraySetRawNoDataValue(variable.get(), &kNoNumber);
      addFlags(variable, map);
    } else {
      GDALMDArraySetNoDataValueAsDouble(variable.get(), NAN);
    }
    if (!is_whole || map.kind == MapKind::count)
      GDALMDArraySetUnit(variable.get(), udunitOf(map.unit).c_str());
    check(messages, GDALMDArraySetSpatialRef(variable.get(), referenceOf(*study_.grid).get()) != 0);
    return variable;
  }

  /// Meaning of the numbers of classes or categories: different words, as CF requires, and the full labels,
  /// one per line.
  static void addFlags(const gdal::Array& variable, const Map& map) {
    if (map.kind == MapKind::count) return;
    std::vector<std::int16_t> values;
    std::string words, labels;
    std::set<std::string> different;
    const auto addFlag = [&](long long value, const std::string& label) {
      std::string word = flagWord(label);
      while (!different.insert(word).second) word += "_";
      words += (words.empty() ? "" : " ") + word;
      labels += (labels.empty() ? "" : "\n") + label;
      values.push_back(static_cast<std::int16_t>(value));
    };
    if (map.kind == MapKind::category) addFlag(-1, "none");
    for (std::size_t n = 0; n < map.labels.size(); ++n) addFlag(static_cast<long long>(n), map.labels[n]);
    const GUInt64 count = values.size();
    const gdal::Attribute attribute(GDALMDArrayCreateAttribute(variable.get(), "flag_values", 1, &count,
                                                               numberType(GDT_Int16).get(), nullptr));
    if (attribute != nullptr) {
      GDALAttributeWriteRaw(attribute.get(), values.data(), values.size() * sizeof(std::int16_t));
    }
    setText(variable, "flag_meanings", words);
    setText(variable, "flag_labels", labels);
  }

  UnfinishedFile file_;
  const MapStudy& study_;
  gdal::Dataset dataset_;
  gdal::Group root_;
  std::map<std::string, gdal::Dimension> dimensions_;
  std::map<std::string, gdal::Array> variables_;
};

}  // namespace

std::unique_ptr<MapCollection> makeNetCdf(const std::filesystem::path& file, const MapStudy& study) {
  return std::make_unique<NetCdf>(file, study);
}

}  // namespace emscape::study
