#include "scenario/map/coast.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>

#include "base/geodesy/gdal_file.h"
#include "emscape/base/error.h"
#include "emscape/base/parallel.h"
#include "scenario/terrain/gdal_messages.h"

namespace emscape::scenario {
namespace {

constexpr int kLevels = 4;
constexpr double kParts = 65535;  // coordinates across a bin
constexpr int kMaxBins = 3600 * 1800;
constexpr int kMaxPoints = 1 << 26;

/// The arrays of a file in the format of GMT (gmt_shore.h).
class CoastFile {
 public:
  explicit CoastFile(const std::string& file) : file_(file) {
    static const char* const kDrivers[] = {"netCDF", nullptr};
    dataset_ = gdal::openFile(file, GDAL_OF_MULTIDIM_RASTER, kDrivers);
    if (dataset_ == nullptr) fail("cannot be read as netCDF");
    group_.reset(GDALDatasetGetRootGroup(dataset_.get()));
    if (group_ == nullptr) fail("has no arrays");
  }

  int number(const char* name) const { return values(name, 0, 1).front(); }

  /// Elements first .. first + count - 1 of an array of one dimension.
  std::vector<int> values(const char* name, int first, int count) const {
    std::vector<int> values(static_cast<std::size_t>(count));
    if (count == 0) return values;
    const gdal::Array array(GDALGroupOpenMDArray(group_.get(), name, nullptr));
    if (array == nullptr) fail(std::string("has no array ") + name);
    const gdal::ValueType type(GDALExtendedDataTypeCreate(GDT_Int32));
    const GUInt64 begin = static_cast<GUInt64>(first);
    const std::size_t size = values.size();
    const GInt64 step = 1;
    const bool is_inside = first >= 0 && begin + size <= GDALMDArrayGetTotalElementsCount(array.get());
    if (!is_inside || GDALMDArrayRead(array.get(), &begin, &size, &step, nullptr, type.get(), values.data(),
                                      values.data(), size * sizeof(int)) == 0) {
      fail(std::string("array ") + name + " cannot be read");
    }
    return values;
  }

  [[noreturn]] void fail(const std::string& problem) const {
    throw Error(ErrorCode::bad_input, {file_, 0, 0}, messages_.explain(problem));
  }

 private:
  const std::string file_;
  const GdalMessages messages_;
  gdal::Dataset dataset_;
  gdal::Group group_;
};

/// Numbers of points, level and so on of a segment, packed into 32 bits.
int pointsOf(int packed) {
  return static_cast<int>(static_cast<std::uint32_t>(packed) >> 9);
}
int levelOf(int packed) {
  return packed >> 6 & 7;
}
/// The level of the south-western corner; those of the others, counter-clockwise, are in lower bits.
int cornerLevelOf(int packed) {
  return packed >> 9 & 7;
}

std::string installedFile() {
  std::vector<std::filesystem::path> folders;
  if (const char* const folder = std::getenv("DIR_GSHHG"); folder != nullptr && *folder != '\0')
    folders.emplace_back(folder);
  for (const char* const folder :
       {"/usr/share/gmt-gshhg", "/usr/share/gshhg-gmt-nc4", "/usr/share/gshhg-gmt"})
    folders.emplace_back(folder);
  for (const char resolution : {'f', 'h', 'i', 'l', 'c'}) {
    for (const std::filesystem::path& folder : folders) {
      const std::filesystem::path file = folder / (std::string("binned_GSHHS_") + resolution + ".nc");
      std::error_code ignored;
      if (std::filesystem::is_regular_file(file, ignored)) return file.string();
    }
  }
  return "";
}

}  // namespace

std::shared_ptr<const Coast> Coast::installed(const GeoBox& box) {
  const std::string file = installedFile();
  try {
    return file.empty() ? nullptr : read(file, box);
  } catch (const Error&) {  // GDAL without netCDF, or another format
    return nullptr;
  }
}

std::shared_ptr<const Coast> Coast::read(const std::string& name, const GeoBox& box) {
  const CoastFile file(name);
  const int columns = file.number("N_bins_in_360_longitude_range");
  const int rows = file.number("N_bins_in_180_degree_latitude_range");
  if (columns < 1 || rows < 1 || static_cast<double>(columns) * rows > kMaxBins)
    file.fail("has impossible bins");
  auto coast = std::make_shared<Coast>();
  const double bin_deg = coast->bin_deg_ = 360.0 / columns;
  const int first_row = std::clamp(static_cast<int>(std::floor((90 - box.north_deg) / bin_deg)), 0, rows - 1);
  const int last_row = std::clamp(static_cast<int>(std::floor((90 - box.south_deg) / bin_deg)), 0, rows - 1);
  const int first_column = static_cast<int>(std::floor(box.west_deg / bin_deg));
  const int last_column =
      std::min(static_cast<int>(std::floor(box.east_deg / bin_deg)), first_column + columns - 1);
  for (int row = first_row; row <= last_row; ++row) {
    for (int column = first_column; column <= last_column; ++column) {
      const int number = row * columns + (column % columns + columns) % columns;
      Bin bin{90 - (row + 1) * bin_deg, column * bin_deg};
      bin.corner_level = cornerLevelOf(file.values("Embedded_node_levels_in_a_bin", number, 1).front());
      bin.first = coast->lines_.size();
      const int segments = file.values("N_segments_in_a_bin", number, 1).front();
      const int first = file.values("Id_of_first_segment_in_a_bin", number, 1).front();
      if (segments < 0) file.fail("has impossible bins");
      const std::vector<int> packed =
          file.values("Embedded_npts_levels_exit_entry_for_a_segment", first, segments);
      const std::vector<int> starts = file.values("Id_of_first_point_in_a_segment", first, segments);
      int begin = 0, end = 0;  // of the points, which are together
      for (std::size_t n = 0; n < packed.size(); ++n) {
        begin = n == 0 ? starts[n] : std::min(begin, starts[n]);
        end = std::max(end, starts[n] + pointsOf(packed[n]));
      }
      if (begin < 0 || end - begin > kMaxPoints) file.fail("has impossible segments");
      const std::vector<int> x = file.values("Relative_longitude_from_SW_corner_of_bin", begin, end - begin);
      const std::vector<int> y = file.values("Relative_latitude_from_SW_corner_of_bin", begin, end - begin);
      for (std::size_t n = 0; n < packed.size(); ++n) {
        CoastLine line{levelOf(packed[n]), {}};
        for (int i = starts[n] - begin; i < starts[n] - begin + pointsOf(packed[n]); ++i) {
          const auto point = static_cast<std::size_t>(i);
          line.points.push_back({bin.south_deg + (y[point] & 0xFFFF) * bin_deg / kParts,
                                 bin.west_deg + (x[point] & 0xFFFF) * bin_deg / kParts, 0});
        }
        coast->lines_.push_back(std::move(line));
      }
      bin.end = coast->lines_.size();
      coast->bins_.push_back(bin);
    }
  }
  return coast;
}

bool Coast::isWater(double latitude_deg, double longitude_deg) const {
  for (const Bin& bin : bins_) {
    const double y = latitude_deg - bin.south_deg, x = wrapLongitude_deg(longitude_deg - bin.west_deg);
    if (!(y >= 0 && y <= bin_deg_ && x >= 0 && x <= bin_deg_)) continue;
    // Shores of each level between the position and the bin's corner: north along the western edge, then
    // east.
    std::array<int, kLevels + 1> crossings{};
    const auto count = [&](const CoastLine& line, double along0, double across0, double along1,
                           double across1, double across, double end) {
      if ((across0 <= across) == (across1 <= across)) return;
      const double at = along0 + (along1 - along0) * (across - across0) / (across1 - across0);
      if (at < end) ++crossings[static_cast<std::size_t>(std::clamp(line.level, 0, kLevels))];
    };
    // The path is half a unit of the file's coordinates inside the edge, at which shores end.
    const double inside_deg = 0.5 * bin_deg_ / kParts;
    for (std::size_t n = bin.first; n < bin.end; ++n) {
      const std::vector<GeodeticPosition>& points = lines_[n].points;
      for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        const double x0 = points[i].longitude_deg - bin.west_deg, y0 = points[i].latitude_deg - bin.south_deg;
        const double x1 = points[i + 1].longitude_deg - bin.west_deg;
        const double y1 = points[i + 1].latitude_deg - bin.south_deg;
        count(lines_[n], x0, y0, x1, y1, y, x);
        count(lines_[n], y0, x0, y1, x1, inside_deg, y);
      }
    }
    int level = 0;
    for (int l = 1; l <= kLevels; ++l) {
      const bool is_inside = (bin.corner_level >= l) != (crossings[static_cast<std::size_t>(l)] % 2 != 0);
      if (is_inside) level = l;
    }
    return level % 2 == 0;
  }
  return false;
}

std::vector<std::uint8_t> waterOnGrid(
    const Coast& coast, int columns, int rows,
    const std::function<std::vector<GridPlace>(const std::vector<GeodeticPosition>&)>& onGrid,
    const std::function<GeodeticPosition(int column, int row)>& positionAt) {
  std::vector<std::vector<double>> crossings(static_cast<std::size_t>(rows));  // columns, by row
  for (const CoastLine& line : coast.lines()) {
    const std::vector<GridPlace> places = onGrid(line.points);
    for (std::size_t n = 1; n < places.size(); ++n) {
      const GridPlace &a = places[n - 1], &b = places[n];
      const double low = std::min(a.row, b.row), high = std::max(a.row, b.row);
      if (!(low < rows && high > 0)) continue;
      for (int row = static_cast<int>(std::ceil(std::max(low, 0.0))); row < high && row < rows; ++row)
        crossings[static_cast<std::size_t>(row)].push_back(a.column + (b.column - a.column) * (row - a.row) /
                                                                          (b.row - a.row));
    }
  }
  std::vector<std::uint8_t> water(static_cast<std::size_t>(columns) * rows, 0);
  parallelFor(rows, 8, [&](int begin, int end) {
    for (int row = begin; row < end; ++row) {
      int column = 0;
      GeodeticPosition first;
      for (; column < columns; ++column) {
        first = positionAt(column, row);
        if (!std::isnan(first.latitude_deg)) break;
      }
      if (column == columns) continue;
      bool is_water = coast.isWater(first.latitude_deg, first.longitude_deg);
      std::vector<double>& of_row = crossings[static_cast<std::size_t>(row)];
      std::sort(of_row.begin(), of_row.end());
      auto next = std::upper_bound(of_row.begin(), of_row.end(), column);
      for (; column < columns; ++column) {
        for (; next != of_row.end() && *next <= column; ++next) is_water = !is_water;
        if (is_water) water[static_cast<std::size_t>(row) * columns + column] = 1;
      }
    }
  });
  return water;
}

}  // namespace emscape::scenario
