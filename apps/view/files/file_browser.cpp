#include "apps/view/files/file_browser.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <initializer_list>
#include <utility>

#include "base/text/failure_text.h"
#include "emscape/base/error.h"
#include "emscape/playback/frames/inputs.h"

namespace emscape::view {
namespace {

namespace fs = std::filesystem;

std::string lowerCase(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

bool endsWith(const std::string& text, const std::string& ending) {
  return text.size() > ending.size() && text.compare(text.size() - ending.size(), ending.size(), ending) == 0;
}

/// Sorts folders first, then by name, ignoring case.
bool comesBefore(const FolderEntry& a, const FolderEntry& b) {
  const bool a_is_folder = a.kind == FileKind::folder, b_is_folder = b.kind == FileKind::folder;
  if (a_is_folder != b_is_folder) return a_is_folder;
  const std::string a_name = lowerCase(a.name), b_name = lowerCase(b.name);
  return a_name != b_name ? a_name < b_name : a.name < b.name;
}

bool mayChoose(FileBrowser::Purpose purpose, FileKind kind) {
  if (kind == FileKind::folder) return true;
  switch (purpose) {
    case FileBrowser::Purpose::input:
      return kind != FileKind::image && kind != FileKind::places;
    case FileBrowser::Purpose::colors:
    case FileBrowser::Purpose::save_colors:
      return kind == FileKind::colors;
    case FileBrowser::Purpose::drape:
      return kind == FileKind::image;
    case FileBrowser::Purpose::places:
      return kind == FileKind::places || kind == FileKind::places_or_tracks;
    case FileBrowser::Purpose::view:
      return kind == FileKind::view;
    case FileBrowser::Purpose::scenario:
    case FileBrowser::Purpose::save_scenario:
      return kind == FileKind::scenario;
    case FileBrowser::Purpose::record:
      break;
  }
  return false;
}

/// The path in a typed text, as file managers and shells give it: without blanks and quotes about it.
std::string pathIn(const std::string& typed) {
  const std::size_t begin = typed.find_first_not_of(" \t\r\n"), end = typed.find_last_not_of(" \t\r\n");
  if (begin == std::string::npos) return "";
  const std::string text = typed.substr(begin, end + 1 - begin);
  const bool is_quoted =
      text.size() > 2 && (text.front() == '"' || text.front() == '\'') && text.back() == text.front();
  return is_quoted ? text.substr(1, text.size() - 2) : text;
}

}  // namespace

FileKind fileKindOf(const fs::path& file, bool is_folder) {
  if (is_folder) return FileKind::folder;
  const std::string name = lowerCase(file.filename().string());
  const auto hasOneOf = [&](std::initializer_list<const char*> endings) {
    return std::any_of(endings.begin(), endings.end(), [&](const char* end) { return endsWith(name, end); });
  };
  if (endsWith(name, ".view.json")) return FileKind::view;
  if (endsWith(name, ".transfer.json")) return FileKind::colors;
  if (hasOneOf({".tif", ".tiff", ".mbtiles", ".vrt", ".png", ".jpg", ".jpeg"})) return FileKind::image;
  if (hasOneOf({".geojson", ".gpkg", ".shp", ".gml"})) return FileKind::places;
  if (endsWith(name, ".kml")) return FileKind::places_or_tracks;
  try {
    switch (playback::inputKindOf(file.string())) {
      case playback::InputKind::scenario:
        return FileKind::scenario;
      case playback::InputKind::volume:
      case playback::InputKind::mesh:
        return FileKind::volume;
      case playback::InputKind::recording:
        return FileKind::recording;
      default:
        return FileKind::other;
    }
  } catch (const Error&) {
    return FileKind::other;
  }
}

std::vector<FolderEntry> listFolder(const fs::path& folder) {
  std::vector<FolderEntry> entries;
  std::error_code failure;
  for (fs::directory_iterator at(folder, failure), end; !failure && at != end; at.increment(failure)) {
    const std::string name = at->path().filename().string();
    if (name.empty() || name.front() == '.') continue;
    std::error_code ignored;
    const FileKind kind = fileKindOf(at->path(), at->is_directory(ignored));
    if (kind != FileKind::other) entries.push_back({name, kind});
  }
  if (failure) {
    throw Error(ErrorCode::other, {folder.string(), 0, 0}, "the folder cannot be read: " + failure.message());
  }
  std::sort(entries.begin(), entries.end(), comesBefore);
  return entries;
}

void FileBrowser::open(Purpose purpose, const fs::path& first_folder, const std::string& proposed) {
  purpose_ = purpose;
  proposed_ = proposed;
  if (std::exchange(begins_anew_, false)) folder_.clear();
  if (folder_.empty()) folder_ = first_folder.empty() ? fs::path(".") : first_folder;
  std::error_code ignored;
  const fs::path absolute = fs::weakly_canonical(fs::absolute(folder_, ignored), ignored);
  enter(absolute.empty() ? folder_ : absolute);
}

void FileBrowser::enter(const fs::path& folder) {
  left_ = folder == folder_.parent_path() && folder != folder_ ? folder_.filename().string() : "";
  folder_ = folder;
  if (task_.active()) {
    again_ = true;
  } else {
    read();
  }
}

void FileBrowser::read() {
  again_ = false;
  task_.start([folder = folder_]() -> Listing {
    try {
      return {folder, listFolder(folder), ""};
    } catch (const std::exception& error) {
      return {folder, {}, failureText(error)};
    }
  });
}

bool FileBrowser::update() {
  if (!task_.done()) return false;
  const Listing listing = task_.take();
  if (again_) {
    read();
    return true;
  }
  entries_.clear();
  for (const FolderEntry& entry : listing.entries) {
    if (mayChoose(purpose_, entry.kind)) entries_.push_back(entry);
  }
  error_ = listing.error;
  selected_ = 0;
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    if (entries_[i].name == left_) selected_ = static_cast<int>(i);
  }
  return true;
}

void FileBrowser::select(int index) {
  selected_ = std::max(0, std::min(index, static_cast<int>(entries_.size()) - 1));
}

std::optional<std::string> FileBrowser::choose() {
  if (entries_.empty()) return std::nullopt;
  return choose(entries_[static_cast<std::size_t>(selected_)].name);
}

std::optional<std::string> FileBrowser::choose(const std::string& typed) {
  refused_.clear();
  std::string text = pathIn(typed);
  if (text.empty()) return std::nullopt;
  const char* home = std::getenv("HOME");
  if (home != nullptr && text.front() == '~' && (text.size() == 1 || text[1] == '/')) {
    text = home + text.substr(1);
  }
  const fs::path path = (folder_ / text).lexically_normal();
  std::error_code ignored;
  const bool exists = savesFile() ? fs::is_directory(path.parent_path(), ignored) : fs::exists(path, ignored);
  if (!exists && purpose_ != Purpose::record) {
    refused_ = typed;
    return std::nullopt;
  }
  if (!fs::is_directory(path, ignored)) return path.string();
  enter(path.has_filename() ? path : path.parent_path());
  return std::nullopt;
}

}  // namespace emscape::view
