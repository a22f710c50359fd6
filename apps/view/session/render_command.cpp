#include "apps/view/session/render_command.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <functional>

#include "base/files/folder.h"
#include "base/text/shell_word.h"
#include "playback/editing/autosave.h"
#include "playback/editing/edit_history.h"

namespace emscape::view {
namespace {

std::string beginOf(const ViewOptions& options) {
  std::string text = "emscape render " + shellWord(options.input);
  if (!options.scenario.empty()) text += " --scenario " + shellWord(options.scenario);
  if (!options.mesh.empty()) text += " --mesh " + options.mesh;
  if (options.cells.method == playback::CellMethod::project) text += " --cells project";
  if (options.allow_missing_terrain) text += " --allow-missing-terrain";
  return text;
}

/// The colours that `render` would fit without a transfer function.
render::TransferFunction fittedColors(const playback::ViewState& view, const playback::ShownField& shown) {
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

std::string colorOptions(const playback::ViewState& view, const playback::ShownField& shown) {
  const std::string range = view.range ? fmt::format(" --range={}:{}", view.range->min, view.range->max) : "";
  if (!view.transfer || view.transfer->categorical) return range;
  const std::string text = render::transferFunctionText(*view.transfer);
  if (text == render::transferFunctionText(fittedColors(view, shown))) return range;
  return " --transfer " + shellWord(writeColors(*view.transfer, text));
}

std::string settingOptions(const render::RenderSettings& settings) {
  const render::RenderSettings usual;
  std::string text = fmt::format(" --mode {}", render::toString(settings.mode));
  if (settings.step_voxels != usual.step_voxels) text += fmt::format(" --step {}", settings.step_voxels);
  if (settings.mida_gamma != usual.mida_gamma) text += fmt::format(" --mida-gamma={}", settings.mida_gamma);
  if (!std::isnan(settings.iso_value)) text += fmt::format(" --iso-value={}", settings.iso_value);
  if (settings.iso_opacity != usual.iso_opacity)
    text += fmt::format(" --iso-opacity {}", settings.iso_opacity);
  if (settings.vertical_exaggeration != usual.vertical_exaggeration)
    text += fmt::format(" --exaggeration {}", settings.vertical_exaggeration);
  for (const render::CutPlane& plane : settings.planes) text += " --plane " + shellWord(toString(plane));
  if (settings.shading) text += " --shading";
  if (settings.exact) text += " --exact";
  return text;
}

}  // namespace

std::string renderCommand(const ViewOptions& options, const std::string& state_file) {
  return beginOf(options) + " --state " + shellWord(state_file) + " -o picture.png";
}

std::string renderCommand(const ViewOptions& options, const playback::ViewState& view,
                          const playback::ShownField& shown) {
  std::string text = beginOf(options) + " --camera " + shellWord(render::toString(view.camera)) +
                     fmt::format(" --times {}", view.time_s) + settingOptions(view.settings);
  if (!view.quantity.empty()) text += " --quantity " + shellWord(view.quantity);
  text += colorOptions(view, shown);
  if (view.theme == render::Theme::light) text += " --theme light";
  if (!view.show_terrain) text += " --terrain off";
  if (!view.show_emitters) text += " --emitters off";
  for (const scenario::Edit& edit : view.edits) text += " --set " + shellWord(scenario::toString(edit));
  if (!view.compare.empty()) text += " --compare " + shellWord(view.compare);
  return text + fmt::format(" --size {}x{} -o picture.png", view.size.width, view.size.height);
}

}  // namespace emscape::view
