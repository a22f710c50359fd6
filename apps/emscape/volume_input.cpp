#include "apps/emscape/volume_input.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <filesystem>

#include "base/error.h"
#include "base/whole_file.h"
#include "volume/raw.h"
#include "volume/vdb.h"

namespace emscape::app {
namespace {

namespace fs = std::filesystem;

/// A file format: its ending and how it is read.
struct Format {
  const char* ending;
  std::vector<volume::DenseVolume> (*describe)(const fs::path&);
  volume::DenseVolume (*read)(const fs::path&, const std::string& quantity);
};

volume::DenseVolume checkQuantity(volume::DenseVolume volume, const fs::path& file,
                                  const std::string& quantity) {
  if (!quantity.empty() && volume.info.quantity != quantity) {
    throw Error(ErrorCode::bad_input, {file.string(), 0, 0},
                fmt::format("holds no '{}', but '{}'", quantity, volume.info.quantity));
  }
  return volume;
}

// In the order in which a folder is searched.
const std::array<Format, 3> kFormats{{
    {".vdb", volume::describeVdb, volume::readVdb},
    {".raw", [](const fs::path& file) { return std::vector<volume::DenseVolume>{volume::describeRaw(file)}; },
     [](const fs::path& file, const std::string& quantity) {
       return checkQuantity(volume::readRaw(file), file, quantity);
     }},
    {".dat", [](const fs::path& file) { return std::vector<volume::DenseVolume>{volume::describeDat(file)}; },
     [](const fs::path& file, const std::string& quantity) {
       return checkQuantity(volume::readDat(file), file, quantity);
     }},
}};

const Format& formatOf(const fs::path& file) {
  const auto format = std::find_if(kFormats.begin(), kFormats.end(), [&file](const Format& candidate) {
    return file.extension() == candidate.ending;
  });
  if (format == kFormats.end()) {
    throw Error(ErrorCode::bad_input, {file.string(), 0, 0}, "not a volume file that can be read");
  }
  return *format;
}

/// The files of the first format that the folder has.
std::vector<fs::path> volumesIn(const fs::path& folder) {
  for (const Format& format : kFormats) {
    std::vector<fs::path> files;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
      if (entry.is_regular_file() && entry.path().extension() == format.ending) files.push_back(entry.path());
    }
    if (files.empty()) continue;
    std::sort(files.begin(), files.end());
    return files;
  }
  throw Error(ErrorCode::bad_input, {folder.string(), 0, 0}, "the folder holds no volumes");
}

}  // namespace

std::vector<VolumeFile> seriesOf(const std::string& path, std::string& quantity) {
  const std::vector<fs::path> files = fs::is_directory(path) ? volumesIn(path) : std::vector<fs::path>{path};
  std::vector<VolumeFile> series;
  for (const fs::path& file : files) {
    for (const volume::DenseVolume& volume : describeVolumes(file.string())) {
      if (quantity.empty()) quantity = volume.info.quantity;
      if (volume.info.quantity == quantity) series.push_back({file.string(), volume.info.time_s});
    }
  }
  if (series.empty()) {
    throw Error(ErrorCode::bad_input, {path, 0, 0},
                fmt::format("there is no volume of '{}'; see 'emscape info'", quantity));
  }
  std::stable_sort(series.begin(), series.end(),
                   [](const VolumeFile& a, const VolumeFile& b) { return a.time_s < b.time_s; });
  return series;
}

std::vector<volume::DenseVolume> describeVolumes(const std::string& file) {
  return formatOf(file).describe(file);
}

volume::DenseVolume readVolume(const std::string& file, const std::string& quantity) {
  return formatOf(file).read(file, quantity);
}

}  // namespace emscape::app
