/// Volumes on disk as a series.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace emscape::playback {

/// One instant of a series on disk.
struct VolumeFile {
  std::filesystem::path file;
  double time_s = 0;
};

/// One volume file, the steps of a .pvd, or the volumes of a folder, in the order of time.
/// @param quantity  only files with it; empty: set to the first quantity of the first file
/// @throws Error (bad_input)
std::vector<VolumeFile> volumeFilesOf(const std::filesystem::path& path, std::string& quantity);

}  // namespace emscape::playback
