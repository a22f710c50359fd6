#include "playback/editing/view_state.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/files/file_reading.h"
#include "base/files/whole_file.h"
#include "document/json_text.h"
#include "document/schema_check.h"
#include "document/text_edit.h"
#include "document/text_file.h"
#include "emscape/base/error.h"
#include "emscape/playback/frames/frame_source.h"
#include "emscape/render/picture/image.h"
#include "emscape/scenario/model/clock.h"
#include "render/transfer/transfer_format.h"

namespace emscape::playback {
namespace {

using document::DocumentNode;
using document::DocumentNodePtr;
using document::ObjectSpec;
using document::ProblemList;
using document::Section;
using document::ValueSpec;
using document::ValueType;
using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;
namespace spec = document::spec;

constexpr int kVersion = 1;
constexpr std::uintmax_t kMaxFileBytes = std::uintmax_t{16} << 20;
constexpr double kMaxRate = 1e4;
constexpr double kMaxValue = 1e30;
constexpr int kMaxItems = 10000;
constexpr int kMaxText = 1 << 20;

// In the order of the enumerations.
const std::vector<std::string> kModes{"dvr", "mida", "mip", "iso"};
const std::vector<std::string> kThemes{"dark", "light"};

ValueSpec text(int min_characters = 0) {
  ValueSpec value = spec::textOf(ValueType::text, kMaxText);
  value.min_items = min_characters;
  return value;
}

ValueSpec within(const render::SettingLimits& limits, const char* unit = "") {
  return spec::number(unit).from(limits.min).to(limits.max);
}

/// The table of the format. The table of the transfer function depends on its form in the file.
class ViewFormat {
 public:
  explicit ViewFormat(const DocumentNode* transfer) : transfer_(transfer) {
    const ValueSpec time = spec::number("s").from(-volume::kMaxTime_s).to(volume::kMaxTime_s);
    const ValueSpec boolean = spec::simple(ValueType::boolean);
    const ValueSpec value = spec::number().from(-kMaxValue).to(kMaxValue);
    bookmark_ = {"bookmark",
                 "",
                 {spec::required("name", text(), ""), spec::required("camera", text(1), ""),
                  spec::optional("time_s", time, "")}};
    range_ = {"range", "", {spec::required("min", value, ""), spec::required("max", value, "")}};
    interval_ = {"interval", "", {spec::required("begin_s", time, ""), spec::required("end_s", time, "")}};
    root_ = {
        "view",
        "",
        {spec::required("schema_version", spec::simple(ValueType::integer).from(kVersion).to(kVersion), ""),
         spec::optional("camera", text(1), ""),
         spec::optional("bookmarks", spec::listOf(spec::object(bookmark_), 0, kMaxItems), ""),
         spec::optional("time_s", time, ""),
         spec::optional("rate", spec::number().from(-kMaxRate).to(kMaxRate), ""),
         spec::optional("loop", boolean, ""),
         spec::optional("play_range", spec::object(interval_), ""),
         spec::optional("visible_time", spec::object(interval_), ""),
         spec::optional("quantity", text(), ""),
         spec::optional("range", spec::object(range_), ""),
         spec::optional("transfer", spec::object(transfer_.object()), ""),
         spec::optional("mode", spec::choice(kModes), ""),
         spec::optional("step_voxels", within(render::kStepLimits, "voxels"), ""),
         spec::optional("mida_gamma", within(render::kMidaGammaLimits), ""),
         spec::optional("exact", boolean, ""),
         spec::optional("shading", boolean, ""),
         spec::optional("iso_value", value, ""),
         spec::optional("iso_opacity", within(render::kIsoOpacityLimits), ""),
         spec::optional("vertical_exaggeration", within(render::kExaggerationLimits), ""),
         spec::optional("planes", spec::listOf(text(1), 0, render::kMaxCutPlanes), ""),
         spec::optional("theme", spec::choice(kThemes), ""),
         spec::optional("show_terrain", boolean, ""),
         spec::optional("show_emitters", boolean, ""),
         spec::optional(
             "size", spec::listOf(spec::simple(ValueType::integer).from(1).to(render::kMaxImageSide), 2, 2),
             ""),
         spec::optional("edits", spec::listOf(text(1), 0, kMaxItems), ""),
         spec::optional("compare", text(), ""),
         spec::optional("open_panels", spec::listOf(text(1), 0, kMaxItems), "")}};
  }
  ViewFormat(const ViewFormat&) = delete;
  ViewFormat& operator=(const ViewFormat&) = delete;

  const ObjectSpec& root() const { return root_; }
  const render::TransferFormat& transfer() const { return transfer_; }

 private:
  render::TransferFormat transfer_;
  ObjectSpec bookmark_, range_, interval_, root_;
};

class Reader {
 public:
  Reader(const ViewFormat& format, ProblemList& problems) : format_(format), problems_(problems) {}

  ViewState read(const Section& root) {
    ViewState state;
    readCamera(root, state.camera);
    for (const Section& item : root.sections("bookmarks")) {
      Bookmark bookmark{item.text("name"), {}, item.optionalNumber("time_s")};
      readCamera(item, bookmark.camera);
      state.bookmarks.push_back(std::move(bookmark));
    }
    read(root, "time_s", state.time_s);
    read(root, "rate", state.rate);
    read(root, "loop", state.loop);
    state.play_range = interval(root, "play_range");
    state.visible_time = interval(root, "visible_time");
    state.quantity = root.text("quantity");
    if (root.has("range")) state.range = range(root.section("range"));
    if (root.has("transfer")) {
      state.transfer =
          render::readTransferFunction(root.section("transfer"), format_.transfer(), nullptr, problems_);
    }
    readSettings(root, state.settings);
    readTexts(root, "planes", render::parseCutPlane, state.settings.planes);
    if (root.has("theme")) state.theme = root.choice<render::Theme>("theme");
    read(root, "show_terrain", state.show_terrain);
    read(root, "show_emitters", state.show_emitters);
    if (root.has("size")) {
      const std::vector<double> size = root.numbers("size");
      state.size = {static_cast<int>(size[0]), static_cast<int>(size[1])};
    }
    readTexts(root, "edits", scenario::parseEdit, state.edits);
    state.compare = root.text("compare");
    state.open_panels = root.texts("open_panels");
    return state;
  }

 private:
  static void read(const Section& section, const std::string& key, double& value) {
    value = section.optionalNumber(key).value_or(value);
  }
  static void read(const Section& section, const std::string& key, bool& value) {
    value = section.optionalBoolean(key).value_or(value);
  }

  void readCamera(const Section& section, render::CameraSpec& camera) {
    if (!section.has("camera")) return;
    try {
      camera = render::parseCamera(section.text("camera"));
    } catch (const Error& error) {
      problems_.addError(section.locationOf("camera"), error.message());
    }
  }

  volume::ValueRange range(const Section& section) {
    const volume::ValueRange range{static_cast<float>(section.number("min")),
                                   static_cast<float>(section.number("max"))};
    if (!(range.min < range.max)) {
      problems_.addError(section.locationOf("max"),
                         fmt::format("'max' is {}, not above 'min', {}", range.max, range.min));
    }
    return range;
  }

  std::optional<scenario::TimeInterval> interval(const Section& root, const std::string& key) {
    if (!root.has(key)) return std::nullopt;
    const Section section = root.section(key);
    const scenario::TimeInterval interval{section.number("begin_s"), section.number("end_s")};
    if (!(interval.begin_s < interval.end_s)) {
      problems_.addError(section.locationOf("end_s"), fmt::format("'end_s' is {}, not above 'begin_s', {}",
                                                                  interval.end_s, interval.begin_s));
    }
    return interval;
  }

  static void readSettings(const Section& root, render::RenderSettings& settings) {
    if (root.has("mode")) settings.mode = root.choice<render::CompositingMode>("mode");
    read(root, "step_voxels", settings.step_voxels);
    read(root, "mida_gamma", settings.mida_gamma);
    read(root, "exact", settings.exact);
    read(root, "shading", settings.shading);
    read(root, "iso_value", settings.iso_value);
    read(root, "iso_opacity", settings.iso_opacity);
    read(root, "vertical_exaggeration", settings.vertical_exaggeration);
  }

  /// A list of texts that a function parses.
  template <class Item>
  void readTexts(const Section& root, const std::string& key, Item (*parse)(const std::string&),
                 std::vector<Item>& items) {
    const std::vector<std::string> texts = root.texts(key);
    for (std::size_t i = 0; i < texts.size(); ++i) {
      try {
        items.push_back(parse(texts[i]));
      } catch (const Error& error) {
        problems_.addError(root.locationOf(key, i), error.message());
      }
    }
  }

  const ViewFormat& format_;
  ProblemList& problems_;
};

/// Reports a newer version with one error, instead of a list of unknown keys.
void refuseNewerVersion(const std::string& file, const DocumentNodePtr& root) {
  const DocumentNodePtr version = document::valueAt(root, {"schema_version"});
  const auto number = version && !version->quoted ? document::numberOf(version->text) : std::nullopt;
  if (!number || !(*number > kVersion)) return;
  throw Error(
      ErrorCode::bad_input, {file, version->position.line, version->position.column},
      fmt::format("this view is of schema_version {}; this program reads {}", version->text, kVersion));
}

/// Removes values in the unit of the previous quantity.
void dropColors(ViewState& state) {
  state.transfer.reset();
  state.range.reset();
  state.settings.iso_value = render::RenderSettings{}.iso_value;
}

void addCamera(const render::CameraSpec& camera, Json& json) {
  json["camera"] = toString(camera);
}

void addInterval(const char* key, const std::optional<scenario::TimeInterval>& interval, Json& json) {
  if (interval) json[key] = {{"begin_s", interval->begin_s}, {"end_s", interval->end_s}};
}

void addSettings(const render::RenderSettings& settings, Json& json) {
  json["mode"] = render::toString(settings.mode);
  json["step_voxels"] = settings.step_voxels;
  json["mida_gamma"] = settings.mida_gamma;
  json["exact"] = settings.exact;
  json["shading"] = settings.shading;
  if (!std::isnan(settings.iso_value)) json["iso_value"] = settings.iso_value;
  json["iso_opacity"] = settings.iso_opacity;
  json["vertical_exaggeration"] = settings.vertical_exaggeration;
  json["planes"] = Json::array();
  for (const render::CutPlane& plane : settings.planes) json["planes"].push_back(toString(plane));
}

bool isRelativeFile(const std::string& compare) {
  return !compare.empty() && compare != kOriginal && fs::path(compare).is_relative();
}

/// Absolute and without symbolic links, as far as they can be resolved.
fs::path resolved(const fs::path& path) {
  const fs::path absolute = fs::absolute(path);
  std::error_code failure;
  const fs::path real = fs::weakly_canonical(absolute, failure);
  return failure ? absolute.lexically_normal() : real;
}

/// The compared file as it is named in the view file `view`: relative to its folder, wherever symbolic links
/// to the folders are.
std::string nameInView(const std::string& compare, const fs::path& view) {
  if (!isRelativeFile(compare)) return compare;
  const fs::path file = fs::absolute(compare);
  const std::string name = (resolved(file.parent_path()) / file.filename())
                               .lexically_normal()
                               .lexically_relative(resolved(fs::absolute(view).parent_path()))
                               .generic_string();
  return name == kOriginal ? "./" + name : name;
}

/// The compared file that the view file `view` names. If there is none, that of the working folder, to which
/// earlier versions of the program wrote the names.
std::string comparedFile(const fs::path& view, const std::string& name) {
  if (!isRelativeFile(name)) return name;
  const fs::path written = view.parent_path() / name, normal = written.lexically_normal();
  // If ".." follows a symbolic link, they are different files.
  const fs::path beside = resolved(normal) == resolved(written) ? normal : resolved(written);
  std::error_code ignored;
  return !fs::exists(beside, ignored) && fs::exists(name, ignored) ? name : beside.string();
}

Json toJson(const std::vector<Bookmark>& bookmarks) {
  Json json = Json::array();
  for (const Bookmark& bookmark : bookmarks) {
    Json entry;
    entry["name"] = bookmark.name;
    addCamera(bookmark.camera, entry);
    if (bookmark.time_s) entry["time_s"] = *bookmark.time_s;
    json.push_back(std::move(entry));
  }
  return json;
}

}  // namespace

ViewState parseViewState(const std::string& text, const std::string& file) {
  ProblemList problems;
  ViewState state;
  const DocumentNodePtr root = document::readDocument(file, document::checkedUtf8(file, text), problems);
  if (root) {
    refuseNewerVersion(file, root);
    const DocumentNodePtr transfer = document::valueAt(root, {"transfer"});
    const ViewFormat format(transfer.get());
    if (document::checkObject(file, *root, format.root(), problems)) {
      state = Reader(format, problems).read({file, root.get(), format.root()});
    }
  }
  document::requireNoProblem(problems);
  return state;
}

ViewState readViewState(const std::string& file) {
  ViewState state = parseViewState(readWholeText(file, kMaxFileBytes), file);
  state.compare = comparedFile(file, state.compare);
  return state;
}

std::string viewStateText(const ViewState& state) {
  Json json;
  json["schema_version"] = kVersion;
  addCamera(state.camera, json);
  json["bookmarks"] = toJson(state.bookmarks);
  json["time_s"] = state.time_s;
  json["rate"] = state.rate;
  json["loop"] = state.loop;
  addInterval("play_range", state.play_range, json);
  addInterval("visible_time", state.visible_time, json);
  json["quantity"] = state.quantity;
  if (state.range) {
    json["range"]["min"] = document::shortNumber(state.range->min);
    json["range"]["max"] = document::shortNumber(state.range->max);
  }
  if (state.transfer && !state.transfer->categorical) json["transfer"] = render::toJson(*state.transfer);
  addSettings(state.settings, json);
  json["theme"] = kThemes[static_cast<std::size_t>(state.theme)];
  json["show_terrain"] = state.show_terrain;
  json["show_emitters"] = state.show_emitters;
  json["size"] = {state.size.width, state.size.height};
  json["edits"] = Json::array();
  for (const scenario::Edit& edit : state.edits) json["edits"].push_back(toString(edit));
  json["compare"] = state.compare;
  json["open_panels"] = state.open_panels;
  return document::jsonText(json);
}

void writeViewState(const std::string& file, const ViewState& state) {
  ViewState stored = state;
  stored.compare = nameInView(state.compare, file);
  const std::string text = viewStateText(stored);
  parseViewState(text, file);
  writeWhole(file, [&text](std::ostream& out) { out << text; });
}

void changeQuantity(ViewState& state, const std::string& quantity) {
  if (quantity == state.quantity) return;
  state.quantity = quantity;
  dropColors(state);
}

void changeComparison(ViewState& state, const std::string& compare) {
  if (compare.empty() != state.compare.empty()) dropColors(state);
  state.compare = compare;
}

void changeRange(ViewState& state, const volume::ValueRange& range) {
  state.range = range;
  state.transfer.reset();
}

PictureStyle pictureStyleOf(const ViewState& state) {
  PictureStyle style;
  style.size = state.size;
  style.camera = state.camera;
  style.theme = state.theme;
  style.settings = state.settings;
  style.function = state.transfer;
  style.colors_span_range = state.range.has_value();
  style.show_terrain = state.show_terrain;
  style.show_emitters = state.show_emitters;
  return style;
}

}  // namespace emscape::playback
