#include "emscape/playback/autosave.h"

#include <sys/stat.h>

#include <cstdint>
#include <cstdlib>
#include <system_error>

#include "base/utc.h"
#include "document/text_file.h"
#include "emscape/base/error.h"
#include "playback/file_names.h"

namespace emscape::playback {
namespace {

namespace fs = std::filesystem;

/// When a file was written last, in milliseconds since 1970; none if there is no such file.
std::optional<std::int64_t> writtenAt_ms(const fs::path& file) {
  struct stat status {};
  if (stat(file.c_str(), &status) != 0) return std::nullopt;
  return std::int64_t{status.st_mtim.tv_sec} * 1000 + status.st_mtim.tv_nsec / 1000000;
}

}  // namespace

fs::path stateFolder() {
  // Relative paths are to be ignored (XDG Base Directory Specification).
  const char* state = std::getenv("XDG_STATE_HOME");
  if (state != nullptr && fs::path(state).is_absolute()) return fs::path(state) / "emscape";
  const char* home = std::getenv("HOME");
  if (home != nullptr && fs::path(home).is_absolute()) return fs::path(home) / ".local/state/emscape";
  throw Error(ErrorCode::other, "neither XDG_STATE_HOME nor HOME is set: there is no folder for autosaves");
}

fs::path autosaveFileOf(const std::string& input) {
  const fs::path path = fs::weakly_canonical(fs::absolute(input));
  document::ContentHash hash;
  hash.add(path.string());
  const fs::path name = path.has_filename() ? path : path.parent_path();
  return stateFolder() / "autosave" / (fileNameOf(name.stem().string()) + "-" + hash.hex() + ".view.json");
}

void autosave(const std::string& input, const ViewState& state) {
  const fs::path file = autosaveFileOf(input);
  std::error_code failure;
  fs::create_directories(file.parent_path(), failure);
  if (failure) {
    throw Error(ErrorCode::other, {file.parent_path().string(), 0, 0},
                "the folder cannot be made: " + failure.message());
  }
  writeViewState(file.string(), state);
}

std::optional<AutosavedView> findAutosave(const std::string& input) {
  const fs::path file = autosaveFileOf(input);
  const std::optional<std::int64_t> written_ms = writtenAt_ms(file);
  if (!written_ms) return std::nullopt;
  return AutosavedView{file, utcText(*written_ms), writtenAt_ms(input).value_or(0) > *written_ms,
                       readViewState(file.string())};
}

void removeAutosave(const std::string& input) {
  std::error_code ignored;
  fs::remove(autosaveFileOf(input), ignored);
}

}  // namespace emscape::playback
