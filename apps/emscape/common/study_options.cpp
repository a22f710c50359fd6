#include "apps/emscape/common/study_options.h"

#include <filesystem>

#include "base/files/whole_file.h"
#include "emscape/base/log.h"
#include "render/annotate/plot.h"
#include "study/report/map_folder.h"

namespace emscape::app {

void addStudyOutputs(CLI::App& command, std::vector<std::string>& files) {
  command
      .add_option("-o,--output", files,
                  "File to write, .png, .svg, .csv or .json; may be given several times")
      ->allow_extra_args(false)
      ->required()
      ->check([](const std::string& file) {
        const std::string extension = std::filesystem::path(file).extension().string();
        const bool is_known = render::isPlotFile(file) || extension == ".csv" || extension == ".json";
        return is_known ? "" : "'" + file + "': files are written as .png, .svg, .csv or .json";
      });
}

void writeStudyOutputs(const std::vector<std::string>& files, const StudyOutputs& outputs) {
  for (const std::string& file : files) {
    if (render::isPlotFile(file)) {
      outputs.plot(file);
    } else if (std::filesystem::path(file).extension() == ".csv") {
      outputs.csv(file);
    } else {
      writeWhole(file, [&](std::ostream& out) { out << outputs.json() << "\n"; });
    }
    logInfo("wrote " + file);
  }
}

void addThresholdOption(CLI::App& command, double& threshold) {
  command
      .add_option(
          "--threshold", threshold,
          "Level of the quantity, in its unit; default: 0.5 of detection_probability, 0 dB of a margin")
      ->default_str("");
}

void addMapOptions(CLI::App& command, report::MapOptions& options, ViewArguments& view) {
  options.prefix = "--";
  command.add_option(
      "--heights", options.heights,
      "Heights in metres above ground (agl:) and above mean sea level (msl:): agl:30,150;msl:500:3000:500");
  addListOption(command, "--products", options.products, "Products, with commas between them");
  command.add_option("--quantity", options.quantity, "Quantity to map; see docs/scenario-format.md");
  addThresholdOption(command, options.threshold);
  command.add_option("--times", options.times,
                     "BEGIN:END:STEP, BEGIN:END (in steps of the scenario), T or a list of them such as "
                     "100,110,130, in seconds since the scenario's epoch or in UTC");
  command.add_option("--cell", options.cell_m, "Side of a pixel (m); default: the scenario's voxels")
      ->default_str("");
  command.add_option(
      "--area", options.area,
      "LATITUDE,LONGITUDE,RADIUS_M or bbox:WEST,SOUTH,EAST,NORTH (deg); default: the box around the region");
  command.add_option(
      "--crs", options.crs,
      "Projection: utm (zone of the area's middle), local (azimuthal equidistant) or EPSG:NUMBER");
  std::vector<std::string> formats;
  for (const study::MapFormat& format : study::mapFormats()) formats.emplace_back(format.name);
  addListOption(command, "--format", options.formats, "Formats of maps, with commas between them")
      ->check(CLI::IsMember(formats));
  view.addSomeTo(command, {"drape", "places", "range_rings", "units", "field_unit"});
}

}  // namespace emscape::app
