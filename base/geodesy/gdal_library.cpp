#include "base/geodesy/gdal_functions.h"

namespace emscape::gdal {

const LoadedLibrary& library() {
  static const LoadedLibrary kLibrary = [] {
    // The C functions are the same in these versions (GDAL 3.6 to 3.12).
    std::vector<std::string> files{EMSCAPE_GDAL_FILE};
    for (int version = 38; version >= 32; --version) files.push_back("libgdal.so." + std::to_string(version));
    return LoadedLibrary(
        files, "the library GDAL",
        "install the package libgdal32 (Debian 12), libgdal34t64 (Ubuntu 24.04) or libgdal36 "
        "(Debian 13)");
  }();
  return kLibrary;
}

}  // namespace emscape::gdal
