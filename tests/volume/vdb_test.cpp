#include "volume/format/vdb.h"

#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/LevelSetSphere.h>

#include <cmath>

#include "emscape/base/work.h"
#include "emscape/volume/format/file.h"
#include "tests/volume/sample_volumes.h"

namespace emscape::volume {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using namespace test;

TEST(Vdb, RoundTripOfFieldIsExact) {
  TemporaryFolder folder;
  const DenseVolume volume = fieldVolume();
  writeVdb(folder / "a.vdb", {&volume});
  expectSame(readVdb(folder / "a.vdb"), volume);
}

TEST(Vdb, RoundTripOfCategoricalVolumeIsExact) {
  TemporaryFolder folder;
  const DenseVolume volume = categoricalVolume();
  writeVdb(folder / "a.vdb", {&volume});
  expectSame(readVdb(folder / "a.vdb"), volume);
}

TEST(Vdb, RoundTripWithoutMaskAndPositionIsExact) {
  TemporaryFolder folder;
  const DenseVolume volume = plainVolume();
  writeVdb(folder / "a.vdb", {&volume});
  expectSame(readVdb(folder / "a.vdb"), volume);
}

TEST(Vdb, RoundTripWithoutFieldIsExact) {
  TemporaryFolder folder;
  DenseVolume volume = fieldVolume();
  std::fill(volume.values.begin(), volume.values.end(), volume.info.floor);
  writeVdb(folder / "a.vdb", {&volume});
  expectSame(readVdb(folder / "a.vdb"), volume);
}

TEST(Vdb, IsNotWrittenToItsEndWhenTheWorkIsStopped) {
  TemporaryFolder folder;
  DenseVolume volume = plainVolume();
  volume.grid.dims = {256, 256, 128};
  volume.values.resize(static_cast<std::size_t>(volume.grid.dims.count()));
  for (std::size_t n = 0; n < volume.values.size(); ++n) volume.values[n] = std::sin(static_cast<float>(n));
  Work work;
  work.stop();
  const WorkScope scope(&work);
  EXPECT_THROW(writeVdb(folder / "a.vdb", {&volume}), Stopped);
  EXPECT_TRUE(folder.files().empty());
}

TEST(Vdb, HoldsSeveralQuantitiesAndReadsTheNamedOne) {
  TemporaryFolder folder;
  const DenseVolume power = fieldVolume(), emitter = categoricalVolume();
  writeVdb(folder / "a.vdb", {&power, &emitter});
  expectSame(readVdb(folder / "a.vdb"), power);
  expectSame(readVdb(folder / "a.vdb", "dominant_emitter"), emitter);
  const std::vector<DenseVolume> descriptions = describeVdb(folder / "a.vdb");
  ASSERT_EQ(descriptions.size(), 2U);
  expectSameInfo(descriptions[0], power);
  expectSameInfo(descriptions[1], emitter);
  EXPECT_THAT(errorOf([&] { readVdb(folder / "a.vdb", "snr_db"); }),
              HasSubstr("a.vdb: no grid \"snr_db\"; the file holds power_density_dbwm2, dominant_emitter"));
}

TEST(Vdb, OpenVdbReadsDocumentedLayout) {
  TemporaryFolder folder;
  const DenseVolume volume = fieldVolume();
  writeVdb(folder / "a.vdb", {&volume});
  openvdb::initialize();
  openvdb::io::File file(folder / "a.vdb");
  file.open();
  const auto grid = openvdb::gridPtrCast<openvdb::FloatGrid>(file.readGrid("power_density_dbwm2"));
  EXPECT_EQ(grid->getGridClass(), openvdb::GRID_FOG_VOLUME);
  EXPECT_EQ(grid->background(), -120.F);
  EXPECT_EQ(grid->metaValue<std::string>("emscape:unit"), "dBW/m2");
  EXPECT_EQ(grid->metaValue<double>("emscape:time_s"), 1.1);
  EXPECT_EQ(grid->metaValue<std::string>("emscape:scenario_hash"), "0123abcd");
  EXPECT_EQ(grid->metaValue<std::string>("emscape:frame"), "enu");
  EXPECT_EQ(grid->metaValue<double>("emscape:origin_longitude_deg"), -84.25);
  EXPECT_EQ(grid->metaValue<openvdb::Vec3i>("emscape:dims"), openvdb::Vec3i(21, 17, 18));
  EXPECT_EQ(grid->metaValue<openvdb::Vec3d>("emscape:spacing_m"), openvdb::Vec3d(150.0 / 7, 151.0 / 3, 60.1));
  auto voxel = grid->getConstAccessor();
  for (int k = 0; k < 18; ++k) {
    for (int j = 0; j < 17; ++j) {
      for (int i = 0; i < 21; ++i) {
        const float value = volume.values[static_cast<std::size_t>(volume.grid.index(i, j, k))];
        ASSERT_EQ(voxel.isValueOn({i, j, k}), !volume.isMasked(i, j, k) && value != -120.F);
        const openvdb::Vec3d world = grid->indexToWorld(openvdb::Coord(i, j, k));
        const Vec3d center = volume.grid.center_m(i, j, k);
        ASSERT_NEAR(world.x(), center.x, 1e-9);
        ASSERT_NEAR(world.y(), center.y, 1e-9);
        ASSERT_NEAR(world.z(), center.z, 1e-9);
      }
    }
  }
  // The block of one value is one tile, not 512 voxels.
  EXPECT_EQ(grid->tree().activeTileCount(), 1U);
}

class ForeignVdb : public ::testing::Test {
 protected:
  ForeignVdb() { openvdb::initialize(); }
  void write(const openvdb::GridBase::Ptr& grid,
             std::uint32_t compression = openvdb::io::COMPRESS_ACTIVE_MASK) {
    openvdb::io::File file(path_.string());
    file.setCompression(compression);
    file.write(openvdb::GridCPtrVec{grid});
  }
  /// The sample as OpenVDB reads it from our file.
  openvdb::FloatGrid::Ptr ours() {
    const DenseVolume volume = fieldVolume();
    std::filesystem::remove(path_);  // as write() left it, it is no file of ours
    writeVdb(path_, {&volume});
    openvdb::io::File file(path_.string());
    file.open(false);
    return openvdb::gridPtrCast<openvdb::FloatGrid>(file.readGrid("power_density_dbwm2"));
  }

  TemporaryFolder folder_;
  std::filesystem::path path_ = folder_ / "foreign.vdb";
};

openvdb::FloatGrid::Ptr cloud() {
  auto grid = openvdb::FloatGrid::create(0.25F);
  grid->setName("density");
  grid->setTransform(openvdb::math::Transform::createLinearTransform(0.5));
  grid->tree().setValueOn({-20, 3, -5000}, 1.5F);
  grid->tree().setValueOn({-11, 9, -4990}, -2.F);
  return grid;
}

TEST_F(ForeignVdb, IsReadOverTheBoxOfItsActiveVoxels) {
  for (const std::uint32_t compression : {0U, 1U, 2U, 3U, 4U, 6U}) {
    write(cloud(), compression);
    const DenseVolume volume = readVdb(path_);
    EXPECT_EQ(volume.grid.dims, (Dims{10, 7, 11}));
    EXPECT_EQ(volume.grid.first_center_m, (Vec3d{-10, 1.5, -2500}));
    EXPECT_EQ(volume.grid.spacing_m, (Vec3d{0.5, 0.5, 0.5}));
    EXPECT_FALSE(volume.grid.georeferenced);
    EXPECT_EQ(volume.info.quantity, "density");
    EXPECT_EQ(volume.info.floor, 0.25F);
    EXPECT_EQ(volume.info.range_min, -2.F);
    EXPECT_EQ(volume.info.range_max, 1.5F);
    EXPECT_EQ(volume.values.front(), 1.5F);
    EXPECT_EQ(volume.values.back(), -2.F);
    EXPECT_EQ(volume.values[1], 0.25F);
  }
}

TEST_F(ForeignVdb, MayBeSavedAsHalf) {
  auto grid = cloud();
  grid->setSaveFloatAsHalf(true);
  for (const std::uint32_t compression : {0U, 2U, 6U, 3U}) {
    write(grid, compression);
    const DenseVolume volume = readVdb(path_);
    EXPECT_EQ(volume.values.front(), 1.5F);
    EXPECT_EQ(volume.values.back(), -2.F);
  }
}

TEST_F(ForeignVdb, MayHoldDoublesOrIntegers) {
  auto doubles = openvdb::DoubleGrid::create(0);
  doubles->fill(openvdb::CoordBBox(openvdb::Coord(0), openvdb::Coord(40)), 0.1);
  write(doubles);
  const DenseVolume volume = readVdb(path_);
  EXPECT_EQ(volume.grid.dims, (Dims{41, 41, 41}));
  EXPECT_EQ(volume.values[1000], 0.1F);
  EXPECT_FALSE(volume.info.categorical);
  auto integers = openvdb::Int64Grid::create(0);
  integers->tree().setValueOn({1, 2, 3}, 7);
  write(integers);
  EXPECT_EQ(readVdb(path_).values, UnsetVector<float>{7.F});
  EXPECT_TRUE(readVdb(path_).info.categorical);
}

TEST_F(ForeignVdb, MayBeALevelSetWhichIsReadAsDistances) {
  write(openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(5.F, openvdb::Vec3f(0), 1.F));
  const DenseVolume volume = readVdb(path_);
  const Dims dims = volume.grid.dims;
  const auto center = static_cast<std::size_t>(volume.grid.index(dims.x / 2, dims.y / 2, dims.z / 2));
  EXPECT_EQ(volume.values[center], -3.F);
  EXPECT_EQ(volume.info.floor, 3.F);
}

TEST_F(ForeignVdb, MayShareATreeBetweenGrids) {
  const auto first = cloud();
  const auto second = openvdb::FloatGrid::create(*static_cast<const openvdb::GridBase*>(first.get()));
  second->setTree(first->treePtr());
  second->setName("second");
  second->setTransform(openvdb::math::Transform::createLinearTransform(2.0));
  openvdb::io::File(path_.string()).write(openvdb::GridCPtrVec{first, second});
  const DenseVolume volume = readVdb(path_, "second");
  EXPECT_EQ(volume.values.back(), -2.F);
  EXPECT_EQ(volume.grid.spacing_m.x, 2.0);
}

TEST_F(ForeignVdb, MayBeWrittenAsAStreamAndHoldGridsOfOneName) {
  auto other = cloud();
  other->tree().setValueOn({-20, 3, -5000}, 9.F);
  std::ofstream stream(path_, std::ios::binary);
  openvdb::io::Stream(stream).write(openvdb::GridCPtrVec{cloud(), other});
  stream.close();
  EXPECT_EQ(readVdb(path_).values.front(), 1.5F);
  EXPECT_EQ(readVdb(path_, "density[1]").values.front(), 9.F);
}

TEST_F(ForeignVdb, OnOtherAxesIsRefused) {
  const auto withTransform = [&](const auto& change) {
    auto grid = cloud();
    change(grid->transform());
    write(grid);
    return path_;
  };
  const DenseVolume volume = readVdb(withTransform([](openvdb::math::Transform& transform) {
    transform.postScale({1e-4, 2, 3e3});
    transform.postTranslate({10, -20, 30});
  }));
  EXPECT_EQ(volume.grid.spacing_m, (Vec3d{0.5e-4, 1, 1.5e3}));
  const std::vector<std::function<void(openvdb::math::Transform&)>> others = {
      [](auto& transform) {
        transform.postScale({-1, 1, 1});
      },
      [](auto& transform) { transform.postRotate(0.3, openvdb::math::Z_AXIS); },
      [](auto& transform) { transform.postRotate(3.14159265358979 / 2, openvdb::math::X_AXIS); },
      [](auto& transform) { transform.postShear(0.1, openvdb::math::X_AXIS, openvdb::math::Y_AXIS); }};
  for (const auto& change : others) {
    withTransform(change);
    EXPECT_THAT(
        errorOf([&] { readVdb(path_); }),
        HasSubstr(
            "foreign.vdb: grid density: the grid is rotated, sheared or mirrored; grids whose axes are"));
    EXPECT_THAT(errorOf([&] { describeVdb(path_); }), HasSubstr("rotated"));
  }
}

TEST_F(ForeignVdb, OfAnotherTypeIsRefusedByName) {
  write(openvdb::Vec3SGrid::create());
  EXPECT_THAT(errorOf([&] { readVdb(path_); }),
              HasSubstr("Tree_vec3s_5_4_3; float, double, int32 and int64 grids can be read"));
}

TEST_F(ForeignVdb, WithoutActiveVoxelsIsRefused) {
  write(openvdb::FloatGrid::create());
  EXPECT_THAT(errorOf([&] { readVdb(path_); }), HasSubstr("no active voxels"));
}

TEST_F(ForeignVdb, TooSparseToBeDenseIsRefused) {
  auto grid = cloud();
  grid->tree().setValueOn({2000, 2000, -4000}, 1.F);
  write(grid);
  EXPECT_THAT(errorOf([&] { readVdb(path_); }), HasSubstr("too sparse"));
  grid->tree().setValueOn({100000, 0, 0}, 1.F);
  write(grid);
  EXPECT_THAT(errorOf([&] { readVdb(path_); }), HasSubstr("foreign.vdb: dims"));
}

// A file of a few hundred bytes, which would take 8 GiB.
TEST_F(ForeignVdb, LargeTilesOfOneValueAreRefused) {
  auto grid = openvdb::FloatGrid::create();
  grid->fill(openvdb::CoordBBox({0, 0, 0}, {1407, 2047, 767}), 1.F);
  write(grid);
  EXPECT_THAT(errorOf([&] { readVdb(path_); }),
              AllOf(HasSubstr("foreign.vdb: the box of the active voxels holds 2214592512"),
                    HasSubstr("too sparse")));
  EXPECT_THAT(errorOf([&] { describeVdb(path_); }), HasSubstr("too sparse"));
}

TEST_F(ForeignVdb, WithOurMetadataAndOtherVoxelsIsReadAsForeign) {
  const DenseVolume volume = fieldVolume();
  const auto grid = ours();
  grid->tree().setValueOn({-1, 0, 0}, 5.F);
  write(grid);
  const DenseVolume read = readVdb(path_);
  EXPECT_EQ(read.values[static_cast<std::size_t>(read.grid.index(0, 0, 0))], 5.F);
  EXPECT_EQ(read.grid.dims.x, volume.grid.dims.x + 1);
  EXPECT_FALSE(read.grid.georeferenced);
}

TEST_F(ForeignVdb, WithOurMetadataUnderAnotherNameIsReadAsForeign) {
  const auto original = ours();
  const auto renamed = original->deepCopy();
  renamed->setName("density");
  renamed->tree().setValueOn({5, 5, 5}, 70.F);
  openvdb::io::File(path_.string()).write(openvdb::GridCPtrVec{original, renamed});
  const std::vector<DenseVolume> descriptions = describeVdb(path_);
  ASSERT_EQ(descriptions.size(), 2U);
  EXPECT_EQ(descriptions[0].info.quantity, "power_density_dbwm2");
  EXPECT_EQ(descriptions[1].info.quantity, "density");
  EXPECT_EQ(descriptions[1].info.unit, "");
  DenseVolume read;
  EXPECT_THAT(messagesOf([&] { read = readVdb(path_, "density"); }),
              ElementsAre(HasSubstr("foreign.vdb: grid density: it has another name than the quantity in its "
                                    "metadata, which another program must have copied")));
  EXPECT_EQ(read.info.range_max, 70);
  EXPECT_FALSE(read.grid.georeferenced);
  expectSame(readVdb(path_, "power_density_dbwm2"), fieldVolume());
}

TEST_F(ForeignVdb, CopiesOfOurGridsUnderOneNameAreReadBothWithTheirMetadata) {
  const auto original = ours();
  const auto copy = original->deepCopy();
  copy->tree().setValueOn({5, 5, 5}, 7.F);
  openvdb::io::File(path_.string()).write(openvdb::GridCPtrVec{original, copy});
  const DenseVolume read = readVdb(path_, describeVdb(path_).at(1).info.quantity);
  EXPECT_EQ(read.info.quantity, "power_density_dbwm2[1]");
  EXPECT_EQ(read.info.unit, "dBW/m2");
  EXPECT_EQ(read.values[static_cast<std::size_t>(read.grid.index(5, 5, 5))], 7);
}

// As vdb_lod writes its levels.
TEST_F(ForeignVdb, CoarserThanOurMetadataStateIsReadAsForeign) {
  const auto grid = ours();
  const auto coarse = openvdb::FloatGrid::create(*static_cast<const openvdb::GridBase*>(grid.get()));
  coarse->setTree(std::make_shared<openvdb::FloatTree>(-120.F));
  coarse->tree().fill(openvdb::CoordBBox({1, 0, 0}, {9, 7, 8}), -50.F);
  coarse->transform().preScale(2);
  write(coarse);
  DenseVolume read;
  EXPECT_THAT(messagesOf([&] { read = readVdb(path_); }),
              ElementsAre(HasSubstr("its voxels have another spacing than in its metadata")));
  EXPECT_EQ(read.grid.dims, (Dims{9, 8, 9}));
  EXPECT_EQ(describeVdb(path_).at(0).grid.dims, (Dims{9, 8, 9}));
  EXPECT_NEAR(read.grid.spacing_m.z, 120.2, 1e-9);
  // A file of version 0.2.0 does not state the spacing.
  const auto old = ours();
  old->removeMeta("emscape:spacing_m");
  write(old);
  expectSame(readVdb(path_), fieldVolume());
}

TEST_F(ForeignVdb, GridsThatCannotBeReadAreLeftOut) {
  const auto vectors = openvdb::Vec3SGrid::create();
  vectors->setName("vel");
  const auto empty = openvdb::FloatGrid::create();
  empty->setName("empty");
  openvdb::io::File(path_.string()).write(openvdb::GridCPtrVec{vectors, cloud(), empty});
  std::vector<DenseVolume> descriptions;
  EXPECT_THAT(messagesOf([&] { descriptions = describeVdb(path_); }),
              ElementsAre(AllOf(HasSubstr("foreign.vdb: left out: grid vel is of type Tree_vec3s_5_4_3"),
                                HasSubstr("; grid empty has no active voxels"))));
  ASSERT_EQ(descriptions.size(), 1U);
  EXPECT_EQ(descriptions[0].info.quantity, "density");
  EXPECT_EQ(readVdb(path_).info.quantity, "density");
  EXPECT_THAT(errorOf([&] { readVdb(path_, "vel"); }), HasSubstr("of type Tree_vec3s_5_4_3"));
  EXPECT_THAT(errorOf([&] { readVdb(path_, "empty"); }), HasSubstr("no active voxels"));
}

TEST_F(ForeignVdb, MayHaveAGridWithoutName) {
  const auto grid = cloud();
  grid->setName("");
  write(grid);
  EXPECT_EQ(readVdb(path_, describeVdb(path_).at(0).info.quantity).values.back(), -2.F);
}

TEST(Vdb, SurvivesDamage) {
  TemporaryFolder folder;
  const DenseVolume power = fieldVolume(), emitter = categoricalVolume();
  writeVdb(folder / "a.vdb", {&power, &emitter});
  survivesDamage(folder / "a.vdb", [&] { readVdb(folder / "a.vdb", "dominant_emitter"); });
}

TEST_F(ForeignVdb, SurvivesDamageInEveryCompression) {
  for (const std::uint32_t compression : {0U, 3U, 6U}) {
    write(openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(6.F, openvdb::Vec3f(0), 1.F), compression);
    survivesDamage(path_, [&] { readVdb(path_); });
  }
}

TEST(Vdb, RefusesOtherFiles) {
  TemporaryFolder folder;
  writeBytes(folder / "a.vdb", std::vector<std::uint8_t>(100, 'x'));
  EXPECT_THAT(errorOf([&] { readVdb(folder / "a.vdb"); }), HasSubstr("a.vdb: no OpenVDB file"));
  EXPECT_THAT(errorOf([&] { readVdb(folder / "none.vdb"); }), HasSubstr("none.vdb: there is no such file"));
}

TEST(Vdb, RefusesCategoricalValuesThatAreNoIndices) {
  TemporaryFolder folder;
  DenseVolume volume = categoricalVolume();
  volume.values[5] = 0.5F;
  EXPECT_THAT(errorOf([&] { writeVdb(folder / "a.vdb", {&volume}); }), HasSubstr("0.500000 is not an index"));
  EXPECT_TRUE(folder.files().empty());
}

TEST(StoredRange, OpenVdbReadsAPatchedFile) {
  const TemporaryFolder folder;
  const DenseVolume volume = fieldVolume();
  writeVolumes(folder / "v.vdb", {&volume});
  setStoredRange(folder / "v.vdb", {{volume.info.quantity, -77.5F, 66.25F}});
  openvdb::initialize();
  openvdb::io::File file(folder / "v.vdb");
  file.open();
  const openvdb::GridBase::Ptr grid = file.readGrid(volume.info.quantity);
  EXPECT_EQ(grid->metaValue<float>("emscape:range_min"), -77.5F);
  EXPECT_EQ(grid->metaValue<float>("emscape:range_max"), 66.25F);
  EXPECT_EQ(grid->metaValue<float>("emscape:floor"), -120.F);
  EXPECT_GT(grid->activeVoxelCount(), 1000U);
}

}  // namespace
}  // namespace emscape::volume
