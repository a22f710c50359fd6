#include "playback/view/view_settings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "emscape/base/error.h"
#include "emscape/render/picture/image.h"
#include "emscape/volume/dense_volume.h"
#include "playback/view/settings_table.h"

namespace emscape::playback {
namespace {

using document::ValueSpec;
using document::ValueType;
using Table = SettingsTable;
namespace spec = document::spec;

constexpr double kMaxRate = 1e4;
constexpr double kMaxValue = 1e30;
constexpr double kMaxLabelScale = 4;
constexpr int kMaxItems = 10000;

ValueSpec valueSpec() {
  return spec::number().from(-kMaxValue).to(kMaxValue);
}
ValueSpec within(const render::SettingLimits& limits) {
  return spec::number().from(limits.min).to(limits.max);
}

std::string sizeText(const render::ImageSize& size) {
  return fmt::format("{}x{}", size.width, size.height);
}

std::optional<double> parseMapLayer(const std::string& text) {
  if (text == "off") return std::nullopt;
  char* end = nullptr;
  const double height_m = std::strtod(text.c_str(), &end);
  const render::SettingLimits& limits = render::kMapHeightLimits;
  if (text.empty() || *end != '\0' || !(height_m >= limits.min && height_m <= limits.max)) {
    throw Error(ErrorCode::usage, fmt::format("map layer '{}': expected off, or a height above ground of "
                                              "{:g}..{:g} m",
                                              text, limits.min, limits.max));
  }
  return height_m;
}

std::string mapLayerText(const std::optional<double>& height_m) {
  return height_m ? fmt::format("{}", *height_m) : "off";
}

std::string rangeText(const std::optional<ValueRange>& range) {
  return range ? fmt::format("{}:{}", range->min, range->max) : "";
}

std::optional<render::Pattern> parsePattern(const std::string& name) {
  return name == "auto" ? std::nullopt : std::optional(render::parsePattern(name));
}

std::string patternText(const std::optional<render::Pattern>& pattern) {
  return pattern ? render::toString(*pattern) : "auto";
}

render::CutPlane parsePlane(const std::string& text) {
  return render::parseCutPlane(text);
}

// In the order of view files.
void addCameraAndTime(Table& table) {
  const ValueSpec time = spec::number("s").from(-volume::kMaxTime_s).to(volume::kMaxTime_s);
  table
      .parsed(
          "camera", Table::textSpec(1), [](auto& view) -> auto& { return view.camera; }, render::parseCamera,
          [](const render::CameraSpec& camera) { return toString(camera); },
          "as for `--camera`: `orbit:azimuth_deg=155,elevation_deg=28,distance=1.2,...` or "
          "`lookat:eye_x_m=..,...`")
      .withTexts("text", "`orbit`")
      .withEffect(&ViewChange::camera)
      .withOption("--camera",
                  "orbit:azimuth_deg=..,elevation_deg=..,distance=..,fov_deg=.. or "
                  "lookat:eye_x_m=..,..,target_x_m=..,..");
  table
      .member(
          "follow", Table::textSpec(), [](auto& view) -> auto& { return view.follow; },
          "platform at which the camera looks, as it moves")
      .withTexts("text", "none")
      .withEffect(&ViewChange::camera)
      .withOption("--follow", "Platform at which the camera looks, as it moves");
  table
      .member(
          "follow_mode", choiceOf<FollowMode>(), [](auto& view) -> auto& { return view.follow_mode; },
          "follow: the camera keeps its bearing; chase: `azimuth_deg` counts from the platform's heading, "
          "180 is "
          "behind it")
      .withEffect(&ViewChange::camera)
      .withOption(
          "--follow-mode",
          "follow: the camera keeps its bearing; chase: azimuth_deg counts from the platform's heading, "
          "180 is behind it");
  table
      .member(
          "camera_path", choiceOf<CameraPath>(), [](auto& view) -> auto& { return view.camera_path; },
          "of several pictures, as films: the camera stays (fixed), or flies from one bookmark to the next, "
          "at their "
          "times if all have ascending ones, else evenly")
      .withOption("--camera-path",
                  "Camera of several pictures: fixed, or along the bookmarks of the view (--state)")
      .withVerb("camera_path", "path",
                "Camera of recordings: fixed, or bookmarks: from one bookmark to the next; without a name "
                "the next one");
  table
      .member(
          "film_speed", switchSpec(), [](auto& view) -> auto& { return view.film_speed; },
          "videos state their speed beside the time, as ×5")
      .withOption("--film-speed", "State the speed of a video beside the time, as x5: on or off")
      .withVerb("film_speed", "on", "Videos state their speed beside the time");
  table.stored("bookmarks", "stored cameras: `name`, `camera`, and optionally `time_s`")
      .withTexts("list", "none");
  table
      .member(
          "time_s", time, [](auto& view) -> auto& { return view.time_s; }, "since the scenario's epoch")
      .withTexts("", "the first step at which an emitter is present")
      .withEffect(&ViewChange::time)
      .withOption("--time",
                  "First instant, in seconds or UTC; default: the first at which an emitter is present");
  table.member(
      "rate", spec::number().from(-kMaxRate).to(kMaxRate), [](auto& view) -> auto& { return view.rate; },
      "scenario seconds per second; negative: backwards. For a window");
  table.member(
      "loop", switchSpec(), [](auto& view) -> auto& { return view.loop; },
      "playback continues from the other end. For a window");
  table.stored("play_range", "range of playback, moved to the nearest steps. For a window")
      .withTexts("`{\"begin_s\": .., \"end_s\": ..}`", "all steps");
  table.stored("visible_time", "visible part of the time line. For a window")
      .withTexts("`{\"begin_s\": .., \"end_s\": ..}`", "all steps");
}

void addColors(Table& table) {
  table
      .member(
          "quantity", Table::textSpec(), [](auto& view) -> auto& { return view.quantity; },
          "quantity, or channel such as `snr_db:search radar`")
      .withTexts("text", "the first")
      .withEffect(&ViewChange::field)
      .withOption("--quantity", "Quantity or channel to draw; default: the first")
      .withChange(changeQuantity);
  table
      .parsed(
          "range", spec::simple(ValueType::object), [](auto& view) -> auto& { return view.range; },
          parseRange, rangeText, "range of the colours, in the quantity's unit")
      .withTexts("`{\"min\": .., \"max\": ..}`", "that of the series")
      .withEffect(&ViewChange::colors)
      .withOption("--range", "MIN:MAX of the colours; default: fitted to the values of the first picture")
      .withChange([](ViewState& view, const std::string& text) { changeRange(view, parseRange(text)); });
  table
      .stored("transfer",
              "colours and opacities, as in a [transfer file](#transfer-functions), with `\"domain\": "
              "\"value\"`")
      .withTexts("object", "fitted")
      .withEffect(&ViewChange::colors)
      .withOption("--transfer",
                  "Colours and opacities (JSON); default: fitted to the values of the first picture")
      .withChange([](ViewState& view, const std::string& file) {
        view.transfer_file = file;
        view.transfer.reset();
      });
  table.rows.back().get = [](const ViewState& view) {
    return view.transfer && !view.transfer->categorical ? render::transferFunctionText(*view.transfer) : "";
  };
}

void addRenderSettings(Table& table) {
  const std::size_t first = table.rows.size();
  table
      .member(
          "mode", choiceOf<render::CompositingMode>(), [](auto& view) -> auto& { return view.settings.mode; },
          "compositing of the samples")
      .withOption("--mode", "Compositing mode; default: dvr")
      .withVerb("mode", "mode", "dvr, mida, mip or iso; without a name the next one")
      .withAction("Mode", "M");
  table
      .member(
          "step_voxels", within(render::kStepLimits),
          [](auto& view) -> auto& { return view.settings.step_voxels; }, "distance of samples")
      .withOption("--step", "Distance between samples, in voxels")
      .withVerb("step_voxels", "value", "Distance between samples, in voxels");
  table
      .member(
          "mida_gamma", within(render::kMidaGammaLimits),
          [](auto& view) -> auto& { return view.settings.mida_gamma; }, "-1 is dvr, 1 is mip")
      .withOption("--mida-gamma", "-1 (dvr) .. 0 (mida) .. 1 (mip)");
  table
      .member(
          "exact", switchSpec(), [](auto& view) -> auto& { return view.settings.exact; },
          "no early termination of rays")
      .withOption("--exact", "No early termination of rays");
  table
      .member(
          "shading", switchSpec(), [](auto& view) -> auto& { return view.settings.shading; },
          "shading of dvr and mida")
      .withOption("--shading", "Shading of dvr and mida; iso is always shaded")
      .withVerb("shading", "on", "Shading of dvr and mida; iso is always shaded")
      .withAction("Shading", "S");
  table
      .member(
          "iso_value", valueSpec(), [](auto& view) -> auto& { return view.settings.iso_value; },
          "value of the isosurface, in the quantity's unit")
      .withTexts("number", "the middle of the colours")
      .withOption("--iso-value",
                  "Value of the isosurface, in the quantity's unit; default: the middle of the colours");
  table
      .member(
          "iso_opacity", within(render::kIsoOpacityLimits),
          [](auto& view) -> auto& { return view.settings.iso_opacity; }, "opacity of the isosurface")
      .withOption("--iso-opacity", "Opacity of the isosurface");
  table
      .member(
          "vertical_exaggeration", within(render::kExaggerationLimits),
          [](auto& view) -> auto& { return view.settings.vertical_exaggeration; }, "0: chosen from the box")
      .withOption("--exaggeration", "Vertical exaggeration; 0: chosen from the box")
      .withVerb("exaggeration", "factor", "Vertical exaggeration; 0: chosen from the box");
  table
      .parsedList(
          "planes", render::kMaxCutPlanes, [](auto& view) -> auto& { return view.settings.planes; },
          parsePlane, "[cutting planes](#cutting-planes), as for `--plane`")
      .withTexts("list of texts, at most 3", "none")
      .withOption("--plane",
                  "Cuts the volume open: horizontal:altitude_m=..[,keep=below|above] or "
                  "vertical:bearing_deg=..[,x_m=..,y_m=..,offset_m=..,keep=left|right] "
                  "(docs/view-state.md); may be given 3 times");
  table
      .parsed(
          "map_layer", Table::textSpec(1), [](auto& view) -> auto& { return view.settings.map_height_agl_m; },
          parseMapLayer, mapLayerText,
          "[map layer](viewer.md#map-layer): the values at this height above the ground (m), painted on the "
          "ground")
      .withTexts("`\"off\"`, or 0..100000 m as text: `\"100\"`", "`\"off\"`")
      .withOption("--map-layer",
                  "Paint the values at a height above the ground on it: the height in metres, or off");
  table
      .member(
          "map_opacity", within(render::kMapOpacityLimits),
          [](auto& view) -> auto& { return view.settings.map_opacity; }, "opacity of the map layer")
      .withOption("--map-opacity", "Opacity of the map layer");
  for (std::size_t row = first; row < table.rows.size(); ++row) {
    table.rows[row].affects = &ViewChange::settings;
  }
}

void addScenery(Table& table) {
  table
      .member(
          "theme", choiceOf<render::Theme>(), [](auto& view) -> auto& { return view.theme; },
          "background, labels and the ground")
      .withEffect(&ViewChange::ground)
      .withOption("--theme", "Background and labels; default: dark")
      .withVerb("theme", "theme", "dark or light; without a name the other one")
      .withAction("Dark or light", "D");
  table
      .member(
          "show_terrain", switchSpec(), [](auto& view) -> auto& { return view.show_terrain; },
          "draw the ground")
      .withEffect(&ViewChange::ground)
      .withOption("--terrain", "Draw the ground: on or off")
      .withVerb("terrain", "on", "Draws the ground")
      .withAction("Ground", "B");
  table
      .member(
          "show_emitters", switchSpec(), [](auto& view) -> auto& { return view.show_emitters; },
          "draw and label the emitters")
      .withEffect(&ViewChange::labels)
      .withOption("--emitters", "Draw and name the emitters: on or off")
      .withVerb("emitters", "on", "Draws the emitters")
      .withAction("Emitters", "E");
  table
      .member(
          "labels", choiceOf<Labels>(), [](auto& view) -> auto& { return view.labels; },
          "labels of emitters and platforms: none; names; or name, kind, frequency and height")
      .withEffect(&ViewChange::labels)
      .withOption("--labels", "Labels of emitters and platforms; default: names")
      .withVerb("labels", "labels",
                "Labels of emitters and platforms: off, names or all; without a name the next one")
      .withAction("Labels", "N");
  addReferences(table);
  table
      .member(
          "trail_s", spec::number("s").from(0).to(volume::kMaxTime_s),
          [](auto& view) -> auto& { return view.trail_s; },
          "length of the tracks that are drawn behind moving platforms; 0: whole tracks, also ahead")
      .withEffect(&ViewChange::labels)
      .withOption("--trail", "Length of the tracks behind moving platforms, in seconds; 0: whole tracks")
      .withVerb("trail", "seconds",
                "Length of the tracks behind moving platforms; 0: whole tracks, also ahead");
  table
      .member(
          "label_scale", spec::number().from(0).to(kMaxLabelScale),
          [](auto& view) -> auto& { return view.label_scale; },
          "minimum size of texts and symbols; 1: that of a picture of 1200x900; 0: follows the picture's "
          "size")
      .withEffect(&ViewChange::ground)  // their margins move the camera: cast again
      .withOption("--label-scale",
                  "Minimum size of texts and symbols; 1: that of a picture of 1200x900; 0: follows the "
                  "picture's size")
      .withVerb(
          "label_scale", "factor",
          "Minimum size of the texts and symbols in the picture; 0: follows the picture's size. The verb "
          "scale sets it too");
  table
      .member(
          "sides", choiceOf<ShownSides>(), [](auto& view) -> auto& { return view.sides; },
          "draw all emitters and platforms, or those of one side")
      .withEffect(&ViewChange::labels)
      .withOption("--sides", "Draw all emitters and platforms, or those of one side; default: all")
      .withVerb("sides", "sides",
                "Draws all emitters and platforms, or those of one side; without a name the next one")
      .withAction("Next side", "Shift+N");
  table
      .parsed(
          "size", spec::listOf(spec::simple(ValueType::integer).from(1).to(render::kMaxImageSide), 2, 2),
          [](auto& view) -> auto& { return view.size; }, render::parseImageSize, sizeText, "pixels")
      .withTexts("[width, height], 1..32767", "[1280, 720]")
      .withEffect(&ViewChange::size)
      .withOption("--size", "Picture size in pixels, WxH; default: 1280x720");
}

void addFieldAndWindow(Table& table) {
  table
      .parsedList(
          "edits", kMaxItems, [](auto& view) -> auto& { return view.edits; }, scenario::parseEdit,
          "changes to the scenario, in order, each as `--set` takes it: "
          "[PATH=VALUE](scenario-format.md#editing)")
      .withTexts("list of texts", "none");
  table
      .member(
          "compare", Table::textSpec(), [](auto& view) -> auto& { return view.compare; },
          "`original` or a file (relative to the folder of the view file; if there is none, to the working "
          "folder): the difference to it is drawn, as with `--compare`; `transfer`, `range` and `iso_value` "
          "are then in the unit of differences. See also `split`")
      .withTexts("text", "none")
      .withEffect(&ViewChange::field)
      .withOption("--compare",
                  "Draw what differs from the scenario without the --set edits (original), or from another "
                  "scenario on the same grid (FILE)")
      .withChange(changeComparison);
  table
      .member(
          "split", spec::number().from(0).to(1), [](auto& view) -> auto& { return view.split; },
          "[split view](viewer.md#split-view): the part of the picture's width, at the left, in which the "
          "reference of `compare` is drawn instead of the difference to it; 0: the difference")
      .withEffect(&ViewChange::split)
      .withOption(
          "--split",
          "Draw the reference of --compare (without one: the scenario without the --set edits) in this "
          "part of the picture's width, 0..1, at the left, instead of the difference to it");
  table.rows.back().change = [](ViewState& view, const SettingValue& value) {
    changeSplit(view, std::get<double>(value));
  };
  table
      .member(
          "open_panels", spec::listOf(Table::textSpec(1), 0, kMaxItems),
          [](auto& view) -> auto& { return view.open_panels; },
          "open panels of the window; `hidden`: all are temporarily hidden. Empty: the panels are not "
          "changed")
      .withTexts("list of texts", "none");
}

/// Settings that belong to the input or to the program, not to a view file.
void addUnstored(Table& table) {
  table
      .member(
          "", Table::textSpec(), [](auto& view) -> auto& { return view.scenario; }, "")
      .withOption("--scenario", "Scenario of the ground and emitters to draw with volumes");
  table
      .member(
          "", switchSpec(), [](auto& view) -> auto& { return view.allow_missing_terrain; }, "")
      .withOption("--allow-missing-terrain",
                  "Compute although elevation data is missing; voxels over holes are masked");
  std::vector<std::string> patterns{"auto"};
  for (const render::Pattern pattern : render::allPatterns())
    patterns.emplace_back(render::toString(pattern));
  table
      .parsed(
          "", spec::choice(patterns), [](auto& view) -> auto& { return view.pattern; }, parsePattern,
          patternText, "")
      .withEffect(&ViewChange::pattern)
      .withOption(
          "--rays",
          "Pixels to cast while the picture changes, the others are interpolated; auto: all, or as many "
          "as the time between two pictures allows");
}

}  // namespace

bool ViewSetting::isListOfTexts() const {
  return spec.type == ValueType::list && spec.item->type == ValueType::text;
}

bool ViewSetting::isSame(const ViewState& a, const ViewState& b) const {
  const SettingValue of_a = get(a), of_b = get(b);
  const double* const number = std::get_if<double>(&of_a);
  return (number && std::isnan(*number) && std::isnan(std::get<double>(of_b))) || of_a == of_b;
}

std::string ViewSetting::text(const ViewState& view) const {
  const SettingValue value = get(view);
  if (const bool* on = std::get_if<bool>(&value)) return *on ? "on" : "off";
  if (const double* number = std::get_if<double>(&value)) return fmt::format("{}", *number);
  return std::get<std::string>(value);
}

std::string ViewSetting::optionText() const {
  if (isChoice()) return fmt::format("{} {}", option, fmt::join(spec.choices, "|"));
  const bool is_flag = isSwitch() && !std::get<bool>(get(ViewState{}));
  return isSwitch() && !is_flag ? option + " on|off" : option;
}

void ViewSetting::changeToNext(ViewState& view) const {
  const SettingValue value = get(view);
  if (const bool* on = std::get_if<bool>(&value)) return change(view, !*on);
  const std::vector<std::string>& names = spec.choices;
  const auto found = std::find(names.begin(), names.end(), std::get<std::string>(value));
  change(view, names[static_cast<std::size_t>(found - names.begin() + 1) % names.size()]);
}

const std::vector<ViewSetting>& viewSettings() {
  static const std::vector<ViewSetting> all = [] {
    Table table;
    addCameraAndTime(table);
    addColors(table);
    addRenderSettings(table);
    addScenery(table);
    addFieldAndWindow(table);
    addUnstored(table);
    return std::move(table.rows);
  }();
  return all;
}

const ViewSetting& settingOfKey(const std::string& key) {
  const std::vector<ViewSetting>& all = viewSettings();
  return *std::find_if(all.begin(), all.end(),
                       [&](const ViewSetting& setting) { return setting.key == key; });
}

const ViewSetting* settingOfVerb(const std::string& verb) {
  for (const ViewSetting& setting : viewSettings()) {
    if (setting.verb == verb) return &setting;
  }
  return nullptr;
}

ViewChange changeOf(const ViewState& before, const ViewState& after) {
  ViewChange change;
  for (const ViewSetting& setting : viewSettings()) {
    if (!setting.affects || change.*setting.affects) continue;
    change.*setting.affects = !setting.isSame(before, after);
  }
  return change;
}

ValueRange parseRange(const std::string& text) {
  const std::size_t colon = text.find(':');
  const auto number = [](const std::string& part, float& value) {
    char* end = nullptr;
    value = static_cast<float>(std::strtold(part.c_str(), &end));
    return !part.empty() && *end == '\0' && std::isfinite(value);
  };
  ValueRange range;
  if (colon == std::string::npos || !number(text.substr(0, colon), range.min) ||
      !number(text.substr(colon + 1), range.max) || range.min >= range.max) {
    throw Error(ErrorCode::usage, "range '" + text + "' must be MIN:MAX, two numbers with MIN < MAX");
  }
  return range;
}

}  // namespace emscape::playback
