#include "emscape/base/geodesy/geoid.h"

#include <mutex>

#include "base/geodesy/geoid_grid.h"
#include "emscape/base/error.h"

namespace emscape {
namespace {

constexpr const char* kGridName = "egm96_15.gtx";

std::mutex settings_mutex;
std::string chosen_file;  ///< of setGeoidFile()
bool is_read = false;     ///< the grid was read; chosen_file has no further effect

GeoidGrid readGrid() {
  const std::lock_guard<std::mutex> lock(settings_mutex);
  std::string searched;
  const std::string file = chosen_file.empty() ? findGeoidFile({kGridName}, searched) : chosen_file;
  if (file.empty()) {
    throw Error(ErrorCode::bad_input, std::string("the EGM96 geoid grid ") + kGridName +
                                          " was not found (Debian package proj-data); searched: " + searched);
  }
  GeoidGrid grid(file);
  is_read = true;
  return grid;
}

}  // namespace

const GeoidGrid& egm96Grid() {
  static const GeoidGrid grid = readGrid();
  return grid;
}

double geoidUndulation_m(double latitude_deg, double longitude_deg) {
  return egm96Grid().undulation_m(latitude_deg, longitude_deg);
}

void setGeoidFile(const std::string& file) {
  const std::lock_guard<std::mutex> lock(settings_mutex);
  if (is_read) throw Error(ErrorCode::usage, "geoid file '" + file + "': the geoid grid was read before");
  chosen_file = file;
}

}  // namespace emscape
