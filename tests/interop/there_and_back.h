/// A scenario, its recording, and the scenario of that.
#pragma once

#include <memory>
#include <string>

#include "emscape/scenario/file/scenario_file.h"
#include "interop/export_scenario.h"
#include "interop/import_scenario.h"
#include "recording/read_recording.h"
#include "tests/support/temporary_folder.h"

namespace emscape::interop::test {

using ScenarioPtr = std::shared_ptr<const scenario::Scenario>;

/// A recording as a scenario, in a folder of its own.
struct Imported {
  emscape::test::TemporaryFolder folder;
  ImportResult result;
  ScenarioPtr scenario;

  Imported() = default;
  explicit Imported(const Recording& recording, const ImportOptions& options = {}) {
    import(recording, options);
  }
  void import(const Recording& recording, ImportOptions options = {}) {
    options.scenario = folder / "out.yaml";
    options.replace = true;
    result = importRecording(recording, options);
    scenario = scenario::loadScenario(options.scenario);
  }
};

/// A scenario that is exported and imported again with the database that export writes.
struct ThereAndBack {
  emscape::test::TemporaryFolder folder;
  ExportResult exported;
  Imported back;

  ThereAndBack(const ScenarioPtr& before, const scenario::Terrain* terrain, const std::string& ending)
      : exported(exportScenario(before, terrain, folder / ("a" + ending))) {
    ImportOptions options;
    options.emitters = exported.emitters;
    back.import(readRecording(exported.file), options);
  }
};

}  // namespace emscape::interop::test
