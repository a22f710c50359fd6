/// Verbs of time: playing, stepping, seeking.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apps/view/session/session.h"
#include "emscape/base/error.h"

namespace emscape::view {
namespace {

constexpr NumberLimits kRates{-1e4, 1e4, false, true};

}  // namespace

std::vector<Verb> Session::timeVerbs() {
  return {
      {"play",
       {{"on", kBoolean, false}},
       "Plays or pauses; without `on` the other of the two",
       [](Session& session, const Command& command) {
         if (command.boolean("on", !session.timeline_.playing())) {
           session.advanced_at_s_ = session.log_.now_s();
           session.timeline_.play();
           session.askTime();
         } else {
           session.pause();
         }
       }},
      {"pause", {}, "Pauses", [](Session& session, const Command&) { session.pause(); }},
      {"step",
       {{"steps", kNumber, true, {-1e9, 1e9, true}}},
       "Moves by so many steps of the series, backwards if negative; pauses",
       [](Session& session, const Command& command) {
         session.timeline_.stepBy(static_cast<int>(command.number("steps")));
         session.askTime();
       }},
      {"seek",
       {{"time_s", kNumber, false}, {"time", kText, false}},
       "Shows a time of the series, given in seconds or as a text (90, 1.5 min, 1:30, 2026-06-01T06:01:30Z, "
       "06:01:30 UTC); of volumes the nearest step. Playing goes on from there",
       [](Session& session, const Command& command) {
         if (command.has("time_s") == command.has("time")) {
           throw Error(ErrorCode::bad_input, "seek: expected either time_s or time");
         }
         const double time_s = command.has("time") ? session.timeline_.parseTime_s(command.text("time"))
                                                   : command.number("time_s");
         session.timeline_.requireTime(time_s);
         session.timeline_.seek(time_s);
         session.askTime();
       }},
      {"first",
       {},
       "Shows the first step; pauses",
       [](Session& session, const Command&) {
         session.timeline_.goToFirst();
         session.askTime();
       }},
      {"last",
       {},
       "Shows the last step; pauses",
       [](Session& session, const Command&) {
         session.timeline_.goToLast();
         session.askTime();
       }},
      {"rate",
       {{"value", kNumber, false, kRates},
        {"change", kNumber, false, {-1, 1, true, true}},
        {"steps_per_s", kNumber, false, {-1e3, 1e3, false, true}}},
       "Scenario seconds per second, backwards if negative; or `change`, 1 or -1: the next usual rate above "
       "or below, below the slowest backwards; or `steps_per_s`: steps of the series per second",
       [](Session& session, const Command& command) {
         if (command.has("value") + command.has("change") + command.has("steps_per_s") != 1) {
           throw Error(ErrorCode::bad_input, "rate: expected value, change or steps_per_s");
         }
         if (command.has("value")) {
           session.timeline_.setRate(command.number("value"));
         } else if (command.has("steps_per_s")) {
           const double step_rate = session.timeline_.stepsPerSecond(1);
           if (step_rate == 0) throw Error(ErrorCode::bad_input, "rate: there is only one step");
           session.timeline_.setRate(
               std::clamp(command.number("steps_per_s") / step_rate, kRates.min, kRates.max));
         } else {
           session.timeline_.changeRate(static_cast<int>(command.number("change")));
         }
         session.tellRate();
       }},
      {"reverse",
       {},
       "Plays in the other direction",
       [](Session& session, const Command&) {
         session.timeline_.reverse();
         session.tellRate();
       }},
      {"loop",
       {{"on", kBoolean, false}},
       "Playing continues at the other end of the playing range",
       [](Session& session, const Command& command) {
         session.timeline_.setLoop(command.boolean("on", !session.timeline_.loop()));
       }},
      {"play_from",
       {{"time_s", kNumber, false}},
       "Playing stays after this time; without one after the present",
       [](Session& session, const Command& command) {
         session.timeline_.setPlayBegin(command.number("time_s", session.timeline_.asked_s()));
       }},
      {"play_to",
       {{"time_s", kNumber, false}},
       "Playing stays before this time; without one before the present",
       [](Session& session, const Command& command) {
         session.timeline_.setPlayEnd(command.number("time_s", session.timeline_.asked_s()));
       }},
      {"play_all",
       {},
       "Plays the whole series again",
       [](Session& session, const Command&) { session.timeline_.playAll(); }},
      {"timeline",
       {{"from_s", kNumber, false},
        {"to_s", kNumber, false},
        {"zoom", kNumber, false, {1e-6, 1e6}},
        {"about_s", kNumber, false},
        {"pan_s", kNumber, false}},
       "What the time line shows: from one time to another; or `zoom` times as much, about a time; or later "
       "by "
       "`pan_s`; without arguments all",
       [](Session& session, const Command& command) {
         playback::Timeline& timeline = session.timeline_;
         if (command.arguments.empty()) timeline.showAll();
         const scenario::TimeInterval seen = timeline.visible();
         if (command.has("from_s") || command.has("to_s")) {
           const double from_s = command.number("from_s", seen.begin_s);
           const double to_s = command.number("to_s", seen.end_s);
           if (!(from_s < to_s)) {
             throw Error(ErrorCode::bad_input,
                         fmt::format("timeline {:g}..{:g}: expected from_s below to_s", from_s, to_s));
           }
           timeline.setVisible(from_s, to_s);
         }
         if (command.has("zoom"))
           timeline.zoom(command.number("zoom"), command.number("about_s", timeline.asked_s()));
         if (command.has("pan_s")) timeline.pan(command.number("pan_s"));
       }},
  };
}

void Session::pause() {
  timeline_.pause();
  askTime();
}

void Session::tellRate() {
  const double rate = timeline_.rate();
  const std::string steps = timeline_.hasLongSteps()
                                ? fmt::format(", {:.2g} steps/s", std::abs(timeline_.stepsPerSecond(rate)))
                                : "";
  tell(fmt::format("{:g} times real time{}{}", std::abs(rate), steps, rate < 0 ? ", backwards" : ""));
}

}  // namespace emscape::view
