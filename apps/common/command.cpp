#include "apps/common/command.h"

#include "emscape/base/error.h"

namespace emscape::app {

void addSetOption(CLI::App& command, std::vector<scenario::Edit>& edits, const std::string& name,
                  const std::string& what) {
  const auto take = [&edits, name](const std::vector<std::string>& texts) {
    try {
      for (const std::string& text : texts) edits.push_back(scenario::parseEdit(text));
    } catch (const Error& error) {
      throw CLI::ValidationError(name, error.message());
    }
  };
  command
      .add_option_function<std::vector<std::string>>(
          name, take,
          "PATH=VALUE: " + what +
              ", such as emitters.NAME.power_w=500; null removes a "
              "key; may be given several times")
      ->allow_extra_args(false);
}

void addCompareOption(CLI::App& command, std::string& compare, const std::string& what) {
  command.add_option("--compare", compare,
                     what +
                         " what differs from the scenario without the --set edits (original), or from "
                         "another scenario on the same grid (FILE)");
}

void addMeshOptions(CLI::App& command, std::string& mesh, playback::CellStyle& cells) {
  command.add_option(
      "--mesh", mesh,
      "terrain:LAYERS[,FIRST_M[,RATIO]]: a scenario's field on tetrahedra that follow the ground, "
      "as simulate computes it");
  const auto addChoice = [&command](const std::string& name, const std::string& help, const auto& take,
                                    const std::vector<std::string>& names) {
    command.add_option_function<std::string>(name, take, help)->check(CLI::IsMember(names));
  };
  addChoice(
      "--cells",
      "Tetrahedra are marched, or projected; auto: marched, except for incomplete pictures if OpenGL has "
      "a GPU and CUDA does not",
      [&cells](const std::string& name) { cells.method = playback::parseCellMethod(name); },
      {"auto", "march", "project"});
  addChoice(
      "--cell-rasterizer",
      "Projects the cells: OpenGL, or tiles of pixels, computed by the backend; default: auto, OpenGL on a "
      "GPU without CUDA, else tiles",
      [&cells](const std::string& name) { cells.projection.rasterizer = render::parseRasterizer(name); },
      {"auto", "opengl", "tiles"});
  addChoice("--cell-order", "Order of projected cells; default: visibility",
            [&cells](const std::string& name) { cells.projection.sorting = render::parseCellSorting(name); },
            {"centroids", "visibility"});
  addChoice(
      "--cell-perspective",
      "How projection finds where a ray leaves a cell: exact, or as published; default: exact",
      [&cells](const std::string& name) { cells.projection.projection = render::parseCellProjection(name); },
      {"published", "exact"});
}

}  // namespace emscape::app
