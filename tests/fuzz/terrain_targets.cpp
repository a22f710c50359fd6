// Elevation files in each format that is read.

#include "emscape/scenario/terrain/terrain.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/scenario/dem_file.h"
#include "tests/support/files.h"
#include "tests/support/temporary_folder.h"

namespace emscape::test {
namespace {

namespace fs = std::filesystem;

constexpr int kPosts = 6;
constexpr double kStep_deg = 0.01;

DemFile smallDem() {
  return geographicDem(5, 52, kStep_deg, kPosts, kPosts, [](double latitude_deg, double longitude_deg) {
    return 1e3 * latitude_deg + longitude_deg;
  });
}

std::string bytesOf(const DemFile& dem) {
  const TemporaryFolder folder;
  dem.write(folder / "a.tif");
  return readFile(folder / "a.tif");
}

/// A file that GDAL writes with the seed in another format. @param driver  GDAL's name of the format
std::string converted(const std::string& driver, const std::string& raster, const std::string& wanted) {
  const TemporaryFolder folder;
  smallDem().write(folder / "a.tif");
  convertDem(folder / "a.tif", driver, folder / raster);
  return readFile(folder / wanted);
}

/// Describes the file and reads its heights around a location.
void readAround(const fs::path& file, double latitude_deg, double longitude_deg) {
  scenario::TerrainSpec spec;
  spec.files = {file.string()};
  const scenario::TerrainPtr terrain = scenario::Terrain::load(
      spec, {latitude_deg - 0.1, latitude_deg + 0.1, longitude_deg - 0.1, longitude_deg + 0.1});
  terrain->heightMsl_m(latitude_deg - 0.03, longitude_deg + 0.03);
  scenario::Terrain::describe(file.string());
}

/// At the location of smallDem().
void readElevation(const fs::path& file, const std::string&) {
  readAround(file, 52, 5);
}

/// A description beside a raster: the raster is the file without the ending .aux.xml.
void readDescribed(const fs::path& file, const std::string& bytes) {
  readElevation(fs::path(file).replace_extension().replace_extension(), bytes);
}

/// A tile of HGT at 52 degrees north, 5 east, packed. @param ending  .zip or .gz
std::string packedTile(const std::string& ending) {
  const TemporaryFolder folder;
  writeHgt(folder / "N52E005.hgt", 11, [](int column, int row) { return column - row; });
  const std::string packed = folder / ("a" + ending);
  if (ending == ".zip") {
    writeZip(packed, {{"N52E005.hgt", folder / "N52E005.hgt"}});
  } else {
    writeGzip(folder / "N52E005.hgt", packed);
  }
  return readFile(packed);
}

/// A GeoTIFF in red, green and blue at 50 degrees north, 10 east, whose colours encode heights.
std::string colours() {
  const TemporaryFolder folder;
  writeColours(folder / "a.tif", [](int column, int row) { return (32768L + column - row) * 256; });
  return readFile(folder / "a.tif");
}

void readColours(const fs::path& file, const std::string&) {
  scenario::TerrainSpec spec;
  spec.files = {file.string()};
  spec.keys.resize(1);
  spec.keys[0].encoding = scenario::HeightEncoding::terrarium;
  scenario::Terrain::load(spec, {49, 50, 10, 11});
}

/// A GeoTIFF of codes of land cover at 52 degrees north, 5 east.
std::string landCover() {
  const TemporaryFolder folder;
  geographicDem(5, 52.1, kStep_deg, kPosts, kPosts, [](double, double) {
    return 10;
  }).write(folder / "a.tif");
  return readFile(wholeNumbers(folder / "a.tif", folder / "codes.tif"));
}

void readLandCover(const fs::path& file, const std::string&) {
  scenario::LandCoverSpec spec;
  spec.files = {file.string()};
  const scenario::LandCover cover(spec, {51.9, 52.1, 4.9, 5.1});
  cover.classAt(52.03, 5.03);
}

void readTable(const fs::path& file, const std::string&) {
  scenario::readCoverTable(file.string());
}

std::string table() {
  return "code,name,clutter_height_m,zone,land,color\n1,palms,7.5,land,woods,#00ff00\n2,lagoon,0,sea,,#"
         "0000ff\n";
}

/// The first columns of a tile of DTED level 0 from 40 to 41 degrees north and 5 to 6 degrees east.
std::string dtedColumns() {
  constexpr int kTilePosts = 121, kColumns = 12;
  constexpr std::size_t kHeaderBytes = 3428, kCountAt = 47, kColumnBytes = 12 + 2 * kTilePosts;
  const TemporaryFolder folder;
  geographicPointDem(5, 41, 1.0 / (kTilePosts - 1), kTilePosts, kTilePosts, [](double latitude_deg, double) {
    return 10 * latitude_deg;
  }).write(folder / "a.tif");
  convertDem(folder / "a.tif", "DTED", folder / "a.dt0");
  std::string bytes = readFile(folder / "a.dt0");
  bytes.resize(kHeaderBytes + kColumns * kColumnBytes);
  return bytes.replace(kCountAt, 4, "0012");
}

std::vector<std::string> geotiffs() {
  DemFile projected = smallDem();
  projected.crs = "EPSG:32631";
  projected.transform = {637000, 30, 0, 5763000, 0, -30};
  DemFile scaled = smallDem();
  scaled.is_point = true;
  scaled.nodata = -9999;
  scaled.unit = "ft";
  scaled.scale = 0.5;
  return {bytesOf(smallDem()), bytesOf(projected), bytesOf(scaled)};
}

const FuzzTargetsAdded added({
    {"terrain_tif", "input.tif", readElevation, geotiffs},
    {"terrain_asc", "input.asc", readElevation,
     [] { return std::vector<std::string>{converted("AAIGrid", "a.asc", "a.asc")}; }},
    {"terrain_colours", "input.tif", readColours, [] { return std::vector<std::string>{colours()}; }},
    {"land_cover_tif", "input.tif", readLandCover, [] { return std::vector<std::string>{landCover()}; }},
    {"land_cover_table", "input.csv", readTable, [] { return std::vector<std::string>{table()}; }},
    {"terrain_gz", "N52E005.hgt.gz", readElevation,
     [] { return std::vector<std::string>{packedTile(".gz")}; }},
    {"terrain_img", "input.img", readElevation,
     [] { return std::vector<std::string>{converted("HFA", "a.img", "a.img")}; }},
    {"terrain_nc", "input.nc", readElevation,
     [] { return std::vector<std::string>{converted("netCDF", "a.nc", "a.nc")}; }},
    {"terrain_gpkg", "input.gpkg", readElevation,
     [] { return std::vector<std::string>{converted("GPKG", "a.gpkg", "a.gpkg")}; }},
    {"terrain_xyz", "input.xyz", readElevation,
     [] { return std::vector<std::string>{converted("XYZ", "a.xyz", "a.xyz")}; }},
    {"terrain_zip", "input.zip", readElevation, [] { return std::vector<std::string>{packedTile(".zip")}; }},
    {"terrain_dem", "input.dem", readElevation,
     [] { return std::vector<std::string>{converted("USGSDEM", "a.dem", "a.dem")}; }},
    {"terrain_dted", "input.dt0",
     [](const fs::path& file, const std::string&) { readAround(file, 40.5, 5.02); },
     [] { return std::vector<std::string>{dtedColumns()}; }},
    {"terrain_bil_header", "input.hdr",
     [](const fs::path& file, const std::string& bytes) {
       readElevation(fs::path(file).replace_extension(".bil"), bytes);
     },
     [] { return std::vector<std::string>{converted("EHdr", "a.bil", "a.hdr")}; },
     [](const fs::path& folder) { writeFile(folder / "input.bil", converted("EHdr", "a.bil", "a.bil")); }},
    {"terrain_aux_xml", "input.tif.aux.xml", readDescribed,
     [] {
       return std::vector<std::string>{
           R"(<PAMDataset><SRS>EPSG:4326</SRS><GeoTransform>5, 0.01, 0, 52, 0, -0.01</GeoTransform>
<Metadata><MDI key="AREA_OR_POINT">Point</MDI></Metadata><Metadata domain="IMAGE_STRUCTURE">
<MDI key="INTERLEAVE">PIXEL</MDI></Metadata><PAMRasterBand band="1"><NoDataValue>-9999</NoDataValue>
<UnitType>ft</UnitType><Offset>1</Offset><Scale>0.5</Scale><Histograms><HistItem><HistMin>0</HistMin>
<HistMax>1</HistMax><BucketCount>2</BucketCount><HistCounts>1|2</HistCounts></HistItem></Histograms>
<Metadata><MDI key="STATISTICS_MAXIMUM">7</MDI></Metadata></PAMRasterBand></PAMDataset>)"};
     },
     [](const fs::path& folder) { writeFile(folder / "input.tif", bytesOf(smallDem())); }},
    {"terrain_prj", "input.prj",
     [](const fs::path& file, const std::string& bytes) {
       readElevation(fs::path(file).replace_extension(".asc"), bytes);
     },
     [] {
       return std::vector<std::string>{
           converted("AAIGrid", "a.asc", "a.prj"),
           R"(PROJCS["WGS_1984_UTM_Zone_31N",GEOGCS["GCS_WGS_1984",DATUM["D_WGS_1984",
SPHEROID["WGS_1984",6378137.0,298.257223563]],PRIMEM["Greenwich",0.0],UNIT["Degree",0.0174532925199433]],
PROJECTION["Transverse_Mercator"],PARAMETER["False_Easting",500000.0],PARAMETER["Central_Meridian",3.0],
PARAMETER["Scale_Factor",0.9996],UNIT["Meter",1.0]])"};
     },
     [](const fs::path& folder) { writeFile(folder / "input.asc", converted("AAIGrid", "a.asc", "a.asc")); }},
    {"terrain_vrt", "input.vrt", readElevation,
     [] {
       return std::vector<std::string>{
           R"(<VRTDataset rasterXSize="6" rasterYSize="6"><SRS>EPSG:4326</SRS>
<GeoTransform>5, 0.01, 0, 52, 0, -0.01</GeoTransform><VRTRasterBand dataType="Float32" band="1">
<NoDataValue>-9999</NoDataValue><SimpleSource><SourceFilename relativeToVRT="1">tile.tif</SourceFilename>
<SourceBand>1</SourceBand><SrcRect xOff="0" yOff="0" xSize="6" ySize="6"/>
<DstRect xOff="0" yOff="0" xSize="6" ySize="6"/></SimpleSource></VRTRasterBand></VRTDataset>)"};
     },
     [](const fs::path& folder) { writeFile(folder / "tile.tif", bytesOf(smallDem())); }},
});

}  // namespace
}  // namespace emscape::test
