/// Elevation files as they are downloaded: folders, patterns, archives, HGT of all sizes, other formats,
/// pictures.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "emscape/scenario/terrain/terrain.h"
#include "scenario/terrain/file_names.h"
#include "tests/scenario/dem_file.h"
#include "tests/support/errors.h"
#include "tests/support/temporary_folder.h"

namespace emscape::scenario {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr GeoBox kBox{49.2, 49.8, 10.2, 10.8};

class TerrainNames : public testing::Test {
 protected:
  /// Of the tiles, so that the east of the largest is no higher than the earth.
  static int postsPerMetre(int posts) { return posts > 8000 ? 2 : 1; }
  /// A tile of 1 degree at 49 N, 10 E: 1000 in the west, 1000 + posts in the east.
  std::string tile(const std::string& name, int posts = 121) const {
    test::writeHgt(folder_ / name, posts,
                   [&](int column, int) { return 1000 + column / postsPerMetre(posts); });
    return folder_ / name;
  }
  std::string raster(const std::string& name) const {
    test::geographicDem(10, 50, 0.1, 10, 10, [](double, double longitude_deg) {
      return 100 * longitude_deg;
    }).write(folder_ / name);
    return folder_ / name;
  }
  static TerrainPtr load(const std::vector<std::string>& files, const TerrainFileKeys& keys = {},
                         const GeoBox& box = kBox) {
    TerrainSpec spec;
    spec.files = files;
    spec.keys.assign(files.size(), keys);
    return Terrain::load(spec, box);
  }
  static std::string problemOf(const std::string& file, const TerrainFileKeys& keys = {}) {
    return test::errorOf([&] { load({file}, keys); }, ErrorCode::bad_input);
  }
  void expectTile(const std::string& name, int posts) const {
    const TerrainPtr terrain = load({name});
    EXPECT_NEAR(terrain->heightMsl_m(49.5, 10.25), 1000 + 0.25 * (posts - 1) / postsPerMetre(posts), 0.01)
        << name;
    EXPECT_NEAR(terrain->postSpacing_m(), 111200.0 * std::cos(49.5 / 57.2958) / (posts - 1), 1500.0 / posts)
        << name;
    if (posts == 1201 || posts == 3601 || posts == 7201 || posts == 10801) {
      EXPECT_THAT(terrain->warnings(), IsEmpty()) << name;
    } else {
      EXPECT_THAT(terrain->warnings(),
                  ElementsAre(HasSubstr(fmt::format("{} posts a side, {} in a degree", posts, posts - 1))))
          << name;
    }
  }
  /// Runs a command line of a message. False: the program is not installed.
  bool run(const std::string& command) const {
    if (std::system("command -v gdal_translate > /dev/null") != 0) return false;
    EXPECT_EQ(std::system(("cd " + folder_.path().string() + " && " + command + " > log 2>&1").c_str()), 0)
        << command;
    return true;
  }

  test::TemporaryFolder folder_;
};

TEST_F(TerrainNames, HgtOfAnySquareSizeIsPlacedByItsName) {
  for (const int posts : {121, 1201, 1801}) {
    for (const char* name :
         {"N49E010.hgt", "n49_e010_1arc_v3.hgt", "copy of N49E010 (1).hgt", "N49E010.SRTMGL1.hgt"})
      expectTile(tile(name, posts), posts);
  }
}

TEST_F(TerrainNames, SLOW_HgtOfHalfAndThirdOfASecondIsRead) {
  for (const int posts : {7201, 10801}) expectTile(tile("N49E010.hgt", posts), posts);
}

TEST_F(TerrainNames, HgtWithoutAPositionIsReadAfterItIsRenamed) {
  for (const char* name : {"elevation.hgt", "N49E010_N48E010.hgt", "S34W271.hgt"})
    EXPECT_THAT(problemOf(tile(name)), HasSubstr("Rename it to that of its south-western corner")) << name;
  fs::rename(folder_ / "elevation.hgt", folder_ / "N49E010.hgt");
  expectTile(folder_ / "N49E010.hgt", 121);
  std::ofstream(folder_ / "N49E010.hgt") << "abc";
  EXPECT_THAT(problemOf(folder_ / "N49E010.hgt"), HasSubstr("has 3 bytes, which is no square of posts"));
}

TEST_F(TerrainNames, FolderStandsForItsFilesWithoutMasks) {
  const std::string a = tile("N49E010.hgt"), b = raster("b.tif");
  for (const char* name : {"N49E010_num.tif", "b_hillshade.tif", "slope.tif", "._b.tif"}) raster(name);
  std::ofstream(folder_ / "readme.txt") << "text";
  test::writeZip(folder_ / "manual.zip", {{"readme.txt", folder_ / "readme.txt"}});
  EXPECT_THAT(elevationFilesOf(folder_.path().string()), ElementsAre(a, b, folder_ / "manual.zip"));
  EXPECT_EQ(load({folder_.path().string()})->uncoveredFraction(), 0);
  fs::create_directories(folder_ / "empty/inner");
  EXPECT_THAT(problemOf(folder_ / "empty"),
              AllOf(HasSubstr("empty has none (by their endings, and no masks: .tif"),
                    HasSubstr("named by a pattern, such as " + folder_ / "empty/*/*.tif")));
}

TEST_F(TerrainNames, FilesOfMacOsInAnArchiveAreLeftOut) {
  tile("N49E010.hgt");
  std::ofstream(folder_ / "properties") << "Mac OS X";
  test::writeZip(folder_ / "a.zip", {{"N49E010.hgt", folder_ / "N49E010.hgt"},
                                     {"__MACOSX/._N49E010.hgt", folder_ / "properties"}});
  expectTile(folder_ / "a.zip", 121);
}

TEST_F(TerrainNames, OfFilesThatDisagreeTheOneThatIsUsedIsTold) {
  const auto write = [&](const std::string& name, double height_m) {
    test::geographicDem(10, 50, 0.1, 10, 10, [=](double, double) { return height_m; }).write(folder_ / name);
    return folder_ / name;
  };
  const std::string a = write("a.tif", 150), b = write("b.tif", 400), c = write("c.tif", 160);
  EXPECT_THAT(load({a, b})->warnings(),
              testing::Contains(AllOf(HasSubstr("b.tif"), HasSubstr("differ by 250 m on average"))));
  EXPECT_THAT(load({a, c})->warnings(), testing::Not(testing::Contains(HasSubstr("on average"))));
}

TEST_F(TerrainNames, AWebPageIsNoTile) {
  std::ofstream(folder_ / "N49E010.hgt") << "\n<!DOCTYPE html><html>Please log in</html>";
  EXPECT_THAT(problemOf(folder_ / "N49E010.hgt"), HasSubstr("is a web page"));
}

TEST_F(TerrainNames, PatternStandsForTheFilesThatMatch) {
  const std::string a = tile("N49E010.hgt"), b = tile("N49E011.hgt");
  EXPECT_THAT(elevationFilesOf(folder_ / "N*.hgt"), ElementsAre(a, b));
  EXPECT_THAT(elevationFilesOf(folder_ / "N49E01?.hgt"), ElementsAre(a, b));
  EXPECT_THAT(problemOf(folder_ / "*.dt1"), HasSubstr("no file matches the pattern"));
  std::ofstream(folder_ / "odd*name.tif") << "";
  EXPECT_THAT(elevationFilesOf(folder_ / "odd*name.tif"), ElementsAre(folder_ / "odd*name.tif"));
}

TEST_F(TerrainNames, ArchivesAreReadWithoutUnpackingThemOnTheDisk) {
  tile("N49E010.hgt");
  test::writeZip(folder_ / "N49E010.SRTMGL1.hgt.zip", {{"N49E010.hgt", folder_ / "N49E010.hgt"}});
  test::writeGzip(folder_ / "N49E010.hgt", folder_ / "N49E010.hgt.gz");
  test::writeZip(folder_ / "two.zip", {{"a/N49E010.hgt", folder_ / "N49E010.hgt"},
                                       {"a/N49E010.num", folder_ / "N49E010.hgt"},
                                       {"a/N49E011.hgt", folder_ / "N49E010.hgt"}});
  fs::remove(folder_ / "N49E010.hgt");
  for (const char* name : {"N49E010.SRTMGL1.hgt.zip", "N49E010.hgt.gz", "two.zip"})
    expectTile(folder_ / name, 121);
  EXPECT_EQ(load({folder_ / "two.zip"}, {}, {49.2, 49.8, 11.2, 11.8})->uncoveredFraction(), 0);
  int files = 0;
  for (const auto& entry : fs::directory_iterator(folder_.path())) files += entry.exists() ? 1 : 0;
  EXPECT_EQ(files, 3) << "nothing is written beside them";
}

TEST_F(TerrainNames, ArchiveOfABilHasItsHeader) {
  test::convertDem(raster("a.tif"), "EHdr", folder_ / "a.bil");
  test::writeZip(
      folder_ / "a.zip",
      {{"x/a.bil", folder_ / "a.bil"}, {"x/a.hdr", folder_ / "a.hdr"}, {"x/a.prj", folder_ / "a.prj"}});
  EXPECT_NEAR(load({folder_ / "a.zip"})->heightMsl_m(49.5, 10.5), 1050, 1e-3);
}

TEST_F(TerrainNames, BrokenArchivesAreNamed) {
  std::ofstream(folder_ / "a.zip") << "not a zip";
  EXPECT_THAT(problemOf(folder_ / "a.zip"), HasSubstr("a.zip: cannot be read as a ZIP archive"));
  std::ofstream(folder_ / "a.tif.gz") << "not a gz";
  EXPECT_THAT(problemOf(folder_ / "a.tif.gz"), HasSubstr("a.tif.gz"));
  std::ofstream(folder_ / "notes.txt") << "text";
  test::writeZip(folder_ / "notes.zip", {{"notes.txt", folder_ / "notes.txt"}});
  EXPECT_THAT(problemOf(folder_ / "notes.zip"), HasSubstr("none of its 1 members is an elevation file"));
  std::ofstream(folder_ / "a.tar.gz") << "";
  EXPECT_THAT(problemOf(folder_ / "a.tar.gz"), HasSubstr("unpack it (tar xf)"));
}

TEST_F(TerrainNames, OtherFormatsAreRead) {
  const std::string from = raster("a.tif");
  for (const auto& [driver, ending] :
       {std::pair{"HFA", "img"}, {"netCDF", "nc"}, {"GPKG", "gpkg"}, {"EHdr", "bil"}, {"AAIGrid", "asc"}}) {
    const std::string file = folder_ / ("b." + std::string(ending));
    test::convertDem(from, driver, file);
    EXPECT_NEAR(load({file})->heightMsl_m(49.5, 10.5), 1050, 1e-3) << driver;
    EXPECT_TRUE(isElevationName(file));
  }
}

TEST_F(TerrainNames, KeyOfTheSystemIsTheRemedyForFilesWithoutOne) {
  const std::string from = raster("a.tif");
  TerrainFileKeys keys;
  keys.crs = "EPSG:4326";
  for (const auto& [driver, ending] : {std::pair{"XYZ", "xyz"}, {"AAIGrid", "asc"}}) {
    const std::string file = folder_ / ("c." + std::string(ending));
    test::convertDem(from, driver, file);
    fs::remove(folder_ / "c.prj");
    fs::remove(file + ".aux.xml");
    EXPECT_THAT(problemOf(file), HasSubstr("`crs: EPSG:4326` of the file in the scenario states")) << driver;
    EXPECT_NEAR(load({file}, keys)->heightMsl_m(49.5, 10.5), 1050, 1e-3) << driver;
  }
  keys.crs = "EPSG:32632";
  EXPECT_THAT(problemOf(from, keys),
              HasSubstr("'crs: EPSG:32632' of the scenario contradicts the file, which states"));
  keys.crs = "http://127.0.0.1:1/x.prj";
  EXPECT_THAT(problemOf(from, keys), HasSubstr("is not EPSG: and the number"));
}

TEST_F(TerrainNames, OtherFormatsNameThemselvesAndTheCommandThatWorks) {
  test::convertDem(raster("a.tif"), "RST", folder_ / "a.rst");
  EXPECT_THAT(problemOf(folder_ / "a.rst"),
              AllOf(HasSubstr("RST (Idrisi Raster"),
                    HasSubstr("gdal_translate " + folder_ / "a.rst" + " HEIGHTS.tif")));
  if (!run("gdal_translate a.rst HEIGHTS.tif")) GTEST_SKIP() << "gdal_translate is not installed";
  EXPECT_NEAR(load({folder_ / "HEIGHTS.tif"})->heightMsl_m(49.5, 10.5), 1050, 1e-3);
}

TEST_F(TerrainNames, BytesAreNoHeightsUnlessTheirUnitIsStated) {
  raster("a.tif");
  if (!run("gdal_translate -ot Byte -scale 0 5000 0 250 a.tif bytes.tif"))
    GTEST_SKIP() << "gdal_translate is not installed";
  EXPECT_THAT(problemOf(folder_ / "bytes.tif"), HasSubstr("`height_unit: m` of the file in the scenario"));
  TerrainFileKeys keys;
  keys.height_unit = HeightUnit::m;
  EXPECT_NEAR(load({folder_ / "bytes.tif"}, keys)->heightMsl_m(49.5, 10.5), 1050 / 20.0, 1);
}

TEST_F(TerrainNames, WhatANetcdfVariableStatesIsUsed) {
  raster("a.tif");
  if (!run("true")) GTEST_SKIP() << "gdal_translate is not installed";
  const auto write = [&](const std::string& name, const std::string& attribute, const std::string& value) {
    run("gdal_translate -of VRT a.tif a.vrt && sed -i 's|<VRTRasterBand[^>]*>|&<Metadata><MDI key=\"" +
        attribute + "\">" + value + "</MDI></Metadata>|' a.vrt && gdal_translate -of netCDF a.vrt " + name);
  };
  write("down.nc", "positive", "down");
  EXPECT_THAT(problemOf(folder_ / "down.nc"), HasSubstr("states depths, downwards (positive: down)"));
  run("gdal_translate -ot Float32 -a_scale -1 -a_offset 0 down.nc HEIGHTS.tif");
  EXPECT_NEAR(load({folder_ / "HEIGHTS.tif"})->heightMsl_m(49.5, 10.5), -1050, 1e-3);
  write("hae.nc", "standard_name", "height_above_reference_ellipsoid");
  EXPECT_THAT(Terrain::describe(folder_ / "hae.nc").vertical_datum, HasSubstr("the ellipsoid (stated by"));
  write("named.nc", "long_name", "depth below sea level");
  EXPECT_THAT(load({folder_ / "named.nc"})->warnings(),
              testing::Contains(HasSubstr("'depth below sea level': if it has depths")));
}

TEST_F(TerrainNames, CommandsOfMessagesMakeFilesThatAreRead) {
  if (!run("true")) GTEST_SKIP() << "gdal_translate is not installed";
  test::DemFile file = test::geographicDem(10, 50, 0.1, 10, 10, [](double, double) { return 100; });
  const auto write = [&](const std::string& name) {
    file.write(folder_ / name);
    return folder_ / name;
  };
  const auto heightOf = [](const std::string& name, const TerrainFileKeys& keys = {}) {
    return load({name}, keys)->heightMsl_m(49.5, 10.5);
  };
  TerrainFileKeys egm96;
  egm96.vertical_datum = VerticalDatum::egm96;

  file.crs = "EPSG:4979";
  EXPECT_THAT(problemOf(write("datum.tif"), egm96),
              AllOf(HasSubstr("gdal_translate -a_srs"), HasSubstr("EPSG:4326+5773")));
  run("gdal_translate -a_srs EPSG:4326+5773 datum.tif datum2.tif");
  EXPECT_EQ(heightOf(folder_ / "datum2.tif", egm96), 100);

  file.crs = "EPSG:4326+5715";
  EXPECT_THAT(problemOf(write("depth.tif")), HasSubstr("gdal_translate -a_scale -1 -a_srs EPSG:4326+5714"));
  run("gdal_translate -a_scale -1 -a_srs EPSG:4326+5714 depth.tif height.tif");
  EXPECT_EQ(heightOf(folder_ / "height.tif"), -100);

  file.crs = "EPSG:4326";
  file.unit = "fathom";
  TerrainFileKeys metres;
  metres.height_unit = HeightUnit::m;
  EXPECT_THAT(problemOf(write("unit.tif")), HasSubstr("`height_unit: m`"));
  EXPECT_EQ(heightOf(folder_ / "unit.tif", metres), 100);
  file.unit = "ft";
  EXPECT_THAT(problemOf(write("feet.tif"), metres), HasSubstr("gdal_translate -of VRT"));
  run("gdal_translate -of VRT feet.tif feet.vrt && sed -i s/ft/m/ feet.vrt");
  EXPECT_EQ(heightOf(folder_ / "feet.vrt", metres), 100);

  file.unit = "";
  file.crs = "";
  file.transform = {};
  EXPECT_THAT(
      problemOf(write("bare.tif")),
      HasSubstr("gdal_translate -a_srs EPSG:4326 -a_ullr WEST NORTH EAST SOUTH " + folder_ / "bare.tif"));
  run("gdal_translate -a_srs EPSG:4326 -a_ullr 10 50 11 49 bare.tif placed.tif");
  EXPECT_EQ(heightOf(folder_ / "placed.tif"), 100);
}

TEST_F(TerrainNames, FileOfSeveralRastersNamesThemAndTheCommand) {
  if (!run("true")) GTEST_SKIP() << "gdal_translate is not installed";
  test::geographicDem(10, 50, 0.1, 10, 10, [](double, double) { return 100; }).write(folder_ / "a.tif");
  if (!run("gdal_translate -of GPKG -co RASTER_TABLE=one a.tif two.gpkg && gdal_translate -of GPKG -co "
           "APPEND_SUBDATASET=YES -co RASTER_TABLE=two a.tif two.gpkg"))
    return;
  const std::string message = problemOf(folder_ / "two.gpkg");
  EXPECT_THAT(message,
              AllOf(HasSubstr("has no raster itself, but 2 in it: one, two."), HasSubstr("gdal_translate ")));
  const std::size_t begin = message.find("gdal_translate "), end = message.find(" makes a file");
  run(message.substr(begin, end - begin));
  EXPECT_EQ(load({folder_ / "HEIGHTS.tif"})->heightMsl_m(49.5, 10.5), 100);
}

TEST_F(TerrainNames, BandIsChosen) {
  test::DemFile file = test::geographicDem(10, 50, 0.1, 10, 10, [](double, double) { return 100; });
  file.bands = 2;
  file.write(folder_ / "a.tif");
  TerrainFileKeys keys;
  keys.band = 2;
  EXPECT_EQ(load({folder_ / "a.tif"}, keys)->heightMsl_m(49.5, 10.5), 2345);
  keys.band = 3;
  EXPECT_THAT(problemOf(folder_ / "a.tif", keys),
              HasSubstr("'band: 3' of the scenario is outside the allowed range 1 to 2"));
}

TEST_F(TerrainNames, ColoursAreDecodedWhenAsked) {
  for (const HeightEncoding encoding : {HeightEncoding::terrain_rgb, HeightEncoding::terrarium}) {
    const std::string file = folder_ / "12.tif";
    test::writeColours(file, [&](int column, int) {
      const double height_m = 1500 + column;
      return encoding == HeightEncoding::terrarium ? std::lround((height_m + 32768) * 256)
                                                   : std::lround((height_m + 10000) * 10);
    });
    EXPECT_THAT(problemOf(file),
                AllOf(HasSubstr("is a picture, not heights"), HasSubstr("`encoding: terrain-rgb`")));
    TerrainFileKeys keys;
    keys.encoding = encoding;
    EXPECT_NEAR(load({file}, keys)->heightMsl_m(49.55, 10.45), 1504, 0.01);
  }
  TerrainFileKeys keys;
  keys.encoding = HeightEncoding::terrarium;
  EXPECT_THAT(problemOf(raster("a.tif"), keys), HasSubstr("needs red, green and blue as bands of bytes"));
}

TEST_F(TerrainNames, TileOfAWebMapIsPlacedByItsPath) {
  fs::create_directories(folder_ / "8/135");
  test::writeColours(folder_ / "a.tif", [](int, int) { return std::lround((700.0 + 32768) * 256); });
  test::convertDem(folder_ / "a.tif", "PNG", folder_ / "8/135/87.png");
  fs::remove(folder_ / "8/135/87.png.aux.xml");
  EXPECT_THAT(problemOf(folder_ / "8/135/87.png"), HasSubstr("`encoding: terrain-rgb` (or terrarium)"));
  TerrainFileKeys keys;
  keys.encoding = HeightEncoding::terrarium;
  const TerrainPtr terrain = load({folder_ / "8/135/87.png"}, keys);
  EXPECT_NEAR(terrain->heightMsl_m(49.5, 10.5), 700, 1e-3);
  EXPECT_EQ(terrain->uncoveredFraction(), 0);
}

TEST_F(TerrainNames, TileOfAWebMapIsPlacedByItsName) {
  test::writeColours(folder_ / "a.tif", [](int, int) { return std::lround((700.0 + 32768) * 256); });
  TerrainFileKeys keys;
  keys.encoding = HeightEncoding::terrarium;
  for (const char* name : {"8-135-87.png", "8_135_87.png", "8-135-87@2x.png", "other.png"}) {
    test::convertDem(folder_ / "a.tif", "PNG", folder_ / name);
    fs::remove(folder_ / (std::string(name) + ".aux.xml"));
    if (std::string(name) == "other.png") {
      EXPECT_THAT(problemOf(folder_ / name, keys), HasSubstr("ZOOM-COLUMN-ROW.png"));
    } else {
      EXPECT_EQ(load({folder_ / name}, keys)->uncoveredFraction(), 0) << name;
    }
  }
}

TEST_F(TerrainNames, TablesOfPointsAreSortedByTheCommandOfTheMessage) {
  const auto height = [](double latitude_deg, double longitude_deg) {
    return 100 * longitude_deg + 10 * latitude_deg;
  };
  std::string latitude_first = "# survey\nlat,lon,height\n", shuffled, commented = "# x y z\n";
  for (int n = 0; n < 121; ++n) {
    const int k = (n * 37) % 121;
    const auto row = [&](int of, const char* separator, bool has_latitude_first) {
      const double latitude_deg = 50 - 0.1 * (of / 11), longitude_deg = 10 + 0.1 * (of % 11);
      return fmt::format("{:.1f}{}{:.1f}{}{}\n", has_latitude_first ? latitude_deg : longitude_deg, separator,
                         has_latitude_first ? longitude_deg : latitude_deg, separator,
                         height(latitude_deg, longitude_deg));
    };
    latitude_first += row(n, ",", true);
    shuffled += row(k, " ", false);
    commented += row(n, "\t", false);
  }
  TerrainFileKeys keys;
  keys.crs = "EPSG:4326";
  for (const auto& [text, name] : {std::pair(latitude_first, "latitude.xyz"),
                                   {shuffled, "shuffled.xyz"},
                                   {commented, "commented.xyz"}}) {
    const std::string file = folder_.write(name, text);
    const std::string problem = problemOf(file, keys);
    const std::size_t begin = problem.find("awk "), end = problem.find(" sorts its rows");
    ASSERT_LT(end, problem.size()) << problem;
    std::string command = problem.substr(begin, end - begin);
    if (name == std::string("latitude.xyz")) command.replace(command.find("$1,$2"), 5, "$2,$1");
    if (!run("(" + command + ")")) GTEST_SKIP() << "gdal_translate is not installed";
    EXPECT_NEAR(load({folder_ / "HEIGHTS.xyz"}, keys)->heightMsl_m(49.55, 10.45), height(49.55, 10.45), 1e-3)
        << name;
  }
}

TEST_F(TerrainNames, GeopotentialBecomesHeightsByTheCommandOfTheMessage) {
  test::DemFile file = test::geographicDem(10, 50, 0.1, 10, 10, [](double, double) { return 500 * 9.80665; });
  file.unit = "m2 s-2";
  file.write(folder_ / "a.tif");
  const std::string problem = problemOf(folder_ / "a.tif");
  const std::size_t begin = problem.find("gdal_translate"), end = problem.find(" makes heights");
  ASSERT_LT(end, problem.size()) << problem;
  if (!run(problem.substr(begin, end - begin))) GTEST_SKIP() << "gdal_translate is not installed";
  TerrainFileKeys keys;
  keys.height_unit = HeightUnit::m;
  EXPECT_NEAR(load({folder_ / "HEIGHTS.tif"}, keys)->heightMsl_m(49.5, 10.5), 500, 0.01);
}

TEST_F(TerrainNames, WhatWasDownloadedInPlaceOfHeightsIsNamed) {
  const std::string page = "\n<!DOCTYPE html>\n<html><body>Log in</body></html>\n";
  for (const char* name : {"a.tif", "N49E010.hgt", "a.zip"})
    EXPECT_THAT(problemOf(folder_.write(name, page)), HasSubstr(std::string(name) + ": is a web page"))
        << name;
  EXPECT_THAT(problemOf(folder_.write("b.tif", "version https://git-lfs.github.com/spec/v1\nsize 7\n")),
              HasSubstr("is a pointer of Git LFS"));
  EXPECT_THAT(problemOf(folder_.write("c.tif", "%PDF-1.4\n")), HasSubstr("is a PDF document"));
}

TEST_F(TerrainNames, GroundControlPointsBecomeAGridByTheCommandOfTheMessage) {
  if (!run("gdal_translate -gcp 0 0 10 50 -gcp 10 0 11 50 -gcp 10 10 11 49 -gcp 0 10 10 49 "
           "-a_srs EPSG:4326 " +
           raster("a.tif") + " gcp.tif"))
    GTEST_SKIP() << "gdal_translate is not installed";
  const std::string problem = problemOf(folder_ / "gcp.tif");
  const std::size_t begin = problem.find("gdalwarp"), end = problem.find(" makes a grid");
  ASSERT_LT(end, problem.size()) << problem;
  run(problem.substr(begin, end - begin));
  EXPECT_NEAR(load({folder_ / "HEIGHTS.tif"})->heightMsl_m(49.5, 10.5), 1050, 10);
}

TEST_F(TerrainNames, LatitudesOfTilesMayHaveThreeDigits) {
  ASSERT_TRUE(cornerInName("ALPSMLC30_N034E135_DSM.tif"));
  EXPECT_EQ(cornerInName("N034E135_AVE_DSM.tif")->latitude_deg, 34);
  EXPECT_EQ(cornerInName("S34W071.hgt")->latitude_deg, -34);
}

TEST_F(TerrainNames, TilesOutsideTheBoxAreNotOpened) {
  tile("N49E010.hgt");
  std::ofstream(folder_ / "N20E100.hgt") << "broken";
  EXPECT_EQ(load({folder_ / "*.hgt"})->uncoveredFraction(), 0);
}

TEST_F(TerrainNames, MissingGroundIsSeaIfTheSpecSaysSo) {
  test::writeHgt(folder_ / "N49E010.hgt", 121, [](int column, int) { return column < 60 ? 50 : -32768; });
  TerrainSpec spec;
  spec.files = {folder_ / "N49E010.hgt"};
  const GeoBox box{49, 50, 9.5, 11};
  const TerrainPtr masked = Terrain::load(spec, box);
  EXPECT_TRUE(std::isnan(masked->heightMsl_m(49.5, 10.9)));
  EXPECT_THAT(masked->warnings(), ElementsAre(HasSubstr("121 posts a side")));
  spec.missing = MissingTerrain::sea;
  const TerrainPtr sea = Terrain::load(spec, box);
  EXPECT_EQ(sea->heightMsl_m(49.5, 10.25), 50);
  EXPECT_EQ(sea->heightMsl_m(49.5, 10.9), 0) << "a void";
  EXPECT_EQ(sea->heightMsl_m(49.5, 9.6), 0) << "no file";
  EXPECT_EQ(sea->lowest_m(), 0);
  EXPECT_THAT(sea->warnings(), ElementsAre(HasSubstr("121 posts a side"),
                                           AllOf(HasSubstr("terrain: 67.3 % of the area is taken as sea"),
                                                 HasSubstr("33.5 % that no elevation file covers"),
                                                 Not(HasSubstr("beside void posts")))));
  test::writeHgt(folder_ / "N49E010.hgt", 121, [](int column, int) { return column < 60 ? 950 : -32768; });
  EXPECT_THAT(Terrain::load(spec, box)->warnings().back(),
              HasSubstr("beside void posts the ground is up to 950 m high"));
}

TEST_F(TerrainNames, AnotherSignOfOneNeededPlaceIsOffered) {
  tile("N49W010.hgt");
  TerrainSpec spec;
  spec.files = {folder_ / "N49W010.hgt"};
  const auto textFor = [&](double latitude_deg, double longitude_deg) {
    return Terrain::load(spec, {9, 50, -10, 50},
                         {{"the region", latitude_deg, longitude_deg}, {"platform 'a'", 49.5, -9.5}})
        ->placeText();
  };
  EXPECT_THAT(textFor(49.5, 9.5), HasSubstr("perhaps longitude has the other sign in the region"));
  EXPECT_THAT(textFor(-9.5, 49.5), HasSubstr("perhaps latitude and longitude are exchanged in the region"));
  EXPECT_THAT(textFor(20, 40), testing::Not(HasSubstr("perhaps")));
}

TEST_F(TerrainNames, AnotherSignIsOfferedIfItFits) {
  tile("N49W010.hgt");
  const TerrainPtr terrain = load({folder_ / "N49W010.hgt"}, {}, {49.2, 49.8, 9.2, 9.8});
  EXPECT_THAT(terrain->placeText(),
              AllOf(HasSubstr("cover latitudes 49 to 50, longitudes -10 to -9 deg"),
                    HasSubstr("longitudes 9.2 to 9.8"),
                    HasSubstr("latitude 49.5, longitude -9.5 deg: perhaps longitude has the other sign")));
  EXPECT_THAT(load({folder_ / "N49W010.hgt"}, {}, {9.2, 9.8, 49.2, 49.8})->placeText(),
              testing::Not(HasSubstr("perhaps")));
}

}  // namespace
}  // namespace emscape::scenario
