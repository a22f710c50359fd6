/// emscape-view: the window; started by `emscape view`.
#include <cstdio>
#include <exception>
#include <memory>
#include <optional>
#include <utility>

#include "apps/common/interrupt.h"
#include "apps/view/app.h"
#include "apps/view/files/message_log.h"
#include "apps/view/files/recordings.h"
#include "base/geodesy/gdal_environment.h"
#include "base/limits/address_limit.h"
#include "base/text/failure_text.h"
#include "emscape/base/cuda/device.h"
#include "emscape/base/error.h"
#include "emscape/base/log.h"
#include "emscape/base/parallel.h"
#include "emscape/emfield/columns/terrain_mesh.h"
#include "emscape/playback/frames/inputs.h"
#include "emscape/render/cells/cell_renderer.h"
#include "emscape/scenario/file/scenario_file.h"
#include "playback/series/series_scenario.h"

namespace emscape::view {
namespace {

int fail(ErrorCode code, const std::string& message) {
  std::fprintf(stderr, "emscape-view: error: %s\n", message.c_str());
  return static_cast<int>(code);
}

int tellSignal() {
  std::fprintf(stderr, "emscape-view: stopped by signal %d\n", app::caughtSignal());
  return 128 + app::caughtSignal();
}

void show(ViewOptions options) {
  const auto messages = std::make_shared<MessageLog>();  // for the window's list of warnings
  setLogSink([quiet = options.quiet, messages](LogLevel level, const std::string& line) {
    if (level == LogLevel::warning) messages->add(line);
    if (level == LogLevel::warning || (level == LogLevel::info && !quiet))
      std::fprintf(stderr, "%s\n", line.c_str());
  });
  setThreadLimit(options.threads);
  setDeviceLimit(options.devices);
  app::handleSignals();
  if (options.stream_request) {
    if (playback::inputKindOf(options.view.input) != playback::InputKind::scenario)
      throw Error(ErrorCode::usage, options.view.input + ": the objects of a stream are added to a scenario");
    options.stream = std::make_shared<playback::LiveBattlefield>(*options.stream_request, nullptr);
    options.made_of = options.view.input;
    options.view.input = options.stream->file();
    options.offers_kept_view = false;
  }
  if (!options.view.input.empty() &&
      playback::inputKindOf(options.view.input) == playback::InputKind::recording) {
    options.made_of = options.view.input;
    options.view.input = importRecordingFile(options.view.input, options.made_note);
    logInfo(options.made_note.text(true));
  }
  if (!options.view.input.empty()) playback::addOwnScenario(options.view);
  // A wrong name and all errors in a scenario are reported before a window appears.
  using playback::InputKind;
  const std::optional<InputKind> kind =
      options.view.input.empty() ? std::nullopt : std::optional(playback::inputKindOf(options.view.input));
  if (kind == InputKind::scenario) playback::requireScenarioFile(options.view.input);
  if (!options.view.mesh.empty()) {
    emfield::parseTerrainMesh(options.view.mesh);
    if (kind != InputKind::scenario) throw Error(ErrorCode::usage, "--mesh: INPUT must be a scenario");
  }
  if (!options.view.mesh.empty() || kind == InputKind::mesh) render::checkCellSettings(options.view.settings);
  if (kind == InputKind::scenario &&
      !scenario::parseScenario(options.view.input, options.view.edits).scenario) {
    scenario::loadScenario(options.view.input, options.view.edits);
  }
  // Opening a window takes long in the driver. Nothing is written yet but the recording of a stream.
  std::optional<app::EndAtInterrupts> at_once;
  if (!options.stream) at_once.emplace();
  app::stopIfInterrupted();
  App app(std::move(options), messages);  // a copy would keep the stream open after another input
  at_once.reset();
  app.run();
}

}  // namespace

int viewMain(int argc, char** argv) {
  spareAddresses();
  gdal::ignoreEnvironment();
  try {
    if (const std::optional<ViewOptions> options = parseOptions(argc, argv)) show(*options);
    return app::caughtSignal() == 0 ? 0 : tellSignal();
  } catch (const Stopped&) {
    return tellSignal();
  } catch (const Error& error) {
    return fail(error.code(), error.what());
  } catch (const std::exception& error) {
    return fail(ErrorCode::other, failureText(error));
  }
}

}  // namespace emscape::view

int main(int argc, char** argv) {
  return emscape::view::viewMain(argc, argv);
}
