#include "playback/pictures/silence.h"

#include <gtest/gtest.h>

#include "emscape/playback/frames/frame_source.h"
#include "emscape/playback/pictures/painter.h"
#include "tests/playback/playback_samples.h"

namespace emscape::playback::test {
namespace {

using scenario::EmitterKind;

scenario::Scenario scenarioWith(const std::vector<EmitterKind>& kinds) {
  scenario::Scenario scenario;
  for (const EmitterKind kind : kinds) {
    scenario::Emitter emitter;
    emitter.name = scenario::toString(kind);
    emitter.kind = kind;
    scenario.emitters.push_back(emitter);
  }
  return scenario;
}

TEST(Silence, IsTheAbsenceOfThoseThatAQuantityIsAbout) {
  scenario::Scenario scenario =
      scenarioWith({EmitterKind::radar, EmitterKind::transmitter, EmitterKind::jammer});
  for (const char* quantity :
       {"snr_db", "snr_db:radar", "jammer_to_signal_db", "power_density_dbwm2", "other"})
    EXPECT_EQ(silenceText(scenario, quantity, 0), "") << quantity;
  scenario.emitters[0].enabled = false;
  EXPECT_EQ(silenceText(scenario, "snr_db", 0), "no radar transmits");
  EXPECT_EQ(silenceText(scenario, "snr_db:radar", 0), "'radar' does not transmit");
  EXPECT_EQ(silenceText(scenario, "detection_probability", 0), "no radar transmits");
  EXPECT_EQ(silenceText(scenario, "power_density_dbwm2", 0), "");
  scenario.emitters[0].enabled = true;
  scenario.emitters[2].active_s = {{10, 20}};
  EXPECT_EQ(silenceText(scenario, "jammer_to_signal_db", 5), "no jammer transmits");
  EXPECT_EQ(silenceText(scenario, "jammer_to_signal_db", 15), "");
  EXPECT_EQ(silenceText(scenario, "detection_probability", 5), "") << "defined without jamming";
  scenario.output.interval = {scenario::IntervalKind::max_hold, 6.0, {}};
  EXPECT_EQ(silenceText(scenario, "jammer_to_signal_db", 5), "") << "within the interval";
  for (scenario::Emitter& emitter : scenario.emitters) emitter.enabled = false;
  EXPECT_EQ(silenceText(scenario, "power_density_dbwm2", 15), "no emitter transmits");
}

TEST(Silence, IsSaidBelowTheLegend) {
  const TemporaryFolder folder;
  ViewState view;
  view.input = quickScenario(folder);
  view.size = {160, 120};
  const auto noteOf = [&](const std::vector<scenario::Edit>& edits) {
    ViewState shown = view;
    shown.edits = edits;
    const auto source = openFrameSource(FrameSelection(shown), {});
    Painter painter(shown, *source, {});
    painter.setFrame(source->frame(0));
    return painter.annotations().legend->note;
  };
  EXPECT_EQ(noteOf({}).find("transmits"), std::string::npos);
  EXPECT_NE(noteOf({{"emitters.radar.enabled", "false"}, {"emitters.transmitter.enabled", "false"}})
                .find("no emitter transmits"),
            std::string::npos);
}

}  // namespace
}  // namespace emscape::playback::test
