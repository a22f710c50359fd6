/// emscape live: computes the field of a battlefield that another program streams.
#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>

#include "apps/common/console.h"
#include "apps/common/interrupt.h"
#include "apps/common/stream_options.h"
#include "apps/emscape/subcommands.h"
#include "base/event.h"
#include "emscape/base/error.h"
#include "emscape/base/work.h"
#include "emscape/emfield/solver/field_solver.h"
#include "emscape/playback/frames/inputs.h"
#include "emscape/scenario/file/scenario_file.h"
#include "emscape/volume/format/file.h"
#include "playback/stream/steady_time.h"

namespace emscape::app {
namespace {

struct LiveArguments {
  StreamOptions stream;
  std::string folder;
  double duration_s = 0;
  bool computes = true;
};

/// Computes the field whenever the battlefield has changed.
class LiveField {
 public:
  explicit LiveField(playback::LiveBattlefield& battlefield) : battlefield_(battlefield) {}

  /// @return true if a field was computed
  bool update() {
    const playback::BattlefieldNow now = battlefield_.now();
    if (now.scenario == scenario_ && now.poses == poses_) return false;
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
        options.allow_missing_terrain = true;
        options.move_tolerance_m = 0;
        solver_ = std::make_unique<emfield::FieldSolver>(loaded_.scenario, loaded_.terrain, options);
      }
      const bool is_other = solver_->update(snapshot, loaded_.terrain).any;
      is_new_ = is_new_ || is_other;
      trouble_.clear();
    } catch (const Error& error) {
      trouble_ = error.what();
      trouble_ = trouble_.substr(0, trouble_.find('\n'));
    }
    scenario_ = now.scenario;
    poses_ = now.poses;
    ++fields_;
    field_ms_ = (playback::steadyTime_s() - begin_s) * 1000;
    if (now.arrival_s > arrival_s_) latency_ms_ = (playback::steadyTime_s() - now.arrival_s) * 1000;
    arrival_s_ = now.arrival_s;
    return true;
  }

  /// Writes the field if it has changed.
  void write(const std::filesystem::path& folder) {
    if (!solver_ || !std::exchange(is_new_, false)) return;
    std::vector<const volume::DenseVolume*> volumes;
    std::vector<std::shared_ptr<const volume::DenseVolume>> kept;
    for (const volume::Volume& volume : solver_->volumes()) {
      kept.push_back(volume.host());
      volumes.push_back(kept.back().get());
    }
    volume::writeVolumes(folder / "live.vdb", volumes);
  }

  long long fields() const { return fields_; }
  double field_ms() const { return field_ms_; }
  double latency_ms() const { return latency_ms_; }
  const std::string& trouble() const { return trouble_; }

 private:
  playback::LiveBattlefield& battlefield_;
  playback::LoadedScenario loaded_;
  std::unique_ptr<emfield::FieldSolver> solver_;
  std::shared_ptr<const scenario::Scenario> scenario_;
  playback::PlatformIndices indices_;
  playback::NamedPosesPtr poses_;
  bool is_new_ = false;
  long long fields_ = 0;
  double field_ms_ = 0, latency_ms_ = 0, arrival_s_ = 0;
  std::string trouble_;
};

Json jsonOf(const playback::StreamStatus& status, const LiveField& field, double t_s) {
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
            {"fields", field.fields()},
            {"field_ms", rounded(field.field_ms())},
            {"latency_ms", rounded(field.latency_ms())}};
  line["silent"] = status.silent;
  line["untold"] = status.untold;
  line["age_s"] = status.age_s ? Json(rounded(*status.age_s)) : Json();
  line["trouble"] =
      status.trouble + (status.trouble.empty() || field.trouble().empty() ? "" : "; ") + field.trouble();
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
  Event changed;
  playback::LiveBattlefield battlefield(request, [&changed] { changed.set(); });
  LiveField field(battlefield);
  const double begin_s = playback::steadyTime_s();
  double told_s = begin_s;
  const auto tell = [&] {
    const playback::StreamStatus status = battlefield.status();
    const double t_s = playback::steadyTime_s() - begin_s;
    if (global.json) {
      print("{}\n", jsonOf(status, field, t_s).dump());
    } else if (!global.quiet) {
      print("{:6.0f} s  {}; {} emitters, {} unmatched; field {:.0f} ms, latency {:.0f} ms{}\n", t_s,
            status.text(), status.emitters, status.unmatched, field.field_ms(), field.latency_ms(),
            field.trouble().empty() ? "" : "; " + field.trouble());
    }
    finishResult();
    if (!arguments.folder.empty()) field.write(arguments.folder);
    told_s = playback::steadyTime_s();
  };
  try {
    while (!stopFlag() &&
           (arguments.duration_s == 0 || playback::steadyTime_s() - begin_s < arguments.duration_s)) {
      const bool is_computed = arguments.computes && field.update();
      if (playback::steadyTime_s() - told_s >= 1) tell();
      if (!is_computed) changed.waitUntil(std::chrono::steady_clock::now() + std::chrono::milliseconds(20));
    }
    tell();
  } catch (const Stopped&) {  // in the midst of a field
    tell();
  }
  battlefield.finishRecording();
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

Exit status: 0, also when Ctrl-C ends it; 2 for wrong options; 3 for a faulty base or database; 1 if the address cannot be used.)");
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
