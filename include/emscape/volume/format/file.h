/// Reads and writes all volume formats, chosen by the file name's extension.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "emscape/volume/dense_volume.h"

namespace emscape::volume {

/// A format and its capabilities.
struct FileFormat {
  std::string name;  ///< name on the command line, and extension: "vdb"
  bool writable = true;
  bool several = false;  ///< holds several volumes
};

/// All formats; folders are searched in this order.
const std::vector<FileFormat>& fileFormats();

/// The format of a file by its ending. @throws Error (bad_input) that lists the known ones
const FileFormat& formatOf(const std::filesystem::path& path);

/// True for names with the extension of a volume format.
bool isVolumeFile(const std::filesystem::path& path);

/// Writes volumes into one file, atomically.
/// @throws Error (bad_input) for a format that cannot be written or cannot hold several volumes, (other) if
/// writing fails
void writeVolumes(const std::filesystem::path& path, const std::vector<const DenseVolume*>& volumes);

/// @param name  of the grid or array; in files of Emscape the quantity; empty: the first that can be read
/// @throws Error (bad_input)
DenseVolume readVolume(const std::filesystem::path& path, const std::string& name = "");

/// The range to write for the volume of one quantity.
struct StoredRange {
  std::string quantity;
  float min = 0, max = 0;
};

/// Changes info.range_min and range_max of volumes in a file that writeVolumes() wrote; the values are not
/// touched. The result is byte-identical to a file that was written with these ranges. For .raw and .nvdb the
/// JSON sidecar is rewritten, atomically; .vdb and .vti are patched in place (8 bytes per grid, or one text
/// of fixed length per volume), so that a reader sees the old or the new range. After a crash of the machine
/// the same call completes the file.
/// @param ranges  volumes without an entry keep their range
/// @throws Error (bad_input) for a format that cannot be written, a quantity that is not in the file, or a
/// file without a range; (other) if writing fails
void setStoredRange(const std::filesystem::path& path, const std::vector<StoredRange>& ranges);

/// Description of a file.
struct FileListing {
  std::string format;
  std::uintmax_t bytes = 0;
  std::vector<DenseVolume> volumes;  ///< without values and mask
};
/// Grids and arrays that cannot be read are left out, with a warning. @throws Error (bad_input) if none can
FileListing listVolume(const std::filesystem::path& path);

/// FOLDER/NAME_0001.vdb: the file of a step of a series. @param number  counts from 1
std::filesystem::path seriesFile(const std::filesystem::path& folder, const std::string& name, int number,
                                 const std::string& format);

/// A step of a series.
struct SeriesStep {
  std::filesystem::path file;
  /// As the list (.pvd) states it, for a file without a time of its own; none without a list.
  std::optional<double> time_s;
};

/// The steps of a series: for a .pvd the files that it lists, in the order of their times; for a folder its
/// volume files in the first of fileFormats() that occurs; for NAME_NNNN.EXT all files with that name and
/// extension; these in the order of their numbers. For any other volume file, the file itself.
/// @throws Error (bad_input) if there is none
std::vector<SeriesStep> seriesSteps(const std::filesystem::path& path);
/// The files of seriesSteps().
std::vector<std::filesystem::path> seriesOf(const std::filesystem::path& path);

}  // namespace emscape::volume
