/// Verbs of recording.
#include <fmt/format.h>

#include <filesystem>

#include "apps/view/session/session.h"
#include "emscape/base/error.h"

namespace emscape::view {

void Session::record(const RecordRange& range, const std::string& output) {
  if (timeline_.times_s().empty()) throw Error(ErrorCode::bad_input, "record: there is nothing to see yet");
  if (output.empty()) throw Error(ErrorCode::bad_input, "record: name a folder, a .mp4 or a .png");
  RecordJob job;
  job.view = viewState();
  job.times = recordTimes(range);
  job.target = target_;
  job.frames_per_s = range.frames_per_s;
  job.output = output;
  files_->recorder.start(job, wake_);
}

/// The times in the syntax of --times; empty: all steps.
std::string Session::recordTimes(const RecordRange& range) const {
  if (!range.begin_s && !range.end_s && !range.step_s) return "";
  const double begin_s = range.begin_s.value_or(timeline_.times_s().front());
  const double end_s = range.end_s.value_or(timeline_.times_s().back());
  if (!(begin_s <= end_s) || (range.step_s && !(*range.step_s > 0))) {
    throw Error(ErrorCode::bad_input, "record: expected begin_s <= end_s and step_s > 0");
  }
  if (begin_s == end_s) return fmt::format("{}", begin_s);
  if (!range.step_s) return fmt::format("{}:{}", begin_s, end_s);
  return fmt::format("{}:{}:{}", begin_s, end_s, *range.step_s);
}

std::vector<Verb> Session::recordVerbs() {
  return {
      {"record",
       {{"file", kText, false},
        {"begin_s", kNumber, false},
        {"end_s", kNumber, false},
        {"step_s", kNumber, false},
        {"frames_per_s", kNumber, false, {0.1, 240}}},
       "Records the view over the series, or from `begin_s` to `end_s`, into a folder of pictures or a .mp4; "
       "without a file: asks for it",
       [](Session& session, const Command& command) {
         if (!command.has("file")) {
           session.panels.record = true;
           return;
         }
         const auto given = [&command](const char* name) {
           return command.has(name) ? std::optional<double>(command.number(name)) : std::nullopt;
         };
         const RecordRange range{given("begin_s"), given("end_s"), given("step_s"),
                                 command.number("frames_per_s", 10)};
         session.record(range, command.text("file"));
       }},
      {"record_cancel",
       {},
       "Ends the recording; complete pictures are kept, a video is not written",
       [](Session& session, const Command&) { session.files_->recorder.cancel(); }},
  };
}

}  // namespace emscape::view
