#include "emscape/base/geoid.h"

#include <cpl_conv.h>
#include <gdal_priv.h>
#include <ogr_srs_api.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "emscape/base/error.h"

namespace emscape {
namespace {

constexpr const char* kGridName = "egm96_15.gtx";
constexpr int kPostsPerDegree = 4;
constexpr int kColumns = 360 * kPostsPerDegree;
constexpr int kRows = 180 * kPostsPerDegree + 1;
/// Posts that the cubic needs beyond the grid on each side: columns repeat round the globe, rows continue
/// over the pole.
constexpr int kPad = 2;
constexpr int kStride = kColumns + 2 * kPad;

std::mutex settings_mutex;
std::string chosen_file;  ///< of setGeoidFile()
bool is_read = false;     ///< the grid was read: chosen_file has no effect any more

/// Folders in which PROJ looks for its grids, those of the environment first.
std::vector<std::string> gridFolders() {
  std::vector<std::string> folders;
  for (const char* variable : {"PROJ_DATA", "PROJ_LIB"}) {
    char** paths = CSLTokenizeString2(CPLGetConfigOption(variable, ""), ":", 0);
    for (char** path = paths; path != nullptr && *path != nullptr; ++path) folders.emplace_back(*path);
    CSLDestroy(paths);
  }
  char** paths = OSRGetPROJSearchPaths();
  for (char** path = paths; path != nullptr && *path != nullptr; ++path) folders.emplace_back(*path);
  CSLDestroy(paths);
  folders.emplace_back("/usr/share/proj");
  folders.emplace_back("/usr/local/share/proj");
  return folders;
}

/// The undulations with their pads, south row first, first column at 180 degrees west.
class GeoidGrid {
 public:
  GeoidGrid() : posts_(static_cast<std::size_t>(kStride) * (kRows + 2 * kPad)) {
    CPLErrorHandlerPusher quiet(CPLQuietErrorHandler);
    GDALAllRegister();
    const std::lock_guard<std::mutex> lock(settings_mutex);
    if (!chosen_file.empty()) {
      load(chosen_file);
      return;
    }
    std::string searched;
    for (const std::string& folder : gridFolders()) {
      const std::string file = folder + "/" + kGridName;
      VSIStatBufL status;
      if (VSIStatL(file.c_str(), &status) == 0) {
        load(file);
        return;
      }
      searched += (searched.empty() ? "" : ", ") + folder;
    }
    throw Error(ErrorCode::bad_input, std::string("the EGM96 geoid grid ") + kGridName +
                                          " was not found (Debian package proj-data); searched: " + searched);
  }

  /// @pre settings_mutex is locked
  void load(const std::string& file) {
    read(file);
    pad();
    is_read = true;
  }

  double undulation_m(double latitude_deg, double longitude_deg) const {
    const double u =
        (longitude_deg - 360.0 * std::floor((longitude_deg + 180.0) / 360.0) + 180.0) * kPostsPerDegree;
    const double v = (std::clamp(latitude_deg, -90.0, 90.0) + 90.0) * kPostsPerDegree;
    if (!(u >= 0.0 && u <= kColumns && v >= 0.0)) return std::nan("");
    const int column = std::min(static_cast<int>(u), kColumns - 1);
    const int row = std::min(static_cast<int>(v), kRows - 2);
    double x[4], y[4];
    cubicWeights(u - column, x);
    cubicWeights(v - row, y);
    double sum = 0.0;
    for (int j = 0; j < 4; ++j) {
      const float* p = &posts_[index(row + j - 1, column - 1)];
      sum += y[j] * (x[0] * p[0] + x[1] * p[1] + x[2] * p[2] + x[3] * p[3]);
    }
    return sum;
  }

 private:
  static std::size_t index(int row, int column) {
    return static_cast<std::size_t>(row + kPad) * kStride + static_cast<std::size_t>(column + kPad);
  }

  /// Lagrange's weights of the posts at -1, 0, 1, 2 for a point at t in 0..1.
  static void cubicWeights(double t, double weights[4]) {
    const double a = t + 1.0, b = t - 1.0, c = t - 2.0;
    weights[0] = -t * b * c / 6.0;
    weights[1] = a * b * c / 2.0;
    weights[2] = -a * t * c / 2.0;
    weights[3] = a * t * b / 6.0;
  }

  void read(const std::string& file) {
    const std::unique_ptr<GDALDataset> dataset(
        GDALDataset::Open(file.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR));
    double transform[6];
    if (!dataset || dataset->GetRasterXSize() != kColumns || dataset->GetRasterYSize() != kRows ||
        dataset->GetGeoTransform(transform) != CE_None) {
      throw Error(
          ErrorCode::bad_input, SourceLocation{file},
          "not the global 15-minute geoid grid (1440 x 721 posts) " + std::string(CPLGetLastErrorMsg()));
    }
    std::vector<float> line(kColumns);
    const int first =
        static_cast<int>(std::lround((transform[0] + 0.5 * transform[1] + 180.0) * kPostsPerDegree));
    for (int row = 0; row < kRows; ++row) {
      if (dataset->GetRasterBand(1)->RasterIO(GF_Read, 0, kRows - 1 - row, kColumns, 1, line.data(), kColumns,
                                              1, GDT_Float32, 0, 0, nullptr) != CE_None) {
        throw Error(ErrorCode::bad_input, SourceLocation{file}, CPLGetLastErrorMsg());
      }
      for (int column = 0; column < kColumns; ++column) {
        posts_[index(row, ((first + column) % kColumns + kColumns) % kColumns)] =
            line[static_cast<std::size_t>(column)];
      }
    }
  }

  void pad() {
    for (int beyond = 1; beyond <= kPad; ++beyond) {
      for (int column = 0; column < kColumns; ++column) {
        const int opposite = (column + kColumns / 2) % kColumns;
        posts_[index(-beyond, column)] = posts_[index(beyond, opposite)];
        posts_[index(kRows - 1 + beyond, column)] = posts_[index(kRows - 1 - beyond, opposite)];
      }
    }
    for (int row = -kPad; row < kRows + kPad; ++row) {
      for (int beyond = 1; beyond <= kPad; ++beyond) {
        posts_[index(row, -beyond)] = posts_[index(row, kColumns - beyond)];
        posts_[index(row, kColumns - 1 + beyond)] = posts_[index(row, beyond - 1)];
      }
    }
  }

  std::vector<float> posts_;
};

}  // namespace

double geoidUndulation_m(double latitude_deg, double longitude_deg) {
  static const GeoidGrid grid;
  return grid.undulation_m(latitude_deg, longitude_deg);
}

void setGeoidFile(const std::string& file) {
  const std::lock_guard<std::mutex> lock(settings_mutex);
  if (is_read) throw Error(ErrorCode::usage, "geoid file '" + file + "': the geoid grid was read before");
  chosen_file = file;
}

}  // namespace emscape
