/// Volumes on disk as a series.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "emscape/scenario/model/clock.h"

namespace emscape::playback {

/// One instant of a series on disk.
struct VolumeFile {
  std::filesystem::path file;
  double time_s = 0;     ///< of the file; of the list (.pvd) for a file without a time
  bool has_time = true;  ///< false: neither states it
  std::string time_utc;  ///< as the file has it; may be empty
};

/// One volume file, the steps of a .pvd, or the volumes of a folder, in the order of time.
/// @param quantity  only files that contain it; empty: set to the first quantity of the first file
/// @param all       null, or receives all quantities of the files
/// @throws Error (bad_input)
std::vector<VolumeFile> volumeFilesOf(const std::filesystem::path& path, std::string& quantity,
                                      std::vector<std::string>* all = nullptr);

/// True for a .vtu file, a .pvd that lists .vtu files, and a folder with .vtu files and no volumes.
bool holdsMeshes(const std::filesystem::path& path);
/// volumeFilesOf() for an input for which holdsMeshes().
std::vector<VolumeFile> meshFilesOf(const std::filesystem::path& path, std::string& quantity,
                                    std::vector<std::string>* all = nullptr);

/// The files of an input of volumes or meshes, of all quantities. Only a list (.pvd) is read.
/// @throws Error (bad_input)
std::vector<std::filesystem::path> stepFilesOf(const std::filesystem::path& path);

/// A warning if a folder has volumes of other names in other formats than the one that is shown; else empty.
std::string otherFormatsText(const std::filesystem::path& path);

/// The time line of files, for times on the command line without a step. @param files  as chosenFiles()
scenario::Clock clockOf(const std::vector<VolumeFile>& files);

/// The files nearest to the times of a selection. @param files  ascending, at least one
/// @param times  "BEGIN:END:STEP", "BEGIN:END" or "T" (s); empty: all @param first_only  only the first
/// @throws Error (usage)
std::vector<VolumeFile> chosenFiles(std::vector<VolumeFile> files, const std::string& times, bool first_only);

}  // namespace emscape::playback
