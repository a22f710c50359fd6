/// Volumes to be read, whatever their format.
#pragma once

#include <string>
#include <vector>

#include "volume/dense_volume.h"

namespace emscape::app {

/// One instant of a series on disk.
struct VolumeFile {
  std::string file;
  double time_s = 0;
};

/// A volume file, the steps of a .pvd, or the volumes in a folder (of the first format of .vdb, .nvdb, .vti,
/// .raw, .dat that it has), in the order of time.
/// @param quantity  only files that hold it; empty: the quantity of the first file, into which the result
/// goes
/// @throws Error (bad_input)
std::vector<VolumeFile> seriesOf(const std::string& path, std::string& quantity);

/// What the volumes of one file are, without their values.
std::vector<volume::DenseVolume> describeVolumes(const std::string& file);

/// @param quantity  empty: the first; else the name of a quantity or channel
volume::DenseVolume readVolume(const std::string& file, const std::string& quantity);

}  // namespace emscape::app
