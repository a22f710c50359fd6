// Emitter databases.
#include "interop/emitters/emitter_database.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "interop/emitters/emitter_names.h"
#include "tests/support/errors.h"
#include "tests/support/files.h"
#include "tests/support/temporary_folder.h"

namespace emscape::interop {
namespace {

using testing::HasSubstr;

const std::string kEmitter =
    "    emitter: {kind: jammer, frequency_hz: 3.0e9, power_w: 10, antenna: {pattern: isotropic}}\n";

EmitterDatabase databaseOf(const std::vector<std::string>& matches, const std::string& end = "") {
  std::string text = "schema_version: 1\nemitters:\n";
  for (std::size_t i = 0; i < matches.size(); ++i)
    text += "  - name: row " + std::to_string(i) + "\n    match: " + matches[i] + "\n" + kEmitter;
  return parseEmitterDatabase("db.yaml", text + end);
}

std::string matchOf(const EmitterDatabase& database, const RecordedObject& object, const RecordedBeam* beam) {
  const EmitterRow* row = findRow(database, object, beam);
  return row == nullptr ? "none" : row->name;
}

TEST(EmitterDatabase, FirstRowWhoseConditionsAllHoldIsUsed) {
  const EmitterDatabase database =
      databaseOf({"{dis_name: 5, function: 2, index: [0, 3]}", "{dis_name: 5}", "{beam_function: [1, 2]}"});
  RecordedObject object;
  RecordedBeam beam;
  beam.keys = {5, 2, 1, 3, {}};
  EXPECT_EQ(matchOf(database, object, &beam), "row 0");
  beam.keys.dis_index = 1;
  EXPECT_EQ(matchOf(database, object, &beam), "row 1");
  beam.keys.dis_name = 6;
  EXPECT_EQ(matchOf(database, object, &beam), "row 2");
  beam.keys.dis_beam_function = 3;
  EXPECT_EQ(matchOf(database, object, &beam), "none");
}

TEST(EmitterDatabase, PatternsMatchNamesAndTypes) {
  const EmitterDatabase database = databaseOf(
      {"{acmi_name: \"F-1?*|mig-29*\", acmi_type: \"Air+*\"}", "{dis_entity_type: \"1.2.225.*\"}"});
  RecordedObject object;
  object.keys.acmi_type = "Air+FixedWing";
  object.keys.acmi_name = "MiG-29S";
  EXPECT_EQ(matchOf(database, object, nullptr), "row 0");
  object.keys.acmi_name = "A-10C";
  EXPECT_EQ(matchOf(database, object, nullptr), "none");
  object.keys.dis_entity_type = {1, 2, 225, 1, 0, 0, 0};
  EXPECT_EQ(matchOf(database, object, nullptr), "row 1");
}

TEST(EmitterDatabase, RowWithConditionsOfBeamsIsNotOfObjectsWithoutBeams) {
  const EmitterDatabase database = databaseOf({"{beam_function: [1]}", "{acmi_type: \"*\"}"});
  RecordedObject object;
  object.keys.acmi_type = "Sea+Watercraft";
  EXPECT_EQ(matchOf(database, object, nullptr), "row 1");
}

TEST(EmitterDatabase, FaultsAreListedWithTheirLocation) {
  EXPECT_THAT(test::errorOf([] { databaseOf({"{dis_nme: 5}"}); }, ErrorCode::bad_input),
              HasSubstr("db.yaml:4:13: unknown key 'dis_nme' of the match; did you mean 'dis_name'?"));
  EXPECT_THAT(test::errorOf([] { databaseOf({"{}"}); }, ErrorCode::bad_input), HasSubstr("has no condition"));
  EXPECT_THAT(
      test::errorOf([] { databaseOf({"{dis_name: 1}"}, "unmatched: default\n"); }, ErrorCode::bad_input),
      HasSubstr("'unmatched' is default, but the database has no 'default'"));
}

TEST(EmitterDatabase, StarterSetIsTheShippedFileAndEveryRowNamesItsSource) {
  const EmitterDatabase starter = loadEmitterDatabase("");
  EXPECT_EQ(test::readFile(test::sourceFile("scenarios/data/emitters.yaml")), kStarterEmitters);
  ASSERT_GT(starter.rows.size(), 8u);
  for (const EmitterRow& row : starter.rows) EXPECT_FALSE(row.source.empty()) << row.name;
  EXPECT_EQ(starter.unmatched, Unmatched::warn);
}

TEST(EmitterNames, AreThoseOfTheListOfEmitters) {
  const test::TemporaryFolder folder;
  const std::string file = folder.write(
      "names.xml",
      "<?xml version=\"1.0\"?><!DOCTYPE ebv [<!ENTITY secret SYSTEM \"file:///etc/passwd\">]>\n"
      "<ebv xmlns=\"http://example.org\"><enum uid=\"4\" name=\"Protocol\"><enumrow value=\"7\" "
      "description=\"seven\"/></enum>\n<enum uid=\"75\" name=\"Emitter Name\"><enumrow value=\"28665\" "
      "description=\"AN/SPS-49\"/><enumrow value=\"3\" description=\"a &secret; b\"/></enum></ebv>");
  const auto names = readEmitterNames(file);
  ASSERT_EQ(names.size(), 2u);
  EXPECT_EQ(names.at(28665), "AN/SPS-49");
  EXPECT_EQ(names.at(3), "a &secret; b") << "entities are not resolved";
  const std::string other = folder.write("other.xml", "<a><b></a>");
  EXPECT_THAT(test::errorOf([&] { readEmitterNames(other); }, ErrorCode::bad_input),
              HasSubstr("other.xml: line 1: no XML"));
  const std::string empty = folder.write("empty.xml", "<ebv/>");
  EXPECT_THAT(test::errorOf([&] { readEmitterNames(empty); }, ErrorCode::bad_input),
              HasSubstr("give the file SISO-REF-010.xml"));
}

TEST(EmitterDatabase, NamesOfBeamsAndObjectsMatchInAnyFormat) {
  const EmitterDatabase database =
      databaseOf({"{object_name: \"ship*\", beam_name: search}", "{cot_type: a-h-A}", "{asi_beam: \"trk*\"}",
                  "{acmi_name: AWG-9}", "{object_name: \"ship*\"}"});
  RecordedObject object;
  object.name = "ship 1";
  RecordedBeam beam;
  beam.name = "search";
  EXPECT_EQ(matchOf(database, object, &beam), "row 0");
  EXPECT_EQ(matchOf(database, object, nullptr), "row 4");
  object.name = "x";
  object.keys.cot_type = "a-h-A-M";
  EXPECT_EQ(matchOf(database, object, nullptr), "row 1");
  object.keys.cot_type = "a-f-A-M";
  EXPECT_EQ(matchOf(database, object, nullptr), "none");
  beam.keys.asi_beam = "trk 3";
  EXPECT_EQ(matchOf(database, object, &beam), "row 2");
  beam.keys = {};
  object.keys.acmi_name = "F-14";
  beam.keys.acmi_name = "AWG-9";
  EXPECT_EQ(matchOf(database, object, &beam), "row 3") << "its own name";
  beam.keys.acmi_name = "";
  EXPECT_EQ(matchOf(database, object, &beam), "none");
}

}  // namespace
}  // namespace emscape::interop
