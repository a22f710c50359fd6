/// Opening of files by GDAL. The name of a file is the name of a local file: GDAL takes names that begin with
/// the prefix of a driver or of a virtual file system for others, among them addresses on the network.
#pragma once

#include <filesystem>
#include <string>

#include "base/geodesy/gdal.h"

namespace emscape::gdal {

/// Registers GDAL's drivers, and keeps PROJ from the network, whatever the environment says: coordinate
/// systems in files may name grids by address. The first call has an effect on the process.
void prepare();

/// Describes why a name is not that of a regular local file; empty if it is.
std::string faultOfName(const std::filesystem::path& file);

/// The name under which GDAL opens a local file: absolute, so that it begins with no driver's prefix.
std::string localName(const std::filesystem::path& file);

/// Opens a regular local file.
/// @param flags     of GDALOpenEx()
/// @param drivers   the drivers to try, ended by null: others read databases, network services and files that
///                  name further ones
/// @param siblings  names of other files of its folder; null: GDAL lists the folder
/// @return null if it is no regular local file or none of the drivers fits; GDAL has then reported a failure
Dataset openFile(const std::filesystem::path& file, unsigned flags, const char* const* drivers,
                 const char* const* options = nullptr, const char* const* siblings = nullptr);

/// Opens a file of GDAL's memory, which the caller has made there.
/// @param name  /vsimem/...
/// @return as openFile()
Dataset openInMemory(const std::string& name, unsigned flags, const char* const* drivers,
                     const char* const* siblings, const char* const* options = nullptr);

}  // namespace emscape::gdal
