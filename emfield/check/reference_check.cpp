#include "emfield/check/reference_check.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "base/files/inputs.h"
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
      {"radar/detection_losses_published.csv", checkDetectionLosses},
      {"radar/knife_edge_J_nu_derived.csv", checkKnifeEdge},
      {"radar/two_ray_flat_pec_derived.csv", checkTwoRay},
      {"radar/freespace_conversions_derived.csv", checkFreeSpaceConversions},
      {"geoid", checkGeoid},
      {"p1812", checkP1812},
      {"p452", checkP452},
      {"pe/two_ray_pec_h.csv", checkPeTwoRay},
      {"pe/gaussian_beam_linear_m.csv", checkPeBeam},
      {"pe/smooth_earth_modes.csv", checkPeSmoothEarth},
      {"pe/smooth_earth_decay.csv", checkPeDecay},
      {"pe/ntia_lfmf_10_30mhz.csv", checkPeLfmf},
      {"pe/knife_edge.csv", checkPeEdge},
      {"pe/sloped_plane_pec_h.csv", checkPeSlope},
      {"pe/duct_fields.csv", checkPeDucts},
      {"pe/duct_modes.csv", checkPeDuctModes},
      {"pe/lobe_cell_mean.csv", checkPeCells},
      {"pe/roughness.csv", checkRoughness},
      {"pe/ntia_lfmf_check.csv", nullptr},
      {"pe/narrow_angle_error.csv", checkPeNarrowAngle},
  };
  return datasets;
}

namespace {

/// The family of a dataset that shares its folder with others: "radar"; empty for other datasets.
std::string familyOf(const ReferenceDataset& dataset) {
  return fs::path(dataset.name).parent_path().string();
}

/// @param only  a family or a dataset; empty: all datasets
ReferenceFolder lookBelow(const fs::path& root, const std::string& only) {
  ReferenceFolder found;
  found.root = root;
  std::set<std::string> known;
  std::set<std::string> families;  // that exist
  for (const ReferenceDataset& dataset : referenceDatasets()) {
    const std::string family = familyOf(dataset);
    if (!only.empty() && family != only && dataset.name != only) continue;
    known.insert(dataset.name);
    if (!family.empty()) known.insert(family);
    if (!family.empty() && fs::is_directory(root / family)) families.insert(family);
    if (inputExists(root / dataset.name)) {
      found.present.push_back(&dataset);
    } else {
      found.absent.push_back(dataset.name);
    }
  }
  if (only.empty()) {
    for (const fs::directory_entry& entry : entriesOf(root)) {
      const std::string name = entry.path().filename().string();
      // top-level files, such as a README, are not datasets
      std::error_code ignored;  // as of a link to itself
      if (entry.is_directory(ignored) && known.count(name) == 0) found.unknown.push_back(name);
    }
  }
  for (const std::string& family : families) {
    for (const fs::directory_entry& entry : entriesOf(root / family)) {
      const std::string name = family + "/" + entry.path().filename().string();
      if (known.count(name) == 0 && entry.path().filename() != "README.md") found.unknown.push_back(name);
    }
  }
  std::sort(found.unknown.begin(), found.unknown.end());
  return found;
}

}  // namespace

ReferenceFolder findDatasets(const fs::path& folder) {
  if (!inputExists(folder) || !fs::is_directory(folder)) {
    throw Error(ErrorCode::bad_input, fmt::format("{}: no such folder", folder.string()));
  }
  ReferenceFolder found = lookBelow(folder, "");
  if (!found.present.empty()) return found;
  const fs::path whole = fs::canonical(folder);
  const std::string family = whole.filename().string();
  for (const ReferenceDataset& dataset : referenceDatasets()) {
    if (family.empty() || (familyOf(dataset) != family && dataset.name != family)) continue;
    found = lookBelow(whole.parent_path(), family);
    if (!found.present.empty()) return found;
  }
  throw Error(ErrorCode::bad_input, fmt::format("{}: has no known dataset; expected folders such as {}",
                                                folder.string(), referenceDatasets().front().name));
}

}  // namespace emscape::emfield
