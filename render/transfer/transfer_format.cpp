#include "render/transfer/transfer_format.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "document/json_text.h"
#include "emscape/base/error.h"

namespace emscape::render {
namespace {

using document::DocumentNode;
using document::NodeKind;
using document::ProblemList;
using document::Section;
using document::ValueSpec;
using document::ValueType;
using Json = nlohmann::ordered_json;
namespace spec = document::spec;

constexpr double kMaxValue = 1e30;
constexpr int kMaxPoints = 10000;

ValueSpec textOrNothing() {
  ValueSpec text = spec::textOf(ValueType::text, 1000);
  text.min_items = 0;
  return text;
}

const DocumentNode* valueOf(const DocumentNode* map, const std::string& key) {
  if (map == nullptr) return nullptr;
  for (const document::MapEntry& entry : map->entries) {
    if (entry.key == key) return entry.value.get();
  }
  return nullptr;
}

class Reader {
 public:
  Reader(const TransferFormat& format, const volume::VolumeInfo* info, ProblemList& problems,
         const ColorRange& range)
      : format_(format), info_(info), problems_(problems), range_(range) {}

  TransferFunction read(const Section& root) {
    TransferFunction function;
    function.name = root.text("name");
    readUnit(root, function);
    for (const Section& point : root.sections("opacity")) {
      const double* before = function.opacities.empty() ? nullptr : &function.opacities.back().at;
      function.opacities.push_back({position(point, before, true), point.number("opacity")});
    }
    format_.hasMap() ? spreadMap(root, function) : readColors(root, function);
    if (!problems_.hasErrors() && !(function.highest() > function.lowest())) {
      problems_.addError(root.locationOf("opacity"),
                         fmt::format("all points are at {}: expected an interval", function.lowest()));
    }
    return function;
  }

 private:
  void readUnit(const Section& root, TransferFunction& function) {
    function.unit = info_ != nullptr ? info_->unit : root.text("unit");
    if (format_.isRelative() && info_ == nullptr) {
      problems_.addError(root.locationOf("domain"), "'domain' must be value here: no volume gives the range");
    } else if (root.has("unit") && format_.isRelative()) {
      problems_.addError(root.locationOf("unit"), "a unit is given, but the domain is relative");
    } else if (root.has("unit") && info_ != nullptr && root.text("unit") != info_->unit) {
      problems_.addError(root.locationOf("unit"),
                         fmt::format("unit '{}' is not that of the volume: {} is in '{}'", root.text("unit"),
                                     info_->quantity, info_->unit));
    }
  }

  /// `at` of a point, in the volume's unit; checks the order.
  double position(const Section& point, const double* before, bool may_repeat) {
    const double given = point.number("at");
    double at = given;
    if (format_.isRelative() && info_ != nullptr) {
      const volume::ValueRange range = colorRangeOf(*info_, range_);
      const double width = range.max > range.min ? double{range.max} - range.min : 1.0;
      at = range.min + width * given;
    }
    if (before != nullptr && (may_repeat ? at < *before : at <= *before)) {
      problems_.addError(point.locationOf("at"), fmt::format("at {}: points must {}", given,
                                                             may_repeat ? "not decrease" : "increase"));
    }
    return at;
  }

  /// A colour map by name covers the opacity points.
  void spreadMap(const Section& root, TransferFunction& function) {
    const double lowest = function.opacities.front().at;
    const double range = function.opacities.back().at - lowest;
    if (!(range > 0)) {
      problems_.addError(root.locationOf("colors"),
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
      if (point.has("rgb")) {
        const std::vector<double> rgb = point.numbers("rgb");
        function.colors.push_back(
            {at, {static_cast<float>(rgb[0]), static_cast<float>(rgb[1]), static_cast<float>(rgb[2])}});
        continue;
      }
      try {
        function.colors.push_back({at, parseColor(point.text("color"))});
      } catch (const Error& error) {
        problems_.addError(point.locationOf("color"), error.message());
      }
    }
  }

  const TransferFormat& format_;
  const volume::VolumeInfo* const info_;
  ProblemList& problems_;
  const ColorRange& range_;
};

/// "#rrggbb" if that is exactly this colour, else its components.
void addColor(const Rgb& color, Json& point) {
  const auto level = [](float component) {
    return static_cast<int>(std::lround(std::min(std::max(component, 0.0F), 1.0F) * 255.0F));
  };
  const std::string text = fmt::format("#{:02x}{:02x}{:02x}", level(color.r), level(color.g), level(color.b));
  const Rgb again = parseColor(text);
  if (again.r == color.r && again.g == color.g && again.b == color.b) {
    point["color"] = text;
  } else {
    point["rgb"] = {document::shortNumber(color.r), document::shortNumber(color.g),
                    document::shortNumber(color.b)};
  }
}

}  // namespace

TransferFormat::TransferFormat(const DocumentNode* node) {
  const DocumentNode* domain = valueOf(node, "domain");
  const DocumentNode* colors = valueOf(node, "colors");
  is_relative_ = domain != nullptr && domain->text == "relative";
  has_map_ = colors != nullptr && colors->kind == NodeKind::scalar;
  const ValueSpec at =
      is_relative_ ? spec::number().from(0).to(1) : spec::number().from(-kMaxValue).to(kMaxValue);
  color_ = {"colour point",
            "",
            {spec::required("at", at, ""), spec::optional("color", textOrNothing(), ""),
             spec::optional("rgb", spec::listOf(spec::number().from(0).to(1), 3, 3), "")},
            {{"color", "rgb"}}};
  opacity_ = {"opacity point",
              "",
              {spec::required("at", at, ""), spec::required("opacity", spec::number().from(0).to(1), "")}};
  const ValueSpec points =
      has_map_ ? spec::choice(colorMapNames()) : spec::listOf(spec::object(color_), 1, kMaxPoints);
  object_ = {"transfer function",
             "",
             {spec::required("schema_version", spec::simple(ValueType::integer).from(1).to(1), ""),
              spec::optional("name", textOrNothing(), ""),
              spec::required("domain", spec::choice({"value", "relative"}), ""),
              spec::optional("unit", textOrNothing(), ""), spec::required("colors", points, ""),
              spec::required("opacity", spec::listOf(spec::object(opacity_), 1, kMaxPoints), "")}};
}

TransferFunction readTransferFunction(const Section& section, const TransferFormat& format,
                                      const volume::VolumeInfo* info, ProblemList& problems,
                                      const ColorRange& range) {
  return Reader(format, info, problems, range).read(section);
}

Json toJson(const TransferFunction& function) {
  if (function.categorical) {
    throw Error(ErrorCode::bad_input,
                fmt::format("the transfer function '{}' is categorical: categories have their own colours",
                            function.name));
  }
  Json json;
  json["schema_version"] = 1;
  if (!function.name.empty()) json["name"] = function.name;
  json["domain"] = "value";
  if (!function.unit.empty()) json["unit"] = function.unit;
  json["colors"] = Json::array();
  for (const TransferFunction::ColorPoint& point : function.colors) {
    Json entry;
    entry["at"] = point.at;
    addColor(point.color, entry);
    json["colors"].push_back(std::move(entry));
  }
  json["opacity"] = Json::array();
  for (const TransferFunction::OpacityPoint& point : function.opacities) {
    json["opacity"].push_back({{"at", point.at}, {"opacity", point.opacity}});
  }
  return json;
}

}  // namespace emscape::render
