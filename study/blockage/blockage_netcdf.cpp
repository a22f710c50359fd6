#include <fmt/format.h>

#include <cmath>

#include "base/files/unfinished_file.h"
#include "emscape/base/geodesy/geo_frame.h"
#include "emscape/base/parallel.h"
#include "emscape/base/units.h"
#include "emscape/base/work.h"
#include "scenario/terrain/gdal_messages.h"
#include "study/blockage/blockage.h"
#include "study/maps/gdal_arrays.h"
#include "study/maps/gdal_support.h"

namespace emscape::study {
namespace {

/// The arrays of a scan, over azimuth and range.
class ScanFile {
 public:
  ScanFile(const Blockage& blockage, const UnfinishedFile& file) : blockage_(blockage), file_(file) {
    const char* const options[] = {"FORMAT=NC4", "CONVENTIONS=CF-1.8", nullptr};
    dataset_ = createArrayFile(file.temporary(), options);
    root_ = rootOf(dataset_);
    check(root_ != nullptr);
  }
  ScanFile(const ScanFile&) = delete;
  ScanFile& operator=(const ScanFile&) = delete;

  void write() {
    setText(root_, "title", fmt::format("{}: beam blockage of '{}'", blockage_.title, blockage_.emitter));
    setText(root_, "source",
            fmt::format("emscape {}, computed from the scenario {}", EMSCAPE_VERSION, blockage_.scenario));
    for (const auto& [name, value] : {std::pair("site_latitude_deg", blockage_.position.latitude_deg),
                                      {"site_longitude_deg", blockage_.position.longitude_deg},
                                      {"antenna_height_msl_m", blockage_.station_msl_m},
                                      {"elevation_deg", blockage_.elevation_deg},
                                      {"beamwidth_deg", blockage_.beamwidth_deg},
                                      {"effective_earth_radius_m", blockage_.effective_earth_radius_m}})
      setText(root_, name, fmt::format("{}", value));
    const auto azimuths = static_cast<std::size_t>(blockage_.request.azimuths),
               ranges = static_cast<std::size_t>(blockage_.ranges);
    std::vector<double> azimuth_deg, gate_m;
    for (int n = 0; n < blockage_.request.azimuths; ++n) azimuth_deg.push_back(blockage_.azimuth_deg(n));
    for (int n = 0; n < blockage_.ranges; ++n) gate_m.push_back(blockage_.gate_m(n));
    addAxis("azimuth", azimuth_deg, "degrees", "of the beam's axis, clockwise from true north");
    addAxis("range", gate_m, "m", "of the gate's middle, along the beam");
    std::vector<double> latitude_deg(azimuths * ranges), longitude_deg(azimuths * ranges);
    std::vector<float> beam_msl_m(azimuths * ranges);
    parallelFor(blockage_.request.azimuths, 1, [&](int begin, int end) {
      for (std::size_t gate = begin * ranges; gate < end * ranges; ++gate) {
        const double slant_m = gate_m[gate % ranges];
        const GeodeticPosition at =
            geodesicDirect(blockage_.position.latitude_deg, blockage_.position.longitude_deg,
                           degToRad(azimuth_deg[gate / ranges]), blockage_.ground_m(slant_m));
        latitude_deg[gate] = at.latitude_deg;
        longitude_deg[gate] = at.longitude_deg;
        beam_msl_m[gate] = static_cast<float>(blockage_.axis_msl_m(slant_m));
      }
    });
    add("lat", latitude_deg.data(), GDT_Float64, "degrees_north", "of the ground below the gate", "latitude");
    add("lon", longitude_deg.data(), GDT_Float64, "degrees_east", "of the ground below the gate",
        "longitude");
    add("beam_msl", beam_msl_m.data(), GDT_Float32, "m", "height of the beam's axis above mean sea level");
    add("ground_msl", blockage_.edge_msl_m.data(), GDT_Float32, "m",
        "highest ground of the gate above mean sea level");
    add("partial_blockage", blockage_.partial.data(), GDT_Float32, "1",
        "part of the beam below the ground of the gate");
    add("cumulative_blockage", blockage_.cumulative.data(), GDT_Float32, "1",
        "largest part of the beam below ground up to the gate");
  }

  void close() {
    dimensions_.clear();
    root_.reset();
    dataset_.reset();
    check(true);
  }

 private:
  void check(bool is_done) const {
    if (!is_done || messages_.hasFailure()) failWriting(messages_, file_.file());
  }

  void addAxis(const std::string& name, const std::vector<double>& values, const char* unit,
               const char* description) {
    dimensions_.push_back(addDimension(root_, name, "", values.size()));
    check(dimensions_.back() != nullptr);
    const gdal::ValueType real = numberType(GDT_Float64);
    const gdal::Array array = addArray(root_, name, {dimensions_.back().get()}, real);
    check(array != nullptr);
    describe(array, unit, description);
    check(writeArray(array, {0}, {values.size()}, real, values.data()));
  }

  void add(const char* name, const void* values, GDALDataType type, const char* unit, const char* description,
           const char* standard_name = nullptr) {
    checkpoint();
    const char* const options[] = {"COMPRESS=DEFLATE", nullptr};
    const gdal::ValueType real = numberType(type);
    const gdal::Array array =
        addArray(root_, name, {dimensions_[0].get(), dimensions_[1].get()}, real, options);
    check(array != nullptr);
    GDALMDArraySetNoDataValueAsDouble(array.get(), NAN);
    describe(array, unit, description);
    if (standard_name != nullptr)
      setText(array, "standard_name", standard_name);
    else
      setText(array, "coordinates", "lat lon");
    check(writeArray(
        array, {0, 0},
        {static_cast<std::size_t>(blockage_.request.azimuths), static_cast<std::size_t>(blockage_.ranges)},
        real, values));
  }

  static void describe(const gdal::Array& array, const char* unit, const char* description) {
    setText(array, "long_name", description);
    GDALMDArraySetUnit(array.get(), unit);
  }

  const Blockage& blockage_;
  const UnfinishedFile& file_;
  const scenario::GdalMessages messages_;
  gdal::Dataset dataset_;
  gdal::Group root_;
  std::vector<gdal::Dimension> dimensions_;
};

}  // namespace

void writeBlockageNetcdf(const Blockage& blockage, const std::string& file, Replaces replaces) {
  requireOwnBeside(file);
  UnfinishedFile unfinished(file, replaces);
  {
    ScanFile scan(blockage, unfinished);
    scan.write();
    scan.close();
  }
  unfinished.publish({});
}

}  // namespace emscape::study
