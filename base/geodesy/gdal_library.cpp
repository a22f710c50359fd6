#include "base/geodesy/gdal_functions.h"
#include "base/limits/address_limit.h"
#include "base/memory.h"

namespace emscape::gdal {
namespace {

/// Address space of GDAL, the libraries that it needs, and PROJ's tables. Without it they end the program, or
/// a message is theirs.
constexpr std::size_t kGdal_bytes = std::size_t{152} << 20;

}  // namespace

const LoadedLibrary& library() {
  static const LoadedLibrary kLibrary = [] {
    if (hasAddressLimit())
      requireMemory({"the library GDAL", kGdal_bytes, "a higher limit is needed (ulimit -v)"}, {});
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
