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

std::vector<std::string> sourcesOfRecording(const std::string& file) {
  return {file, file + ".emitters.yaml"};
}

std::string importRecordingFile(const std::string& file, ImportNote& note) {
  const fs::path recording = fs::absolute(file).lexically_normal();
  const std::string stem = recording.filename().string().substr(0, recording.filename().string().find('.'));
  const std::size_t number = std::hash<std::string>()(recording.string());
  const fs::path folder = playback::stateFolder() / "imported" /
                          fmt::format("{}-{:016x}", stem.empty() ? "recording" : stem, number);
  makeFolder(folder);
  interop::ImportOptions options;
  options.scenario = (folder / ((stem.empty() ? "recording" : stem) + ".yaml")).string();
  options.replace = true;
  const std::string database = sourcesOfRecording(file).back();
  std::error_code ignored;
  if (fs::exists(database, ignored)) options.emitters = database;
  options.adds_silent_emitter = true;
  const interop::ImportResult result = [&] {
    try {
      return interop::importRecording(interop::readRecording(file), options);
    } catch (const Error& error) {
      if (error.message().find(" --") == std::string::npos) throw;
      throw Error(error.code(), error.location(), error.message() + " (options of `emscape import`)");
    }
  }();
  int unmatched = 0;
  for (const interop::ImportedEmitters& use : result.emitters) unmatched += use.fault.empty() ? 0 : use.count;
  const std::string known = options.emitters.empty() ? "" : fs::path(database).filename().string();
  const std::string source = known.empty() ? "the starter set" : known;
  note.platforms = fmt::format("{}: {}", recording.filename().string(),
                               countText(result.platforms.size(), "platform", "platforms"));
  if (result.silent_emitter.empty()) {
    note.platforms +=
        ", emitters of " + source +
        (known.empty() ? " (nominal values of a kind of radar, without a source)" : std::string());
  } else {
    note.silence = fmt::format(
        ", without an emitter, as {} has none for {}: switch on '{}' in What if, or add others there or by a "
        "right click in the picture",
        source, result.platforms.size() == 1 ? "it" : "them", result.silent_emitter);
  }
  note.rest = fmt::format(
      "{}; over flat land at mean sea level; `emscape import` has further options (emitters, terrain, "
      "region, a base)",
      unmatched > 0 ? fmt::format(", {} left out", countText(unmatched, "beam", "beams")) : "");
  return options.scenario;
}

}  // namespace emscape::view
