// Map files, read back by GDAL: contours at their levels, bands without gaps, contents of each format.
#include <fmt/format.h>
#include <gdal_priv.h>
#include <gdal_rat.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <ogrsf_frmts.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "base/files/file_digest.h"
#include "emscape/scenario/file/scenario_file.h"
#include "study/files/geotiff.h"
#include "study/files/map_shapes.h"
#include "study/picture/map_colors.h"
#include "study/picture/map_objects.h"
#include "study/report/map_folder.h"
#include "study/report/map_report.h"
#include "tests/support/errors.h"
#include "tests/support/file_size_limit.h"
#include "tests/support/files.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/unfinished_files.h"

namespace emscape::study {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

struct Close {
  void operator()(GDALDataset* dataset) const { GDALClose(dataset); }
};
using Opened = std::unique_ptr<GDALDataset, Close>;

Opened open(const std::string& file, unsigned flags) {
  GDALAllRegister();
  return Opened(GDALDataset::Open(file.c_str(), flags));
}

/// A grid of 40 x 30 pixels of 500 m, and a study of the shipped scenario over it.
struct Fixture {
  std::shared_ptr<const scenario::Scenario> scenario =
      scenario::loadScenario(test::shippedScenario("jacksboro.yaml"));
  MapArea area = parseArea("36.3,-84.2,9000");
  std::shared_ptr<const MapGrid> grid = std::make_shared<const MapGrid>(makeMapGrid(area, 500, "utm"));
  MapHeight height{emfield::HeightReference::mean_sea_level, 1500};

  MapStudy study() const {
    return {"coverage", "Coverage of <jacksboro>",
            {scenario}, loadTerrain(*scenario, area),
            grid,       scenario::Quantity::detection_probability,
            0.5,        {70, 80},
            {height},   {}};
  }
  /// Values that rise and fall over the grid; none outside the area and at one pixel inside.
  Map map(MapKind kind, double time_s, double low, double high) const {
    Map map;
    map.name = kind == MapKind::classes ? "covered" : kind == MapKind::category ? "best" : "value";
    map.kind = kind;
    map.title = map.name;
    map.unit = kind == MapKind::level ? "dB" : "";
    map.subject = map.name;
    map.description = map.name + " at 1500 m above mean sea level";
    map.height = height;
    map.time_s = time_s;
    map.values.assign(grid->pixels(), NAN);
    for (std::size_t p = 0; p < grid->pixels(); ++p) {
      if (std::isnan(grid->positions[p].latitude_deg) || p == grid->pixels() / 2) continue;
      const double x = static_cast<double>(p % grid->width), y = static_cast<double>(p / grid->width);
      const double wave = 0.5 + 0.25 * (std::sin(x / 5 + time_s) + std::cos(y / 4));
      map.values[p] = static_cast<float>(low + wave * (high - low));
      if (isWhole(kind)) map.values[p] = std::round(map.values[p]);
    }
    return map;
  }
  /// The value at a position, linear between the centres of four pixels; NaN if one is missing.
  double valueAt(const Map& map, double x, double y, double (*scaled)(double)) const {
    const double column = (x - grid->left_m) / grid->cell_m - 0.5,
                 row = (grid->top_m - y) / grid->cell_m - 0.5;
    const int i = std::clamp(static_cast<int>(std::floor(column)), 0, grid->width - 2);
    const int j = std::clamp(static_cast<int>(std::floor(row)), 0, grid->height - 2);
    const auto at = [&](int di, int dj) {
      return scaled(static_cast<double>(map.values[static_cast<std::size_t>(j + dj) * grid->width + i + di]));
    };
    const double u = column - i, v = row - j;
    return (1 - v) * ((1 - u) * at(0, 0) + u * at(1, 0)) + v * ((1 - u) * at(0, 1) + u * at(1, 1));
  }
};

double asItIs(double value) {
  return value;
}
double logOdds(double value) {
  return std::log(value / (1 - value));
}

TEST(MapShapes, ContoursLieOnTheirLevels) {
  const Fixture fixture;
  for (const auto& [kind, low, high, scaled] :
       {std::tuple{MapKind::level, -37.0, 26.0, &asItIs}, {MapKind::probability, 0.002, 0.999, &logOdds}}) {
    const Map map = fixture.map(kind, 70, low, high);
    const MapShapes shapes = shapesOf(*fixture.grid, map, "test");
    int compared = 0;
    std::set<double> levels;
    for (const MapLine& line : shapes.lines) {
      levels.insert(line.level);
      OGRGeometryH points = line.geometry.get();
      for (int n = 0; n < OGR_G_GetPointCount(points); ++n) {
        const double value = fixture.valueAt(map, OGR_G_GetX(points, n), OGR_G_GetY(points, n), scaled);
        if (std::isnan(value)) continue;  // beside a pixel without a value
        // A thousandth of a cell, for the steepest slope.
        const double slope = (scaled(high) - scaled(low)) / 5;
        EXPECT_NEAR(value, scaled(line.level), 1e-3 * slope);
        ++compared;
      }
    }
    EXPECT_GT(compared, 200);
    EXPECT_THAT(levels, testing::ElementsAreArray(levelsOf(map)));
  }
}

TEST(MapShapes, BandsTileThePixelsThatHaveAValue) {
  const Fixture fixture;
  const double pixel_m2 = 500.0 * 500.0;
  for (const MapKind kind : {MapKind::level, MapKind::probability, MapKind::category}) {
    const bool is_part = kind == MapKind::probability;
    const Map map = fixture.map(kind, 70, is_part ? 0.002 : -0.4, is_part ? 0.999 : 43);
    double expected_m2 = 0, area_m2 = 0;
    for (const float value : map.values) expected_m2 += std::isnan(value) ? 0 : pixel_m2;
    const MapShapes shapes = shapesOf(*fixture.grid, map, "test");
    gdal::Geometry all(OGR_G_CreateGeometry(wkbMultiPolygon));
    for (const MapBand& band : shapes.bands) {
      EXPECT_TRUE(OGR_G_IsValid(band.geometry.get()));
      EXPECT_LE(band.min, band.max);
      area_m2 += OGR_G_Area(band.geometry.get());
      all.reset(OGR_G_Union(all.get(), band.geometry.get()));
    }
    EXPECT_NEAR(area_m2 / expected_m2, 1, 1e-6) << "neither overlap";
    EXPECT_NEAR(OGR_G_Area(all.get()) / expected_m2, 1, 1e-6) << "nor gap";
  }
}

TEST(MapShapes, BandsAroundPixelsThatTouchAtCornersAreValid) {
  const Fixture fixture;
  Map map = fixture.map(MapKind::level, 70, -37, 26);
  const int width = fixture.grid->width;
  for (std::size_t p = 0; p < map.values.size(); ++p) {
    const int column = static_cast<int>(p) % width, row = static_cast<int>(p) / width;
    if (row % 7 < 4 && column % 5 < 4 && (row + column) % 2 == 0) map.values[p] = NAN;
  }
  for (const MapBand& band : shapesOf(*fixture.grid, map, "test").bands) {
    EXPECT_TRUE(OGR_G_IsValid(band.geometry.get())) << band.min;
    EXPECT_EQ(wkbFlatten(OGR_G_GetGeometryType(band.geometry.get())), wkbMultiPolygon);
  }
}

TEST(MapShapes, ClassesHaveTheOutlinesOfTheirPixels) {
  const Fixture fixture;
  Map map = fixture.map(MapKind::classes, 70, 0, 1);
  map.labels = {"no", "yes"};
  map.area_class = 1;
  const MapShapes shapes = shapesOf(*fixture.grid, map, "test");
  ASSERT_EQ(shapes.bands.size(), 1u);
  EXPECT_EQ(shapes.bands[0].label, "yes");
  double pixels = 0;
  for (const float value : map.values) pixels += value == 1 ? 1 : 0;
  EXPECT_NEAR(OGR_G_Area(shapes.bands[0].geometry.get()) / (pixels * 500 * 500), 1, 1e-12);
  EXPECT_TRUE(shapes.lines.empty());
}

TEST(MapShapes, LevelsAreRoundNumbers) {
  const Fixture fixture;
  EXPECT_THAT(levelsOf(fixture.map(MapKind::probability, 70, 0, 1)), ElementsAre(0.1, 0.5, 0.9));
  EXPECT_THAT(levelsOf(fixture.map(MapKind::level, 70, -37, 15)),
              testing::Each(testing::Truly([](double level) { return std::remainder(level, 10) == 0; })));
  Map heights = fixture.map(MapKind::level, 70, 0, 700);
  heights.unit = "m";
  EXPECT_THAT(levelsOf(heights), ElementsAre(200, 400, 600));
  heights.values.assign(heights.values.size(), 3.0f);
  EXPECT_TRUE(levelsOf(heights).empty());
  EXPECT_EQ(shapesOf(*fixture.grid, heights, "test").bands.size(), 1u);
}

/// A folder with maps of each kind at two times, in all formats.
class MapFiles : public testing::Test {
 protected:
  void write(const std::string& name) const {
    MapFolder maps(folder.path() / name, fixture.study(),
                   {"cog", "png", "gpkg", "geojson", "nc", "kmz", "czml"});
    for (const double time_s : {70.0, 80.0}) {
      for (const Map& map : mapsOf(time_s)) maps.add(map);
    }
    maps.finish({});
  }
  std::vector<Map> mapsOf(double time_s) const {
    std::vector<Map> maps{fixture.map(MapKind::probability, time_s, 0.002, 0.999),
                          fixture.map(MapKind::classes, time_s, 0, 1),
                          fixture.map(MapKind::category, time_s, -1, 2)};
    maps[1].labels = {"no", "yes"};
    maps[1].area_class = 1;
    maps[2].labels = {"search radar", "it's", "third"};
    return maps;
  }

  const Fixture fixture;
  const test::TemporaryFolder folder;
};

TEST_F(MapFiles, TemporariesOfKilledProcessAreRemoved) {
  std::filesystem::create_directories(folder / "a/maps");
  for (const char* left : {"a/maps/coverage.gpkg", "a/report.html"}) test::leaveUnfinished(folder / left);
  folder.write("a/maps/notes.txt", "of the user");
  { const MapFolder maps(folder.path() / "a", fixture.study(), {"cog"}); }
  EXPECT_THAT(folder.files(), ElementsAre("a/maps/notes.txt"));
}

TEST_F(MapFiles, SLOW_TwoRunsWriteTheSameBytes) {
  write("a");
  write("b");
  for (const char* file : {"coverage.gpkg", "coverage.nc", "coverage.kmz", "coverage.czml"}) {
    const std::string name = std::string("maps/") + file;
    const std::string bytes = test::readFile(folder.path() / "a" / name);
    EXPECT_FALSE(bytes.empty()) << file;
    EXPECT_EQ(bytes, test::readFile(folder.path() / "b" / name)) << file;
  }
}

TEST_F(MapFiles, TheGeoPackageHoldsBandsContoursEmittersSitesAndTracks) {
  write("a");
  const Opened package = open(folder / "a/maps/coverage.gpkg", GDAL_OF_VECTOR);
  ASSERT_NE(package, nullptr);
  OGRLayer* const bands = package->GetLayerByName("bands");
  ASSERT_NE(bands, nullptr);
  EXPECT_EQ(bands->GetSpatialRef()->GetAuthorityCode(nullptr), std::string("32616"));
  std::set<std::string> labels;
  int first_time = 0;
  for (const OGRFeatureUniquePtr& feature : *bands) {
    labels.insert(feature->GetFieldAsString("label"));
    EXPECT_EQ(feature->GetFieldAsDouble("height"), 1500);
    EXPECT_STREQ(feature->GetFieldAsString("height_above"), "mean sea level");
    const std::string time = feature->GetFieldAsString("time");
    EXPECT_THAT(time, HasSubstr("2026/06/01 06:01:"));
    if (time.find("06:01:10") != std::string::npos) ++first_time;
  }
  EXPECT_THAT(labels, testing::IsSupersetOf({"yes", "search radar", "it's"}));
  EXPECT_EQ(2 * first_time, static_cast<int>(bands->GetFeatureCount()));
  EXPECT_GT(package->GetLayerByName("contours")->GetFeatureCount(), 0);
  OGRLayer* const emitters = package->GetLayerByName("emitters");
  EXPECT_EQ(emitters->GetFeatureCount(), 5) << "the jammer moves: two places";
  OGRLayer* const tracks = package->GetLayerByName("tracks");
  ASSERT_EQ(tracks->GetFeatureCount(), 1);
  const OGRFeatureUniquePtr track(tracks->GetNextFeature());
  EXPECT_GT(track->GetGeometryRef()->toLineString()->getM(1), 0);
  OGRLayer* const styles = package->GetLayerByName("layer_styles");
  EXPECT_EQ(styles->GetFeatureCount(), 5);
  OGRLayer* const sites = package->GetLayerByName("sites");
  EXPECT_EQ(sites->GetFeatureCount(), 5) << "the helicopter moves: two places";
  std::map<std::string, std::string> emitters_of;
  for (const OGRFeatureUniquePtr& feature : *sites) {
    const std::string name = feature->GetFieldAsString("name");
    emitters_of[name] = feature->GetFieldAsString("emitters");
    EXPECT_EQ(feature->GetFieldAsInteger("is_moving"), name == "helicopter" ? 1 : 0);
    EXPECT_EQ(feature->IsFieldSetAndNotNull(feature->GetFieldIndex("time")), name == "helicopter");
    EXPECT_GT(feature->GetFieldAsDouble("height_agl_m"), 1);
    EXPECT_GT(feature->GetFieldAsDouble("height_msl_m"), 200 + feature->GetFieldAsDouble("height_agl_m"));
  }
  EXPECT_EQ(emitters_of, (std::map<std::string, std::string>{{"ridge site", "search radar"},
                                                             {"valley site", "tracking radar"},
                                                             {"mast", "communications mast"},
                                                             {"helicopter", "jammer"}}));
}

TEST_F(MapFiles, AGeoTiffOfClassesNamesThem) {
  write("a");
  const Opened map = open(folder / "a/maps/best_msl1500m_t70s.tif", GDAL_OF_RASTER);
  ASSERT_NE(map, nullptr);
  GDALRasterBand* const band = map->GetRasterBand(1);
  const GDALRasterAttributeTable* const table = band->GetDefaultRAT();
  ASSERT_NE(table, nullptr);
  char** const names = band->GetCategoryNames();  // GDAL 3.6 has them after the table
  ASSERT_EQ(CSLCount(names), 3);
  EXPECT_STREQ(names[1], "it's");
  EXPECT_STREQ(table->GetValueAsString(2, table->GetColOfUsage(GFU_Name)), "third");
  EXPECT_STREQ(map->GetMetadataItem("EMSCAPE_TIME_S"), "70");
  EXPECT_STREQ(map->GetMetadataItem("EMSCAPE_TIME_UTC"), "2026-06-01T06:01:10.000Z");
  EXPECT_THAT(test::readFile(folder / "a/study.json"), HasSubstr("best_msl1500m_t70s.tif.aux.xml"));
  EXPECT_FALSE(std::filesystem::exists(folder / "a/maps/value_msl1500m_t70s.tif.aux.xml"));
}

TEST_F(MapFiles, AGeoTiffHoldsCountsUpTo254) {
  Map counts = fixture.map(MapKind::count, 70, 0, 300);
  const std::size_t largest = summaryOf(*fixture.grid, counts).largest_pixel;
  ASSERT_GT(counts.values[largest], 254);
  const std::string file = folder / "counts.tif";
  writeGeoTiff(file, *fixture.grid, counts, {});
  const Opened dataset = open(file, GDAL_OF_RASTER);
  std::uint8_t value = 0;
  const int width = fixture.grid->width, index = static_cast<int>(largest);
  ASSERT_EQ(dataset->GetRasterBand(1)->RasterIO(GF_Read, index % width, index / width, 1, 1, &value, 1, 1,
                                                GDT_Byte, 0, 0, nullptr),
            CE_None);
  EXPECT_EQ(value, 254);
}

TEST_F(MapFiles, AGeoTiffHasTheColoursOfThePicture) {
  Map covered = fixture.map(MapKind::classes, 70, 0, 1);
  covered.labels = {"no", "yes"};
  covered.colors = {2, 2};
  for (const Map& map : {fixture.map(MapKind::count, 70, 0, 5), covered}) {
    const std::string file = folder / (map.name + ".tif");
    writeGeoTiff(file, *fixture.grid, map, {});
    const Opened dataset = open(file, GDAL_OF_RASTER);
    const GDALColorTable* const table = dataset->GetRasterBand(1)->GetColorTable();
    ASSERT_NE(table, nullptr);
    const render::Legend legend = legendOf(map);
    for (const int n : {0, 1}) {
      const auto color = colorOf(map, legend, static_cast<float>(n));
      const GDALColorEntry* const entry = table->GetColorEntry(n);
      EXPECT_NEAR(entry->c2, color ? 255 * color->g : 255, 1) << map.name << " " << n;
    }
    EXPECT_EQ(table->GetColorEntry(255)->c4, 0);
  }
}

TEST_F(MapFiles, TheReportHasTheAreaOfEachBestEmitter) {
  Map best = fixture.map(MapKind::category, 70, -1, 1);
  best.labels = {"search radar", "tracking radar"};
  const MapSummary summary = summaryOf(*fixture.grid, best);
  double areas_m2[2] = {0, 0};
  for (std::size_t p = 0; p < fixture.grid->pixels(); ++p) {
    if (best.values[p] >= 0) areas_m2[static_cast<int>(best.values[p])] += fixture.grid->areas_m2[p];
  }
  EXPECT_THAT(summary.label_areas_m2, ElementsAre(areas_m2[0], areas_m2[1]));
  const ReportTable table = tableOf({{best, summary, {}}});
  ASSERT_EQ(table.rows.size(), 2u);
  EXPECT_EQ(table.rows[0][0], "best: search radar");
  EXPECT_EQ(table.rows[0][3], figureText(areas_m2[0] / 1e6, "km2"));
  EXPECT_EQ(table.rows[0][5], "");
}

TEST(FigureText, HasTheDigitsOfTheUnit) {
  EXPECT_EQ(figureText(4.19996e-05, ""), "0.0000");
  EXPECT_EQ(figureText(614.522, "km2"), "614.522");
  EXPECT_EQ(figureText(-3.14159, "dBW/m2"), "-3.14");
  EXPECT_EQ(figureText(645.625, "m"), "645.6");
  EXPECT_EQ(figureText(12.3456, "s"), "12.35");
  EXPECT_EQ(figureText(NAN, "dB"), "none");
}

TEST_F(MapFiles, TheNetCdfHoldsTheValuesOverTimeAndHeight) {
  write("a");
  const Opened file = open(folder / "a/maps/coverage.nc", GDAL_OF_MULTIDIM_RASTER);
  ASSERT_NE(file, nullptr);
  const auto root = file->GetRootGroup();
  EXPECT_STREQ(root->GetAttribute("Conventions")->ReadAsString(), "CF-1.8");
  const auto value = root->OpenMDArray("value_msl");
  ASSERT_NE(value, nullptr);
  EXPECT_EQ(value->GetUnit(), "1");
  const auto& dimensions = value->GetDimensions();
  ASSERT_EQ(dimensions.size(), 4u);
  EXPECT_EQ(dimensions[0]->GetName(), "time");
  EXPECT_EQ(dimensions[1]->GetName(), "height_msl");
  std::vector<float> read(fixture.grid->pixels());
  const GUInt64 start[] = {1, 0, 0, 0};
  const std::size_t count[] = {1, 1, static_cast<std::size_t>(fixture.grid->height),
                               static_cast<std::size_t>(fixture.grid->width)};
  ASSERT_TRUE(
      value->Read(start, count, nullptr, nullptr, GDALExtendedDataType::Create(GDT_Float32), read.data()));
  const Map map = mapsOf(80)[0];
  for (std::size_t p = 0; p < read.size(); ++p) {
    ASSERT_TRUE(read[p] == map.values[p] || (std::isnan(read[p]) && std::isnan(map.values[p])));
  }
  EXPECT_STREQ(root->OpenMDArray("covered_msl")->GetAttribute("flag_meanings")->ReadAsString(), "no yes");
  EXPECT_STREQ(root->OpenMDArray("best_msl")->GetAttribute("flag_meanings")->ReadAsString(),
               "none search_radar it_s third");
  EXPECT_STREQ(root->OpenMDArray("best_msl")->GetAttribute("flag_labels")->ReadAsString(),
               "none\nsearch radar\nit's\nthird");
  EXPECT_EQ(root->OpenMDArray("time")->GetUnit(), "seconds since 2026-06-01T06:00:00.000Z");
}

TEST_F(MapFiles, NetCdfFlagMeaningsOfEmittersDiffer) {
  Map best = fixture.map(MapKind::category, 70, -1, 3);
  best.labels = {"\u0441\u0435\u0432\u0435\u0440", "\u044E\u0436\u043D\u044B\u0439", "a b", "a_b"};
  MapFolder maps(folder.path() / "a", fixture.study(), {"nc"});
  maps.add(best);
  maps.finish({});
  const Opened file = open(folder / "a/maps/coverage.nc", GDAL_OF_MULTIDIM_RASTER);
  ASSERT_NE(file, nullptr);
  const auto variable = file->GetRootGroup()->OpenMDArray("best_msl");
  ASSERT_NE(variable, nullptr);
  EXPECT_STREQ(variable->GetAttribute("flag_meanings")->ReadAsString(),
               "none __________ ___________ a_b a_b_");
  EXPECT_EQ(variable->GetAttribute("flag_labels")->ReadAsString(),
            "none\n" + best.labels[0] + "\n" + best.labels[1] + "\na b\na_b");
}

TEST_F(MapFiles, TheRecordIsOfTheTerrainThatTheMapsAreComputedFrom) {
  const std::filesystem::path copy = folder.path() / "own", raster = copy / "data/jacksboro.tif";
  const std::filesystem::path shipped = test::shippedScenario("jacksboro.yaml");
  std::filesystem::create_directory(copy);
  std::filesystem::copy(shipped, copy);
  std::filesystem::copy(shipped.parent_path() / "data", copy / "data",
                        std::filesystem::copy_options::recursive);
  MapStudy study = fixture.study();
  study.scenarios = {scenario::loadScenario((copy / "jacksboro.yaml").string())};
  const std::string crc32 = fmt::format("{:08x}", digestOf(raster).crc32);
  for (const bool is_removed : {false, true}) {
    MapFolder maps(folder.path() / "a", study, {"cog"});
    maps.add(fixture.map(MapKind::level, 70, -37, 26));
    folder.write("own/data/jacksboro.tif", "another one");
    if (is_removed) std::filesystem::remove(raster);
    maps.finish({});
    EXPECT_THAT(test::readFile(folder / "a/study.json"), HasSubstr(crc32));
    std::filesystem::copy(shipped.parent_path() / "data/jacksboro.tif", raster,
                          std::filesystem::copy_options::overwrite_existing);
  }
}

/// A picture of a KMZ file.
struct KmzOverlay {
  std::string kml;
  double north_deg = 0, south_deg = 0, east_deg = 0, west_deg = 0;  ///< of the first picture
  int width = 0, height = 0;
  std::vector<std::uint8_t> alpha;

  KmzOverlay(const std::string& file, const std::string& map) {
    const std::string archive = "/vsizip/" + file;
    GByte* bytes = nullptr;
    vsi_l_offset size = 0;
    if (VSIIngestFile(nullptr, (archive + "/doc.kml").c_str(), &bytes, &size, -1) == FALSE) return;
    kml.assign(reinterpret_cast<const char*>(bytes), size);
    VSIFree(bytes);
    for (const auto& [name, edge_deg] :
         {std::pair{"north", &north_deg}, {"south", &south_deg}, {"east", &east_deg}, {"west", &west_deg}}) {
      const std::string tag = fmt::format("<{}>", name);
      *edge_deg = std::stod(kml.substr(kml.find(tag) + tag.size()));
    }
    const Opened picture = open(archive + "/files/" + map + ".png", GDAL_OF_RASTER);
    if (picture == nullptr || picture->GetRasterCount() != 4) return;
    width = picture->GetRasterXSize();
    height = picture->GetRasterYSize();
    alpha.resize(static_cast<std::size_t>(width) * height);
    EXPECT_EQ(picture->GetRasterBand(4)->RasterIO(GF_Read, 0, 0, width, height, alpha.data(), width, height,
                                                  GDT_Byte, 0, 0, nullptr),
              CE_None);
  }
};

/// Expects that an overlay is opaque where a map's class is 1.
void expectShows(const KmzOverlay& overlay, const MapGrid& grid, const Map& covered) {
  ASSERT_FALSE(overlay.alpha.empty());
  int wrong = 0, compared = 0;
  for (std::size_t p = 0; p < covered.values.size(); ++p) {
    if (std::isnan(covered.values[p])) continue;
    const auto [latitude_deg, longitude_deg] = grid.positions[p];
    const int x = static_cast<int>((longitude_deg - overlay.west_deg) /
                                   (overlay.east_deg - overlay.west_deg) * overlay.width);
    const int y = static_cast<int>((overlay.north_deg - latitude_deg) /
                                   (overlay.north_deg - overlay.south_deg) * overlay.height);
    ASSERT_TRUE(x >= 0 && x < overlay.width && y >= 0 && y < overlay.height);
    if ((overlay.alpha[static_cast<std::size_t>(y) * overlay.width + x] > 0) != (covered.values[p] == 1))
      ++wrong;
    ++compared;
  }
  EXPECT_GT(compared, 500);
  EXPECT_LT(wrong, compared / 20) << "only at the edges of what is covered";
}

TEST_F(MapFiles, KmzPlacesAMap) {
  write("a");
  const KmzOverlay overlay(folder / "a/maps/coverage.kmz", "covered_msl1500m_t70s");
  EXPECT_THAT(overlay.kml, HasSubstr("Coverage of &lt;jacksboro&gt;"));
  EXPECT_THAT(overlay.kml,
              HasSubstr("<begin>2026-06-01T06:01:10.000Z</begin><end>2026-06-01T06:01:20.000Z</end>"));
  expectShows(overlay, *fixture.grid, mapsOf(70)[1]);
}

TEST_F(MapFiles, KmzPlacesAMapOverAPole) {
  struct Case {
    std::string name, area;
    double cell_m;
  };
  for (const auto& [name, area, cell_m] : {Case{"north", "90,10,20000", 400},
                                           {"south", "-89.97,10,20000", 400},
                                           {"north_beyond_the_equator", "bbox:-180,-10,180,90", 200000},
                                           {"south_beyond_the_equator", "bbox:-180,-90,180,10", 200000}}) {
    SCOPED_TRACE(name);
    const bool is_north = name[0] == 'n';
    Fixture polar;
    polar.area = parseArea(area);
    polar.grid = std::make_shared<const MapGrid>(makeMapGrid(polar.area, cell_m, "local"));
    MapStudy study = fixture.study();
    study.grid = polar.grid;
    MapFolder maps(folder.path() / name, study, {"kmz"});
    Map covered = polar.map(MapKind::classes, 70, 0, 1);
    covered.labels = {"no", "yes"};
    covered.area_class = 1;
    maps.add(covered);
    maps.finish({});
    const KmzOverlay overlay(folder / (name + "/maps/coverage.kmz"), "covered_msl1500m_t70s");
    EXPECT_EQ(overlay.east_deg - overlay.west_deg, 360);
    EXPECT_EQ(is_north ? overlay.north_deg : overlay.south_deg, is_north ? 90 : -90);
    expectShows(overlay, *polar.grid, covered);
  }
}

TEST_F(MapFiles, TheCzmlHasPolygonsForTheirTimes) {
  write("a");
  const auto packets = nlohmann::json::parse(test::readFile(folder / "a/maps/coverage.czml"));
  ASSERT_EQ(packets[0]["id"], "document");
  int polygons = 0;
  std::set<std::string> ids, times;
  for (const auto& packet : packets) {
    EXPECT_TRUE(ids.insert(packet["id"]).second) << packet["id"];
    if (!packet.contains("polygon")) continue;
    ++polygons;
    times.insert(packet["availability"]);
    EXPECT_EQ(packet["polygon"]["positions"]["cartographicDegrees"].size() % 3, 0u);
  }
  EXPECT_GT(polygons, 2);
  EXPECT_THAT(times, ElementsAre("2026-06-01T06:01:10.000Z/2026-06-01T06:01:20.000Z",
                                 "2026-06-01T06:01:20.000Z/2026-06-01T06:01:30.000Z"));
}

TEST_F(MapFiles, EmittersOfTheCzmlMoveWithTheirTracksAlsoForASingleTime) {
  MapStudy study = fixture.study();
  study.times_s = {70};
  MapFolder maps(folder.path() / "one", study, {"czml"});
  for (const Map& map : mapsOf(70)) maps.add(map);
  maps.finish({});
  const auto packets = nlohmann::json::parse(test::readFile(folder / "one/maps/coverage.czml"));
  int moving = 0;
  for (const scenario::Emitter& emitter : fixture.scenario->emitters) {
    if (!fixture.scenario->platforms[static_cast<std::size_t>(emitter.platform)].moves()) continue;
    for (const auto& packet : packets) {
      if (packet.value("name", "") != emitter.name) continue;
      EXPECT_EQ(packet["position"].value("reference", ""), "track/0#position") << packet;
      ++moving;
    }
  }
  EXPECT_EQ(moving, 1);
}

TEST_F(MapFiles, AbsentPlatformsHaveNoPositionInMaps) {
  const std::string track =
      "{points: [{t_s: 75, latitude_deg: 36.3, longitude_deg: -84.2, height_msl_m: 2000}, {t_s: 85, "
      "latitude_deg: "
      "36.31, longitude_deg: -84.2, height_msl_m: 2000}]}";
  MapStudy study = fixture.study();
  scenario::Scenario late = *fixture.scenario;
  late.set("platforms.helicopter.track", track);
  study.scenarios = {std::make_shared<const scenario::Scenario>(late)};
  for (const MapSite& site : sitesOf(study)) {
    if (site.platform != "helicopter") continue;
    ASSERT_EQ(site.positions.size(), 1u);
    EXPECT_EQ(site.positions[0].time_s, 80);
  }
  ASSERT_EQ(tracksOf(study).size(), 1u);
  EXPECT_EQ(tracksOf(study)[0].positions.front().time_s, 75);
  EXPECT_EQ(tracksOf(study)[0].positions.back().time_s, 85);
  MapFolder maps(folder.path() / "late", study, {"czml", "gpkg", "kmz"});
  for (const Map& map : mapsOf(70)) maps.add(map);
  maps.finish({});
  const auto packets = nlohmann::json::parse(test::readFile(folder / "late/maps/coverage.czml"));
  for (const auto& packet : packets) {
    if (packet["id"] != "track/0") continue;
    EXPECT_EQ(packet["availability"], "2026-06-01T06:01:15.000Z/2026-06-01T06:01:25.000Z");
    EXPECT_EQ(packet["position"]["forwardExtrapolationType"], "NONE");
    EXPECT_EQ(packet["position"]["backwardExtrapolationType"], "NONE");
  }
}

TEST_F(MapFiles, FullDiskOfGeoPackageIsOneErrorWithoutGdalOutput) {
  for (const rlim_t bytes : {0, 50000, 100000, 150000}) {
    const test::TemporaryFolder full;
    testing::internal::CaptureStderr();
    const std::string message = test::errorOf([&] {
      MapFolder maps(full.path() / "out", fixture.study(), {"gpkg"});
      const test::FileSizeLimit limit(bytes);
      for (const Map& map : mapsOf(70)) maps.add(map);
      maps.finish({});
    });
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << bytes;
    EXPECT_THAT(message, HasSubstr("coverage.gpkg: cannot be written (")) << bytes;
    EXPECT_THAT(message, testing::Not(HasSubstr("sqlite3_exec"))) << bytes;
  }
}

TEST_F(MapFiles, FullDiskOfNetCdfIsOneErrorWithoutGdalOutput) {
  for (const rlim_t bytes : {0, 600, 3000, 20000}) {
    const test::TemporaryFolder full;
    testing::internal::CaptureStderr();
    const std::string message = test::errorOf([&] {
      MapFolder maps(full.path() / "out", fixture.study(), {"nc"});
      const test::FileSizeLimit limit(bytes);
      for (const Map& map : mapsOf(70)) maps.add(map);
      maps.finish({});
    });
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << bytes;
    EXPECT_THAT(message, AllOf(HasSubstr("coverage.nc: cannot be written"), HasSubstr("File too large")))
        << bytes;
  }
}

TEST_F(MapFiles, AFileThatCannotBeWrittenIsNamedAndRemoved) {
  for (const char* format : {"cog", "gpkg", "geojson", "nc", "kmz", "czml"}) {
    const test::TemporaryFolder full;
    const std::string message = test::errorOf([&] {
      MapFolder maps(full.path() / "out", fixture.study(), {format});
      const test::FileSizeLimit limit(600);
      for (const Map& map : mapsOf(70)) maps.add(map);
      maps.finish({});
    });
    EXPECT_THAT(message, AllOf(HasSubstr("out/maps/"), HasSubstr("File too large"))) << format;
    for (const std::string& file : full.files()) {
      EXPECT_THAT(file, testing::EndsWith("never")) << format << " leaves this behind";
    }
  }
}

TEST_F(MapFiles, UnknownFormatsAndHeightsAreRefused) {
  EXPECT_THAT(test::errorOf([&] { MapFolder(folder.path() / "x", fixture.study(), {"shp"}); }),
              HasSubstr("unknown format 'shp'; one of cog, png, gpkg"));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "x"));
  MapFolder maps(folder.path() / "y", fixture.study(), {"nc"});
  Map map = mapsOf(70)[0];
  map.height->metres = 77;
  EXPECT_THAT(test::errorOf([&] { maps.add(map); }), HasSubstr("77 is neither a time nor a height"));
}

TEST(MapObjects, TracksAreCutAtTheAntimeridian) {
  scenario::Platform aircraft;
  MapTrack track{&aircraft, {{0, {10, 179, 0}, 100}, {10, {12, -179, 0}, 300}, {20, {12, -178, 0}, 300}}};
  const std::vector<MapTrack> parts = cutAtAntimeridian(track);
  ASSERT_EQ(parts.size(), 2u);
  ASSERT_EQ(parts[0].positions.size(), 2u);
  ASSERT_EQ(parts[1].positions.size(), 3u);
  const MapPosition &end = parts[0].positions.back(), &begin = parts[1].positions.front();
  EXPECT_EQ(end.position.longitude_deg, 180);
  EXPECT_EQ(begin.position.longitude_deg, -180);
  for (const MapPosition* at : {&end, &begin}) {
    EXPECT_NEAR(at->position.latitude_deg, 11, 1e-12);
    EXPECT_NEAR(at->time_s, 5, 1e-12);
    EXPECT_NEAR(at->height_msl_m, 200, 1e-9);
  }
  EXPECT_EQ(parts[1].platform, &aircraft);
  track.positions.erase(track.positions.begin());
  EXPECT_EQ(cutAtAntimeridian(track).size(), 1u);
}

double areaOf(const MapShapes& shapes, double above) {
  double area = 0;
  for (const MapBand& band : shapes.bands)
    if (band.min >= above) area += OGR_G_Area(band.geometry.get());
  return area;
}

TEST(MapShapes, FollowThePixelsBesideThoseWithoutAnEcho) {
  const Fixture fixture;
  Map map = fixture.map(MapKind::probability, 80, 0.92, 0.99);
  std::size_t covered = 0, known = 0;
  for (std::size_t p = 0; p < map.values.size(); ++p) {
    if (std::isnan(map.values[p])) continue;
    ++known;
    if (p % fixture.grid->width < 20) {
      map.values[p] = 0;
    } else {
      ++covered;
    }
  }
  const MapShapes shapes = shapesOf(*fixture.grid, map, "none");
  const double pixel_m2 = fixture.grid->cell_m * fixture.grid->cell_m;
  EXPECT_NEAR(areaOf(shapes, 0.9), covered * pixel_m2, 1e-3 * covered * pixel_m2);
  EXPECT_NEAR(areaOf(shapes, 0), known * pixel_m2, 1e-3 * known * pixel_m2) << "no gaps";
  EXPECT_EQ(shapes.bands.front().min, 0);
  EXPECT_EQ(shapes.bands.size(), 2U) << "none between 0.1 and 0.9";
  for (const MapBand& band : shapes.bands) EXPECT_TRUE(OGR_G_IsValid(band.geometry.get()));
  std::fill(map.values.begin(), map.values.end(), 0.0F);
  EXPECT_EQ(shapesOf(*fixture.grid, map, "none").bands.size(), 1U);
}

TEST(MapFolder, GeoJsonIsCutWhereTheLongitudeTurns) {
  Fixture fixture;
  MapStudy study = fixture.study();
  study.grid = fixture.grid =
      std::make_shared<const MapGrid>(makeMapGrid(parseArea("51,180,9000"), 500, "utm"));
  const test::TemporaryFolder folder;
  MapFolder maps(folder.path(), study, {"geojson"});
  maps.add(fixture.map(MapKind::level, 80, -100, -20));
  maps.finish({});
  const nlohmann::json json = nlohmann::json::parse(test::readFile(folder / "maps/coverage.geojson"));
  int in_west = 0, in_east = 0;
  for (const auto& feature : json["features"]) {
    if (feature["properties"]["layer"] != "bands") continue;
    for (const auto& polygon : feature["geometry"]["coordinates"]) {
      double west = 1000, east = -1000;
      for (const auto& ring : polygon) {
        for (const auto& at : ring) {
          west = std::min(west, at[0].get<double>());
          east = std::max(east, at[0].get<double>());
        }
      }
      EXPECT_GE(west, -180);
      EXPECT_LE(east, 180);
      EXPECT_LT(east - west, 1);
      ++(west < 0 ? in_west : in_east);
    }
  }
  EXPECT_GT(in_west, 0);
  EXPECT_GT(in_east, 0);
}

TEST(MapFolder, FilesOfAnEditedScenarioSayWhatWasChanged) {
  Fixture fixture;
  const std::vector<scenario::Edit> edits{{"emitters.search radar.power_w", "500"},
                                          {"emitters.jammer.enabled", "false"}};
  fixture.scenario = scenario::loadScenario(test::shippedScenario("jacksboro.yaml"), edits);
  const test::TemporaryFolder folder;
  MapFolder maps(folder.path(), fixture.study(), {"cog", "png", "geojson", "nc", "gpkg"});
  maps.add(fixture.map(MapKind::level, 80, -100, -20));
  maps.finish({});
  const std::string changes =
      "changed: emitters.search radar.power_w=500\nchanged: emitters.jammer.enabled=false";
  const Opened tif = open(folder / "maps/value_msl1500m_t80s.tif", GDAL_OF_RASTER);
  EXPECT_EQ(std::string(tif->GetMetadataItem("EMSCAPE_SCENARIO_CHANGES")), changes);
  EXPECT_THAT(test::readFile(folder / "maps/value_msl1500m_t80s.png"), HasSubstr("iTXtComment"));
  EXPECT_THAT(test::readFile(folder / "maps/value_msl1500m_t80s.png"), HasSubstr(changes));
  EXPECT_EQ(scenario::titleOf(*fixture.scenario), "jacksboro (2 values changed)");
  const nlohmann::json json = nlohmann::json::parse(test::readFile(folder / "maps/coverage.geojson"));
  int off = 0;
  for (const auto& feature : json["features"]) {
    const auto& properties = feature["properties"];
    if (properties["layer"] == "emitters")
      off += properties["enabled"] == (properties["kind"] != "jammer") ? 0 : 1;
  }
  EXPECT_EQ(off, 0);
}

}  // namespace
}  // namespace emscape::study
