/// Transfer functions as files: strict reading with the place of every fault.
#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <cmath>
#include <fstream>
#include <set>
#include <sstream>

#include "emscape/base/error.h"
#include "emscape/render/transfer_function.h"

namespace emscape::render {
namespace {

constexpr int kSchemaVersion = 1;

/// Reads one file; YAML is a superset of JSON, and its reader knows where each value stands.
class Reader {
 public:
  Reader(std::string file, const volume::VolumeInfo& info) : file_(std::move(file)), info_(info) {}

  TransferFunction read(const std::string& text) {
    const YAML::Node root = load(text);
    requireMap(root, {"schema_version", "name", "domain", "unit", "colors", "opacity"});
    number(required(root, "schema_version"), kSchemaVersion, kSchemaVersion, "schema_version");
    TransferFunction function;
    if (root["name"]) function.name = scalar(root["name"]);
    function.unit = info_.unit;
    readDomain(root);
    readOpacity(required(root, "opacity"), function);
    readColors(required(root, "colors"), function);
    if (!(function.highest() > function.lowest())) {
      fail(root["opacity"], fmt::format("all points are at {}: expected an interval", function.lowest()));
    }
    return function;
  }

 private:
  YAML::Node load(const std::string& text) const {
    try {
      return YAML::Load(text);
    } catch (const YAML::Exception& error) {
      throw Error(ErrorCode::bad_input, {file_, error.mark.line + 1, error.mark.column + 1}, error.msg);
    }
  }

  [[noreturn]] void fail(const YAML::Node& node, const std::string& message) const {
    throw Error(ErrorCode::bad_input, {file_, node.Mark().line + 1, node.Mark().column + 1}, message);
  }

  void requireMap(const YAML::Node& node, const std::set<std::string>& known) const {
    if (!node.IsMap()) fail(node, "expected an object");
    std::set<std::string> seen;
    for (const auto& entry : node) {
      const std::string key = scalar(entry.first);
      if (known.count(key) == 0)
        fail(entry.first, fmt::format("unknown key '{}': expected {}", key, fmt::join(known, ", ")));
      if (!seen.insert(key).second) fail(entry.first, fmt::format("key '{}' is given twice", key));
    }
  }

  YAML::Node required(const YAML::Node& map, const char* key) const {
    YAML::Node value = map[key];
    if (!value) fail(map, fmt::format("key '{}' is missing", key));
    return value;
  }

  std::string scalar(const YAML::Node& node) const {
    if (!node.IsScalar()) fail(node, "expected a single value");
    return node.Scalar();
  }

  double number(const YAML::Node& node, double least, double largest, const char* what) const {
    double value = 0;
    if (!node.IsScalar() || !YAML::convert<double>::decode(node, value)) {
      fail(node, fmt::format("{}: expected a number", what));
    }
    if (!(value >= least && value <= largest)) {
      fail(node, least == largest ? fmt::format("{} {}: expected {}", what, value, least)
                                  : fmt::format("{} {}: expected {}..{}", what, value, least, largest));
    }
    return value;
  }

  /// Gives an error that knows no place that of a node.
  template <class Read>
  auto atNode(const YAML::Node& node, const Read& read) const {
    try {
      return read();
    } catch (const Error& error) {
      if (error.place().line > 0) throw;
      fail(node, error.message());
    }
  }

  void readDomain(const YAML::Node& root) {
    const YAML::Node node = required(root, "domain");
    const std::string domain = scalar(node);
    if (domain != "value" && domain != "relative") {
      fail(node, fmt::format("domain '{}': expected value or relative", domain));
    }
    relative_ = domain == "relative";
    const YAML::Node unit_node = root["unit"];
    if (!unit_node) return;
    const std::string unit = scalar(unit_node);
    if (relative_) fail(unit_node, "a unit is given, but the domain is relative");
    if (unit != info_.unit) {
      fail(unit_node, fmt::format("unit '{}' is not that of the volume: {} is in '{}'", unit, info_.quantity,
                                  info_.unit));
    }
  }

  /// `at` of a point, in the volume's unit; checks the order.
  double position(const YAML::Node& point, const double* before, bool may_repeat) const {
    const YAML::Node node = required(point, "at");
    const double range = info_.range_max > info_.range_min ? double{info_.range_max} - info_.range_min : 1.0;
    const double at =
        relative_ ? info_.range_min + range * number(node, 0, 1, "at") : number(node, -1e30, 1e30, "at");
    if (before != nullptr && (may_repeat ? at < *before : at <= *before)) {
      fail(node,
           fmt::format("at {}: points must {}", scalar(node), may_repeat ? "not decrease" : "increase"));
    }
    return at;
  }

  void requirePoints(const YAML::Node& list, const char* what) const {
    if (!list.IsSequence() || list.size() == 0)
      fail(list, fmt::format("{}: expected a list of points", what));
  }

  void readOpacity(const YAML::Node& list, TransferFunction& function) const {
    requirePoints(list, "opacity");
    for (const YAML::Node& point : list) {
      requireMap(point, {"at", "opacity"});
      const double* before = function.opacities.empty() ? nullptr : &function.opacities.back().at;
      const double at = position(point, before, true);
      function.opacities.push_back({at, number(required(point, "opacity"), 0, 1, "opacity")});
    }
  }

  void readColors(const YAML::Node& node, TransferFunction& function) const {
    if (node.IsScalar()) {
      const double lowest = function.opacities.front().at;
      const double range = function.opacities.back().at - lowest;
      if (!(range > 0)) fail(node, "a colour map by name needs opacity points at two different values");
      const ColorMap map = atNode(node, [&] { return colorMap(node.Scalar()); });
      for (const ColorMap::Point& point : map.points) {
        function.colors.push_back({lowest + range * point.at, point.color});
      }
      return;
    }
    requirePoints(node, "colors");
    for (const YAML::Node& point : node) {
      requireMap(point, {"at", "color"});
      const double* before = function.colors.empty() ? nullptr : &function.colors.back().at;
      const double at = position(point, before, false);
      const YAML::Node color = required(point, "color");
      function.colors.push_back({at, atNode(color, [&] { return parseColor(scalar(color)); })});
    }
  }

  std::string file_;
  const volume::VolumeInfo& info_;
  bool relative_ = false;
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
  return Reader(file, info).read(text);
}

TransferFunction readTransferFunction(const std::string& file, const volume::VolumeInfo& info) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  if (!stream || !(text << stream.rdbuf())) {
    throw Error(ErrorCode::bad_input, fmt::format("cannot read transfer function '{}'", file));
  }
  return parseTransferFunction(text.str(), file, info);
}

}  // namespace emscape::render
