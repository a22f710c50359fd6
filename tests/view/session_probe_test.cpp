#include "apps/view/values/position_text.h"
#include "tests/view/session_sample.h"

namespace emscape::view::test {
namespace {

using testing::HasSubstr;

constexpr const char* kProbe =
    R"({"do":"probe","latitude_deg":52.02,"longitude_deg":5.03,"height_msl_m":1500})";

TEST(SessionProbe, LocksAtAPositionAndExplainsItsValue) {
  SessionSample sample("quick.yaml");
  sample.perform(kProbe);
  EXPECT_EQ(sample.error(), "");
  const Json report = sample->report();
  EXPECT_TRUE(report["probe_locked"].get<bool>());
  EXPECT_NEAR(report["probe_latitude_deg"].get<double>(), 52.02, 1e-9);
  EXPECT_NEAR(report["probe_height_msl_m"].get<double>(), 1500, 1e-3);
  EXPECT_THAT(report["probe_text"].get<std::string>(), HasSubstr("dBW/m2"));
  const ProbeResult& result = *sample->prober().result();
  ASSERT_EQ(result.contributions.size(), 2U);
  EXPECT_GE(result.contributions[0].value, result.contributions[1].value);
  EXPECT_THAT(result.contributions[0].text, HasSubstr("dBW/m2"));
  EXPECT_FALSE(result.reading->emitters[0].budget->verdict.empty());
}

TEST(SessionProbe, ContributionsHaveTheUnitInWhichFieldsAreShown) {
  playback::ViewState view;
  EXPECT_EQ(valueText(-60, "dBW/m2", "-60 dBW/m2", view), "-60 dBW/m²");
  view.field_unit = FieldUnit::dbm;
  EXPECT_EQ(valueText(-60, "dBW/m2", "-60 dBW/m2", view), "-30 dBm/m²");
  EXPECT_EQ(valueText(12, "dB", "12 dB", view), "12 dB");
  EXPECT_EQ(valueText(-INFINITY, "", "no field", view), "no field");
}

TEST(SessionProbe, FollowsTimeAndEdits) {
  SessionSample sample("quick.yaml", {{"output.floor", "-300"}});
  sample.perform(kProbe);
  const auto value = [&] { return sample->report()["probe_value"].get<double>(); };
  const auto budgetOfTransmitter = [&] {
    return sample->prober().result()->reading->emitters[1].budget->find("power_density_dbwm2")->value;
  };
  const double before = value(), transmitter_before = budgetOfTransmitter();
  sample.perform(
      R"({"do":"set_together","edits":["emitters.transmitter.power_w=10000","emitters.radar.power_w=100000"]})");
  sample.settle();
  EXPECT_NEAR(value(), before + 10, 0.01);
  EXPECT_NEAR(budgetOfTransmitter(), transmitter_before + 10, 1e-6);
  sample.perform(R"({"do":"seek","time_s":2})");
  sample.settle();
  EXPECT_EQ(sample->report()["probe_time_s"], 2);
  // A movement of the camera is no reason to read again.
  const ProbeResult* result = sample->prober().result();
  const auto scenario = result->scenario;
  sample.perform(R"({"do":"orbit","azimuth_deg":20})");
  sample.settle();
  EXPECT_NEAR(sample->report()["probe_latitude_deg"].get<double>(), 52.02, 1e-9);
}

TEST(SessionProbe, FollowsEditsWhereTheCursorLeftThePicture) {
  SessionSample sample("quick.yaml", {{"output.floor", "-300"}});
  sample.perform(R"({"do":"panel","name":"probe"})");
  sample->prober().hover(render::Projected{110, 110});
  sample.settle();
  const auto value = [&] { return sample->report()["probe_value"].get<double>(); };
  const double before = value();
  sample->prober().hover(std::nullopt);
  sample.perform(
      R"({"do":"set_together","edits":["emitters.transmitter.power_w=10000","emitters.radar.power_w=100000"]})");
  sample.settle();
  EXPECT_NEAR(value(), before + 10, 0.01);
  EXPECT_FALSE(sample->prober().isLocked());
}

TEST(SessionProbe, FollowsTheCursorUntilItIsLocked) {
  SessionSample sample("jacksboro.yaml", {{"region.dims", "[40, 40, 20]"}});
  sample.perform(R"({"do":"panel","name":"probe"})");
  Prober& prober = sample->prober();
  prober.hover(render::Projected{110, 110});
  sample.settle();
  const double latitude_deg = sample->report()["probe_latitude_deg"].get<double>();
  // Above the ground, at a receiver's height, in a voxel with a field.
  EXPECT_GT(sample->report()["probe_height_agl_m"].get<double>(), 9);
  EXPECT_LT(sample->report()["probe_height_agl_m"].get<double>(), 200);
  EXPECT_THAT(sample->report()["probe_text"].get<std::string>(), testing::Not(testing::HasSubstr("masked")));
  prober.hover(render::Projected{120, 100});
  sample.settle();
  EXPECT_NE(sample->report()["probe_latitude_deg"].get<double>(), latitude_deg);
  prober.hover(render::Projected{110, 110});
  sample.settle();
  sample.perform(R"({"do":"lock_probe"})");
  prober.hover(render::Projected{20, 20});
  sample.settle();
  EXPECT_TRUE(prober.isLocked());
  EXPECT_NEAR(sample->report()["probe_latitude_deg"].get<double>(), latitude_deg, 1e-9);
  sample.perform(R"({"do":"lock_probe"})");
  sample.settle();
  EXPECT_FALSE(prober.isLocked());
  EXPECT_FALSE(prober.result()->reading);  // the corner is outside the volume
  sample.perform(R"({"do":"probe","x":110,"y":110})");
  EXPECT_NEAR(sample->report()["probe_latitude_deg"].get<double>(), latitude_deg, 1e-9);
  EXPECT_TRUE(prober.locked_m());
}

TEST(SessionProbe, CopiesTheCommandThatExplainsThePath) {
  SessionSample sample("quick.yaml");
  sample.perform(R"({"do":"copy_profile","emitter":"radar"})");
  EXPECT_EQ(sample.error(), "there is no path to explain: the probe has no point of a scenario");
  sample.perform(kProbe);
  sample.perform(R"({"do":"set","path":"emitters.radar.power_w","value":"5"})");
  sample.settle();
  sample.perform(R"({"do":"copy_profile","emitter":"radar"})");
  EXPECT_THAT(sample.window.clipboard, HasSubstr("quick.yaml --set emitters.radar.power_w=5 --emitter radar "
                                                 "--to=52.0200000,5.0300000,1500.00 --time 0"));
}

TEST(SessionProbe, CopiesNoCommandForAnUnknownEmitter) {
  SessionSample sample("quick.yaml");
  sample.perform(kProbe);
  sample.settle();
  sample.perform(R"({"do":"copy_profile","emitter":"nobody"})");
  EXPECT_EQ(sample.error(), "there is no emitter 'nobody'; the scenario has 'radar', 'transmitter'");
  EXPECT_EQ(sample.window.clipboard, "");
}

TEST(SessionProbe, ValueOverTimeIsThatOfTheField) {
  SessionSample sample("quick.yaml");
  sample.perform(kProbe);
  const std::vector<double>& times_s = sample->timeline().times_s();
  sample.waitUntil([&] { return sample->history().computed == times_s.size(); });
  const ValueHistory history = sample->history();
  EXPECT_EQ(history.error, "");
  EXPECT_EQ(history.times_s, times_s);
  // The same as the radar's and the transmitter's budgets at the point, and near the volume's value, which is
  // interpolated between voxels.
  for (const std::size_t step : {std::size_t{0}, std::size_t{2}}) {
    sample.perform(R"({"do":"seek","time_s":)" + std::to_string(times_s[step]) + "}");
    sample.settle();
    double sum_w = 0;
    for (const playback::EmitterProbe& emitter : sample->prober().result()->reading->emitters) {
      sum_w += std::pow(10, emitter.budget->find("power_density_dbwm2")->value / 10);
    }
    EXPECT_NEAR(history.values[step], 10 * std::log10(sum_w), 0.05) << step;
  }
  sample.perform(R"({"do":"copy_history"})");
  EXPECT_THAT(sample.window.clipboard, testing::StartsWith("t_s,\"power_density_dbwm2\"\n0,-"));
  sample.perform(R"({"do":"lock_probe"})");
  sample.settle();
  EXPECT_EQ(sample->history().computed, 0U);
}

TEST(SessionProbe, TheTimesOfValuesAreKnownBeforeTheValues) {
  SessionSample sample("quick.yaml");
  const playback::LivePicture& picture = *sample->picture();
  ProbeHistory history([] {});
  history.ask({{picture.scenario, picture.terrain}, "power_density_dbwm2", 52, 5, 1500, {0, 1, 2}});
  EXPECT_EQ(history.values().times_s, (std::vector<double>{0, 1, 2})) << "their chart has its place";
  EXPECT_EQ(history.values().computed, 0U);
}

TEST(SessionProbe, ReportsInvalidPositions) {
  SessionSample sample("quick.yaml");
  sample.perform(R"({"do":"probe","x":3})");
  EXPECT_EQ(sample.error(),
            "probe: expected x and y, or latitude_deg and longitude_deg with height_msl_m or height_agl_m");
  sample.perform(R"({"do":"probe","latitude_deg":91,"longitude_deg":5,"height_msl_m":0})");
  EXPECT_EQ(sample.error(), "probe: 91, 5 is outside latitude -90..90 and longitude -180..180 deg");
}

TEST(SessionProbe, SaysWhereVolumeAndPointDisagree) {
  using Kind = playback::VolumeSample::Kind;
  SessionSample sample("quick.yaml");
  sample.perform(kProbe);
  sample.settle();
  ProbeResult result = *sample->prober().result();
  EXPECT_EQ(pointFieldOf(result), PointField::same);
  result.reading->sample.kind = Kind::at_floor;
  EXPECT_EQ(pointFieldOf(result), PointField::differs) << "the point alone has a field";
  result.floor = 1000;
  EXPECT_EQ(pointFieldOf(result), PointField::same) << "the point has none above the floor either";
  result.floor = -1000;
  result.reading->sample.kind = Kind::value;
  result.reading->sample.value += 4;
  EXPECT_EQ(pointFieldOf(result), PointField::differs);
  result.reading->sample.value -= 4;
  result.reading->sample.kind = Kind::at_floor;
  for (Contribution& each : result.contributions) each.value = -INFINITY;
  EXPECT_EQ(pointFieldOf(result), PointField::same) << "none at all";
  result.reading->sample.kind = Kind::value;
  EXPECT_EQ(pointFieldOf(result), PointField::of_volume_only);
  result.reading->sample.kind = Kind::masked;
  EXPECT_EQ(pointFieldOf(result), PointField::same) << "the volume does not know";
}

}  // namespace
}  // namespace emscape::view::test
