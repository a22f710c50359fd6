#include "study/sweep/results/result_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "base/files/unfinished_file.h"
#include "base/files/whole_file.h"
#include "base/text/csv_cell.h"
#include "document/schema_check.h"
#include "emscape/base/error.h"
#include "scenario/terrain/gdal_messages.h"
#include "study/maps/gdal_arrays.h"
#include "study/maps/gdal_support.h"

namespace emscape::study {
namespace {

/// Writes arrays of a netCDF file.
class NetcdfWriter {
 public:
  explicit NetcdfWriter(const std::string& file) {
    static const char* const kOptions[] = {"FORMAT=NC4", nullptr};
    dataset_ = createArrayFile(file, kOptions);
    root_ = rootOf(dataset_);
    fail_ = root_ == nullptr;
  }

  /// Finishes the file. @return false if anything failed
  bool close() {
    dimensions_.clear();
    root_.reset();
    dataset_.reset();
    return !fail_;
  }

  void note(const std::string& name, const std::string& text) {
    if (fail_) return;
    fail_ = !setText(root_, name.c_str(), text);
  }

  /// No array but its coordinate gets its name. @return valid until the file is finished
  GDALDimensionH dimension(const std::string& name, std::size_t size) {
    if (fail_) return nullptr;
    dimensions_.push_back(addDimension(root_, unique(name), "", size));
    fail_ = dimensions_.back() == nullptr;
    return dimensions_.back().get();
  }

  /// @param name  empty: an array of one dimension that has the dimension's name, which makes it a coordinate
  void numbers(const std::string& name, const ArrayDimensions& dimensions, const std::vector<double>& values,
               const std::string& long_name, const std::string& unit) {
    array(name, dimensions, numberType(GDT_Float64), values.data(), long_name, unit);
  }
  void texts(const std::string& name, const ArrayDimensions& dimensions,
             const std::vector<std::string>& values, const std::string& long_name) {
    std::vector<const char*> pointers;
    for (const std::string& value : values) pointers.push_back(value.c_str());
    array(name, dimensions, textType(), pointers.data(), long_name, "");
  }

 private:
  static bool isPlain(char c, bool is_first) {
    const bool is_letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
    return is_letter || (!is_first && ((c >= '0' && c <= '9') || c == '_'));
  }

  /// A unique name of letters, digits and underscores, as CF requires.
  std::string unique(const std::string& name) {
    std::string own = name;
    for (char& c : own) {
      if (!isPlain(c, false)) c = '_';
    }
    if (own.empty() || !isPlain(own[0], true)) own = "v_" + own;
    while (!names_.insert(own).second) own += "_";
    return own;
  }

  void array(const std::string& name, const ArrayDimensions& dimensions, const gdal::ValueType& type,
             const void* values, const std::string& long_name, const std::string& unit) {
    if (fail_) return;
    const std::string own = name.empty() ? GDALDimensionGetName(dimensions.front()) : unique(name);
    const gdal::Array made = addArray(root_, own, dimensions, type);
    fail_ = made == nullptr;
    if (fail_) return;
    const std::vector<GUInt64> starts(dimensions.size(), 0);
    std::vector<std::size_t> counts;
    for (GDALDimensionH of_array : dimensions) {
      counts.push_back(static_cast<std::size_t>(GDALDimensionGetSize(of_array)));
    }
    fail_ = !writeArray(made, starts, counts, type, values);
    for (const auto& [key, text] : {std::pair{"long_name", long_name}, std::pair{"units", unit}}) {
      if (fail_ || text.empty()) continue;
      fail_ = !setText(made, key, text);
    }
  }

  gdal::Dataset dataset_;
  gdal::Group root_;
  std::vector<gdal::Dimension> dimensions_;
  std::set<std::string> names_;  ///< of dimensions and arrays
  bool fail_ = false;
};

/// The unit of a measure in the notation of UDUNITS.
std::string udunit(const std::string& unit) {
  return unit == "km2" ? "km2" : unit.empty() ? "1" : unit;
}

/// The unit of a parameter in the notation of UDUNITS, from the end of its path, such as power_w.
std::string unitOfPath(const std::string& path) {
  constexpr std::pair<const char*, const char*> kUnits[] = {{"hz", "Hz"},
                                                            {"w", "W"},
                                                            {"m", "m"},
                                                            {"m2", "m2"},
                                                            {"s", "s"},
                                                            {"k", "K"},
                                                            {"deg", "degree"},
                                                            {"hpa", "hPa"},
                                                            {"db", "0.1 lg(re 1)"},
                                                            {"dbi", "0.1 lg(re 1)"},
                                                            {"rpm", "rpm"},
                                                            {"percent", "percent"},
                                                            {"mps", "m s-1"}};
  const std::string ending = path.substr(path.find_last_of("_.") + 1);
  for (const auto& [suffix, unit] : kUnits) {
    if (ending == suffix) return unit;
  }
  return "1";
}

/// A parameter's values, as numbers if all given values are numbers.
/// @param name  of the array; see NetcdfWriter
void writeParameter(NetcdfWriter& writer, const std::string& name, const std::string& path,
                    const ArrayDimensions& dimensions, const std::vector<std::string>& values) {
  std::vector<double> numbers;
  for (const std::string& value : values) {
    const std::optional<double> number = document::numberOf(value);
    if (!number && !value.empty()) return writer.texts(name, dimensions, values, path);
    numbers.push_back(number.value_or(NAN));
  }
  writer.numbers(name, dimensions, numbers, path, unitOfPath(path));
}

}  // namespace

std::string csvNumber(double value) {
  return std::isnan(value) ? "" : fmt::format("{}", value);
}

void writeResultsCsv(const std::filesystem::path& file, const StudySpec& study, const StudyResults& results) {
  const VariantSet& variants = study.variants;
  writeWhole(file, [&](std::ostream& out) {
    out << "variant,name";
    for (const std::string& path : variants.paths()) out << ',' << csvCell(path);
    for (const StudyMeasure& measure : study.measures) {
      const std::string unit = unitOf(measure);
      out << ',' << csvCell(measure.name + (unit.empty() ? "" : " (" + unit + ")"));
    }
    out << '\n';
    for (std::size_t v = 0; v < variants.count(); ++v) {
      if (!results.is_computed[v]) continue;
      out << v << ',' << csvCell(variants.name(v));
      for (std::size_t path = 0; path < variants.paths().size(); ++path) {
        out << ',' << csvCell(variants.value(v, path));
      }
      for (std::size_t m = 0; m < study.measures.size(); ++m) {
        out << ',' << csvNumber(results.value(v, m, study.measures.size()));
      }
      out << '\n';
    }
  });
}

void writeResultsNetcdf(const std::filesystem::path& file, const StudySpec& study,
                        const StudyResults& results) {
  const scenario::GdalMessages messages;
  const VariantSet& variants = study.variants;
  UnfinishedFile unfinished(file);
  NetcdfWriter writer(unfinished.temporary());
  writer.note("Conventions", "CF-1.8");
  writer.note("title", study.name);
  writer.note("source", "emscape study " + study.hash);
  writer.note("history", "written by emscape study");
  const bool is_grid =
      std::all_of(variants.factors().begin(), variants.factors().end(),
                  [](const VariantFactor& factor) { return factor.kind == VariantFactor::Kind::sweep; });
  ArrayDimensions dimensions;
  if (is_grid) {
    for (const VariantFactor& factor : variants.factors()) {
      dimensions.push_back(writer.dimension(factor.paths.front(), factor.count));
      for (std::size_t path = 0; path < factor.paths.size(); ++path) {
        std::vector<std::string> values;
        for (std::size_t setting = 0; setting < factor.count; ++setting)
          values.push_back(factor.value(setting, path));
        const std::string& name = factor.paths[path];
        writeParameter(writer, path == 0 ? "" : name, name, {dimensions.back()}, values);
      }
    }
  } else {
    dimensions.push_back(writer.dimension("variant", variants.count()));
    std::vector<std::string> names;
    for (std::size_t v = 0; v < variants.count(); ++v) names.push_back(variants.name(v));
    if (std::any_of(names.begin(), names.end(), [](const std::string& name) { return !name.empty(); })) {
      writer.texts("name", dimensions, names, "name of the variant");
    }
    for (std::size_t path = 0; path < variants.paths().size(); ++path) {
      std::vector<std::string> values;
      for (std::size_t v = 0; v < variants.count(); ++v) values.push_back(variants.value(v, path));
      writeParameter(writer, variants.paths()[path], variants.paths()[path], dimensions, values);
    }
  }
  for (std::size_t m = 0; m < study.measures.size(); ++m) {
    std::vector<double> values;
    for (std::size_t v = 0; v < variants.count(); ++v) {
      values.push_back(results.value(v, m, study.measures.size()));
    }
    const StudyMeasure& measure = study.measures[m];
    writer.numbers(measure.name, dimensions, values, measure.name, udunit(unitOf(measure)));
  }
  if (!writer.close() || messages.hasFailure()) failWriting(messages, file);
  unfinished.publish();
}

}  // namespace emscape::study
