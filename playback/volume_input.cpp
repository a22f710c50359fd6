#include "emscape/playback/volume_input.h"

#include <algorithm>

#include "emscape/base/error.h"
#include "emscape/volume/file.h"

namespace emscape::playback {

std::vector<VolumeFile> volumeFilesOf(const std::filesystem::path& path, std::string& quantity) {
  const bool is_series = std::filesystem::is_directory(path) || path.extension() == ".pvd";
  std::vector<VolumeFile> files;
  for (const auto& file : is_series ? volume::seriesOf(path) : std::vector<std::filesystem::path>{path}) {
    for (const volume::DenseVolume& volume : volume::listVolume(file).volumes) {
      if (quantity.empty()) quantity = volume.info.quantity;
      if (volume.info.quantity == quantity) files.push_back({file, volume.info.time_s});
    }
  }
  if (files.empty()) {
    throw Error(ErrorCode::bad_input, {path.string(), 0, 0}, "there is no volume of '" + quantity + "'");
  }
  std::stable_sort(files.begin(), files.end(),
                   [](const VolumeFile& a, const VolumeFile& b) { return a.time_s < b.time_s; });
  return files;
}

}  // namespace emscape::playback
