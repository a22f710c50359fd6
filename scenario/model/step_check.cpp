#include "scenario/model/step_check.h"

#include <fmt/core.h>

#include <memory>
#include <optional>

#include "emscape/scenario/model/snapshot.h"

namespace emscape::scenario {

std::string StepFault::text() const {
  return error.message() + (steps > 1 ? fmt::format(" (at {} of {} steps)", faulty, steps) : "");
}

std::vector<StepFault> faultsOfSteps(const Scenario& scenario, const Terrain* terrain, int every,
                                     const std::function<void()>& before_each) {
  const std::vector<double> times_s = timesOf(scenario.clock);
  const auto alone = std::make_shared<Scenario>(scenario);  // with a single platform at a time
  alone->emitters.clear();
  alone->placed_receivers.clear();
  std::vector<StepFault> faults;
  for (const Platform& platform : scenario.platforms) {
    alone->platforms = {platform};
    std::optional<StepFault> found;
    int checked = 0;
    for (std::size_t i = 0; i < (platform.moves() ? times_s.size() : 1);
         i += static_cast<std::size_t>(every)) {
      if (before_each) before_each();
      ++checked;
      try {
        snapshotAt(alone, terrain, times_s[i]);
      } catch (const Error& error) {
        if (!found) found = StepFault{error, 0, 1, i == 0};
        ++found->faulty;
      }
    }
    if (!found) continue;
    found->steps = checked;
    faults.push_back(*found);
  }
  return faults;
}

}  // namespace emscape::scenario
