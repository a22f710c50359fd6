#include "emscape/emfield/link.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "emfield/link/links_of_time.h"
#include "emscape/base/error.h"
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

void addOnce(std::vector<std::string>& all, const std::vector<std::string>& more) {
  for (const std::string& warning : more) {
    if (std::find(all.begin(), all.end(), warning) == all.end()) all.push_back(warning);
  }
}

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
  const int tasks = static_cast<int>(listeners.size() + watchers.size());
  for (std::size_t t = 0; t < options.times_s.size(); ++t) {
    const scenario::Snapshot snapshot = scenario::instantAt(scenario, terrain, options.times_s[t]);
    parallelFor(tasks, 1, [&](int begin, int end) {
      for (int i = begin; i < end; ++i) {
        const std::size_t task = static_cast<std::size_t>(i);
        if (task < listeners.size()) {
          listeners[task].add(snapshot, terrain);
        } else {
          watchers[task - listeners.size()].add(snapshot, terrain);
        }
      }
    });
    if (progress) progress("links", static_cast<double>(t + 1) / static_cast<double>(options.times_s.size()));
  }
  for (const int e : options.emitters) {
    for (ReceiverListener& listener : listeners) {
      for (Link& link : listener.links) {
        if (link.emitter == e) report.links.push_back(std::move(link));
      }
    }
  }
  for (const ReceiverListener& listener : listeners) addOnce(report.warnings, listener.warnings);
  for (TargetWatcher& watcher : watchers) {
    addOnce(report.warnings, watcher.warnings);
    report.detections.push_back(std::move(watcher.detection));
  }
  return report;
}

}  // namespace emscape::emfield
