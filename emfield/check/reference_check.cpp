#include "emscape/emfield/reference_check.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "emfield/check/datasets.h"
#include "emscape/base/error.h"

namespace emscape::emfield {
namespace fs = std::filesystem;

void FigureCheck::compare(double computed, double expected, int line) {
  double error = std::fabs(computed - expected);
  if (std::isnan(error)) error = std::numeric_limits<double>::infinity();
  if (error <= max_abs_error) return;
  max_abs_error = error;
  worst_line = line;
}

void FigureCheck::compareRelative(double computed, double expected, int line) {
  const double scale = expected == 0 ? 1 : std::fabs(expected);
  compare(computed / scale, expected / scale, line);
}

bool DatasetCheck::pass() const {
  return std::all_of(figures.begin(), figures.end(), [](const FigureCheck& figure) { return figure.pass(); });
}

const std::vector<ReferenceDataset>& referenceDatasets() {
  static const std::vector<ReferenceDataset> datasets = {
      {"itm_p2p", checkItmPointToPoint},
      {"itm_p2p_published", checkItmPublished},
      {"itm_area", checkItmArea},
      {"p528", checkP528},
      {"p526_delta_bullington", checkDeltaBullington},
      {"p676_13_specific", checkSpecificGasAttenuation},
      {"p676_13_slant", checkSlantGasAttenuation},
      {"p838_3", checkRain},
      {"radar/swerling_exact_derived.csv", checkSwerling},
      {"radar/roc_pd_reference.csv", checkDetectionProbability},
      {"radar/radar_equation_worked_examples.csv", checkRadarEquation},
      {"radar/sea_clutter_nathanson.csv", checkSeaClutter},
      {"radar/clutter_worked_examples.csv", checkClutterExamples},
      {"radar/knife_edge_J_nu_derived.csv", checkKnifeEdge},
      {"radar/two_ray_flat_pec_derived.csv", checkTwoRay},
      {"radar/freespace_conversions_derived.csv", checkFreeSpaceConversions},
      {"geoid", checkGeoid},
      {"p1812", checkP1812},
      {"p452", checkP452},
      {"pe", nullptr},
  };
  return datasets;
}

ReferenceFolder lookInto(const fs::path& folder) {
  if (!fs::is_directory(folder)) {
    throw Error(ErrorCode::bad_input, fmt::format("{}: no such folder", folder.string()));
  }
  ReferenceFolder found;
  std::set<std::string> known;
  std::set<std::string> shared;  // folders with several datasets
  for (const ReferenceDataset& dataset : referenceDatasets()) {
    known.insert(dataset.name);
    const fs::path parent = fs::path(dataset.name).parent_path();
    if (!parent.empty()) known.insert(parent.string());
    if (!parent.empty() && fs::is_directory(folder / parent)) shared.insert(parent.string());
    if (fs::exists(folder / dataset.name)) {
      found.present.push_back(&dataset);
    } else {
      found.absent.push_back(dataset.name);
    }
  }
  if (found.present.empty()) {
    throw Error(ErrorCode::bad_input,
                fmt::format("{}: holds no dataset that is known; expected folders such as {}",
                            folder.string(), referenceDatasets().front().name));
  }

  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    // files at the top, such as a README, are not datasets
    if (entry.is_directory() && known.count(name) == 0) found.unknown.push_back(name);
  }
  for (const std::string& parent : shared) {
    for (const fs::directory_entry& entry : fs::directory_iterator(folder / parent)) {
      const std::string name = parent + "/" + entry.path().filename().string();
      if (known.count(name) == 0) found.unknown.push_back(name);
    }
  }
  std::sort(found.unknown.begin(), found.unknown.end());
  return found;
}

}  // namespace emscape::emfield
