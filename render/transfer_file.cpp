/// Transfer functions as files: the table of the format, and what it cannot say.
#include <fmt/format.h>

#include "base/whole_file.h"
#include "document/schema_check.h"
#include "document/section.h"
#include "document/text_file.h"
#include "emscape/base/error.h"
#include "emscape/render/transfer_function.h"

namespace emscape::render {
namespace {

using document::DocumentNode;
using document::DocumentNodePtr;
using document::NodeKind;
using document::ObjectSpec;
using document::ProblemList;
using document::Section;
using document::ValueSpec;
using document::ValueType;
namespace spec = document::spec;

constexpr std::uintmax_t kMaxFileBytes = std::uintmax_t{1} << 20;
constexpr double kMaxValue = 1e30;
constexpr int kMaxPoints = 10000;

ValueSpec textOrNothing() {
  ValueSpec text = spec::textOf(ValueType::text, 1000);
  text.min_items = 0;
  return text;
}

/// The table of the format. Two of its values have two forms: positions are values or parts of the volume's
/// range, and colours are the name of a map or points.
class TransferFormat {
 public:
  TransferFormat(bool is_relative, bool has_map) {
    const ValueSpec at =
        is_relative ? spec::number().from(0).to(1) : spec::number().from(-kMaxValue).to(kMaxValue);
    color_ = {
        "colour point", "", {spec::required("at", at, ""), spec::required("color", textOrNothing(), "")}};
    opacity_ = {"opacity point",
                "",
                {spec::required("at", at, ""), spec::required("opacity", spec::number().from(0).to(1), "")}};
    const ValueSpec colors =
        has_map ? spec::choice(colorMapNames()) : spec::listOf(spec::object(color_), 1, kMaxPoints);
    root_ = {"transfer function",
             "",
             {spec::required("schema_version", spec::simple(ValueType::integer).from(1).to(1), ""),
              spec::optional("name", textOrNothing(), ""),
              spec::required("domain", spec::choice({"value", "relative"}), ""),
              spec::optional("unit", textOrNothing(), ""), spec::required("colors", colors, ""),
              spec::required("opacity", spec::listOf(spec::object(opacity_), 1, kMaxPoints), "")}};
  }
  TransferFormat(const TransferFormat&) = delete;
  TransferFormat& operator=(const TransferFormat&) = delete;

  const ObjectSpec& root() const { return root_; }

 private:
  ObjectSpec color_, opacity_, root_;
};

const DocumentNode* valueOf(const DocumentNode& map, const std::string& key) {
  for (const document::MapEntry& entry : map.entries) {
    if (entry.key == key) return entry.value.get();
  }
  return nullptr;
}

class Reader {
 public:
  Reader(const std::string& file, const volume::VolumeInfo& info) : file_(file), info_(info) {}

  TransferFunction read(const std::string& text) {
    TransferFunction function;
    if (const DocumentNodePtr root = document::readDocument(file_, text, problems_)) {
      const DocumentNode* domain = valueOf(*root, "domain");
      const DocumentNode* colors = valueOf(*root, "colors");
      is_relative_ = domain != nullptr && domain->text == "relative";
      has_map_ = colors != nullptr && colors->kind == NodeKind::scalar;
      const TransferFormat format(is_relative_, has_map_);
      if (document::checkObject(file_, *root, format.root(), problems_)) {
        readRoot(Section(file_, root.get(), format.root()), function);
      }
    }
    requireNoFault();
    return function;
  }

 private:
  void readRoot(const Section& root, TransferFunction& function) {
    function.name = root.text("name");
    function.unit = info_.unit;
    if (root.has("unit") && is_relative_) {
      problems_.addError(root.placeOf("unit"), "a unit is given, but the domain is relative");
    } else if (root.has("unit") && root.text("unit") != info_.unit) {
      problems_.addError(root.placeOf("unit"),
                         fmt::format("unit '{}' is not that of the volume: {} is in '{}'", root.text("unit"),
                                     info_.quantity, info_.unit));
    }
    for (const Section& point : root.sections("opacity")) {
      const double* before = function.opacities.empty() ? nullptr : &function.opacities.back().at;
      function.opacities.push_back({position(point, before, true), point.number("opacity")});
    }
    has_map_ ? spreadMap(root, function) : readColors(root, function);
    if (!problems_.hasErrors() && !(function.highest() > function.lowest())) {
      problems_.addError(root.placeOf("opacity"),
                         fmt::format("all points are at {}: expected an interval", function.lowest()));
    }
  }

  /// `at` of a point, in the volume's unit; checks the order.
  double position(const Section& point, const double* before, bool may_repeat) {
    const double range = info_.range_max > info_.range_min ? double{info_.range_max} - info_.range_min : 1.0;
    const double given = point.number("at");
    const double at = is_relative_ ? info_.range_min + range * given : given;
    if (before != nullptr && (may_repeat ? at < *before : at <= *before)) {
      problems_.addError(point.placeOf("at"), fmt::format("at {}: points must {}", given,
                                                          may_repeat ? "not decrease" : "increase"));
    }
    return at;
  }

  /// A colour map by name covers the opacity points.
  void spreadMap(const Section& root, TransferFunction& function) {
    const double lowest = function.opacities.front().at;
    const double range = function.opacities.back().at - lowest;
    if (!(range > 0)) {
      problems_.addError(root.placeOf("colors"),
                         "a colour map by name needs opacity points at two different values");
    }
    for (const ColorMap::Point& point : colorMap(root.text("colors")).points) {
      function.colors.push_back({lowest + range * point.at, point.color});
    }
  }

  void readColors(const Section& root, TransferFunction& function) {
    for (const Section& point : root.sections("colors")) {
      const double* before = function.colors.empty() ? nullptr : &function.colors.back().at;
      const double at = position(point, before, false);
      try {
        function.colors.push_back({at, parseColor(point.text("color"))});
      } catch (const Error& error) {
        problems_.addError(point.placeOf("color"), error.message());
      }
    }
  }

  /// One fault keeps its place; several are told one a line.
  void requireNoFault() const {
    const std::vector<document::Problem> problems = problems_.inOrder();
    if (problems.empty()) return;
    if (problems.size() == 1)
      throw Error(ErrorCode::bad_input, problems.front().place, problems.front().message);
    std::string all;
    for (const document::Problem& problem : problems) {
      all += (all.empty() ? "" : "\n") + toString(problem.place) + ": " + problem.message;
    }
    throw Error(ErrorCode::bad_input, all);
  }

  const std::string& file_;
  const volume::VolumeInfo& info_;
  ProblemList problems_;
  bool is_relative_ = false;
  bool has_map_ = false;
};

}  // namespace

TransferFunction parseTransferFunction(const std::string& text, const std::string& file,
                                       const volume::VolumeInfo& info) {
  if (info.categorical) {
    throw Error(
        ErrorCode::bad_input, {file, 0, 0},
        fmt::format(
            "{} is categorical: its categories have their own colours, a transfer function does not apply",
            info.quantity));
  }
  return Reader(file, info).read(document::checkedUtf8(file, text));
}

TransferFunction readTransferFunction(const std::string& file, const volume::VolumeInfo& info) {
  return parseTransferFunction(readWholeText(file, kMaxFileBytes), file, info);
}

}  // namespace emscape::render
