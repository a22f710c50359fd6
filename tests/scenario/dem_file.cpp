#include "tests/scenario/dem_file.h"

#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <cstdint>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <vector>

namespace emscape::test {
namespace {

OGRSpatialReference spatialReference(const std::string& crs) {
  OGRSpatialReference reference;
  if (reference.SetFromUserInput(crs.c_str()) != OGRERR_NONE) throw std::runtime_error("no such CRS: " + crs);
  reference.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return reference;
}

}  // namespace

void DemFile::write(const std::filesystem::path& path) const {
  GDALAllRegister();
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  const char* const version[] = {"GEOTIFF_VERSION=1.0", nullptr};
  const char* const* options = is_geotiff_1_0 ? version : nullptr;
  std::unique_ptr<GDALDataset> dataset(
      driver->Create(path.c_str(), columns, rows, bands, GDT_Float32, const_cast<char**>(options)));
  if (!dataset) throw std::runtime_error("cannot write " + path.string());
  // Set before the transform, since GDAL writes the transform accordingly.
  if (is_point) dataset->SetMetadataItem(GDALMD_AREA_OR_POINT, GDALMD_AOP_POINT);
  if (!crs.empty()) {
    const OGRSpatialReference reference = spatialReference(crs);
    dataset->SetSpatialRef(&reference);
  }
  std::array<double, 6> corners = transform;
  if (corners != std::array<double, 6>{}) dataset->SetGeoTransform(corners.data());
  GDALRasterBand* band = dataset->GetRasterBand(1);
  if (nodata) band->SetNoDataValue(*nodata);
  if (!unit.empty()) band->SetUnitType(unit.c_str());
  if (scale != 1) band->SetScale(scale);
  if (offset != 0) band->SetOffset(offset);
  std::vector<float> line(static_cast<std::size_t>(columns));
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      line[static_cast<std::size_t>(column)] = static_cast<float>(value(column, row));
    }
    if (band->RasterIO(GF_Write, 0, row, columns, 1, line.data(), columns, 1, GDT_Float32, 0, 0, nullptr) !=
        CE_None) {
      throw std::runtime_error("cannot write " + path.string());
    }
  }
  for (int other = 2; other <= bands; ++other) dataset->GetRasterBand(other)->Fill(2345);
}

DemFile geographicDem(double west_deg, double north_deg, double step_deg, int columns, int rows,
                      const std::function<double(double, double)>& height) {
  DemFile file;
  file.columns = columns;
  file.rows = rows;
  file.transform = {west_deg, step_deg, 0, north_deg, 0, -step_deg};
  file.value = [=](int column, int row) {
    return height(north_deg - (row + 0.5) * step_deg, west_deg + (column + 0.5) * step_deg);
  };
  return file;
}

DemFile geographicPointDem(double west_deg, double north_deg, double step_deg, int columns, int rows,
                           const std::function<double(double, double)>& height) {
  DemFile file =
      geographicDem(west_deg - 0.5 * step_deg, north_deg + 0.5 * step_deg, step_deg, columns, rows, height);
  file.is_point = true;
  return file;
}

std::array<double, 2> projected(const std::string& crs, double latitude_deg, double longitude_deg) {
  const OGRSpatialReference to = spatialReference(crs), from = spatialReference("EPSG:4326");
  const std::unique_ptr<OGRCoordinateTransformation> transformation(
      OGRCreateCoordinateTransformation(&from, &to));
  double x = longitude_deg, y = latitude_deg;
  if (!transformation || !transformation->Transform(1, &x, &y))
    throw std::runtime_error("cannot project to " + crs);
  return {x, y};
}

namespace {

/// Copies a file within GDAL's file systems.
void copyTo(const std::string& from, const std::string& to) {
  VSILFILE* const in = VSIFOpenL(from.c_str(), "rb");
  VSILFILE* const out = VSIFOpenL(to.c_str(), "wb");
  if (in == nullptr || out == nullptr) throw std::runtime_error("cannot copy " + from + " to " + to);
  std::vector<char> part(1 << 20);
  for (std::size_t got = 1; got > 0;) {
    got = VSIFReadL(part.data(), 1, part.size(), in);
    if (VSIFWriteL(part.data(), 1, got, out) != got) throw std::runtime_error("cannot write " + to);
  }
  VSIFCloseL(in);
  VSIFCloseL(out);
}

}  // namespace

void writeZip(const std::string& archive, const std::vector<std::pair<std::string, std::string>>& members) {
  for (const auto& [name, file] : members) copyTo(file, "/vsizip/" + archive + "/" + name);
}

void writeGzip(const std::string& from, const std::string& to) {
  copyTo(from, "/vsigzip/" + to);
}

void writeHgt(const std::string& file, int posts, const std::function<int(int, int)>& height) {
  std::ofstream stream(file, std::ios::binary);
  std::vector<char> line(static_cast<std::size_t>(posts) * 2);
  for (int row = 0; row < posts; ++row) {
    for (int column = 0; column < posts; ++column) {
      const auto value = static_cast<std::uint16_t>(static_cast<std::int16_t>(height(column, row)));
      line[static_cast<std::size_t>(column) * 2] = static_cast<char>(value >> 8);
      line[static_cast<std::size_t>(column) * 2 + 1] = static_cast<char>(value & 255);
    }
    stream.write(line.data(), static_cast<std::streamsize>(line.size()));
  }
}

void writeColours(const std::string& file, const std::function<long(int, int)>& value) {
  constexpr int kSize = 10;
  GDALAllRegister();
  const char* const options[] = {"PHOTOMETRIC=RGB", nullptr};
  const std::unique_ptr<GDALDataset> dataset(GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
      file.c_str(), kSize, kSize, 3, GDT_Byte, const_cast<char**>(options)));
  const OGRSpatialReference reference = spatialReference("EPSG:4326");
  dataset->SetSpatialRef(&reference);
  std::array<double, 6> corners{10, 0.1, 0, 50, 0, -0.1};
  dataset->SetGeoTransform(corners.data());
  for (int row = 0; row < kSize; ++row) {
    for (int column = 0; column < kSize; ++column) {
      const long bits = value(column, row);
      for (int band = 0; band < 3; ++band) {
        auto byte = static_cast<unsigned char>(bits >> (16 - 8 * band) & 255);
        if (dataset->GetRasterBand(band + 1)->RasterIO(GF_Write, column, row, 1, 1, &byte, 1, 1, GDT_Byte, 0,
                                                       0, nullptr) != CE_None)
          throw std::runtime_error("cannot write " + file);
      }
    }
  }
}

void convertDem(const std::string& from, const std::string& driver, const std::string& to) {
  GDALAllRegister();
  const std::unique_ptr<GDALDataset> source(GDALDataset::Open(from.c_str()));
  if (!source) throw std::runtime_error("cannot read " + from);
  const std::unique_ptr<GDALDataset> copy(
      GetGDALDriverManager()
          ->GetDriverByName(driver.c_str())
          ->CreateCopy(to.c_str(), source.get(), true, nullptr, nullptr, nullptr));
  if (!copy) throw std::runtime_error("cannot write " + to);
}

std::string wholeNumbers(const std::string& from, const std::string& to) {
  GDALAllRegister();
  const std::unique_ptr<GDALDataset> source(GDALDataset::Open(from.c_str()));
  const int columns = source->GetRasterXSize(), rows = source->GetRasterYSize();
  std::vector<std::uint16_t> values(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  const std::unique_ptr<GDALDataset> copy(GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
      to.c_str(), columns, rows, 1, GDT_UInt16, nullptr));
  std::array<double, 6> transform{};
  source->GetGeoTransform(transform.data());
  copy->SetGeoTransform(transform.data());
  copy->SetSpatialRef(source->GetSpatialRef());
  GDALColorTable colors;
  const GDALColorEntry green{0, 100, 0, 255};
  colors.SetColorEntry(10, &green);
  copy->GetRasterBand(1)->SetColorTable(&colors);
  if (source->GetRasterBand(1)->RasterIO(GF_Read, 0, 0, columns, rows, values.data(), columns, rows,
                                         GDT_UInt16, 0, 0, nullptr) != CE_None ||
      copy->GetRasterBand(1)->RasterIO(GF_Write, 0, 0, columns, rows, values.data(), columns, rows,
                                       GDT_UInt16, 0, 0, nullptr) != CE_None)
    throw std::runtime_error("cannot write " + to);
  return to;
}

}  // namespace emscape::test
