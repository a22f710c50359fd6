#include "emscape/volume/format/file.h"

#include "tests/support/file_size_limit.h"
#include "tests/volume/sample_volumes.h"
#include "volume/vtk/vti.h"

namespace emscape::volume {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using namespace test;

TEST(File, RoundTripIsExactInEveryFormat) {
  TemporaryFolder folder;
  const DenseVolume volume = fieldVolume();
  for (const FileFormat& format : fileFormats()) {
    if (!format.writable) continue;
    SCOPED_TRACE(format.name);
    const auto path = folder / ("a." + format.name);
    writeVolumes(path, {&volume});
    expectSame(readVolume(path), volume);
    expectSame(readVolume(path, volume.info.quantity), volume);
    const FileListing listing = listVolume(path);
    EXPECT_EQ(listing.format, format.name);
    EXPECT_EQ(listing.bytes, std::filesystem::file_size(path));
    ASSERT_EQ(listing.volumes.size(), 1U);
    expectSameInfo(listing.volumes[0], volume);
    EXPECT_TRUE(listing.volumes[0].values.empty());
    EXPECT_THROW(readVolume(path, "another"), Error);
  }
}

TEST(File, FailedWriteLeavesNoFile) {
  TemporaryFolder folder;
  DenseVolume volume = fieldVolume();
  volume.values.pop_back();
  for (const FileFormat& format : fileFormats()) {
    EXPECT_THROW(writeVolumes(folder / ("a." + format.name), {&volume}), Error) << format.name;
    EXPECT_THROW(writeVolumes(folder / ("a." + format.name), {}), Error) << format.name;
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(File, FullDiskLeavesNoFile) {
  TemporaryFolder folder;
  const DenseVolume volume = fieldVolume();
  const emscape::test::FileSizeLimit limit(5000);
  for (const FileFormat& format : fileFormats()) {
    if (!format.writable) continue;
    EXPECT_THAT(errorOf([&] { writeVolumes(folder / ("a." + format.name), {&volume}); }),
                AllOf(HasSubstr(folder / "a."), HasSubstr("cannot write: File too large")));
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(File, QuantitiesOfOneFileDiffer) {
  const DenseVolume volume = plainVolume();
  EXPECT_THAT(errorOf([&] {
                writeVolumes("a.vdb", {&volume, &volume});
              }),
              HasSubstr("two volumes of density"));
}

TEST(File, UnknownEndingsAreRefusedWithTheKnownOnes) {
  const DenseVolume volume = plainVolume();
  EXPECT_THAT(errorOf([] { readVolume("a.tiff"); }),
              HasSubstr("a.tiff: no volume file by its ending; known are .vdb, .nvdb, .vti, .raw, .dat"));
  EXPECT_THAT(errorOf([&] { writeVolumes("a.tiff", {&volume}); }),
              EndsWith("known are .vdb, .nvdb, .vti, .raw"));
  EXPECT_THAT(errorOf([&] { writeVolumes("a.dat", {&volume}); }), HasSubstr("read, not written"));
  EXPECT_THAT(errorOf([&] {
                writeVolumes("a.raw", {&volume, &volume});
              }),
              HasSubstr("holds one volume, not 2"));
  EXPECT_TRUE(isVolumeFile("x/A.VDB"));
  EXPECT_FALSE(isVolumeFile("vdb"));
}

TEST(Series, NamesItsFilesByNumber) {
  EXPECT_EQ(seriesFile("out", "demo", 1, "vdb"), "out/demo_0001.vdb");
  EXPECT_EQ(seriesFile("out", "demo", 12345, "vti"), "out/demo_12345.vti");
}

TEST(Series, IsFoundFromAFolderAFileOrAList) {
  TemporaryFolder folder;
  const auto touch = [&](const std::string& name) {
    writeBytes(folder / name, {});
    return folder / name;
  };
  EXPECT_THAT(errorOf([&] { seriesOf(folder.path()); }), HasSubstr("has no volume file"));
  const auto late = touch("a_10000.vti"), early = touch("a_9999.vti"), other = touch("b_0001.vti");
  touch("a_0001.raw");
  EXPECT_THAT(seriesOf(folder.path()), ElementsAre(early, late, other));
  EXPECT_THAT(seriesOf(late), ElementsAre(early, late));
  EXPECT_THAT(seriesOf(touch("single.vdb")), ElementsAre(folder / "single.vdb"));
  writePvd(folder / "a.pvd", {{2, late}, {1, other}});
  EXPECT_THAT(seriesOf(folder / "a.pvd"), ElementsAre(other, late));
  EXPECT_THAT(errorOf([&] { seriesOf(folder / "none.vdb"); }), HasSubstr("there is no such file"));
}

}  // namespace
}  // namespace emscape::volume
