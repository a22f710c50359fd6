#include "emscape/emfield/link/link.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <thread>
#include <unordered_set>

#include "emfield/link/links_of_time.h"
#include "emscape/base/parallel.h"

namespace emscape::emfield {
namespace {

using scenario::EmitterKind;
using scenario::Scenario;

template <class Row, class Condition>
std::optional<double> firstTime_s(const std::vector<Row>& rows, const Condition& holds) {
  const auto found = std::find_if(rows.begin(), rows.end(), holds);
  return found == rows.end() ? std::nullopt : std::optional<double>(found->time_s);
}

bool isReceived(const LinkRow& row) {
  return row.is_received;
}

/// The links by emitter in the order of the selection, then by receiver.
std::vector<Link> linksOf(std::vector<ReceiverListener>& listeners, const std::vector<int>& emitters) {
  std::vector<Link> links;
  std::vector<std::size_t> taken(listeners.size());  // links of each listener, which are in the same order
  for (const int e : emitters) {
    for (std::size_t l = 0; l < listeners.size(); ++l) {
      std::vector<Link>& own = listeners[l].links;
      for (; taken[l] < own.size() && own[taken[l]].emitter == e; ++taken[l])
        links.push_back(std::move(own[taken[l]]));
    }
  }
  return links;
}

/// Reports the progress of tasks of several threads, from the calling thread, about a thousand times in all.
class TaskProgress {
 public:
  TaskProgress(const ProgressSink& sink, double tasks) : sink_(sink), tasks_(tasks) {}

  void addTask() {
    ++done_;
    if (std::this_thread::get_id() == caller_) report();
  }

  /// From the calling thread.
  void report() {
    const double part = static_cast<double>(done_) / tasks_;
    if (!sink_ || part < reported_ + 1e-3) return;
    reported_ = part;
    sink_("links", part);
  }

 private:
  const ProgressSink& sink_;
  double tasks_;
  std::thread::id caller_ = std::this_thread::get_id();
  std::atomic<long long> done_{0};
  double reported_ = 0;
};

}  // namespace

std::optional<double> Link::firstReceived_s() const {
  return firstTime_s(rows, isReceived);
}

std::optional<double> Link::lastReceived_s() const {
  const auto found = std::find_if(rows.rbegin(), rows.rend(), isReceived);
  return found == rows.rend() ? std::nullopt : std::optional<double>(found->time_s);
}

double Link::receivedShare() const {
  if (rows.empty()) return 0;
  return static_cast<double>(std::count_if(rows.begin(), rows.end(), isReceived)) /
         static_cast<double>(rows.size());
}

std::optional<double> Detection::firstDetection_s() const {
  return firstTime_s(rows, [](const DetectionRow& row) { return row.detection_probability >= 0.5; });
}

LinkReport computeLinks(const std::shared_ptr<const Scenario>& scenario, const scenario::Terrain* terrain,
                        const LinkOptions& options, const ProgressSink& progress) {
  if (progress) progress("links", 0);
  LinkReport report;
  std::vector<ReceiverListener> listeners;
  for (const int receiver : options.receivers) listeners.emplace_back(*scenario, receiver, options);
  std::vector<TargetWatcher> watchers;
  for (const int e : options.emitters) {
    for (const int target : options.targets) {
      const bool is_radar = scenario->emitters[e].kind == EmitterKind::radar;
      if (is_radar && scenario->emitters[e].platform != scenario->targets[target].platform)
        watchers.emplace_back(*scenario, e, target, options);
    }
  }
  TargetScenes scenes;
  const int tasks = static_cast<int>(listeners.size() + watchers.size());
  TaskProgress done(progress, static_cast<double>(tasks) * static_cast<double>(options.times_s.size()));
  for (std::size_t t = 0; t < options.times_s.size(); ++t) {
    const scenario::Snapshot snapshot = scenario::instantAt(scenario, terrain, options.times_s[t]);
    parallelFor(tasks, 1, [&](int begin, int end) {
      for (int i = begin; i < end; ++i) {
        const std::size_t task = static_cast<std::size_t>(i);
        if (task < listeners.size()) {
          listeners[task].add(snapshot, terrain, t + 1 == options.times_s.size());
        } else {
          watchers[task - listeners.size()].add(snapshot, terrain, scenes);
        }
        done.addTask();
      }
    });
    done.report();
  }
  report.links = linksOf(listeners, options.emitters);
  std::unordered_set<std::string> known;
  const auto addOnce = [&](const std::vector<std::string>& warnings) {
    for (const std::string& warning : warnings) {
      if (known.insert(warning).second) report.warnings.push_back(warning);
    }
  };
  if (const std::string outside = scenario::outsideClockText(options.times_s, scenario->clock);
      !outside.empty())
    addOnce({outside});
  SteepGrounds steep;
  const auto addSteep = [&](const SteepGrounds& more) {
    for (const auto& [emitter, marches] : more)
      steep[emitter].insert(steep[emitter].end(), marches.begin(), marches.end());
  };
  for (const ReceiverListener& listener : listeners) {
    addOnce(listener.warnings);
    addSteep(listener.steep);
  }
  for (TargetWatcher& watcher : watchers) {
    addOnce(watcher.warnings);
    addSteep(watcher.steep);
    report.detections.push_back(std::move(watcher.detection));
  }
  addOnce(steepGroundWarnings(steep));
  return report;
}

}  // namespace emscape::emfield
