/// Verbs of the probe.
#include <fmt/format.h>

#include <cmath>

#include "apps/view/session/session.h"
#include "emscape/base/error.h"
#include "emscape/base/geodesy/geoid.h"

namespace emscape::view {
namespace {

/// The position in the picture's frame that a command names by latitude, longitude and a height.
Vec3d positionOf(const Command& command, const playback::LivePicture& picture) {
  if (!picture.grid().georeferenced) {
    throw Error(ErrorCode::bad_input, "probe: the volume has no position on the earth; give x and y");
  }
  const double latitude_deg = command.number("latitude_deg"), longitude_deg = command.number("longitude_deg");
  if (!(std::abs(latitude_deg) <= 90) || !(std::abs(longitude_deg) <= 180)) {
    throw Error(ErrorCode::bad_input,
                fmt::format("probe: {:g}, {:g} is outside latitude -90..90 and longitude -180..180 deg",
                            latitude_deg, longitude_deg));
  }
  double height_msl_m = command.number("height_msl_m");
  if (command.has("height_agl_m")) {
    const double ground_m = picture.terrain ? picture.terrain->heightMsl_m(latitude_deg, longitude_deg) : 0;
    if (std::isnan(ground_m)) {
      throw Error(ErrorCode::bad_input, fmt::format("probe: the ground at {:g}, {:g} is not known; give "
                                                    "height_msl_m",
                                                    latitude_deg, longitude_deg));
    }
    height_msl_m = ground_m + command.number("height_agl_m");
  }
  return GeoFrame(picture.grid().frame)
      .toLocal({latitude_deg, longitude_deg, height_msl_m + geoidUndulation_m(latitude_deg, longitude_deg)});
}

}  // namespace

std::vector<Verb> Session::probeVerbs() {
  return {
      {"probe",
       {{"x", kNumber, false},
        {"y", kNumber, false},
        {"latitude_deg", kNumber, false},
        {"longitude_deg", kNumber, false},
        {"height_msl_m", kNumber, false},
        {"height_agl_m", kNumber, false}},
       "Locks the probe at a pixel of the picture or at a position",
       [](Session& session, const Command& command) {
         if (!session.picture_) throw Error(ErrorCode::bad_input, "probe: there is no picture yet");
         const bool is_pixel = command.has("x") && command.has("y");
         const bool is_position = command.has("latitude_deg") && command.has("longitude_deg") &&
                                  command.has("height_msl_m") != command.has("height_agl_m");
         if (is_pixel == is_position) {
           throw Error(ErrorCode::bad_input,
                       "probe: expected x and y, or latitude_deg and longitude_deg with height_msl_m or "
                       "height_agl_m");
         }
         if (is_pixel) {
           session.prober_.lockAtPixel(command.number("x"), command.number("y"));
         } else {
           session.prober_.lockAt(positionOf(command, *session.picture_));
         }
         session.panels.probe = true;
         session.panels.hidden = false;
         session.prober_.turnOn(true);
       }},
      {"lock_probe",
       {},
       "Locks the probe where it is, or unlocks it, so that it follows the cursor; opens its panel",
       [](Session& session, const Command&) {
         session.panels.probe = true;
         session.panels.hidden = false;
         session.prober_.turnOn(true);
         session.prober_.toggleLock();
       }},
      {"copy_history",
       {},
       "Puts the values over time at the locked probe on the clipboard, as CSV",
       [](Session& session, const Command&) {
         if (session.history().computed == 0)
           throw Error(ErrorCode::bad_input, "copy_history: there are no values over time yet");
         session.window_.setClipboard(csvOf(session.history(), session.picture_->info().quantity));
         session.tell(fmt::format("copied: {} values over time", session.history().computed));
       }},
      {"copy_profile",
       {{"emitter", kText}},
       "Puts the command that explains the path from an emitter to the probe on the clipboard",
       [](Session& session, const Command& command) {
         const ProbeResult* result = session.prober_.result();
         const std::string text = profileCommand(result ? *result : ProbeResult{}, command.text("emitter"));
         session.window_.setClipboard(text);
         session.tell("copied: " + text);
       }},
  };
}

/// Asks for the values over time at the locked probe, and for none otherwise.
void Session::askHistory() {
  const ProbeResult* const result = prober_.result();
  const bool is_asked = prober_.isOn() && prober_.isLocked() && result != nullptr && result->reading &&
                        result->reading->position && picture_ && picture_->scenario && !picture_->cells &&
                        computedScenario() && !compares() && timeline_.times_s().size() > 1;
  if (!is_asked) return history_.clear();
  history_.ask({{picture_->scenario, picture_->terrain},
                picture_->info().quantity,
                result->reading->position->latitude_deg,
                result->reading->position->longitude_deg,
                *result->reading->height_msl_m,
                timeline_.times_s()});
}

Json Session::probeReport() const {
  Json report{{"probe_locked", prober_.isLocked()}};
  const ProbeResult* result = prober_.result();
  report["history_steps"] = history_.values().computed;
  if (!prober_.isOn() || result == nullptr || !result->reading) return report;
  const playback::ProbeReading& reading = *result->reading;
  report["probe_text"] = reading.text;
  report["probe_time_s"] = result->time_s;
  if (reading.sample.kind == playback::VolumeSample::Kind::value)
    report["probe_value"] = reading.sample.value;
  if (reading.position) {
    report["probe_latitude_deg"] = reading.position->latitude_deg;
    report["probe_longitude_deg"] = reading.position->longitude_deg;
    report["probe_height_msl_m"] = *reading.height_msl_m;
  }
  if (reading.height_agl_m) report["probe_height_agl_m"] = *reading.height_agl_m;
  return report;
}

}  // namespace emscape::view
