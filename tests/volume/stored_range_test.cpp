// setStoredRange(): the range of a finished file, changed without its values.

#include "emscape/volume/format/file.h"
#include "tests/volume/sample_volumes.h"

namespace emscape::volume::test {
namespace {

DenseVolume withRange(DenseVolume volume, float min, float max) {
  volume.info.range_min = min;
  volume.info.range_max = max;
  return volume;
}

class StoredRangeOf : public testing::TestWithParam<const char*> {
 protected:
  std::filesystem::path file(const std::string& stem) const { return folder_ / (stem + "." + GetParam()); }
  /// Bytes of a volume file and of the JSON beside it.
  std::vector<std::uint8_t> bytesOf(const std::filesystem::path& path) const {
    std::vector<std::uint8_t> bytes = readWhole(path);
    const std::filesystem::path sidecar = path.string() + ".json";
    if (std::filesystem::exists(sidecar)) {
      const std::vector<std::uint8_t> more = readWhole(sidecar);
      bytes.insert(bytes.end(), more.begin(), more.end());
    }
    return bytes;
  }

  TemporaryFolder folder_;
};

TEST_P(StoredRangeOf, FileWithNewRangeEqualsFileWrittenWithIt) {
  for (const auto& [min, max] : std::vector<std::pair<float, float>>{
           {-119.75F, 17.5F}, {-1.17549e-38F, 3.4e38F}, {0.F, 0.F}, {-120.1F, 1}}) {
    const DenseVolume before = withRange(fieldVolume(), -3.25F, 2.F),
                      after = withRange(fieldVolume(), min, max);
    writeVolumes(file("changed"), {&before});
    writeVolumes(file("written"), {&after});
    setStoredRange(file("changed"), {{after.info.quantity, min, max}});
    EXPECT_TRUE(bytesOf(file("changed")) == bytesOf(file("written"))) << min << " " << max;
    expectSame(readVolume(file("changed")), after);
  }
}

TEST_P(StoredRangeOf, SettingTheSameRangeKeepsTheFile) {
  const DenseVolume volume = fieldVolume();
  writeVolumes(file("v"), {&volume});
  const std::vector<std::uint8_t> before = bytesOf(file("v"));
  setStoredRange(file("v"), {{volume.info.quantity, volume.info.range_min, volume.info.range_max}});
  EXPECT_TRUE(bytesOf(file("v")) == before);
}

using StoredRangesOf = StoredRangeOf;

TEST_P(StoredRangesOf, SeveralVolumesEachGetsItsOwnAndTheOthersKeepTheirs) {
  const DenseVolume field = fieldVolume();
  DenseVolume second = fieldVolume();
  second.info.quantity = "snr_db:search radar";
  DenseVolume third = fieldVolume();
  third.info.quantity = "snr_db";
  writeVolumes(file("v"), {&field, &second, &third});
  setStoredRange(file("v"), {{"snr_db:search radar", -7, 8}, {"snr_db", -9, 10}});
  expectSame(readVolume(file("v"), field.info.quantity), field);
  expectSame(readVolume(file("v"), "snr_db:search radar"), withRange(second, -7, 8));
  expectSame(readVolume(file("v"), "snr_db"), withRange(third, -9, 10));
}

TEST_P(StoredRangeOf, ACategoricalVolumeKeepsItsIndices) {
  const DenseVolume volume = categoricalVolume();
  writeVolumes(file("v"), {&volume});
  setStoredRange(file("v"), {{volume.info.quantity, 1, 3}});
  expectSame(readVolume(file("v")), withRange(volume, 1, 3));
}

TEST_P(StoredRangeOf, MissingQuantityIsNamedAndFileIsUnchanged) {
  const DenseVolume volume = fieldVolume();
  writeVolumes(file("v"), {&volume});
  const std::vector<std::uint8_t> before = bytesOf(file("v"));
  const std::string error = errorOf([&] {
    setStoredRange(file("v"), {{volume.info.quantity, 1, 2}, {"snr_db", 1, 2}});
  });
  EXPECT_THAT(error, testing::HasSubstr("states no range of a volume"));
  EXPECT_THAT(error, testing::HasSubstr("snr_db"));
  EXPECT_TRUE(bytesOf(file("v")) == before);
}

TEST_P(StoredRangeOf, ADamagedFileIsAnError) {
  const DenseVolume volume = fieldVolume({6, 5, 4});
  writeVolumes(file("v"), {&volume});
  std::filesystem::path described = file("v").string() + ".json";
  if (!std::filesystem::exists(described)) described = file("v");
  const std::vector<std::uint8_t> whole = readWhole(described);
  for (const std::size_t size : {std::size_t{0}, std::size_t{30}, whole.size() / 2}) {
    writeBytes(described, {whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)});
    EXPECT_THROW(setStoredRange(file("v"), {{volume.info.quantity, 1, 2}}), Error) << size;
  }
}

INSTANTIATE_TEST_SUITE_P(EveryFormat, StoredRangeOf, testing::Values("vdb", "nvdb", "vti", "raw"),
                         [](const auto& format) { return std::string(format.param); });
INSTANTIATE_TEST_SUITE_P(EveryFormatOfSeveralVolumes, StoredRangesOf, testing::Values("vdb", "nvdb", "vti"),
                         [](const auto& format) { return std::string(format.param); });

TEST(StoredRange, EqualVolumesGiveEqualVdbFilesAndOthersDiffer) {
  const TemporaryFolder folder;
  const DenseVolume volume = fieldVolume();
  DenseVolume other = volume;
  other.values[other.values.size() - 2] += 1;
  writeVolumes(folder / "a.vdb", {&volume});
  writeVolumes(folder / "b.vdb", {&volume});
  writeVolumes(folder / "c.vdb", {&other});
  EXPECT_TRUE(readWhole(folder / "a.vdb") == readWhole(folder / "b.vdb"));
  const auto identifierOf = [&](const std::string& name) {
    const std::vector<std::uint8_t> bytes = readWhole(folder / name);
    return std::string(bytes.begin() + 21, bytes.begin() + 57);
  };
  EXPECT_NE(identifierOf("a.vdb"), identifierOf("c.vdb"));
  EXPECT_THAT(identifierOf("a.vdb"),
              testing::MatchesRegex("[0-9a-f]+-[0-9a-f]+-8[0-9a-f]+-[89ab][0-9a-f]+-[0-9a-f]+"));
}

TEST(StoredRange, AFormatThatIsOnlyReadIsRefused) {
  EXPECT_THAT(errorOf([] { setStoredRange("scan.dat", {}); }), testing::HasSubstr("read, not written"));
}

}  // namespace
}  // namespace emscape::volume::test
