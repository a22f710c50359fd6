#include "study/sweep/variant_files.h"

#include <fmt/format.h>

#include <cctype>
#include <optional>
#include <set>
#include <vector>

#include "base/files/folder.h"
#include "base/files/unfinished_file.h"
#include "emscape/scenario/model/snapshot.h"
#include "emscape/volume/format/file.h"
#include "study/files/geotiff.h"
#include "study/files/map_metadata.h"
#include "study/maps/terrain_cache.h"

namespace emscape::study {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kPerFolder = 1000, kMaxName = 60;

/// A name as a part of a path on any file system.
std::string pathNameOf(const std::string& name) {
  std::string text;
  for (const char c : name.substr(0, kMaxName)) {
    const bool is_safe =
        (std::isalnum(static_cast<unsigned char>(c)) != 0 && static_cast<unsigned char>(c) < 128) ||
        c == '.' || c == '-';
    text += is_safe ? c : '_';
  }
  return text;
}

/// Quantities and thresholds of the measures.
std::set<std::pair<scenario::Quantity, double>> levelsOf(const StudySpec& study) {
  std::set<std::pair<scenario::Quantity, double>> levels;
  for (const StudyMeasure& measure : study.measures) levels.emplace(measure.quantity, measure.threshold);
  return levels;
}

}  // namespace

fs::path folderOfVariant(const StudySpec& study, std::size_t variant) {
  const std::size_t count = study.variants.count();
  const std::size_t digits = std::to_string(count - 1).size();
  fs::path folder = "variants";
  if (count > kPerFolder) folder /= fmt::format("{:0{}}", variant / kPerFolder * kPerFolder, digits);
  const std::string name = pathNameOf(study.variants.name(variant));
  return folder / fmt::format("{:0{}}{}{}", variant, digits, name.empty() ? "" : "_", name);
}

struct VariantFiles::State {
  const StudySpec& study;
  fs::path folder;
  KeptFiles kept;
  emfield::FieldOptions options;
  bool has_levels = false;  ///< several quantities or thresholds
  std::optional<emfield::FieldSolver> solver;
  TerrainCache terrain;
  std::set<std::size_t> begun;  ///< variants whose folder has no temporaries of ended processes

  fs::path folderFor(std::size_t variant) {
    fs::path own = makeFolderIn(folder, folderOfVariant(study, variant));
    if (begun.insert(variant).second) removeAbandonedFiles(own);
    return own;
  }
};

VariantFiles::VariantFiles(const StudySpec& study, fs::path folder, KeptFiles kept,
                           const emfield::FieldOptions& options)
    : state_(new State{study, std::move(folder), kept, options, levelsOf(study).size() > 1, {}, {}, {}}) {
  std::set<std::string> quantities;
  for (const auto& [quantity, threshold] : levelsOf(study)) quantities.insert(scenario::info(quantity).name);
  state_->options.quantities.assign(quantities.begin(), quantities.end());
  state_->options.allow_missing_terrain = true;
  state_->options.move_tolerance_m = 0;
}

VariantFiles::~VariantFiles() = default;

void VariantFiles::addMap(std::size_t variant, const scenario::Scenario& scenario, const MapGrid& grid,
                          const CoverageRequest& request, const CoverageMap& map) {
  State& state = *state_;
  if (state.kept != KeptFiles::maps) return;
  const std::string level =
      state.has_levels ? fmt::format("{}_{}_", scenario::info(request.quantity).name, request.threshold) : "";
  auto metadata = metadataOf(scenario, request.quantity, request.threshold, map);
  metadata.emplace_back("EMSCAPE_VARIANT", fmt::format("{}", variant));
  writeGeoTiff(state.folderFor(variant) / (level + fileNameOf(map) + ".tif"), grid, map, metadata);
}

void VariantFiles::addVolumes(std::size_t variant,
                              const std::shared_ptr<const scenario::Scenario>& scenario) {
  State& state = *state_;
  if (state.kept != KeptFiles::volumes) return;
  auto own = std::make_shared<scenario::Scenario>(*scenario);
  own->output.radar_look = scenario::RadarAim::target;
  if (own->output.combine != scenario::CombineMode::max) own->output.combine = scenario::CombineMode::sum;
  const scenario::TerrainPtr& terrain = state.terrain.of(scenario);
  const fs::path folder = state.folderFor(variant);
  for (const double time_s : state.study.times_s) {
    if (!state.solver) state.solver.emplace(own, terrain, state.options);
    state.solver->update(scenario::snapshotAt(own, terrain.get(), time_s), terrain);
    std::vector<std::shared_ptr<const volume::DenseVolume>> kept;
    std::vector<const volume::DenseVolume*> volumes;
    for (const volume::Volume& volume : state.solver->volumes()) {
      kept.push_back(volume.host());
      volumes.push_back(kept.back().get());
    }
    volume::writeVolumes((folder / fmt::format("field_t{}s.vdb", time_s)).string(), volumes);
  }
}

}  // namespace emscape::study
