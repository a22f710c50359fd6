#include "apps/view/files/recordings.h"

#include <fmt/format.h>

#include <filesystem>
#include <functional>

#include "base/files/folder.h"
#include "base/text/count_text.h"
#include "emscape/base/error.h"
#include "interop/import_scenario.h"
#include "playback/editing/autosave.h"
#include "recording/read_recording.h"

namespace emscape::view {

namespace fs = std::filesystem;

std::string importRecordingFile(const std::string& file, std::string& note) {
  const fs::path recording = fs::absolute(file).lexically_normal();
  const std::string stem = recording.filename().string().substr(0, recording.filename().string().find('.'));
  const std::size_t number = std::hash<std::string>()(recording.string());
  const fs::path folder = playback::stateFolder() / "imported" /
                          fmt::format("{}-{:016x}", stem.empty() ? "recording" : stem, number);
  makeFolder(folder);
  interop::ImportOptions options;
  options.scenario = (folder / ((stem.empty() ? "recording" : stem) + ".yaml")).string();
  options.replace = true;
  const std::string database = file + ".emitters.yaml";
  std::error_code ignored;
  if (fs::exists(database, ignored)) options.emitters = database;
  const interop::ImportResult result = [&] {
    const auto recorded = interop::readRecording(file);
    try {
      return interop::importRecording(recorded, options);
    } catch (const Error& error) {
      if (error.message().rfind("no emitter is left", 0) != 0) throw;
      const std::string known =
          options.emitters.empty() ? "the starter set" : fs::path(options.emitters).filename().string();
      throw Error(
          error.code(), error.location(),
          fmt::format(
              "no object of the recording has an emitter in {}. The window makes emitters by the "
              "file {}, if there is one (docs/battlefield.md tells what it contains); tracks "
              "without emitters belong into a scenario: platforms: [{{name: ..., track: {{file: {}}}}}]",
              known, database, recording.filename().string()));
    }
  }();
  int unmatched = 0;
  for (const interop::ImportedEmitters& use : result.emitters) unmatched += use.fault.empty() ? 0 : use.count;
  note = fmt::format(
      "{}: {}, emitters of {}{}, over flat land at mean sea level; `emscape import` has further "
      "options (emitters, terrain, region)",
      recording.filename().string(), countText(result.platforms.size(), "platform", "platforms"),
      options.emitters.empty() ? "the starter set (nominal values of a kind of radar, without a source)"
                               : fs::path(database).filename().string(),
      unmatched > 0 ? fmt::format(", {} left out", countText(unmatched, "beam", "beams")) : "");
  return options.scenario;
}

}  // namespace emscape::view
