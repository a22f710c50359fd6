#include "apps/emscape/common/study_options.h"

#include <filesystem>

#include "base/files/whole_file.h"
#include "emscape/base/log.h"
#include "emscape/study/maps/coverage.h"
#include "render/annotate/plot.h"

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

double thresholdOf(double threshold, scenario::Quantity quantity) {
  const scenario::QuantityInfo& info = scenario::info(quantity);
  if (std::isnan(threshold)) {
    if (const std::optional<double> usual = study::defaultThreshold(quantity)) return *usual;
    const std::string unit = info.unit;
    throw Error(ErrorCode::usage,
                fmt::format("--threshold: quantity '{}' has no default threshold; give one{}", info.name,
                            unit.empty() ? "" : " in " + unit));
  }
  study::requireThreshold(quantity, threshold);
  return threshold;
}

}  // namespace emscape::app
