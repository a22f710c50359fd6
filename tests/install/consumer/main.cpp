// The smallest program that computes a field with an installed Emscape.
#include <cstdio>

#include "emscape/emfield/field_solver.h"
#include "emscape/render/image.h"
#include "emscape/scenario/scenario_file.h"
#include "emscape/scenario/snapshot.h"

int main(int, char** arguments) {
  const auto scenario = emscape::scenario::loadScenario(arguments[1]);
  emscape::emfield::FieldSolver solver(scenario, nullptr, {});
  solver.update(emscape::scenario::snapshotAt(scenario, nullptr, 0));
  const auto& volume = solver.volumes().front();
  const emscape::render::ImageSize size{volume.grid().dims.x, volume.grid().dims.y};
  std::printf("%s %d\n", volume.info().quantity.c_str(), static_cast<int>(size.count()));
}
