#include "volume/nvdb/nvdb.h"

#include <nanovdb/util/OpenToNanoVDB.h>
#include <openvdb/openvdb.h>

#include <nlohmann/json.hpp>

#include "tests/support/files.h"
#include "tests/volume/sample_volumes.h"
#include "volume/sparse/nanovdb_wrapper.h"

namespace emscape::volume {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using namespace test;

TEST(Nvdb, RoundTripIsExact) {
  TemporaryFolder folder;
  for (const DenseVolume& volume : {fieldVolume(), categoricalVolume(), plainVolume()}) {
    writeNvdb(folder / "a.nvdb", {&volume});
    expectSame(readNvdb(folder / "a.nvdb"), volume);
  }
}

TEST(Nvdb, HoldsSeveralQuantitiesAndReadsTheNamedOne) {
  TemporaryFolder folder;
  const DenseVolume power = fieldVolume(), emitter = categoricalVolume();
  writeNvdb(folder / "a.nvdb", {&power, &emitter});
  expectSame(readNvdb(folder / "a.nvdb", "dominant_emitter"), emitter);
  const std::vector<DenseVolume> descriptions = describeNvdb(folder / "a.nvdb");
  ASSERT_EQ(descriptions.size(), 2U);
  expectSameInfo(descriptions[0], power);
  expectSameInfo(descriptions[1], emitter);
  EXPECT_THAT(errorOf([&] { readNvdb(folder / "a.nvdb", "x"); }),
              HasSubstr("no grid \"x\"; the file holds power_density_dbwm2, dominant_emitter"));
}

TEST(Nvdb, NanoVdbReadsDocumentedLayout) {
  TemporaryFolder folder;
  const DenseVolume volume = fieldVolume();
  writeNvdb(folder / "a.nvdb", {&volume});
  const nano::Handle handle = ::nanovdb::io::readGrid(folder / "a.nvdb", "power_density_dbwm2");
  const auto* grid = handle.grid<float>();
  ASSERT_NE(grid, nullptr);
  EXPECT_TRUE(grid->isFogVolume());
  EXPECT_EQ(grid->tree().background(), -120.F);
  const nano::Coord voxel(4, 5, 6);
  EXPECT_EQ(grid->tree().getValue(voxel),
            volume.values[static_cast<std::size_t>(volume.grid.index(4, 5, 6))]);
  const nano::Vec3d world = grid->indexToWorld(nano::Vec3d(4, 5, 6));
  EXPECT_NEAR(world[1], volume.grid.center_m(4, 5, 6).y, 1e-9);
}

TEST(Nvdb, WithoutSidecarIsReadOverTheBoxOfItsActiveVoxels) {
  TemporaryFolder folder;
  const DenseVolume volume = fieldVolume();
  writeNvdb(folder / "a.nvdb", {&volume});
  std::filesystem::remove(folder / "a.nvdb.json");
  const DenseVolume read = readNvdb(folder / "a.nvdb");
  EXPECT_EQ(read.grid.dims, (Dims{20, 17, 18}));  // the columns of x = 0 are all masked
  EXPECT_EQ(read.info.floor, -120.F);
  EXPECT_NEAR(read.grid.first_center_m.x, volume.grid.center_m(1, 0, 0).x, 1e-9);
  EXPECT_NEAR(read.grid.spacing_m.z, 60.1, 1e-9);
  for (int k = 0; k < 18; ++k) {
    for (int i = 0; i < 20; ++i) {
      EXPECT_EQ(read.values[static_cast<std::size_t>(read.grid.index(i, 5, k))],
                volume.values[static_cast<std::size_t>(volume.grid.index(i + 1, 5, k))]);
    }
  }
}

TEST(Nvdb, OnOtherAxesIsRefused) {
  TemporaryFolder folder;
  const auto grid = openvdb::FloatGrid::create();
  grid->tree().setValueOn({1, 2, 3}, 1.F);
  const auto writeGrid = [&] {
    nanovdb::io::writeGrid(folder / "a.nvdb", nano::Handle(nanovdb::openToNanoVDB(*grid)));
  };
  grid->transform().postScale(openvdb::Vec3d(1, 2, 3));
  writeGrid();
  EXPECT_EQ(readNvdb(folder / "a.nvdb").grid.spacing_m, (Vec3d{1, 2, 3}));
  grid->transform().postRotate(0.3, openvdb::math::Z_AXIS);
  writeGrid();
  EXPECT_THAT(errorOf([&] { readNvdb(folder / "a.nvdb"); }),
              HasSubstr("a.nvdb: grid density: the grid is rotated, sheared or mirrored"));
  grid->setTransform(openvdb::math::Transform::createLinearTransform());
  grid->transform().postScale(openvdb::Vec3d(1, 1, -1));
  writeGrid();
  EXPECT_THAT(errorOf([&] { readNvdb(folder / "a.nvdb"); }), HasSubstr("mirrored"));
}

TEST(Nvdb, IsValidForNanoVdb) {
  TemporaryFolder folder;
  for (const DenseVolume& volume : {fieldVolume(), categoricalVolume()}) {
    writeNvdb(folder / "a.nvdb", {&volume});
    const nano::Handle handle = ::nanovdb::io::readGrid(folder / "a.nvdb");
    const auto* data = reinterpret_cast<const nano::GridData*>(handle.data());
    EXPECT_TRUE(::nanovdb::isValid(data->mGridType, data->mGridClass)) << volume.info.quantity;
  }
}

TEST(Nvdb, GridsThatCannotBeReadAreLeftOut) {
  TemporaryFolder folder;
  const auto vectors = openvdb::Vec3fGrid::create();
  vectors->setName("U");
  vectors->tree().setValueOn({1, 2, 3}, openvdb::Vec3f(1));
  const auto grid = openvdb::FloatGrid::create();  // without a name
  grid->tree().setValueOn({1, 2, 3}, 4.F);
  std::vector<nano::Handle> handles;
  handles.push_back(nanovdb::openToNanoVDB(*vectors));
  handles.push_back(nanovdb::openToNanoVDB(*grid));
  nanovdb::io::writeGrids(folder / "a.nvdb", handles);
  std::vector<DenseVolume> descriptions;
  EXPECT_THAT(messagesOf([&] { descriptions = describeNvdb(folder / "a.nvdb"); }),
              ElementsAre(HasSubstr("a.nvdb: left out: grid U is of NanoVDB's type")));
  ASSERT_EQ(descriptions.size(), 1U);
  EXPECT_EQ(descriptions[0].info.quantity, "density");
  EXPECT_EQ(readNvdb(folder / "a.nvdb", "density").values[0], 4);
  EXPECT_EQ(readNvdb(folder / "a.nvdb").values[0], 4);
  EXPECT_THAT(errorOf([&] { readNvdb(folder / "a.nvdb", "U"); }), HasSubstr("grid U is of NanoVDB's type"));
  EXPECT_THAT(errorOf([&] { readNvdb(folder / "a.nvdb", "x"); }),
              HasSubstr("no grid \"x\"; the file holds U, density"));
}

TEST(Nvdb, LargeTilesOfOneValueAreRefused) {
  TemporaryFolder folder;
  const auto grid = openvdb::FloatGrid::create();
  grid->fill(openvdb::CoordBBox({0, 0, 0}, {1407, 2047, 767}), 1.F);
  const nano::Handle handle = nanovdb::openToNanoVDB(*grid);
  nanovdb::io::writeGrid(folder / "tiles.nvdb", handle);
  const std::string error = errorOf([&] { readNvdb(folder / "tiles.nvdb"); });
  EXPECT_THAT(error, HasSubstr("tiles.nvdb: the box of the active voxels holds 2214592512"));
  EXPECT_THAT(error, HasSubstr("too sparse"));
}

TEST(Nvdb, SurvivesDamage) {
  TemporaryFolder folder;
  const DenseVolume volume = fieldVolume();
  writeNvdb(folder / "a.nvdb", {&volume});
  survivesDamage(folder / "a.nvdb", [&] { readNvdb(folder / "a.nvdb"); });
  std::filesystem::remove(folder / "a.nvdb");  // it is no file of ours any more
  writeNvdb(folder / "a.nvdb", {&volume});
  std::filesystem::remove(folder / "a.nvdb.json");
  survivesDamage(folder / "a.nvdb", [&] { readNvdb(folder / "a.nvdb"); });
}

TEST(Nvdb, ASidecarWithoutTheNumberOfVoxelsIsRefused) {
  TemporaryFolder folder;
  const DenseVolume volume = fieldVolume();
  writeNvdb(folder / "a.nvdb", {&volume});
  std::string sidecar = emscape::test::readFile(folder / "a.nvdb.json");
  const std::size_t at = sidecar.find("\"voxels\"");
  ASSERT_NE(at, std::string::npos);
  sidecar.replace(at, 8, "\"others\"");
  emscape::test::writeFile(folder / "a.nvdb.json", sidecar);
  EXPECT_THAT(errorOf([&] { readNvdb(folder / "a.nvdb"); }), HasSubstr("a.nvdb.json: key voxels"));
}

TEST(Nvdb, AFaultOfTheSidecarNamesTheVolume) {
  TemporaryFolder folder;
  const DenseVolume power = fieldVolume();
  DenseVolume snr = fieldVolume();
  snr.info.quantity = "snr_db";
  const auto refusal = [&](const char* key, const nlohmann::ordered_json& value) {
    std::filesystem::remove(folder / "b.nvdb.json");  // edited by the last one
    writeNvdb(folder / "b.nvdb", {&power, &snr});
    auto json = nlohmann::ordered_json::parse(emscape::test::readFile(folder / "b.nvdb.json"));
    json["volumes"][1][key] = value;
    emscape::test::writeFile(folder / "b.nvdb.json", json.dump());
    return errorOf([&] { describeNvdb(folder / "b.nvdb"); });
  };
  EXPECT_THAT(refusal("spacing_m", {-1, 1, 1}),
              HasSubstr("b.nvdb.json: volume snr_db: spacing_m in x -1 m is outside the allowed range"));
  EXPECT_THAT(refusal("dims", {0, 1, 1}), HasSubstr("b.nvdb.json: volume snr_db: dims 0 x 1 x 1: each"));
  EXPECT_THAT(refusal("time_s", 1e99), HasSubstr("b.nvdb.json: volume snr_db: time_s 1e+99 s is outside"));
  EXPECT_THAT(refusal("range_min", 1e9),
              HasSubstr("b.nvdb.json: volume snr_db: range_min 1000000000 is above"));
}

TEST(Nvdb, RefusesOtherFiles) {
  TemporaryFolder folder;
  writeBytes(folder / "a.nvdb", std::vector<std::uint8_t>(100, 'x'));
  EXPECT_THAT(errorOf([&] { readNvdb(folder / "a.nvdb"); }), HasSubstr("a.nvdb: no NanoVDB file"));
}

}  // namespace
}  // namespace emscape::volume
