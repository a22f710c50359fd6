#include "emscape/volume/format/file.h"

#include <algorithm>
#include <cctype>
#include <set>
#include <tuple>

#include "base/files/inputs.h"
#include "volume/format/raw.h"
#include "volume/format/vdb.h"
#include "volume/nvdb/nvdb.h"
#include "volume/stored_range.h"
#include "volume/vtk/vti.h"

namespace emscape::volume {
namespace fs = std::filesystem;
namespace {

using Volumes = std::vector<const DenseVolume*>;

struct Format {
  FileFormat about;
  void (*write)(const fs::path& path, const Volumes& volumes);
  DenseVolume (*read)(const fs::path& path, const std::string& name);
  std::vector<DenseVolume> (*describe)(const fs::path& path);
  void (*set_range)(const fs::path& path, const std::vector<StoredRange>& ranges);
};

/// For files with one volume: checks the name, if given.
DenseVolume named(DenseVolume volume, const fs::path& path, const std::string& name) {
  if (!name.empty() && volume.info.quantity != name) {
    throw Error(ErrorCode::bad_input, {path.string()},
                "no volume \"" + name + "\"; the file holds " + volume.info.quantity);
  }
  return volume;
}

std::vector<DenseVolume> listOf(DenseVolume volume) {
  volume.first_valid_k = {};
  std::vector<DenseVolume> list;
  list.push_back(std::move(volume));
  return list;
}

const std::vector<Format>& formats() {
  static const std::vector<Format> kFormats = {
      {{"vdb", true, true}, writeVdb, readVdb, describeVdb, setVdbRange},
      {{"nvdb", true, true}, writeNvdb, readNvdb, describeNvdb, setNvdbRange},
      {{"vti", true, true}, writeVti, readVti, describeVti, setVtiRange},
      {{"raw", true, false},
       [](const fs::path& path, const Volumes& volumes) { writeRaw(path, *volumes.front()); },
       [](const fs::path& path, const std::string& name) { return named(readRaw(path), path, name); },
       [](const fs::path& path) { return listOf(describeRaw(path)); },
       setRawRange},
      {{"dat", false, false},
       nullptr,
       [](const fs::path& path, const std::string& name) { return named(readDat(path), path, name); },
       [](const fs::path& path) { return listOf(describeDat(path)); },
       nullptr},
  };
  return kFormats;
}

const Format* findFormat(const fs::path& path) {
  std::string ending = path.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  for (const Format& format : formats()) {
    if (ending == "." + format.about.name) return &format;
  }
  return nullptr;
}

/// @param to_write  the message lists only the formats that can be written
const Format& requireFormat(const fs::path& path, bool to_write = false) {
  if (const Format* format = findFormat(path)) return *format;
  std::string known;
  for (const Format& format : formats()) {
    if (format.about.writable || !to_write) known += (known.empty() ? "." : ", .") + format.about.name;
  }
  throw Error(ErrorCode::bad_input, {path.string()}, "no volume file by its ending; known are " + known);
}

/// NAME_ and the number of NAME_NNNN; the whole stem and -1 for names of another form.
struct SeriesName {
  explicit SeriesName(const fs::path& path) : base(path.stem().string()) {
    constexpr std::size_t kMinDigits = 4, kMaxDigits = 9;
    const std::size_t before = base.find_last_not_of("0123456789");
    if (before == std::string::npos || base[before] != '_') return;
    const std::size_t digits = base.size() - before - 1;
    if (digits < kMinDigits || digits > kMaxDigits) return;
    number = std::stoi(base.substr(before + 1));
    base.erase(before + 1);
  }
  bool operator<(const SeriesName& other) const {
    return std::tie(base, number) < std::tie(other.base, other.number);
  }

  std::string base;
  int number = -1;
};

std::vector<fs::path> sorted(std::vector<fs::path> files) {
  std::sort(files.begin(), files.end());
  std::stable_sort(files.begin(), files.end(),
                   [](const fs::path& a, const fs::path& b) { return SeriesName(a) < SeriesName(b); });
  return files;
}

std::vector<fs::path> filesOfFolder(const fs::path& folder) {
  for (const Format& format : formats()) {
    std::vector<fs::path> files;
    for (const fs::directory_entry& entry : entriesOf(folder)) {
      std::error_code ignored;  // as of a link to itself
      if (entry.is_regular_file(ignored) && findFormat(entry.path()) == &format)
        files.push_back(entry.path());
    }
    if (!files.empty()) return sorted(std::move(files));
  }
  throw Error(ErrorCode::bad_input, {folder.string()}, "the folder has no volume file");
}

/// The files in the folder of a numbered one that differ from it only in the number.
std::vector<fs::path> numberedFiles(const fs::path& path) {
  requireFormat(path);
  if (!inputExists(path)) throw Error(ErrorCode::bad_input, {path.string()}, "there is no such file");
  const SeriesName own(path);
  if (own.number < 0) return {path};
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : entriesOf(path.has_parent_path() ? path.parent_path() : ".")) {
    const SeriesName name(entry.path());
    const bool sibling =
        entry.path().extension() == path.extension() && name.base == own.base && name.number >= 0;
    if (sibling) files.push_back(path.parent_path() / entry.path().filename());
  }
  return sorted(std::move(files));
}

}  // namespace

const std::vector<FileFormat>& fileFormats() {
  static const std::vector<FileFormat> kAbout = [] {
    std::vector<FileFormat> about;
    for (const Format& format : formats()) about.push_back(format.about);
    return about;
  }();
  return kAbout;
}

const FileFormat& formatOf(const fs::path& path) {
  return requireFormat(path).about;
}

bool isVolumeFile(const fs::path& path) {
  return findFormat(path) != nullptr;
}

void writeVolumes(const fs::path& path, const Volumes& volumes) {
  const Format& format = requireFormat(path, true);
  const auto fail = [&](const std::string& what) {
    throw Error(ErrorCode::bad_input, {path.string()}, what);
  };
  if (!format.about.writable) fail("." + format.about.name + " files are read, not written");
  if (volumes.empty()) fail("no volume to write");
  if (volumes.size() > 1 && !format.about.several) {
    fail("a ." + format.about.name + " file holds one volume, not " + std::to_string(volumes.size()));
  }
  std::set<std::string> quantities;
  for (const DenseVolume* volume : volumes) {
    if (!quantities.insert(volume->info.quantity).second) fail("two volumes of " + volume->info.quantity);
  }
  format.write(path, volumes);
}

DenseVolume readVolume(const fs::path& path, const std::string& name) {
  return requireFormat(path).read(path, name);
}

void setStoredRange(const fs::path& path, const std::vector<StoredRange>& ranges) {
  const Format& format = requireFormat(path);
  if (format.set_range == nullptr) {
    throw Error(ErrorCode::bad_input, {path.string()},
                "." + format.about.name + " files are read, not written");
  }
  format.set_range(path, ranges);
}

FileListing listVolume(const fs::path& path) {
  const Format& format = requireFormat(path);
  FileListing listing{format.about.name, 0, format.describe(path)};
  listing.bytes = fs::file_size(path);
  return listing;
}

fs::path seriesFile(const fs::path& folder, const std::string& name, int number, const std::string& format) {
  std::string digits = std::to_string(number);
  digits.insert(0, digits.size() < 4 ? 4 - digits.size() : 0, '0');
  return folder / (name + "_" + digits + "." + format);
}

std::vector<SeriesStep> seriesSteps(const fs::path& path) {
  std::vector<SeriesStep> steps;
  if (path.extension() == ".pvd" && !fs::is_directory(path)) {
    for (const PvdEntry& entry : readPvd(path)) steps.push_back({entry.file, entry.time_s});
    std::stable_sort(steps.begin(), steps.end(),
                     [](const SeriesStep& a, const SeriesStep& b) { return a.time_s < b.time_s; });
    return steps;
  }
  for (const fs::path& file : fs::is_directory(path) ? filesOfFolder(path) : numberedFiles(path)) {
    steps.push_back({file, std::nullopt});
  }
  return steps;
}

std::vector<fs::path> seriesOf(const fs::path& path) {
  std::vector<fs::path> files;
  for (const SeriesStep& step : seriesSteps(path)) files.push_back(step.file);
  return files;
}

}  // namespace emscape::volume
