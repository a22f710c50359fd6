#include "apps/view/parts/render_command.h"

#include <fmt/format.h>

#include <filesystem>
#include <functional>
#include <set>

#include "base/files/folder.h"
#include "base/text/shell_word.h"
#include "playback/editing/autosave.h"
#include "playback/view/view_settings.h"

namespace emscape::view {
namespace {

using playback::ViewSetting;
using playback::ViewState;

std::string beginOf(const ViewState& view) {
  std::string text = "emscape render " + shellWord(view.input);
  if (!view.scenario.empty()) text += " --scenario " + shellWord(view.scenario);
  if (!view.mesh.empty()) text += " --mesh " + view.mesh;
  if (view.cells.method == playback::CellMethod::project) text += " --cells project";
  const auto& projection = view.cells.projection;
  const decltype(view.cells.projection) usual;
  if (projection.rasterizer != usual.rasterizer)
    text += std::string(" --cell-rasterizer ") + toString(projection.rasterizer);
  if (projection.sorting != usual.sorting)
    text += std::string(" --cell-order ") + toString(projection.sorting);
  if (projection.projection != usual.projection)
    text += std::string(" --cell-perspective ") + toString(projection.projection);
  if (view.allow_missing_terrain) text += " --allow-missing-terrain";
  return text;
}

/// The colours that `render` would fit without a transfer function.
render::TransferFunction fittedColors(const ViewState& view, const playback::ShownField& shown) {
  if (!view.range) return shown.defaultColors();
  return render::defaultTransferFunction(shown.info(), view.range);
}

/// Writes the function to a file; equal functions share a file.
std::string writeColors(const render::TransferFunction& function, const std::string& text) {
  namespace fs = std::filesystem;
  const fs::path folder = playback::stateFolder() / "copied";
  makeFolder(folder);
  const fs::path file = folder / fmt::format("colors-{:016x}.json", std::hash<std::string>()(text));
  render::writeTransferFunction(file.string(), function);
  return file.string();
}

std::string colorOptions(const ViewState& view, const playback::ShownField& shown) {
  const std::string range = view.range ? fmt::format(" --range={}:{}", view.range->min, view.range->max) : "";
  if (!view.transfer || view.transfer->categorical) return range;
  const std::string text = render::transferFunctionText(*view.transfer);
  if (text == render::transferFunctionText(fittedColors(view, shown))) return range;
  return " --transfer " + shellWord(writeColors(*view.transfer, text));
}

/// The options of a setting that is not the default.
std::string optionsOf(const ViewSetting& setting, const ViewState& view) {
  if (setting.isSame(view, {})) return "";
  const std::string begin = " " + setting.option;
  if (setting.isListOfTexts()) {
    std::string text;
    const auto items = std::get<std::vector<std::string>>(setting.get(view));
    for (const std::string& item : items) {
      text += begin + " " + shellWord(item);
    }
    return text;
  }
  const std::string value = setting.text(view);
  if (setting.isSwitch() && value == "on") return begin;  // a flag
  return begin + (value[0] == '-' ? "=" : " ") + shellWord(value);
}

}  // namespace

std::string renderCommand(const ViewState& view, const std::string& state_file) {
  return beginOf(view) + " --state " + shellWord(state_file) + " -o picture.png";
}

std::string renderCommand(const ViewState& view, const playback::ShownField& shown) {
  std::string text = beginOf(view) + " --camera " + shellWord(render::toString(view.camera)) +
                     fmt::format(" --times {}", view.time_s);
  const std::set<std::string> others{"--camera", "--time", "--range", "--transfer", "--size"};
  for (const ViewSetting& setting : playback::viewSettings()) {
    const bool is_plain =
        !setting.key.empty() && !setting.option.empty() && others.count(setting.option) == 0;
    if (is_plain) text += optionsOf(setting, view);
  }
  text += colorOptions(view, shown);
  for (const scenario::Edit& edit : view.edits) text += " --set " + shellWord(scenario::toString(edit));
  return text + fmt::format(" --size {}x{} -o picture.png", view.size.width, view.size.height);
}

}  // namespace emscape::view
