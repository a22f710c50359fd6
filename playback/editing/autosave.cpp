#include "playback/editing/autosave.h"

#include <sys/stat.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <system_error>
#include <utility>
#include <vector>

#include "base/files/folder.h"
#include "base/files/folder_lock.h"
#include "base/text/utc.h"
#include "document/text_file.h"
#include "emscape/base/error.h"
#include "playback/series/file_names.h"

namespace emscape::playback {
namespace {

namespace fs = std::filesystem;

/// Limit of files per input: of programs that run at the same time or ended abnormally.
constexpr int kMaxFiles = 32;

/// Time at which a file was last written, in milliseconds since 1970; empty if there is no such file.
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

fs::path autosaveFileOf(const std::string& input, int number) {
  const fs::path path = fs::weakly_canonical(fs::absolute(input));
  document::ContentHash hash;
  hash.add(path.string());
  const fs::path name = path.has_filename() ? path : path.parent_path();
  const std::string suffix = number == 1 ? "" : "-" + std::to_string(number);
  return stateFolder() / "autosave" /
         (fileNameOf(name.stem().string()) + "-" + hash.hex() + suffix + ".view.json");
}

Autosaves::Autosaves() = default;
Autosaves::~Autosaves() = default;

bool Autosaves::claim(Claims& claims, const std::string& input, const fs::path& file) {
  auto lock = FolderLock::tryLock(file.parent_path(), file.filename().string() + ".lock");
  if (lock == nullptr) return false;
  claims[autosaveFileOf(input)] = {file, std::move(lock)};
  return true;
}

void Autosaves::keep(const std::string& input, const ViewState& state) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const fs::path first = autosaveFileOf(input);
  makeFolder(first.parent_path());
  for (int number = 1; stored_.count(first) == 0; ++number) {
    if (number > kMaxFiles) {
      throw Error(ErrorCode::other, {first.string(), 0, 0},
                  "the view cannot be stored: all autosave files are in use");
    }
    const fs::path file = autosaveFileOf(input, number);
    if (!writtenAt_ms(file)) claim(stored_, input, file);
  }
  writeViewState(stored_[first].file.string(), state);
}

std::optional<AutosavedView> Autosaves::find(const std::string& input,
                                             const std::vector<std::string>& sources) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const fs::path first = autosaveFileOf(input);
  const auto own = stored_.find(first);
  if (own != stored_.end()) {  // of an earlier session of this program; what that one found stays
    found_[first] = std::move(own->second);
    stored_.erase(own);
  }
  std::vector<std::pair<std::int64_t, fs::path>> files;
  for (int number = 1; number <= kMaxFiles; ++number) {
    const fs::path file = autosaveFileOf(input, number);
    if (const auto written_ms = writtenAt_ms(file)) files.emplace_back(*written_ms, file);
  }
  std::sort(files.rbegin(), files.rend());
  int others = 0;
  for (const auto& [written_ms, file] : files) {
    const auto claimed = found_.find(first);
    if (claimed == found_.end()) {
      claim(found_, input, file);
    } else if (claimed->second.file != file) {
      others += FolderLock::tryLock(file.parent_path(), file.filename().string() + ".lock") ? 1 : 0;
    }
  }
  const auto found = found_.find(first);
  if (found == found_.end()) return std::nullopt;
  const fs::path& file = found->second.file;
  const std::optional<std::int64_t> written_ms = writtenAt_ms(file);
  if (!written_ms) return std::nullopt;
  const bool has_changed = std::any_of(sources.begin(), sources.end(), [&](const std::string& source) {
    return writtenAt_ms(source).value_or(0) > *written_ms;
  });
  return AutosavedView{file, utcText(*written_ms), has_changed, others, readViewState(file.string())};
}

void Autosaves::adopt(const std::string& input) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const fs::path first = autosaveFileOf(input);
  const auto found = found_.find(first);
  if (found == found_.end()) return;
  // What was stored before is found next: it stays until it is adopted or discarded.
  const auto stored = stored_.find(first);
  if (stored == stored_.end()) {
    stored_[first] = std::move(found->second);
    found_.erase(found);
  } else {
    std::swap(stored->second, found->second);
  }
}

void Autosaves::discard(const std::string& input) {
  const std::lock_guard<std::mutex> lock(mutex_);
  removeFrom(found_, input);
}

void Autosaves::remove(const std::string& input) {
  const std::lock_guard<std::mutex> lock(mutex_);
  removeFrom(stored_, input);
}

void Autosaves::removeFrom(Claims& claims, const std::string& input) {
  const auto claimed = claims.find(autosaveFileOf(input));
  if (claimed == claims.end()) return;
  std::error_code ignored;
  fs::remove(claimed->second.file, ignored);
  claims.erase(claimed);
}

}  // namespace emscape::playback
