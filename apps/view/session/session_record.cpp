/// Verbs of recording.
#include <fmt/format.h>

#include "apps/view/session/session.h"
#include "base/files/descriptor.h"
#include "emscape/base/error.h"
#include "playback/pictures/picture_sink.h"

namespace emscape::view {
namespace {

constexpr NumberLimits kSide_px{16, render::kMaxImageSide, true};

}  // namespace

void Session::record(const RecordRange& range, const std::string& output, Replaces replaces) {
  if (timeline_.times_s().empty()) throw Error(ErrorCode::bad_input, "record: there is nothing to see yet");
  if (output.empty()) throw Error(ErrorCode::bad_input, "record: name a folder, a .mp4 or a .png");
  RecordJob job;
  job.view = viewState();
  if (edits_ && view_.scenario.empty() && scenario()->source) job.opened = scenario();
  if (range.size) job.view.size = *range.size;
  job.times = recordTimes(range);
  job.target = target_;
  job.frames_per_s = range.frames_per_s;
  job.output = output;
  job.replaces = replaces;
  files_->recorder.start(job, wake_);
}

/// The times in the syntax of --times; empty: all steps.
std::string Session::recordTimes(const RecordRange& range) const {
  if (!range.begin_s && !range.end_s && !range.step_s) return "";
  const double begin_s = range.begin_s.value_or(timeline_.begin_s());
  const double end_s = range.end_s.value_or(timeline_.end_s());
  timeline_.requireTime(begin_s);
  timeline_.requireTime(end_s);
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
        {"begin", kText, false},
        {"end", kText, false},
        {"step_s", kNumber, false},
        {"frames_per_s", kNumber, false, {kMinFramesPerSecond, kMaxFramesPerSecond}},
        {"width", kNumber, false, kSide_px},
        {"height", kNumber, false, kSide_px},
        {"replace", kBoolean, false}},
       "Records the view over the series, or from `begin_s` to `end_s` (or from `begin` to `end`, texts as "
       "for "
       "`seek`), into a folder of pictures or a .mp4, "
       "of `width` x `height` pixels or as large as on screen; without a file: asks for it",
       [](Session& session, const Command& command) {
         if (!command.has("file")) {
           session.panels.record = true;
           return;
         }
         const auto given = [&command](const char* name) {
           return command.has(name) ? std::optional<double>(command.number(name)) : std::nullopt;
         };
         const auto time = [&](const char* name_s, const char* name) {
           if (command.has(name_s) && command.has(name)) {
             throw Error(ErrorCode::bad_input, fmt::format("record: expected either {} or {}", name_s, name));
           }
           return command.has(name) ? std::optional(session.timeline_.parseTime_s(command.text(name)))
                                    : given(name_s);
         };
         RecordRange range{time("begin_s", "begin"), time("end_s", "end"), given("step_s"),
                           command.number("frames_per_s", 10), std::nullopt};
         if (command.has("width") != command.has("height")) {
           throw Error(ErrorCode::bad_input, "record: expected width and height together");
         }
         if (command.has("width")) {
           range.size = render::ImageSize{static_cast<int>(command.number("width")),
                                          static_cast<int>(command.number("height"))};
         }
         const std::filesystem::path output = command.text("file");
         if (!output.empty()) {
           playback::checkPictureOutput(output);
           if (output.has_extension()) openFolderOf(output);  // before a question, and the work
         }
         const bool records = session.files_->recorder.running();  // refused below
         if (!records && session.asksToReplace(command, command.text("file"))) return;
         session.record(range, command.text("file"),
                        session.mayReplace(command) ? Replaces::any : Replaces::own);
         session.panels.record = false;
       }},
      {"record_cancel",
       {},
       "Ends the recording; complete pictures are kept, a video is not written",
       [](Session& session, const Command&) { session.files_->recorder.cancel(); }},
  };
}

}  // namespace emscape::view
