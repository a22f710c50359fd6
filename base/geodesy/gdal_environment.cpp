#include "base/geodesy/gdal_environment.h"

#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <iterator>
#include <string>
#include <vector>

namespace emscape::gdal {

void ignoreEnvironment() {
  std::vector<std::string> names;
  for (char** variable = ::environ; variable != nullptr && *variable != nullptr; ++variable) {
    const std::string name(*variable, std::strcspn(*variable, "="));
    const auto begins = [&](const char* prefix) { return name.rfind(prefix, 0) == 0; };
    const auto is = [&](const char* kept) { return name == kept; };
    constexpr const char* kPrefixes[] = {"GDAL_",   "OGR_", "OSR_", "GTIFF_",  "GPKG_", "KML_",
                                         "LIBKML_", "CPL_", "VSI_", "SQLITE_", "PROJ_"};
    constexpr const char* kKept[] = {"GDAL_DATA", "GDAL_DRIVER_PATH", "GDAL_CACHEMAX", "PROJ_DATA",
                                     "PROJ_LIB"};
    if (std::any_of(std::begin(kPrefixes), std::end(kPrefixes), begins) &&
        std::none_of(std::begin(kKept), std::end(kKept), is)) {
      names.push_back(name);
    }
  }
  for (const std::string& name : names) ::unsetenv(name.c_str());
  // Where a call has no handler of errors, GDAL and PROJ would print beside the program's message.
  ::setenv("CPL_LOG", "/dev/null", 1);
  // HDF5 would lock netCDF files, which are new and in folders of their own: some file systems have no locks.
  ::setenv("HDF5_USE_FILE_LOCKING", "FALSE", 1);
}

}  // namespace emscape::gdal
