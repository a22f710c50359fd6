#include <fmt/format.h>

#include <filesystem>

#include "study/sweep/definition/study_file.h"
#include "study/sweep/definition/study_reading.h"

namespace emscape::study {
namespace {

using document::Section;

/// Unit of the values of a measure's map; may be empty.
std::string unitOfValues(const StudyMeasure& measure) {
  const char* const unit = info(measure.product).unit;
  return unit != nullptr ? unit : scenario::info(measure.quantity).unit;
}

void readFigure(StudyReading& reading, const Section& item, StudyMeasure& measure) {
  using Figure = StudyMeasure::Figure;
  const bool has_area = info(measure.product).area_class >= 0;
  const std::string unit = item.text("unit");
  const bool is_area = unit == "km2" || unit == "percent" || (unit.empty() && has_area);
  if (item.has("statistic") && (unit == "km2" || unit == "percent")) {
    reading.fault(item.locationOf("statistic"),
                  fmt::format("'statistic' goes with values, not with areas in {}", unit));
  } else if (item.has("statistic") || !is_area) {
    const bool is_index = measure.product == Product::best ||
                          (measure.product == Product::value && scenario::info(measure.quantity).categorical);
    if (is_index) {
      reading.fault(item.locationOf("product"),
                    fmt::format("measure '{}': {} is an index, which has no mean, min and max", measure.name,
                                measure.product == Product::best
                                    ? "product 'best'"
                                    : fmt::format("quantity '{}'", scenario::info(measure.quantity).name)));
    }
    measure.figure = item.has("statistic")
                         ? static_cast<Figure>(static_cast<int>(Figure::mean) + item.choiceIndex("statistic"))
                         : Figure::mean;
    if (!unit.empty() && unit != unitOf(measure)) {
      reading.fault(item.locationOf("unit"), fmt::format("product '{}' is in '{}', not {}",
                                                         info(measure.product).name, unitOf(measure), unit));
    }
  } else {
    measure.figure = unit == "percent" ? Figure::percent : Figure::km2;
    if (!has_area) {
      const std::string values = unitOfValues(measure);
      reading.fault(item.locationOf("unit"),
                    fmt::format("product '{}' has no area; its values {}, with statistic mean, min or max",
                                info(measure.product).name,
                                values.empty() ? "have no unit" : "are in '" + values + "'"));
    }
  }
}

}  // namespace

std::string unitOf(const StudyMeasure& measure) {
  switch (measure.figure) {
    case StudyMeasure::Figure::km2:
      return "km2";
    case StudyMeasure::Figure::percent:
      return "percent";
    default:
      break;
  }
  return unitOfValues(measure);
}

void readMeasures(StudyReading& reading, const Section& root) {
  StudySpec& spec = reading.spec;
  for (const Section& item : root.sections("measures")) {
    StudyMeasure measure;
    measure.name = reading.nameOf(item);
    measure.product = productNamed(item.text("product"));
    const ProductInfo& product = info(measure.product);
    if (item.has("height") && !product.at_heights) {
      reading.fault(item.locationOf("height"), fmt::format("product '{}' has no 'height'", product.name));
    }
    reading.reportAt(item.locationOf("height"), [&] {
      const std::vector<MapHeight> heights = parseHeights(item.text("height"));
      if (heights.size() != 1) throw Error(ErrorCode::usage, "a measure has one height");
      measure.height = heights.front();
    });
    const Section& with_quantity = item.has("quantity") ? item : root;
    reading.reportAt(with_quantity.locationOf("quantity"),
                     [&] { measure.quantity = scenario::quantityFromName(with_quantity.text("quantity")); });
    const std::optional<double> given =
        item.has("threshold") ? item.optionalNumber("threshold") : root.optionalNumber("threshold");
    const std::optional<double> usual = defaultThreshold(measure.quantity);
    if (!given && !usual && measure.product != Product::value) {
      reading.fault(item.location(),
                    fmt::format("measure '{}' needs a threshold: quantity '{}' has no default", measure.name,
                                scenario::info(measure.quantity).name));
    }
    measure.threshold = given.value_or(usual.value_or(0));
    if (measure.product != Product::value) {
      reading.reportAt((item.has("threshold") ? item : root).locationOf("threshold"),
                       [&] { requireThreshold(measure.quantity, measure.threshold); });
    }
    if (product.over_time && spec.times_s.size() < 2) {
      reading.fault(item.location(),
                    fmt::format("product '{}' is over time: give the study 'times' with two times or more",
                                product.name));
    }
    readFigure(reading, item, measure);
    if (item.text("over") != "region") {
      measure.over = reading.resolve(item.text("over"));
      std::error_code ignored;  // such as a name that is too long
      if (!std::filesystem::is_regular_file(measure.over, ignored)) {
        reading.fault(item.locationOf("over"), measure.over + ": no such file; polygons, or 'region'");
      } else {
        reading.reportAt(item.locationOf("over"), [&] { reading.addVectors(measure.over); });
      }
    }
    spec.measures.push_back(std::move(measure));
  }
}

}  // namespace emscape::study
