#include "apps/view/session/opening.h"

#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "apps/view/session/file_browser.h"
#include "base/whole_file.h"
#include "emscape/base/error.h"
#include "emscape/playback/inputs.h"
#include "emscape/scenario/scenario_file.h"
#include "emscape/volume/file.h"

namespace emscape::view {
namespace {

using scenario::Edit;

enum class Content { input, view, colors, header, series };

constexpr std::uintmax_t kMaxJsonBytes = 16 << 20;

/// Distinguishes view files, transfer functions, what belongs to volumes, and scenarios in JSON by their
/// keys.
Content contentOf(const std::string& file) {
  if (fileKindOf(file, false) == FileKind::view) return Content::view;
  std::error_code ignored;
  const std::filesystem::path path(file);
  if (path.extension() != ".json" || std::filesystem::file_size(path, ignored) > kMaxJsonBytes)
    return Content::input;
  if (volume::isVolumeFile(path.stem())) return Content::header;
  const auto json = nlohmann::json::parse(readWholeText(file, kMaxJsonBytes), nullptr, false);
  if (!json.is_object() || json.contains("emitters") || json.contains("region")) return Content::input;
  if (json.contains("domain") && json.contains("opacity")) return Content::colors;
  if (json.contains("recipe") && json.contains("format_version")) return Content::series;
  return json.contains("camera") || json.contains("open_panels") ? Content::view : Content::input;
}

/// @throws Error (bad_input) for contents that belong to volumes
void refusePartOfVolumes(const std::string& file, Content content) {
  const std::filesystem::path path(file);
  if (content == Content::header) {
    throw Error(ErrorCode::bad_input, {file, 0, 0},
                "the header of a volume: open " + path.stem().string() + " beside it");
  }
  if (content == Content::series) {
    throw Error(ErrorCode::bad_input, {file, 0, 0}, "describes a series of volumes: open its folder");
  }
}

bool applies(const std::string& file, const std::vector<Edit>& edits) {
  return scenario::parseScenario(file, edits).scenario != nullptr;
}

/// Removes edits that no longer apply to the scenario.
void checkScenario(const std::string& file, std::vector<Edit>& edits, std::string& left_out) {
  if (applies(file, edits)) return;
  scenario::loadScenario(file);  // throws its errors
  std::vector<Edit> kept;
  for (const Edit& edit : edits) {
    kept.push_back(edit);
    if (applies(file, kept)) continue;
    kept.pop_back();
    left_out += (left_out.empty() ? "" : ", ") + scenario::toString(edit);
  }
  edits = kept;
}

void checkInput(const ViewOptions& options, Opening& opening) {
  switch (playback::inputKindOf(options.input)) {
    case playback::InputKind::scenario:
      checkScenario(options.input, opening.options.view.edits, opening.left_out);
      break;
    case playback::InputKind::volume:
      if (!options.scenario.empty()) {
        checkScenario(options.scenario, opening.options.view.edits, opening.left_out);
      }
      break;
    case playback::InputKind::mesh:
      render::checkCellSettings(options.view.settings);
      if (!options.scenario.empty()) {
        checkScenario(options.scenario, opening.options.view.edits, opening.left_out);
      }
      break;
    case playback::InputKind::elevation:
    case playback::InputKind::antenna:
      throw Error(ErrorCode::bad_input, {options.input, 0, 0},
                  "neither a scenario nor a volume: open the scenario that names it");
  }
}

}  // namespace

void requireInputFile(const std::string& file) {
  const Content content = contentOf(file);
  refusePartOfVolumes(file, content);
  if (content == Content::input) return;
  const bool is_view = content == Content::view;
  throw Error(ErrorCode::bad_input, {file, 0, 0},
              std::string(is_view ? "a view file" : "a transfer function") + ", not an input: give it with " +
                  (is_view ? "--state" : "--transfer") + " after a scenario or volumes");
}

Opening prepareOpening(const OpenRequest& request, const ViewOptions& present) {
  playback::inputKindOf(request.file);  // throws if there is no such file
  Opening opening;
  opening.options = present;
  ViewOptions& options = opening.options;
  const Content content = contentOf(request.file);
  refusePartOfVolumes(request.file, content);
  switch (content) {
    case Content::colors:
      if (present.input.empty()) {
        throw Error(ErrorCode::bad_input, {request.file, 0, 0},
                    "colours, which need a volume: open a scenario or volumes first");
      }
      opening.colors = request.file;
      return opening;
    case Content::view:
      if (present.input.empty()) {
        throw Error(ErrorCode::bad_input, {request.file, 0, 0},
                    "a view of some input: open the scenario or the volumes first");
      }
      options.view = playback::readViewState(request.file);
      if (options.view.open_panels.empty()) options.view.open_panels = present.view.open_panels;
      options.state = request.file;
      options.offers_kept_view = false;
      break;
    default:
      if (request.file != present.input) options.mesh.clear();  // chosen for that scenario
      options.input = request.file;
      options.scenario = request.scenario;
      options.state.clear();
      if (request.view) options.view = *request.view;
      options.offers_kept_view = !request.view;
      break;
  }
  options.transfer.clear();
  options.unsaved_edits = request.unsaved_edits;
  checkInput(options, opening);
  if (!opening.left_out.empty()) options.state.clear();
  return opening;
}

}  // namespace emscape::view
