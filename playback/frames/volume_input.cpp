#include "playback/frames/volume_input.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <set>

#include "base/files/inputs.h"
#include "base/text/utc.h"
#include "emscape/base/error.h"
#include "emscape/scenario/model/clock.h"
#include "emscape/volume/format/file.h"
#include "volume/mesh/mesh_file.h"

namespace emscape::playback {
namespace {

namespace fs = std::filesystem;

/// The files of one quantity, by time, out of all volumes or fields of an input.
class FilesOfQuantity {
 public:
  /// @param quantity  empty: receives the first that is added
  explicit FilesOfQuantity(std::string& quantity) : quantity_(quantity) {}

  void add(const volume::SeriesStep& step, const volume::VolumeInfo& info) {
    if (quantity_.empty()) quantity_ = info.quantity;
    const double time_s = info.has_time ? info.time_s : step.time_s.value_or(info.time_s);
    if (info.quantity == quantity_) {
      files_.push_back({step.file, time_s, info.has_time || step.time_s.has_value(), info.time_utc});
    }
    if (std::find(found_.begin(), found_.end(), info.quantity) == found_.end())
      found_.push_back(info.quantity);
  }

  /// @param all  as for volumeFilesOf()
  /// @throws Error (bad_input) with the quantities that the input has
  std::vector<VolumeFile> sorted(const fs::path& path, std::vector<std::string>* all) {
    if (all) *all = found_;
    if (files_.empty()) {
      throw Error(ErrorCode::bad_input, {path.string(), 0, 0},
                  found_.empty() ? "there is no volume"
                                 : fmt::format("there is no volume of '{}'; there are volumes of {}",
                                               quantity_, fmt::join(found_, ", ")));
    }
    std::stable_sort(files_.begin(), files_.end(),
                     [](const VolumeFile& a, const VolumeFile& b) { return a.time_s < b.time_s; });
    return std::move(files_);
  }

 private:
  std::string& quantity_;
  std::vector<std::string> found_;
  std::vector<VolumeFile> files_;
};

/// A volume file, the steps of a list, or the volumes of a folder.
std::vector<volume::SeriesStep> volumesOf(const fs::path& path) {
  if (fs::is_directory(path) || path.extension() == ".pvd") return volume::seriesSteps(path);
  return {{path, std::nullopt}};
}

/// The .vtu files of a folder by name, or of a list.
std::vector<volume::SeriesStep> meshesOf(const fs::path& path) {
  if (path.extension() == ".pvd") return volume::seriesSteps(path);
  if (!fs::is_directory(path)) return {{path, std::nullopt}};
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : entriesOf(path)) {
    std::error_code ignored;  // as of a link to itself
    if (entry.is_regular_file(ignored) && volume::isMeshFile(entry.path())) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  std::vector<volume::SeriesStep> steps;
  for (const fs::path& file : files) steps.push_back({file, std::nullopt});
  return steps;
}

}  // namespace

std::vector<VolumeFile> volumeFilesOf(const fs::path& path, std::string& quantity,
                                      std::vector<std::string>* all) {
  FilesOfQuantity files(quantity);
  for (const volume::SeriesStep& step : volumesOf(path)) {
    for (const volume::DenseVolume& volume : volume::listVolume(step.file).volumes)
      files.add(step, volume.info);
  }
  return files.sorted(path, all);
}

bool holdsMeshes(const fs::path& path) {
  if (volume::isMeshFile(path)) return true;
  if (path.extension() == ".pvd") {
    try {
      return volume::isMeshFile(volume::seriesOf(path).front());
    } catch (const Error&) {
      return false;  // the fault is reported when the file is read
    }
  }
  if (!fs::is_directory(path)) return false;
  bool has_meshes = false;
  for (const fs::directory_entry& entry : entriesOf(path)) {
    if (volume::isVolumeFile(entry.path())) return false;
    has_meshes = has_meshes || volume::isMeshFile(entry.path());
  }
  return has_meshes;
}

std::vector<fs::path> stepFilesOf(const fs::path& path) {
  std::vector<fs::path> files;
  for (const volume::SeriesStep& step : holdsMeshes(path) ? meshesOf(path) : volumesOf(path))
    files.push_back(step.file);
  return files;
}

std::string otherFormatsText(const fs::path& path) {
  constexpr std::size_t kMaxNames = 3;
  if (!fs::is_directory(path) || holdsMeshes(path)) return "";
  const std::vector<fs::path> shown = stepFilesOf(path);
  std::set<std::string> stems, others;
  for (const fs::path& file : shown) stems.insert(file.stem().string());
  for (const fs::directory_entry& entry : entriesOf(path)) {
    const fs::path file = entry.path();
    const bool is_other = volume::isVolumeFile(file) && file.extension() != shown.front().extension() &&
                          stems.count(file.stem().string()) == 0;
    if (is_other) others.insert(file.filename().string());
  }
  if (others.empty()) return "";
  std::string names;
  for (const std::string& name : others) names += (names.empty() ? "" : ", ") + name;
  if (others.size() > kMaxNames) names = fmt::format("{} and {} more", *others.begin(), others.size() - 1);
  return fmt::format("{}: the {} files are shown; not shown: {}. Open such a file to see it", path.string(),
                     shown.front().extension().string(), names);
}

std::vector<VolumeFile> meshFilesOf(const fs::path& path, std::string& quantity,
                                    std::vector<std::string>* all) {
  FilesOfQuantity files(quantity);
  for (const volume::SeriesStep& step : meshesOf(path)) {
    for (const volume::VolumeInfo& info : volume::listMesh(step.file)) files.add(step, info);
  }
  return files.sorted(path, all);
}

scenario::Clock clockOf(const std::vector<VolumeFile>& files) {
  scenario::Clock clock;
  clock.duration_s = files.back().time_s;
  if (files.size() > 1)
    clock.step_s = (files.back().time_s - files.front().time_s) / static_cast<double>(files.size() - 1);
  if (clock.step_s <= 0) clock.step_s = 1;
  const VolumeFile& first = files.front();
  if (const std::optional<std::int64_t> first_ms = parseUtc_ms(first.time_utc))
    clock.epoch_utc = utcText(*first_ms - std::llround(first.time_s * 1000));
  return clock;
}

std::vector<VolumeFile> chosenFiles(std::vector<VolumeFile> files, const std::string& times,
                                    bool first_only) {
  if (first_only) files.resize(1);
  if (first_only || times.empty()) return files;
  std::vector<VolumeFile> chosen;
  for (const double time_s : scenario::parseTimes(times, clockOf(files), volume::kMaxTime_s)) {
    chosen.push_back(
        *std::min_element(files.begin(), files.end(), [time_s](const VolumeFile& a, const VolumeFile& b) {
          return std::abs(a.time_s - time_s) < std::abs(b.time_s - time_s);
        }));
  }
  return chosen;
}

}  // namespace emscape::playback
