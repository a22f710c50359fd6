// Computes a scenario's field at one time, writes it, and computes it again after an edit.
//   field SCENARIO TIME_S VOLUME.vdb
#include <emscape/emscape.h>

#include <cstdio>
#include <cstdlib>
#include <exception>

int main(int argc, char** argv) {
  using namespace emscape;
  if (argc != 4) {
    std::fprintf(stderr, "usage: field SCENARIO TIME_S VOLUME.vdb\n");
    return 2;
  }
  try {
    const double time_s = std::atof(argv[2]);
    const auto scenario = scenario::loadScenario(argv[1]);
    const auto terrain = scenario::loadTerrain(*scenario);  // null where the scenario names none
    emfield::FieldSolver solver(scenario, terrain);
    solver.update(scenario::snapshotAt(scenario, terrain.get(), time_s));
    const volume::Volume volume = solver.volumes().front();
    volume::writeVolumes(argv[3], {volume.host().get()});
    std::printf("%s: %.1f..%.1f %s\n", volume.info().quantity.c_str(), volume.info().range_min,
                volume.info().range_max, volume.info().unit.c_str());

    // What if the first emitter had half the power? Only what depends on it is computed again.
    auto edited = *scenario;
    const auto& emitter = scenario->emitters.front();
    edited.set("emitters." + emitter.name + ".power_w", std::to_string(emitter.power_w / 2));
    const auto half = std::make_shared<const scenario::Scenario>(edited);
    solver.update(scenario::snapshotAt(half, terrain.get(), time_s));
    std::printf("at half the power: up to %.1f %s\n", solver.volumes().front().info().range_max,
                volume.info().unit.c_str());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "field: %s\n", error.what());
    return 1;
  }
}
