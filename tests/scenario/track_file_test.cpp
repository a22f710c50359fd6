#include <gmock/gmock.h>

#include <string>
#include <vector>

#include "scenario/file/parse_sections.h"

namespace emscape::scenario {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class TrackFile : public ::testing::Test {
 protected:
  /// The places and messages of a track's faults.
  std::vector<std::string> faultsOf(const std::string& text) {
    ProblemList problems;
    const scenario::TrackFile track = parseTrack("track.csv", text, {"scenario.yaml", 1, 1}, problems);
    points_ = track.points;
    warnings_ = track.warnings;
    std::vector<std::string> faults;
    for (const Problem& problem : problems.inOrder())
      faults.push_back(toString(problem.location) + ": " + problem.message);
    return faults;
  }
  std::vector<TrackPoint> points_;
  std::vector<std::string> warnings_;
};

TEST_F(TrackFile, MayComeFromASpreadsheet) {
  EXPECT_THAT(faultsOf("\"t_s\",\"latitude_deg\",\"longitude_deg\",\"height_msl_m\"\r\n0,50,6,100\r\n,,,\r\n"
                       "\"10\",\"50.1\",6,100\r\n,,,\r\n"),
              IsEmpty());
  ASSERT_EQ(points_.size(), 2u);
  EXPECT_EQ(points_[1].t_s, 10);
  EXPECT_EQ(points_[1].position.latitude_deg, 50.1);
}

TEST_F(TrackFile, OtherSeparatorsAreOneFault) {
  EXPECT_THAT(faultsOf("t_s;latitude_deg;longitude_deg;height_msl_m\n0;50;6;100\n"),
              ElementsAre(HasSubstr("track.csv:1:1: columns are separated by commas, not semicolons")));
  EXPECT_THAT(faultsOf("t_s\tlatitude_deg\tlongitude_deg\theight_msl_m\n"),
              ElementsAre(HasSubstr("columns are separated by commas, not tabs")));
  EXPECT_THAT(faultsOf("t_s,latitude_deg,longitude_deg,height_msl_m,\n"),
              ElementsAre(HasSubstr("track.csv:1:45: column 5 has no name")));
}

TEST_F(TrackFile, ARowWithoutAnEndIsTold) {
  const std::string rows = "t_s,latitude_deg,longitude_deg,height_msl_m\n0,50,6,1500\n10,50.1,6,15";
  EXPECT_THAT(faultsOf(rows), IsEmpty());
  EXPECT_THAT(warnings_, ElementsAre(HasSubstr("line 3, a row, has no end: if the file was cut there")));
  for (const char* const end : {"\n", "\r\n", "00\n# made\n# by hand", "\n  "}) {
    EXPECT_THAT(faultsOf(rows + end), IsEmpty());
    EXPECT_THAT(warnings_, IsEmpty()) << end;
  }
}

TEST_F(TrackFile, ColumnsAreMissingOnlyWhereTheOthersAreKnown) {
  EXPECT_THAT(faultsOf("T_S,latitude_deg,longitude_deg,Height_MSL_m\n"),
              ElementsAre(HasSubstr("1:1: unknown key 'T_S'; write 't_s' (s)"),
                          HasSubstr("1:32: unknown key 'Height_MSL_m'; write 'height_msl_m' (m)")));
  EXPECT_THAT(faultsOf("when,latitude_deg,longitude_deg\n"), ElementsAre(HasSubstr("unknown key 'when'")));
  EXPECT_THAT(faultsOf("t_s,latitude_deg,longitude_deg\n"),
              ElementsAre(HasSubstr("exactly one of the columns 'height_msl_m' and 'height_agl_m'")));
}

}  // namespace
}  // namespace emscape::scenario
