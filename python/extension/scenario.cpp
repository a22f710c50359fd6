/// Scenarios: reading, editing, contents.
#include "emfield/channels/categories.h"
#include "emscape/emfield/solver/field_solver.h"
#include "emscape/scenario/file/scenario_file.h"
#include "emscape/scenario/model/quantities.h"
#include "emscape/scenario/model/snapshot.h"
#include "python/extension/module.h"

namespace emscape::python {
namespace {

using scenario::Scenario;

using ProblemRow =
    std::tuple<std::string, int, int, std::string, std::string>;  // file, line, column, severity, message
using Parsed = std::pair<std::optional<ScenarioHandle>, std::vector<ProblemRow>>;

Parsed parsedOf(const scenario::ParseResult& result) {
  std::vector<ProblemRow> problems;
  for (const document::Problem& problem : result.problems) {
    const SourceLocation& location = problem.location;
    problems.emplace_back(location.file, location.line, location.column,
                          problem.severity == document::Severity::error ? "error" : "warning",
                          problem.message);
  }
  if (result.scenario == nullptr) return {std::nullopt, problems};
  return {ScenarioHandle{result.scenario}, problems};
}

template <class Item>
std::vector<std::string> namesOf(const std::vector<Item>& items) {
  std::vector<std::string> names;
  for (const Item& item : items) names.push_back(item.name);
  return names;
}

using Position =
    std::tuple<double, double, double>;  // latitude (deg), longitude (deg), height above sea level (m)

}  // namespace

void bindScenario(nb::module_& module) {
  nb::class_<ScenarioHandle> handle(module, "Scenario", "A scenario; does not change.");
  const auto text = [&handle](const char* name, std::string Scenario::*member) {
    handle.def_prop_ro(name, [member](const ScenarioHandle& of) { return (*of.scenario).*member; });
  };
  text("name", &Scenario::name);
  text("file", &Scenario::file);
  text("hash", &Scenario::hash);
  handle.def_prop_ro("epoch_utc", [](const ScenarioHandle& of) { return of.scenario->clock.epoch_utc; })
      .def_prop_ro("duration_s", [](const ScenarioHandle& of) { return of.scenario->clock.duration_s; })
      .def_prop_ro("step_s", [](const ScenarioHandle& of) { return of.scenario->clock.step_s; })
      .def_prop_ro("dims",
                   [](const ScenarioHandle& of) {
                     const Dims& dims = of.scenario->region.dims;
                     return std::tuple(dims.x, dims.y, dims.z);
                   })
      .def_prop_ro("size_m",
                   [](const ScenarioHandle& of) {
                     const Vec3d& size_m = of.scenario->region.size_m;
                     return std::tuple(size_m.x, size_m.y, size_m.z);
                   })
      .def_prop_ro("quantities", [](const ScenarioHandle& of) { return of.scenario->output.quantities; })
      .def_prop_ro("emitters", [](const ScenarioHandle& of) { return namesOf(of.scenario->emitters); })
      .def_prop_ro("platforms", [](const ScenarioHandle& of) { return namesOf(of.scenario->platforms); })
      .def_prop_ro("receivers",
                   [](const ScenarioHandle& of) { return namesOf(of.scenario->placed_receivers); })
      .def_prop_ro("targets", [](const ScenarioHandle& of) { return namesOf(of.scenario->targets); })
      .def_prop_ro("edits",
                   [](const ScenarioHandle& of) {
                     Edits edits;
                     for (const scenario::Edit& edit : of.scenario->edits())
                       edits.emplace_back(edit.path, edit.value);
                     return edits;
                   })
      .def_prop_ro("files", [](const ScenarioHandle& of) { return scenario::filesOf(*of.scenario); })
      .def("grid",
           [](const ScenarioHandle& of) { return describeGrid(emfield::gridOf(of.scenario->region)); })
      .def(
          "channels",
          [](const ScenarioHandle& of, const std::vector<std::string>& quantities) {
            std::vector<std::string> names;
            for (const emfield::Channel& channel : emfield::channelsOf(*of.scenario, quantities))
              names.push_back(channel.name);
            return names;
          },
          nb::arg("quantities"))
      .def(
          "category_names",
          [](const ScenarioHandle& of, const std::string& quantity) {
            return emfield::categoryNames(*of.scenario, scenario::quantityFromName(quantity));
          },
          nb::arg("quantity"), "Names of the indices 0, 1 ... of a categorical quantity.")
      .def(
          "edit",
          [](const ScenarioHandle& of, const Edits& edits) {
            const nb::gil_scoped_release unlocked;
            return parsedOf(scenario::editScenario(*of.scenario, editsOf(edits)));
          },
          nb::arg("edits"))
      .def(
          "times",
          [](const ScenarioHandle& of, const std::string& times) {
            return times.empty() ? scenario::timesOf(of.scenario->clock)
                                 : scenario::parseTimes(times, of.scenario->clock);
          },
          nb::arg("times"))
      .def(
          "utc_at",
          [](const ScenarioHandle& of, double t_s) { return scenario::utcAt(of.scenario->clock, t_s); },
          nb::arg("t_s"))
      .def(
          "save",
          [](const ScenarioHandle& of, const std::string& file) {
            scenario::saveScenario(*of.scenario, file);
          },
          nb::arg("file"))
      .def(
          "positions",
          [](const ScenarioHandle& of, double t_s) {
            const nb::gil_scoped_release unlocked;
            const scenario::TerrainPtr terrain = scenario::loadTerrain(*of.scenario);
            const scenario::Snapshot snapshot = scenario::snapshotAt(of.scenario, terrain.get(), t_s);
            std::vector<std::pair<std::string, Position>> rows;
            for (std::size_t p = 0; p < snapshot.platforms.size(); ++p) {
              const scenario::PlatformState& state = snapshot.platforms[p];
              if (!state.present) continue;
              rows.emplace_back(
                  of.scenario->platforms[p].name,
                  Position{state.position.latitude_deg, state.position.longitude_deg, state.height_msl_m});
            }
            return rows;
          },
          nb::arg("t_s"));

  module.def(
      "load",
      [](const std::string& file, const Edits& edits) {
        const nb::gil_scoped_release unlocked;
        return parsedOf(scenario::parseScenario(file, editsOf(edits)));
      },
      nb::arg("file"), nb::arg("edits"), "The scenario, None if it has errors; and its problems.");
  module.def(
      "load_text",
      [](const std::string& file, const std::string& content, const Edits& edits) {
        const nb::gil_scoped_release unlocked;
        return parsedOf(scenario::parseScenarioText(file, content, editsOf(edits)));
      },
      nb::arg("file"), nb::arg("text"), nb::arg("edits"),
      "As load() for a text; file need not exist: its folder is that of relative names.");
  module.def(
      "to_geodetic",
      [](double origin_latitude_deg, double origin_longitude_deg, double x_m, double y_m) {
        const GeoFrame frame({FrameKind::altitude, origin_latitude_deg, origin_longitude_deg, 0});
        const GeodeticPosition position = frame.toGeodetic({x_m, y_m, 0});
        return std::pair(position.latitude_deg, position.longitude_deg);
      },
      nb::arg("origin_latitude_deg"), nb::arg("origin_longitude_deg"), nb::arg("x_m"), nb::arg("y_m"),
      "Latitude and longitude (deg) of a position in the frame \"altitude\".");
  module.def(
      "path_step", [](const std::string& name) { return scenario::pathStep(name); }, nb::arg("name"));
  module.def("schema", &scenario::scenarioJsonSchema);
  module.def("quantity_table", [] {
    std::vector<std::tuple<std::string, std::string, std::string, bool>> rows;
    for (const scenario::QuantityInfo& row : scenario::quantityTable())
      rows.emplace_back(row.name, row.unit, row.description, row.categorical);
    return rows;
  });
}

}  // namespace emscape::python
