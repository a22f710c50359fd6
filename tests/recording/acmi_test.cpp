// Reading of ACMI recordings.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "recording/acmi/acmi_lines.h"
#include "recording/acmi/acmi_reader.h"
#include "recording/acmi/acmi_text.h"
#include "recording/read_recording.h"
#include "tests/support/errors.h"
#include "tests/support/files.h"
#include "tests/support/reference_data.h"
#include "tests/support/temporary_folder.h"

namespace emscape::interop {
namespace {

using testing::HasSubstr;

const std::string kHeader = "FileType=text/acmi/tacview\nFileVersion=2.2\n";

Recording readText(const std::string& text) {
  return readAcmi(*openText(text), "test.acmi", {});
}
/// The recording of lines after the header.
Recording readLines(const std::string& lines) {
  return readText(kHeader + lines);
}

TEST(Acmi, PartsOfAPositionThatAreEmptyAreThoseBefore) {
  const Recording r = readLines(
      "1,T=10|20|300|1|2|3,Name=A\n#1\n1,T=10.5|||||4\n#2\n1,T=||310|\n#3\n1,T=11|21|320|100|200\n"
      "#4\n1,T=12|22|330|5|6|7|100|200|8\n");
  ASSERT_EQ(r.objects.size(), 1u);
  const auto& poses = r.objects[0].poses;
  EXPECT_EQ(r.tally.bad, 1) << "four parts are no position";
  EXPECT_THAT(r.tally.first_bad, HasSubstr("line 7: T=||310| does not have 3, 5, 6 or 9 numbers"));
  ASSERT_EQ(poses.size(), 4u);
  EXPECT_EQ(poses[1].longitude_deg, 10.5);
  EXPECT_EQ(poses[1].latitude_deg, 20);
  EXPECT_EQ(poses[1].roll_deg, 1);
  EXPECT_EQ(poses[1].heading_deg, 4);
  EXPECT_EQ(poses[2].height_msl_m, 320);
  EXPECT_EQ(poses[2].heading_deg, 4) << "the fourth and fifth of five parts are of a plane";
  EXPECT_EQ(poses[3].roll_deg, 5);
  EXPECT_EQ(poses[3].heading_deg, 7);
}

TEST(Acmi, WithoutAYawTheHeadingIsAlongTheTrack) {
  const Recording r = readLines("1,T=10|20|300\n");
  EXPECT_TRUE(std::isnan(r.objects.at(0).poses.at(0).heading_deg));
}

TEST(Acmi, ReferencePositionAppliesToWhatStandsBeforeIt) {
  const Recording r = readLines("1,T=1|2|3\n0,ReferenceLongitude=179.5,ReferenceLatitude=30\n");
  EXPECT_DOUBLE_EQ(r.objects.at(0).poses.at(0).longitude_deg, -179.5);
  EXPECT_DOUBLE_EQ(r.objects.at(0).poses.at(0).latitude_deg, 32);
}

TEST(Acmi, FramesOutOfOrderAreSorted) {
  const Recording r = readLines("#5\n1,T=5|0|0\n#-1\n1,T=1|0|0\n#2\n1,T=2|0|0\n");
  const auto& poses = r.objects.at(0).poses;
  ASSERT_EQ(poses.size(), 3u);
  EXPECT_EQ(poses[0].t_s, -1);
  EXPECT_EQ(poses[1].longitude_deg, 2);
  EXPECT_EQ(poses[2].t_s, 5);
}

TEST(Acmi, EscapedCommasAndLineEndsBelongToTheValue) {
  const Recording r = readLines("1,T=1|2|3, Name=a\\, b,Pilot=x\\\ny\n#1\n1,T=2|2|3\n");
  EXPECT_EQ(r.objects.at(0).name, "a, b x y");
  EXPECT_EQ(r.objects.at(0).poses.size(), 2u);
  EXPECT_EQ(r.tally.bad, 0);
}

TEST(Acmi, RemovedObjectIsAbsentAndItsIdIsUsedAgain) {
  const Recording r = readLines("a,T=1|2|3,Name=A\n#1\n-a\n#2\na,T=5|6|7,Name=B\n");
  ASSERT_EQ(r.objects.size(), 2u);
  ASSERT_EQ(r.objects[0].presence.size(), 1u);
  EXPECT_EQ(r.objects[0].presence[0].t_s, 1);
  EXPECT_FALSE(r.objects[0].presence[0].is_present);
  EXPECT_EQ(r.objects[1].name, "B");
}

TEST(Acmi, RemovalWithAMarkOfTimeIsARemoval) {
  const Recording r = readLines("1001,T=1|2|3\n#1.5\n#-1001\n1002,T=1|2|3\n");
  ASSERT_EQ(r.objects.size(), 2u);
  EXPECT_EQ(r.objects[0].presence.at(0).t_s, 1.5);
  EXPECT_EQ(r.objects[1].poses.at(0).t_s, 1.5);
}

TEST(Acmi, HiddenAndDestroyedObjectsAreAbsent) {
  const Recording r =
      readLines("1,T=1|2|3\n2,T=1|2|3\n#1\n1,T=||,Visible=0\n0,Event=Destroyed|2|\n#2\n1,T=||,Visible=1\n");
  ASSERT_EQ(r.objects[0].presence.size(), 2u);
  EXPECT_FALSE(r.objects[0].presence[0].is_present);
  EXPECT_TRUE(r.objects[0].presence[1].is_present);
  EXPECT_FALSE(r.objects[1].presence.at(0).is_present);
}

TEST(Acmi, RadarIsABeamOfItsObject) {
  const Recording r = readLines(
      "1,T=1|2|3,RadarMode=1,RadarAzimuth=10,RadarElevation=-2,RadarHorizontalBeamwidth=5\n#2\n1,RadarMode="
      "0\n");
  ASSERT_EQ(r.beams.size(), 1u);
  EXPECT_EQ(r.beams[0].kind, BeamKind::radar);
  ASSERT_EQ(r.beams[0].states.size(), 2u);
  EXPECT_TRUE(r.beams[0].states[0].is_on);
  EXPECT_EQ(r.beams[0].states[0].azimuth_deg, 10);
  EXPECT_EQ(r.beams[0].states[0].beamwidth_az_deg, 5);
  EXPECT_FALSE(r.beams[0].states[1].is_on);
}

TEST(Acmi, ObjectOfTypeBeamIsABeamOfTheObjectThatCarriesIt) {
  // By its parent; without one by its place.
  for (const std::string parent : {"Parent=a,", ""}) {
    const Recording r = readLines(
        "c,T=1.1|2|3,Type=Air+FixedWing,Name=F-16\na,T=1|2|3,Type=Air+FixedWing,Name=F-14B\n"
        "b,T=1|2|3,Type=Beam," +
        parent + "Name=AWG-9,RadarHorizontalBeamwidth=120\n");
    ASSERT_EQ(r.objects.size(), 2u) << parent;
    ASSERT_EQ(r.beams.size(), 1u);
    EXPECT_EQ(r.objects[r.beams[0].object].keys.acmi_name, "F-14B");
    EXPECT_EQ(r.beams[0].keys.acmi_name, "AWG-9");
    EXPECT_TRUE(r.beams[0].states.at(0).is_on);
  }
}

TEST(Acmi, BeamWithoutACarrierStaysAnObject) {
  const Recording r =
      readLines("a,T=1|2|3,Type=Air+FixedWing,Name=F-14B\nb,T=1|2.1|3,Type=Beam,Name=AWG-9\n");
  EXPECT_EQ(r.objects.size(), 2u);
}

TEST(Acmi, DirectionOfABeamIsThatOfItsObjectInTheAxesOfItsCarrier) {
  const Recording r = readLines(
      "a,T=1|2|3000|0|0|90,Type=Air+FixedWing,Name=F-14B\n"
      "b,T=1|2|3000|0|5|120,Type=Beam,Parent=a,RadarAzimuth=10\n#10\nb,T=|||0|0|60\n#20\n-b\n");
  ASSERT_EQ(r.beams.size(), 1u);
  const auto& states = r.beams[0].states;
  ASSERT_EQ(states.size(), 3u);
  EXPECT_NEAR(states[0].azimuth_deg, 40, 0.05);
  EXPECT_NEAR(states[0].elevation_deg, 5, 0.15) << "10 degrees beside the nose, that is pitched up";
  EXPECT_EQ(states[1].t_s, 10);
  EXPECT_NEAR(states[1].azimuth_deg, -20, 0.05);
  EXPECT_NEAR(states[1].elevation_deg, 0, 0.01);
  EXPECT_EQ(states[2].t_s, 20);
  EXPECT_FALSE(states[2].is_on) << "its object was removed";
}

TEST(Acmi, SideIsThatOfTheColourElseOfTheCoalition) {
  const Recording r = readLines(
      "1,T=1|2|3,Coalition=Allies,Color=Red\n2,T=1|2|3,Coalition=Hostile\n3,T=1|2|3,Coalition=Friend\n"
      "4,T=1|2|3,Coalition=Neutrals\n5,T=1|2|3,Coalition=Some Country\n6,T=1|2|3\n");
  std::vector<Side> sides;
  for (const RecordedObject& object : r.objects) sides.push_back(object.side);
  EXPECT_THAT(sides, testing::ElementsAre(Side::hostile, Side::hostile, Side::friendly, Side::neutral,
                                          Side::unknown, Side::unknown));
}

TEST(Acmi, TornEndIsToldAndWhatWasReadIsKept) {
  const Recording r = readLines("1,T=1|2|3\n#1\n1,T=1.5|2.");
  EXPECT_EQ(r.objects.at(0).poses.size(), 1u);
  EXPECT_THAT(r.tally.torn, HasSubstr("line 5 has no end"));
}

TEST(Acmi, LinesThatCannotBeReadAreCountedWithTheFirstReason) {
  const Recording r = readLines("1,T=1|2|3\nxyz,T=1|2|3\n#abc\n1,T=1|95|3\n1,T=1|2|x\n");
  EXPECT_EQ(r.tally.bad, 4);
  EXPECT_THAT(r.tally.first_bad, HasSubstr("line 4: 'xyz' is no hexadecimal id"));
}

TEST(Acmi, OtherFormatsAndVersionsAreRefusedWithARemedy) {
  EXPECT_THAT(
      test::errorOf([] { readText("FileType=text/acmi/tacview\nFileVersion=1.5\n"); }, ErrorCode::bad_input),
      HasSubstr("test.acmi:2:1: 'FileVersion=1.5' must be FileVersion=2.0 to FileVersion=2.2"));
  EXPECT_THAT(test::errorOf([] { readText("hello\n"); }, ErrorCode::bad_input),
              HasSubstr("begins with FileType=text/acmi/tacview"));
  const test::TemporaryFolder folder;
  const std::string archive = folder.write("a.acmi", "7z\xBC\xAF\x27\x1C....");
  EXPECT_THAT(test::errorOf([&] { readRecording(archive); }, ErrorCode::bad_input),
              HasSubstr("packed by 7z, xz, bzip2 or zstd, of which none is read; unpack it"));
  const std::string other = folder.write("b.acmi", "hello");
  EXPECT_THAT(test::errorOf([&] { readRecording(other); }, ErrorCode::bad_input),
              HasSubstr("no recording of a known format: ACMI 2.0 to 2.2"));
}

TEST(Acmi, DamagedZipIsRefused) {
  const test::TemporaryFolder folder;
  const std::string archive = folder.write("a.zip.acmi", "PK\x03\x04 damaged");
  EXPECT_THAT(test::errorOf([&] { readRecording(archive); }, ErrorCode::bad_input),
              HasSubstr("cannot read: "));
}

class AcmiSample : public testing::Test {
 protected:
  void SetUp() override {
    for (const char* name : {"kavinsky_simple.txt.acmi", "kavinsky_simple.zip.acmi"}) {
      const std::string path = std::string("interop/acmi/") + name;
      const auto file = test::referenceFile(path);
      if (!file) GTEST_SKIP() << test::notInRepository(path);
      files_.push_back(*file);
    }
  }
  std::vector<std::string> files_;
};

TEST_F(AcmiSample, HasItsObjectsAndTimes) {
  const Recording r = readRecording(files_[0]);
  EXPECT_EQ(r.format, "ACMI 2.2");
  EXPECT_EQ(r.objects.size(), 14u);
  EXPECT_EQ(r.epoch_ms, 641541600000);  // 1990-05-01T06:00:00Z
  EXPECT_NEAR(spanOf(r).end_s, 221, 1);
  EXPECT_EQ(r.tally.bad, 0) << r.tally.first_bad;
  EXPECT_EQ(r.tally.torn, "");
  const RecordedObject& tomcat = r.objects.back();
  EXPECT_EQ(tomcat.name, "F-14B Nuevo apodo");
  EXPECT_EQ(tomcat.domain, Domain::air);
  EXPECT_EQ(tomcat.side, Side::friendly);
  EXPECT_NEAR(tomcat.poses[0].longitude_deg, 36.8608779, 1e-9);
  EXPECT_NEAR(tomcat.poses[0].latitude_deg, 45.001753, 1e-9);
  EXPECT_EQ(tomcat.poses[0].height_msl_m, 4569.69);
}

TEST_F(AcmiSample, TextAndZipAreEqual) {
  const Recording text = readRecording(files_[0]), zip = readRecording(files_[1]);
  ASSERT_EQ(text.objects.size(), zip.objects.size());
  for (std::size_t i = 0; i < text.objects.size(); ++i) {
    ASSERT_EQ(text.objects[i].poses.size(), zip.objects[i].poses.size());
    EXPECT_EQ(text.objects[i].poses.back().longitude_deg, zip.objects[i].poses.back().longitude_deg);
  }
}

TEST_F(AcmiSample, CutZipIsReadToTheCut) {
  const std::string archive = test::readFile(files_[1]);
  const test::TemporaryFolder folder;
  const Recording r = readRecording(folder.write("a.zip.acmi", archive.substr(0, archive.size() / 2)));
  EXPECT_EQ(r.objects.size(), 14u);
  EXPECT_THAT(r.tally.torn, HasSubstr("the zip file is cut"));
  std::string damaged = archive;
  damaged[damaged.size() / 2] = static_cast<char>(damaged[damaged.size() / 2] ^ 0x10);
  EXPECT_THAT(readRecording(folder.write("b.zip.acmi", damaged)).tally.torn,
              HasSubstr("the zip file is damaged"));
}

TEST_F(AcmiSample, CutAnywhereItIsReadToTheCut) {
  const std::string text = test::readFile(files_[0]);
  for (const double part : {0.01, 0.3, 0.77777}) {
    const Recording r =
        readText(text.substr(0, static_cast<std::size_t>(part * static_cast<double>(text.size()))));
    EXPECT_EQ(r.tally.bad, 0) << r.tally.first_bad;
    EXPECT_EQ(r.objects.size(), 14u);
  }
}

/// The logical lines of physical ones.
std::vector<std::string> joinedLines(AcmiLines& lines, const std::vector<std::string>& physical) {
  std::vector<std::string> joined;
  for (const std::string& line : physical) {
    if (const auto logical = lines.take(line)) joined.emplace_back(*logical);
  }
  return joined;
}

TEST(AcmiLines, GoOnAfterABackslash) {
  AcmiLines lines;
  EXPECT_THAT(joinedLines(lines, {"#1", "a,Label=one\\", "two\\", "three,Name=F-16C", "", "#2"}),
              testing::ElementsAre("#1", "a,Label=one\ntwo\nthree,Name=F-16C", "", "#2"));
  EXPECT_EQ(lines.line(), 6);
  EXPECT_EQ(physicalAcmi("a,Label=one\ntwo"), "a,Label=one\\\ntwo");
}

TEST(AcmiLines, TooLongOnesAreLeftOutWholeAndCounted) {
  AcmiLines lines;
  const std::string half(600000, 'x');
  EXPECT_THAT(joinedLines(lines, {half + "\\", half + "\\", "the end of it", "#1"}),
              testing::ElementsAre("#1"));
  EXPECT_EQ(lines.tooLong(), 1);
  EXPECT_FALSE(lines.take("cut", true));
  EXPECT_EQ(lines.tooLong(), 2);
}

TEST(AcmiText, TimesOfFramesAreFiniteNumbersWithinATrack) {
  EXPECT_EQ(acmiFrame_s("#12.5"), 12.5);
  for (const char* text : {"#nan", "#inf", "#9e9", "#", "12", "#1x"}) EXPECT_FALSE(acmiFrame_s(text)) << text;
}

}  // namespace
}  // namespace emscape::interop
