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
      const bool lacks_database =
          options.emitters.empty() && error.message().find("--emitters") != std::string::npos;
      if (!lacks_database) throw;
      throw Error(error.code(), error.location(),
                  error.message() + "; the window reads the database " + database);
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
