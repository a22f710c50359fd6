/// emscape live: computes the field of a battlefield that another program streams.
#include <fmt/core.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <exception>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>

#include "apps/common/console.h"
#include "apps/common/interrupt.h"
#include "apps/common/stream_options.h"
#include "apps/emscape/subcommands.h"
#include "base/event.h"
#include "emscape/base/backend.h"
#include "emscape/base/error.h"
#include "emscape/base/work.h"
#include "emscape/emfield/solver/field_solver.h"
#include "emscape/playback/frames/inputs.h"
#include "emscape/scenario/file/scenario_file.h"
#include "emscape/volume/format/file.h"
#include "playback/frames/busy_field.h"
#include "playback/stream/live_scenario.h"
#include "playback/stream/steady_time.h"
#include "volume/format/vdb.h"

namespace emscape::app {
namespace {

struct LiveArguments {
  StreamOptions stream;
  std::string folder;
  double duration_s = 0;
  bool computes = true;
};

struct LiveFieldStatus {
  long long fields = 0;
  double field_ms = 0, latency_ms = 0;  ///< of the last one
  int column_step = 1;                  ///< of the last one: 1 is the whole field
  std::string trouble;                  ///< why there is none
  std::string unwritten;                ///< why the last one is not in its file; tried again
};

/// Computes the field whenever the battlefield has changed.
class LiveField {
 public:
  /// @param writes  the fields are written: all columns of each are computed
  LiveField(playback::LiveBattlefield& battlefield, Backend backend, bool writes)
      : battlefield_(battlefield), backend_(backend), writes_(writes) {}

  /// @return true if a field was computed
  bool update() {
    const playback::BattlefieldNow now = battlefield_.now();
    const bool rests = now.scenario == scenario_ && now.poses == poses_;
    const bool is_quiet = playback::steadyTime_s() - computed_s_ > playback::BusyField::kQuiet_ms / 1000;
    if (rests && (column_step_ == 1 || !is_quiet)) return false;
    if (now.scenario != scenario_) indices_ = playback::platformIndices(*now.scenario);
    const double begin_s = playback::steadyTime_s();
    Work work(&stopFlag());
    const WorkScope scope(&work);
    try {
      loaded_ = loaded_.scenario
                    ? playback::withScenario(loaded_, now.scenario)
                    : playback::LoadedScenario{now.scenario, scenario::loadTerrain(*now.scenario)};
      const auto snapshot =
          scenario::snapshotAt(loaded_.scenario, loaded_.terrain.get(), 0,
                               playback::posesOf(indices_, *now.poses, now.arrival_s)->platforms);
      if (!solver_) {
        emfield::FieldOptions options;
        options.backend = backend_;
        options.allow_missing_terrain = true;
        options.move_tolerance_m = 0;
        solver_ = std::make_unique<emfield::FieldSolver>(loaded_.scenario, loaded_.terrain, options);
      }
      solver_->setTimeGoal(rests || writes_ ? 0 : playback::BusyField::kGoal_ms);
      const bool is_other = solver_->update(snapshot, loaded_.terrain).any;
      is_new_ = is_new_ || is_other;
      column_step_ = solver_->columnStep();
      trouble_.clear();
    } catch (const Error& error) {
      column_step_ = 1;
      trouble_ = error.what();
      trouble_ = trouble_.substr(0, trouble_.find('\n'));
    }
    scenario_ = now.scenario;
    poses_ = now.poses;
    const std::lock_guard<std::mutex> lock(mutex_);
    computed_s_ = playback::steadyTime_s();
    ++told_.fields;
    told_.field_ms = (computed_s_ - begin_s) * 1000;
    if (now.arrival_s > arrival_s_) told_.latency_ms = (computed_s_ - now.arrival_s) * 1000;
    told_.column_step = column_step_;
    told_.trouble = trouble_;
    arrival_s_ = now.arrival_s;
    return true;
  }

  /// Writes the field if it has changed, or could not be written before.
  void write(const std::filesystem::path& folder) {
    if (!solver_ || !is_new_) return;
    std::vector<const volume::DenseVolume*> volumes;
    std::vector<std::shared_ptr<const volume::DenseVolume>> kept;
    for (const volume::Volume& volume : solver_->volumes()) {
      kept.push_back(volume.host());
      volumes.push_back(kept.back().get());
    }
    std::string failure;
    try {
      volume::writeVolumes(folder / playback::kLiveField, volumes);
      is_new_ = false;
    } catch (const Error& error) {
      failure = error.what();
    }
    const std::lock_guard<std::mutex> lock(mutex_);
    told_.unwritten = failure;
  }

  /// Of the fields so far; any thread may ask.
  LiveFieldStatus status() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return told_;
  }

 private:
  playback::LiveBattlefield& battlefield_;
  Backend backend_;
  const bool writes_;
  playback::LoadedScenario loaded_;
  std::unique_ptr<emfield::FieldSolver> solver_;
  std::shared_ptr<const scenario::Scenario> scenario_;
  playback::PlatformIndices indices_;
  playback::NamedPosesPtr poses_;
  bool is_new_ = false;
  int column_step_ = 1;
  double computed_s_ = 0, arrival_s_ = 0;
  std::string trouble_;
  mutable std::mutex mutex_;
  LiveFieldStatus told_;
};

/// Calls a function each second on a thread of its own, until it ends or the function throws.
class EachSecond {
 public:
  explicit EachSecond(std::function<void()> call)
      : thread_([this, call = std::move(call)] {
          auto next = std::chrono::steady_clock::now();
          while (!ends_) {
            next += std::chrono::seconds(1);
            while (!ends_ && std::chrono::steady_clock::now() < next) end_.waitUntil(next);
            try {
              if (!ends_) call();
            } catch (...) {
              failure_ = std::current_exception();
              ends_ = true;
            }
          }
        }) {}
  ~EachSecond() { finish(); }
  EachSecond(const EachSecond&) = delete;
  EachSecond& operator=(const EachSecond&) = delete;

  bool hasFailed() const { return ends_; }
  /// @throws what the function has thrown
  void end() {
    finish();
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  void finish() {
    ends_ = true;
    end_.set();
    if (thread_.joinable()) thread_.join();
  }

  std::atomic<bool> ends_{false};
  std::exception_ptr failure_;
  Event end_;
  std::thread thread_;  ///< the last: it uses the others
};

/// Two texts, of which either may be empty.
std::string joined(const std::string& first, const std::string& second) {
  return first + (first.empty() || second.empty() ? "" : "; ") + second;
}

Json jsonOf(const playback::StreamStatus& status, const LiveFieldStatus& field, double t_s) {
  const auto rounded = [](double value) { return std::round(value * 1000) / 1000; };
  Json line{{"t_s", rounded(t_s)},
            {status.kind == playback::StreamKind::dis ? "pdus" : playback::formatOf(status.kind).plural,
             status.records},
            {"per_s", rounded(status.records_per_s)},
            {"bytes", status.bytes},
            {"lost", status.lost},
            {"bad", status.bad},
            {"late", status.late},
            {"duplicates", status.duplicates},
            {"outside", status.outside},
            {"forgotten", status.forgotten},
            {"entities", status.entities},
            {"emitters", status.emitters},
            {"unmatched", status.unmatched},
            {"fields", field.fields},
            {"field_ms", rounded(field.field_ms)},
            {"latency_ms", rounded(field.latency_ms)},
            {"column_step", field.column_step}};
  line["silent"] = status.silent;
  line["untold"] = status.untold;
  line["age_s"] = status.age_s ? Json(rounded(*status.age_s)) : Json();
  line["trouble"] = joined(joined(status.trouble, field.trouble), field.unwritten);
  return line;
}

int live(const LiveArguments& arguments, const GlobalOptions& global) {
  playback::StreamRequest request = arguments.stream.parse();
  if (request.base.empty()) {
    throw Error(ErrorCode::usage,
                "--base is needed: a scenario with the region and the terrain, to which the objects are "
                "added; any of scenarios/ will do to begin with");
  }
  request.folder = arguments.folder;
  if (!arguments.folder.empty()) volume::requireVdb();  // before the first file
  Event changed;
  playback::LiveBattlefield battlefield(request, [&changed] { changed.set(); });
  LiveField field(battlefield, parseBackend(global.backend), !arguments.folder.empty());
  const double begin_s = playback::steadyTime_s();
  const auto tell = [&] {
    const playback::StreamStatus status = battlefield.status();
    const LiveFieldStatus of_field = field.status();
    const double t_s = playback::steadyTime_s() - begin_s;
    const std::string trouble = joined(of_field.trouble, of_field.unwritten);
    if (global.json) {
      print("{}\n", jsonOf(status, of_field, t_s).dump());
    } else if (!global.quiet) {
      print("{:6.0f} s  {}; {} emitters, {} unmatched; field {:.0f} ms, latency {:.0f} ms{}\n", t_s,
            status.text(), status.emitters, status.unmatched, of_field.field_ms, of_field.latency_ms,
            trouble.empty() ? "" : "; " + trouble);
    }
    finishResult();
  };
  EachSecond teller(tell);  // also while a field takes longer
  const auto compute = [&] {
    double written_s = begin_s;
    const auto write = [&] {
      if (!arguments.folder.empty()) field.write(arguments.folder);
      written_s = playback::steadyTime_s();
    };
    while (!stopFlag() && !teller.hasFailed() &&
           (arguments.duration_s == 0 || playback::steadyTime_s() - begin_s < arguments.duration_s)) {
      const bool is_computed = arguments.computes && field.update();
      if (playback::steadyTime_s() - written_s >= 1) write();
      if (!is_computed) changed.waitUntil(std::chrono::steady_clock::now() + std::chrono::milliseconds(20));
    }
    write();
  };
  try {
    compute();
  } catch (const Stopped&) {  // in the midst of a field
  }
  teller.end();
  tell();
  battlefield.finishRecording();
  if (const std::string failure = field.status().unwritten; !failure.empty())
    throw Error(ErrorCode::other, failure);
  return 0;
}

}  // namespace

void addLive(CLI::App& app, const GlobalOptions& global, Action& action) {
  CLI::App* command =
      app.add_subcommand("live", "Compute the field of a battlefield that another program streams");
  command->fallthrough();
  command->footer(R"(
Receives DIS by UDP, Tacview's real-time telemetry by TCP or Cursor on Target (TAK) by either, adds the objects to the base scenario as `import` does, moves them by
dead reckoning, and computes the field whenever something has changed. Prints a line each second; with --json an object. Listens
on this computer alone unless an address is given. An object with the name of a platform of the base moves that platform.
`emscape view --dis` shows the same in the window.

Examples:
  emscape live --dis 3000 --base scenarios/jamming.yaml
  emscape live --dis 239.1.2.3:3000 --interface 10.0.0.5 --base region.yaml --emitters mine.yaml --record exercise.pcap
  emscape live --cot 239.2.3.1:6969 --interface 10.0.0.5 --base region.yaml --record team.cot
  emscape live --cot tcp:10.0.0.9:8087 --base region.yaml
  emscape live --acmi 10.0.0.7:42674 --base region.yaml -o now --duration 3600 --json

Exit status: 0, also when Ctrl-C ends it, but 130 before it receives; 2 for wrong options; 3 for a faulty base or database; 1 if the address cannot be used, or the last
field or the recording could not be written.)");
  auto arguments = std::make_shared<LiveArguments>();
  arguments->stream.addTo(*command, "--base", "--emitters,--emitter-database");
  command->add_option("-o,--output", arguments->folder,
                      "Folder for live.yaml, the scenario, and live.vdb, its field, written each second that "
                      "changed it");
  command->add_option("--duration", arguments->duration_s, "Seconds after which it ends; 0: never")
      ->check(CLI::Range(0.0, 1e7));
  command->add_flag_callback(
      "--no-field", [arguments] { arguments->computes = false; }, "Receive and record only");
  command->callback(
      [arguments, &global, &action] { action = [arguments, &global] { return live(*arguments, global); }; });
}

}  // namespace emscape::app
