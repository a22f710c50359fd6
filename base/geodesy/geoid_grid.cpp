#include "base/geodesy/geoid_grid.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>

#include "base/geodesy/gdal_file.h"
#include "emscape/base/error.h"

namespace emscape {
namespace {

int wrapped(int index, int count) {
  return (index % count + count) % count;
}

bool endsWith(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

/// Undulation = offset + scale * value, in the comments of GeographicLib's PGM files.
struct PgmScale {
  double offset_m = 0, scale_m = 0;  ///< scale 0: not given
};

PgmScale readPgmScale(const std::string& file) {
  PgmScale scale;
  std::ifstream in(file, std::ios::binary);
  std::string line;
  std::getline(in, line);  // P5
  while (in.peek() == '#' && std::getline(in, line)) {
    if (line.rfind("# Offset ", 0) == 0) scale.offset_m = std::atof(line.c_str() + 9);
    if (line.rfind("# Scale ", 0) == 0) scale.scale_m = std::atof(line.c_str() + 8);
  }
  return scale;
}

void addPaths(char** paths, std::vector<std::string>& folders) {
  for (char** path = paths; path != nullptr && *path != nullptr; ++path) folders.emplace_back(*path);
  CSLDestroy(paths);
}

/// Folders in which PROJ and GeographicLib search for their grids, those of the environment first.
std::vector<std::string> gridFolders() {
  std::vector<std::string> folders;
  for (const char* variable : {"PROJ_DATA", "PROJ_LIB", "GEOGRAPHICLIB_GEOID_PATH"})
    addPaths(CSLTokenizeString2(CPLGetConfigOption(variable, ""), ":", 0), folders);
  const std::string geographiclib = CPLGetConfigOption("GEOGRAPHICLIB_DATA", "");
  if (!geographiclib.empty()) folders.push_back(geographiclib + "/geoids");
  addPaths(OSRGetPROJSearchPaths(), folders);
  for (const char* prefix : {"/usr/share", "/usr/local/share"}) {
    folders.push_back(std::string(prefix) + "/proj");
    folders.push_back(std::string(prefix) + "/GeographicLib/geoids");
  }
  return folders;
}

/// Suppresses GDAL's messages.
struct QuietGdal {
  QuietGdal() {
    CPLPushErrorHandlerEx([](CPLErr, CPLErrorNum, const char*) {}, nullptr);
  }
  ~QuietGdal() { CPLPopErrorHandler(); }
  QuietGdal(const QuietGdal&) = delete;
  QuietGdal& operator=(const QuietGdal&) = delete;
};

/// GDAL's last message, which may begin with the file's name.
std::string withoutName(const std::string& file) {
  std::string message = CPLGetLastErrorMsg();
  const std::size_t named = message.find(file);
  if (named == std::string::npos) return message;
  const std::size_t rest = message.find_first_not_of(" ,:", named + file.size());
  return rest == std::string::npos ? "" : message.substr(rest);
}

}  // namespace

GeoidGrid::GeoidGrid(const std::string& file, const GeoidArea& area) {
  const QuietGdal quiet;
  read(file, area);
}

void GeoidGrid::read(const std::string& file, const GeoidArea& area) {
  static const char* const kDrivers[] = {"GTiff", "GTX", "PNM", nullptr};
  const gdal::Dataset dataset = gdal::openFile(file, GDAL_OF_RASTER | GDAL_OF_VERBOSE_ERROR, kDrivers);
  const int columns = dataset ? GDALGetRasterXSize(dataset.get()) : 0;
  const int rows = dataset ? GDALGetRasterYSize(dataset.get()) : 0;
  double west_deg = 0;  // of the file's first post; PGM files, which do not state it, begin at Greenwich
  PgmScale scale{0, 1};
  double transform[6];
  bool is_placed = dataset != nullptr;
  if (endsWith(file, ".pgm")) {
    scale = readPgmScale(file);
    is_placed = is_placed && scale.scale_m > 0;
  } else if (is_placed && GDALGetGeoTransform(dataset.get(), transform) == CE_None) {
    west_deg = transform[0] + 0.5 * transform[1];
  } else {
    is_placed = false;
  }
  if (!is_placed || columns == 0 || columns % 360 != 0 || rows != columns / 2 + 1) {
    throw Error(ErrorCode::bad_input, SourceLocation{file},
                "not a global geoid grid (360 n x (180 n + 1) posts) " + std::string(CPLGetLastErrorMsg()));
  }
  posts_per_degree_ = columns / 360;
  const double n = posts_per_degree_;
  // Cubic interpolation needs one more post to the south and west, and two to the north and east.
  first_row_ = static_cast<int>(std::floor((area.south_deg + 90) * n)) - 1;
  row_count_ = std::min(static_cast<int>(std::floor((area.north_deg + 90) * n)) + 2, rows) - first_row_ + 1;
  const bool is_round = area.east_deg - area.west_deg >= 360;
  first_column_ = is_round ? -1 : static_cast<int>(std::floor((area.west_deg + 180) * n)) - 1;
  column_count_ = is_round ? columns + 3
                           : static_cast<int>(std::floor((area.east_deg + 180) * n)) + 2 - first_column_ + 1;

  const int file_first = static_cast<int>(std::lround((west_deg + 180.0) * n));
  posts_.reserve(static_cast<std::size_t>(row_count_) * static_cast<std::size_t>(column_count_));
  std::vector<float> line(static_cast<std::size_t>(columns));
  for (int r = 0; r < row_count_; ++r) {
    // Rows continue over the poles, on the opposite meridian.
    int row = first_row_ + r, turn = 0;
    if (row < 0 || row > rows - 1) {
      row = row < 0 ? -row : 2 * (rows - 1) - row;
      turn = columns / 2;
    }
    if (GDALRasterIO(GDALGetRasterBand(dataset.get(), 1), GF_Read, 0, rows - 1 - row, columns, 1, line.data(),
                     columns, 1, GDT_Float32, 0, 0) != CE_None) {
      throw Error(ErrorCode::bad_input, SourceLocation{file}, "cannot read: " + withoutName(file));
    }
    int at = wrapped(first_column_ + turn - file_first, columns);
    for (int c = 0; c < column_count_; ++c, at = at + 1 < columns ? at + 1 : 0) {
      const float value = line[static_cast<std::size_t>(at)];
      posts_.push_back(static_cast<float>(scale.offset_m + scale.scale_m * static_cast<double>(value)));
    }
  }
}

std::string findGeoidFile(const std::vector<std::string>& names, std::string& searched) {
  const std::vector<std::string> folders = gridFolders();
  for (const std::string& name : names) {
    for (const std::string& folder : folders) {
      if (gdal::faultOfName(folder + "/" + name).empty()) return folder + "/" + name;
    }
  }
  searched.clear();
  for (const std::string& folder : folders) searched += (searched.empty() ? "" : ", ") + folder;
  return {};
}

GeoidGrid egm2008Grid(const GeoidArea& area) {
  std::string searched;
  const std::string file = findGeoidFile(
      {"us_nga_egm08_25.tif", "egm08_25.gtx", "egm2008-2_5.pgm", "egm2008-5.pgm", "egm2008-1.pgm"}, searched);
  if (!file.empty()) return GeoidGrid(file, area);
  throw Error(
      ErrorCode::bad_input,
      "heights above EGM2008 need its geoid grid, which was not found. Install one: 'projsync --file "
      "us_nga_egm08_25' (PROJ) or 'geographiclib-get-geoids egm2008-5' (Debian package geographiclib-tools). "
      "With 'vertical_datum: egm96' the heights are taken as above EGM96, which differs by 0.2 m in the "
      "median and by up to 12 m in high mountains. "
      "Searched: " +
          searched);
}

}  // namespace emscape
