/// One door to all volume files: the format follows from the name's ending.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "emscape/volume/dense_volume.h"

namespace emscape::volume {

/// A format and what it can do.
struct FileFormat {
  std::string name;  ///< as on the command line, for example "vdb"; files end in "." and the name
  bool writable = true;
  bool several = false;   ///< holds several volumes
  bool one_grid = false;  ///< ... which must lie on one grid
};

/// All of them; folders are searched in this order.
const std::vector<FileFormat>& fileFormats();

/// The format of a file by its ending. @throws Error (bad_input) that lists the known ones
const FileFormat& formatOf(const std::filesystem::path& path);

/// True for names that end as volume files do.
bool isVolumeFile(const std::filesystem::path& path);

/// Writes volumes into one file, whole or not at all.
/// @throws Error (bad_input) for a format that is not written or does not hold as many, (other) where writing
/// fails
void writeVolumes(const std::filesystem::path& path, const std::vector<const DenseVolume*>& volumes);

/// @param name  of the grid or array, for our files the quantity; empty: the first
/// @throws Error (bad_input)
DenseVolume readVolume(const std::filesystem::path& path, const std::string& name = "");

/// The range that the volume of one quantity is to state.
struct StoredRange {
  std::string quantity;
  float min = 0, max = 0;
};

/// Changes info.range_min and range_max of volumes in a file that writeVolumes() wrote; the values are not
/// touched. The result is byte-equal to a file that was written with these ranges. A .raw or .nvdb file's
/// JSON beside it is written anew, whole; .vdb and .vti are patched where they lie (8 bytes a grid, or one
/// text of fixed length a volume), so that a reader sees the old or the new range, and a file that was cut
/// short by a crash of the machine is completed by the same call again.
/// @param ranges  volumes that are not named keep theirs
/// @throws Error (bad_input) for a format that is not written, a quantity that the file does not hold, or a
/// file that states no range; (other) where writing fails
void setStoredRange(const std::filesystem::path& path, const std::vector<StoredRange>& ranges);

/// What a file holds.
struct FileListing {
  std::string format;
  std::uintmax_t bytes = 0;
  std::vector<DenseVolume> volumes;  ///< without values and mask
};
FileListing listVolume(const std::filesystem::path& path);

/// FOLDER/NAME_0001.vdb: the file of a step of a series. @param number  counts from 1
std::filesystem::path seriesFile(const std::filesystem::path& folder, const std::string& name, int number,
                                 const std::string& format);

/// The steps of a series: of a .pvd the files that it lists, in the order of their times; of a folder its
/// volume files, of the first of fileFormats() that it has; of NAME_NNNN.EXT all with that name and ending;
/// these in the order of their numbers. Of any other volume file itself.
/// @throws Error (bad_input) where there is none
std::vector<std::filesystem::path> seriesOf(const std::filesystem::path& path);

}  // namespace emscape::volume
