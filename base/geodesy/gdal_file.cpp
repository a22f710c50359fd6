#include "base/geodesy/gdal_file.h"

#include <cstdint>
#include <mutex>
#include <string>
#include <system_error>

#include "base/geodesy/netcdf_header.h"

namespace emscape::gdal {
namespace fs = std::filesystem;

namespace {

/// netCDF files are read by HDF5, which prints, for each thread that does not forbid it, of attributes that a
/// file need not have.
void silenceHdf5() {
  using SetHandler = int(std::int64_t stack, int (*handler)(std::int64_t, void*), void* data);
  static void* const address = library().functionIfAny("H5Eset_auto2");
  constexpr std::int64_t kDefaultStack = 0;
  if (address != nullptr) reinterpret_cast<SetHandler*>(address)(kDefaultStack, nullptr, nullptr);
}

}  // namespace

void prepare() {
  static std::once_flag once;
  std::call_once(once, [] {
    // What is read and written does not depend on the user's environment, nor on ~/.gdal/gdalrc.
    for (const auto& [option, value] :
         {std::pair("GDAL_PAM_ENABLED", "YES"), std::pair("GTIFF_POINT_GEO_IGNORE", "NO"),
          std::pair("GDAL_TIFF_ENDIANNESS", "NATIVE"), std::pair("GDAL_TIFF_INTERNAL_MASK", "NO"),
          std::pair("GDAL_NUM_THREADS", "1"), std::pair("GDAL_CONFIG_FILE", "/dev/null"),
          std::pair("GDAL_GEOREF_SOURCES", "PAM,INTERNAL,TABFILE,WORLDFILE"),
          std::pair("OGR_CT_FORCE_TRADITIONAL_GIS_ORDER", "NO"),
          std::pair("OGR_ENABLE_PARTIAL_REPROJECTION", "NO"),
          std::pair("GDAL_DISABLE_READDIR_ON_OPEN", "NO")}) {
      CPLSetConfigOption(option, value);
    }
    GDALAllRegister();
    OSRSetPROJEnableNetwork(0);
  });
}

std::string localName(const fs::path& file) {
  return fs::absolute(file);
}

std::string faultOfName(const fs::path& file) {
  std::error_code failed;
  const fs::file_status status = fs::status(file, failed);
  if (status.type() == fs::file_type::none) return failed.message();
  if (!fs::exists(status)) return "no such file";
  if (!fs::is_regular_file(status)) return "not a regular file";
  // A folder /vsi... of the disk cannot be told from a virtual file system of GDAL.
  if (localName(file).rfind("/vsi", 0) == 0) return "names of GDAL's virtual file systems are not read";
  return "";
}

namespace {

/// The first layer of a GeoPackage that is a view, which may be a query without end; empty: none.
std::string viewIn(GDALDatasetH dataset) {
  if (std::string(GDALGetDriverShortName(GDALGetDatasetDriver(dataset))) != "GPKG") return "";
  const OGRLayerH views = GDALDatasetExecuteSQL(
      dataset,
      "SELECT c.table_name FROM gpkg_contents c JOIN sqlite_master m ON lower(m.name) = lower(c.table_name) "
      "WHERE m.type = 'view'",
      nullptr, nullptr);
  if (views == nullptr) return "";
  std::string name;
  if (const OGRFeatureH row = OGR_L_GetNextFeature(views)) {
    name = OGR_F_GetFieldAsString(row, 0);
    OGR_F_Destroy(row);
  }
  GDALDatasetReleaseResultSet(dataset, views);
  return name;
}

/// Null if the dataset has a view.
Dataset withoutViews(Dataset dataset) {
  if (dataset == nullptr) return dataset;
  if (const std::string view = viewIn(dataset.get()); !view.empty()) {
    CPLError(CE_Failure, CPLE_OpenFailed,
             "layer '%s' is a view (SQL), which is not read; export it as a table", view.c_str());
    return nullptr;
  }
  return dataset;
}

}  // namespace

Dataset openFile(const fs::path& file, unsigned flags, const char* const* drivers, const char* const* options,
                 const char* const* siblings) {
  prepare();
  if (const std::string fault = faultOfName(file); !fault.empty()) {
    CPLError(CE_Failure, CPLE_OpenFailed, "%s", fault.c_str());
    return nullptr;
  }
  if (const std::string fault = faultOfNetcdfHeader(file.string()); !fault.empty()) {
    CPLError(CE_Failure, CPLE_OpenFailed, "%s", fault.c_str());
    return nullptr;
  }
  silenceHdf5();
  return withoutViews(
      Dataset(GDALOpenEx(localName(file).c_str(), flags | GDAL_OF_READONLY, drivers, options, siblings)));
}

Dataset openInMemory(const std::string& name, unsigned flags, const char* const* drivers,
                     const char* const* siblings, const char* const* options) {
  silenceHdf5();
  return withoutViews(
      Dataset(GDALOpenEx(name.c_str(), flags | GDAL_OF_READONLY, drivers, options, siblings)));
}

}  // namespace emscape::gdal
