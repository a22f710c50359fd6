// A host program moves a platform itself and asks for the field at each of its steps.
//   moving SCENARIO PLATFORM
#include <emscape/emscape.h>

#include <cstdio>
#include <exception>

int main(int argc, char** argv) {
  using namespace emscape;
  if (argc != 3) {
    std::fprintf(stderr, "usage: moving SCENARIO PLATFORM\n");
    return 2;
  }
  try {
    const auto scenario = scenario::loadScenario(argv[1]);
    const auto terrain = scenario::loadTerrain(*scenario);
    emfield::FieldSolver solver(scenario, terrain);

    // The platform starts where the scenario has it and goes north, 400 m above the ground.
    scenario::PlatformPose pose;
    pose.platform = scenario::platformNamed(*scenario, argv[2]);
    const auto& platform = scenario->platforms[static_cast<std::size_t>(pose.platform)];
    const auto start = scenario::pointAt(platform, 0).position;
    for (int step = 0; step < 5; ++step) {
      pose.position = scenario::positionAgl(start.latitude_deg + 0.001 * step, start.longitude_deg, 400);
      pose.attitude.heading_deg = 0;
      const auto changed = solver.update(step, {pose});
      const volume::VolumeInfo info = solver.volumes().front().info();
      std::printf("step %d: %zu emitters moved, %s up to %.1f %s\n", step, changed.moved.size(),
                  info.quantity.c_str(), info.range_max, info.unit.c_str());
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "moving: %s\n", error.what());
    return 1;
  }
}
