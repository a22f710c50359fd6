#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/files/file_reading.h"
#include "tests/support/errors.h"
#include "tests/support/meshes.h"
#include "tests/support/temporary_folder.h"
#include "volume/mesh/mesh_file.h"
#include "volume/vtk/vti.h"

namespace emscape::volume {
namespace {

using test::errorOf;
using test::TemporaryFolder;
using ::testing::AnyOf;
using ::testing::HasSubstr;

MeshField sample() {
  TetrahedralMesh mesh = test::boxMesh({3, 4, 3}, {-200.25, 0, 100}, {300, 500, 200}, 0.1);
  mesh.frame = {FrameKind::altitude, 36.3, -84.2, 100};
  mesh.georeferenced = true;
  MeshField field = test::fieldOn(std::move(mesh), [](const Vec3d& p) { return p.x / 3 + p.z; });
  field.info.quantity = "power_density_dbwm2";
  field.info.unit = "dBW/m2";
  field.info.time_s = 12.5;
  field.info.time_utc = "2026-06-01T06:00:12.5Z";
  field.info.floor = -120;
  field.info.extra = {{"scenario", "a \"b\" <c>"}};
  field.values[5] = std::numeric_limits<float>::quiet_NaN();
  return field;
}

void expectSame(const MeshField& found, const MeshField& expected) {
  EXPECT_TRUE(found.info == expected.info);
  EXPECT_TRUE(found.mesh->points_m == expected.mesh->points_m);
  EXPECT_TRUE(found.mesh->cells == expected.mesh->cells);
  EXPECT_EQ(found.mesh->georeferenced, expected.mesh->georeferenced);
  EXPECT_EQ(found.mesh->frame.latitude_deg, expected.mesh->frame.latitude_deg);
  ASSERT_EQ(found.values.size(), expected.values.size());
  for (std::size_t n = 0; n < found.values.size(); ++n) {
    EXPECT_TRUE(found.values[n] == expected.values[n] ||
                (std::isnan(found.values[n]) && std::isnan(expected.values[n])));
  }
}

std::string readText(const std::string& file) {
  const auto bytes = readWhole(file);
  return {bytes.begin(), bytes.end()};
}

TEST(Vtu, RoundTripIsExact) {
  TemporaryFolder folder;
  const MeshField power = sample();
  MeshField emitter = power;
  emitter.info.quantity = "dominant_emitter";
  emitter.info.categorical = true;
  emitter.info.floor = -1;
  for (std::size_t n = 0; n < emitter.values.size(); ++n) emitter.values[n] = static_cast<float>(n % 4) - 1;
  writeMesh(folder / "a.vtu", {&power, &emitter});
  const MeshFile file = readMesh(folder / "a.vtu");
  ASSERT_EQ(file.fields.size(), 2U);
  EXPECT_EQ(file.inverted_cells, 0);
  expectSame(file.fields[0], power);
  expectSame(file.fields[1], emitter);
  expectSame(readMesh(folder / "a.vtu", "dominant_emitter").fields.at(0), emitter);
  EXPECT_TRUE(listMesh(folder / "a.vtu").at(1) == emitter.info);
  EXPECT_THAT(errorOf([&] { readMesh(folder / "a.vtu", "snr_db"); }),
              HasSubstr("no array \"snr_db\"; the file holds power_density_dbwm2, dominant_emitter"));
}

TEST(Vtu, TwoWritesGiveTheSameBytes) {
  TemporaryFolder folder;
  const MeshField field = sample();
  writeMesh(folder / "a.vtu", {&field});
  writeMesh(folder / "b.vtu", {&field});
  EXPECT_EQ(readText(folder / "a.vtu"), readText(folder / "b.vtu"));
}

TEST(Vtu, TheStoredRangeIsChangedInPlace) {
  TemporaryFolder folder;
  MeshField field = sample();
  writeMesh(folder / "a.vtu", {&field});
  setMeshRange(folder / "a.vtu", {{field.info.quantity, -99.5F, 1234.125F}});
  field.info.range_min = -99.5F;
  field.info.range_max = 1234.125F;
  writeMesh(folder / "b.vtu", {&field});
  EXPECT_EQ(readText(folder / "a.vtu"), readText(folder / "b.vtu"));
}

TEST(Vtu, RefusesToWriteUnreadableMeshes) {
  TemporaryFolder folder;
  const MeshField field = sample(), other = sample();
  EXPECT_THAT(errorOf([&] { writeMesh(folder / "a.vtu", {}); }), HasSubstr("no field to write"));
  EXPECT_THAT(errorOf([&] {
                writeMesh(folder / "a.vtu", {&field, &other});
              }),
              HasSubstr("are on different meshes"));
  EXPECT_THAT(errorOf([&] { writeMesh(folder / "a.vtu", {&field, &field}); }), HasSubstr("two fields of"));
  MeshField shorter = field;
  shorter.values.pop_back();
  EXPECT_THAT(errorOf([&] { writeMesh(folder / "a.vtu", {&shorter}); }),
              HasSubstr("35 values for 36 points"));
  EXPECT_TRUE(folder.files().empty());
}

TEST(Vtu, SurvivesDamage) {
  TemporaryFolder folder;
  const MeshField field = sample();
  writeMesh(folder / "a.vtu", {&field});
  const std::string whole = readText(folder / "a.vtu");
  for (std::size_t size = 0; size < whole.size(); size += 97) {
    folder.write("b.vtu", whole.substr(0, size));
    EXPECT_NE(errorOf([&] { readMesh(folder / "b.vtu"); }, ErrorCode::bad_input), "") << size;
  }
  std::mt19937 random(3);
  for (int n = 0; n < 300; ++n) {
    std::string damaged = whole;
    for (int byte = 0; byte < 4; ++byte) damaged[random() % damaged.size()] = static_cast<char>(random());
    folder.write("b.vtu", damaged);
    errorOf([&] { readMesh(folder / "b.vtu"); }, ErrorCode::bad_input);
  }
}

TEST(Vtu, SizesAreCheckedBeforeMemoryIsAllocated) {
  TemporaryFolder folder;
  const MeshField field = sample();
  writeMesh(folder / "a.vtu", {&field});
  const std::string whole = readText(folder / "a.vtu");
  const auto errorWith = [&](const std::string& from, const std::string& to) {
    std::string damaged = whole;
    const std::size_t at = damaged.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    damaged.replace(at, from.size(), to);
    folder.write("b.vtu", damaged);
    return errorOf([&] { readMesh(folder / "b.vtu"); }, ErrorCode::bad_input);
  };
  EXPECT_THAT(errorWith("NumberOfPoints=\"36\"", "NumberOfPoints=\"2000000000\""),
              HasSubstr("truncated: an array of"));
  EXPECT_THAT(errorWith("NumberOfPoints=\"36\"", "NumberOfPoints=\"3000000000\""),
              HasSubstr("NumberOfPoints=\"3000000000\": must be 1..2147483647"));
  EXPECT_THAT(errorWith("NumberOfCells=\"72\"", "NumberOfCells=\"500000000\""),
              HasSubstr("truncated: an array of"));
  EXPECT_THAT(errorWith("NumberOfCells=\"72\"", "NumberOfCells=\"73\""), HasSubstr("bytes, found"));
  EXPECT_THAT(errorWith("NumberOfCells=\"72\"", "NumberOfCells=\"-1\""), HasSubstr("must be 1.."));
  EXPECT_THAT(errorWith("\"types\"", "\"tepys\""), HasSubstr("Cells: there is no array types"));
  EXPECT_THAT(errorWith("type=\"Int64\"", "type=\"Float64\""), HasSubstr("of type \"Float64\""));
  EXPECT_THAT(errorWith("<PointData", "<PaintData"), AnyOf(HasSubstr("XML"), HasSubstr("no point data")));
}

/// A file as another program may write it: inline, with other types.
std::string foreign(const std::string& type, const std::string& points) {
  return "<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" byte_order=\"LittleEndian\">"
         "<UnstructuredGrid><Piece NumberOfPoints=\"4\" NumberOfCells=\"1\"><PointData>"
         "<DataArray type=\"UInt8\" Name=\"s\" format=\"binary\">BAAAAAECAwQ=</DataArray></PointData>"
         "<Points><DataArray type=\"Float32\" NumberOfComponents=\"3\" format=\"binary\">" +
         points +
         "</DataArray></Points><Cells>"
         "<DataArray type=\"Int32\" Name=\"connectivity\" format=\"binary\">"
         "EAAAAAAAAAABAAAAAgAAAAMAAAA=</DataArray>"
         "<DataArray type=\"Int32\" Name=\"offsets\" format=\"binary\">BAAAAAQAAAA=</DataArray>"
         "<DataArray type=\"UInt8\" Name=\"types\" format=\"binary\">" +
         type + "</DataArray></Cells></Piece></UnstructuredGrid></VTKFile>";
}

TEST(Vtu, ReadsInlineFilesOfOthers) {
  TemporaryFolder folder;
  // Points (0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1).
  const std::string points = "MAAAAAAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAIA/AAAAAAAAAAAAAAAAAACAPw==";
  folder.write("a.vtu", foreign("AQAAAAo=", points));
  const MeshFile file = readMesh(folder / "a.vtu");
  EXPECT_EQ(file.mesh->points_m[3].z, 1);
  EXPECT_EQ(file.fields.at(0).values, (std::vector<float>{1, 2, 3, 4}));
  EXPECT_EQ(file.fields[0].info.range_max, 4);
  EXPECT_FALSE(file.mesh->georeferenced);
  folder.write("b.vtu", foreign("AQAAAAw=", points));
  EXPECT_THAT(errorOf([&] { readMesh(folder / "b.vtu"); }, ErrorCode::bad_input),
              HasSubstr("cell 0 is of VTK type 12; tetrahedra (10) can be read"));
}

TEST(Vtu, ReadsTextOfOthers) {
  TemporaryFolder folder;
  std::string text =
      "<VTKFile type=\"UnstructuredGrid\" byte_order=\"BigEndian\"><UnstructuredGrid>"
      "<Piece NumberOfPoints=\"4\" NumberOfCells=\"1\"><PointData>"
      "<DataArray type=\"Float64\" Name=\"s\" format=\"ascii\"> 0 0.5 -1 1e2 </DataArray></PointData>"
      "<Points><DataArray type=\"Float32\" NumberOfComponents=\"3\" format=\"ascii\">"
      "0 0 0 1 0 0\n0 1 0 0 0 1</DataArray></Points><Cells>"
      "<DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">0 1 2 3</DataArray>"
      "<DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">4</DataArray>"
      "<DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">10</DataArray>"
      "</Cells></Piece></UnstructuredGrid></VTKFile>";
  folder.write("a.vtu", text);
  const MeshFile file = readMesh(folder / "a.vtu");
  EXPECT_EQ(file.mesh->points_m[3].z, 1);
  EXPECT_EQ(file.mesh->cells[0], (std::array<std::int32_t, 4>{0, 1, 2, 3}));
  EXPECT_EQ(file.fields.at(0).values, (std::vector<float>{0, 0.5F, -1, 100}));
  text.replace(text.find("0 1 2 3"), 7, "0 1 2 ?");
  folder.write("a.vtu", text);
  EXPECT_THAT(errorOf([&] { readMesh(folder / "a.vtu"); }, ErrorCode::bad_input),
              HasSubstr("a.vtu: array connectivity: value 3: \"?\": must be a number of type Int64"));
  text.replace(text.find("1 0 0\n"), 5, "1 0 x");
  folder.write("a.vtu", text);
  EXPECT_THAT(errorOf([&] { readMesh(folder / "a.vtu"); }, ErrorCode::bad_input),
              HasSubstr("a.vtu: array of Points: value 5: \"x\": must be a number of type Float32"));
}

TEST(Vtu, ZeroIsAValueInFilesOfOthers) {
  TemporaryFolder folder;
  std::string text =
      foreign("AQAAAAo=", "MAAAAAAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAIA/AAAAAAAAAAAAAAAAAACAPw==");
  const std::string one_to_four = "BAAAAAECAwQ=";
  text.replace(text.find(one_to_four), one_to_four.size(), "BAAAAAAAAAE=");
  folder.write("a.vtu", text);
  const MeshField field = readMesh(folder / "a.vtu").fields.at(0);
  EXPECT_EQ(field.values, (std::vector<float>{0, 0, 0, 1}));
  EXPECT_EQ(field.info.range_min, 0);
  EXPECT_EQ(field.info.range_max, 1);
  EXPECT_EQ(statisticsOf(field).at_floor, 0);
}

TEST(Vtu, MayHaveAnArrayWithoutName) {
  TemporaryFolder folder;
  std::string text =
      foreign("AQAAAAo=", "MAAAAAAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAIA/AAAAAAAAAAAAAAAAAACAPw==");
  const std::size_t at = text.find("Name=\"", text.find("<PointData")) + 6;
  text.erase(at, text.find('"', at) - at);
  folder.write("a.vtu", text);
  const std::string name = listMesh(folder / "a.vtu").at(0).quantity;
  EXPECT_EQ(name, "scalars");
  EXPECT_EQ(readMesh(folder / "a.vtu", name).fields.at(0).values.size(), 4U);
}

TEST(Vtu, ASeriesIsListedInAPvd) {
  TemporaryFolder folder;
  writePvd(folder / "a.pvd", {{0, folder / "a_0001.vtu"}, {1, folder / "a_0002.vtu"}});
  EXPECT_EQ(seriesOf(folder / "a.pvd").at(1), folder.path() / "a_0002.vtu");
}

}  // namespace
}  // namespace emscape::volume
