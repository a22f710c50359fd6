/// emscape terrain: what was understood of elevation files, as a picture and as text.
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>

#include "apps/common/console.h"
#include "apps/common/interrupt.h"
#include "apps/emscape/subcommands.h"
#include "base/files/own_file.h"
#include "emscape/base/log.h"
#include "emscape/scenario/file/scenario_file.h"
#include "report/maps/output_files.h"
#include "report/maps/terrain_report.h"
#include "study/picture/terrain_picture.h"

namespace emscape::app {
namespace {

constexpr int kMinWidth = 400, kMaxWidth = 8000;

struct TerrainCommand {
  std::vector<std::string> inputs;
  std::vector<scenario::Edit> edits;
  std::string picture;
  int width = 1200;
  bool draws_cover = false;
};

/// True for a single scenario.
bool isScenario(const std::vector<std::string>& inputs) {
  const std::string ending = std::filesystem::path(inputs.front()).extension();
  return inputs.size() == 1 && (ending == ".yaml" || ending == ".yml" || ending == ".json");
}

int terrain(const TerrainCommand& command, const GlobalOptions& global) {
  std::optional<EndAtInterrupts> at_once(std::in_place);
  std::vector<report::NamedFile> inputs;
  for (const std::string& input : command.inputs) inputs.push_back({"an input", input});
  report::checkOutputs({{"--output", command.picture}}, inputs, {});
  report::TerrainReport result;
  std::string title;
  if (isScenario(command.inputs)) {
    const auto scenario = scenario::loadScenario(command.inputs.front(), command.edits);
    result = report::terrainReport(*scenario);
    title = "Terrain of " + scenario->name;
  } else {
    if (!command.edits.empty())
      throw Error(ErrorCode::usage, "--set changes a scenario; the inputs are elevation files");
    scenario::TerrainSpec spec;
    spec.files = command.inputs;
    result = report::terrainReport(spec);
    title = result.files.size() == 1 ? std::filesystem::path(result.files.front().file).filename().string()
                                     : fmt::format("{} elevation files", result.files.size());
  }
  if (command.draws_cover && result.terrain->landCover() == nullptr)
    throw Error(ErrorCode::usage,
                "--land-cover draws the land cover of a scenario with 'terrain: {land_cover: ...}'");
  at_once.reset();
  if (!command.picture.empty()) {
    const auto content =
        command.draws_cover ? study::TerrainContent::land_cover : study::TerrainContent::sources;
    const render::Image8 picture =
        study::drawTerrain(result.files, *result.terrain, content, result.needed, title, command.width);
    requireOwn(command.picture);
    render::writePng(command.picture, picture);
    logInfo("wrote " + command.picture);
  }
  if (global.json) {
    printJson(report::toJson(result));
  } else {
    printResult(report::terrainText(result));
  }
  return 0;
}

}  // namespace

void addTerrain(CLI::App& app, const GlobalOptions& global, Action& action) {
  CLI::App* command =
      app.add_subcommand("terrain", "Describe and draw elevation files, or those of a scenario");
  command->fallthrough();
  command->footer(R"(
Of each file: format, posts, coordinate system, vertical datum and its origin, unit, range, voids, and what was assumed, with its
effect and how to state it. Of all: the ground that a scenario gets from them, above EGM96 mean sea level. With -o a picture: the
shaded ground, coloured by height, with voids and ground that no file covers; with --land-cover by the classes of the land cover.

Inputs are elevation files, folders and patterns of them, .zip and .gz (see docs/terrain.md), or one scenario: then the files
that reach its area are read, with the scenario's keys.

Examples:
  emscape terrain scenarios/jacksboro.yaml -o terrain.png
  emscape terrain scenarios/data/jacksboro.tif --json

Exit status: 0; 2 for a usage error; 3 for a file that cannot be read, with the reason and what to do.)");
  auto options = std::make_shared<TerrainCommand>();
  command->add_option("INPUT", options->inputs, "Elevation files, folders, patterns, archives; or a scenario")
      ->required();
  addSetOption(*command, options->edits);
  command->add_option("-o,--output", options->picture, "Picture to write (PNG)")
      ->check([](const std::string& file) {
        return std::filesystem::path(file).extension() == ".png"
                   ? ""
                   : "'" + file + "': pictures are written as .png";
      });
  command->add_option("--width", options->width, "Width of the picture in pixels")
      ->check(CLI::Range(kMinWidth, kMaxWidth));
  command->add_flag("--land-cover", options->draws_cover,
                    "Draw the classes of the scenario's land cover in place of the sources of the ground");
  command->callback(
      [options, &global, &action] { action = [options, &global] { return terrain(*options, global); }; });
}

}  // namespace emscape::app
