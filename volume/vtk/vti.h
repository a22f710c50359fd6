/// Volumes as VTK image data (.vti) and series of them (.pvd), for example for ParaView.
///
/// Point data at the voxels' centres: one array per quantity, named by it, Float32, or Int32 for categorical
/// ones; appended raw, little endian. Masked voxels are 0 in a UInt8 array `valid`, present if a volume has a
/// mask (`valid:NAME` for each quantity if their masks differ). Field data: TimeValue, and for each quantity
/// a string `emscape:NAME` with the description of the volume as JSON.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "emscape/volume/dense_volume.h"

namespace emscape::volume {

/// Writes volumes of one grid. @throws Error
void writeVti(const std::filesystem::path& path, const std::vector<const DenseVolume*>& volumes);

/// Reads an array: one that writeVti() wrote exactly; for another program the point data, or the cell data if
/// there are none, of one component, as text or in binary form (appended or inline, raw or base64,
/// uncompressed or compressed with zlib). If the image has another grid than the metadata of an array, these
/// are ignored, with a warning.
/// @param array_name  empty: the first that can be read
/// @throws Error (bad_input), which lists the file's arrays if none has that name
DenseVolume readVti(const std::filesystem::path& path, const std::string& array_name = "");

/// The arrays without values and mask. Those that cannot be read are left out, with a warning, as are the
/// cell data beside point data. @throws Error (bad_input) if none can be read
std::vector<DenseVolume> describeVti(const std::filesystem::path& path);

/// A step of a series.
struct PvdEntry {
  double time_s = 0;
  std::filesystem::path file;
};

/// Writes the list of a series' files, atomically: it may be rewritten after each step. Files below the
/// list's folder are named relative to it.
void writePvd(const std::filesystem::path& path, const std::vector<PvdEntry>& entries);

/// The files of a series, relative to the list's folder. A step without a timestep is at 0.
/// @throws Error (bad_input), among others for a timestep that is not a number or beyond kMaxTime_s, and for
/// several parts of one step
std::vector<PvdEntry> readPvd(const std::filesystem::path& path);

}  // namespace emscape::volume
