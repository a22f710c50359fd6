#include "emscape/playback/frames/frame_source.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "emscape/base/error.h"
#include "emscape/base/work.h"
#include "emscape/emfield/columns/terrain_mesh.h"
#include "emscape/playback/frames/scene.h"
#include "emscape/scenario/file/scenario_file.h"
#include "emscape/volume/format/file.h"
#include "playback/frames/difference_source.h"
#include "playback/frames/platform_tracks.h"
#include "playback/frames/presence.h"
#include "playback/frames/range_search.h"
#include "playback/frames/volume_input.h"
#include "volume/difference.h"
#include "volume/mesh/mesh_file.h"

namespace emscape::playback {
namespace {

std::vector<double> timesOf(const FrameSelection& selection, const scenario::Scenario& scenario) {
  const scenario::Clock& clock = scenario.clock;
  if (!selection.times.empty()) return scenario::parseTimes(selection.times, clock);
  std::vector<double> times_s = scenario::timesOf(clock);
  if (selection.first_only) return {firstPresentTime_s(scenario, times_s)};
  return times_s;
}

/// The one quantity that is needed: "snr_db" of the channel "snr_db:search radar".
std::vector<std::string> quantitiesOf(const std::string& quantity, const scenario::Scenario& scenario) {
  return {quantity.empty() ? scenario.output.quantities.front() : quantity.substr(0, quantity.find(':'))};
}

emfield::FieldOptions fieldOptionsOf(const FrameSelection& selection, const ComputeTarget& target,
                                     const scenario::Scenario& scenario) {
  emfield::FieldOptions options = target.fieldOptions();
  options.quantities = quantitiesOf(selection.quantity, scenario);
  options.allow_missing_terrain = selection.allow_missing_terrain;
  if (selection.independent) options.move_tolerance_m = 0;
  return options;
}

std::size_t channelOf(const std::vector<emfield::Channel>& channels, const std::string& name) {
  if (name.find(':') == std::string::npos) return 0;
  std::string names;
  for (std::size_t c = 0; c < channels.size(); ++c) {
    if (channels[c].name == name) return c;
    names += (c == 0 ? "" : ", ") + channels[c].name;
  }
  throw Error(ErrorCode::usage,
              fmt::format("quantity '{}': there is no such channel; there are {}", name, names));
}

/// True if a mesh over one region fits the other.
bool sameGround(const LoadedScenario& a, const LoadedScenario& b) {
  return a.terrain == b.terrain && emfield::gridOf(a.scenario->region) == emfield::gridOf(b.scenario->region);
}

/// The mesh of a computed field.
struct ComputedMesh {
  std::shared_ptr<const emfield::TerrainMesh> mesh;  ///< null: a grid
  std::shared_ptr<const volume::MeshFaces> faces;

  ComputedMesh(const std::string& text, const LoadedScenario& input) {
    if (text.empty()) return;
    mesh = std::make_shared<const emfield::TerrainMesh>(*input.scenario, input.terrain.get(),
                                                        emfield::parseTerrainMesh(text));
    faces = std::make_shared<const volume::MeshFaces>(volume::facesOf(*mesh->mesh(), {input.scenario->file}));
  }

  std::shared_ptr<const emfield::Surface> surface() const { return mesh ? mesh->surface() : nullptr; }
  ShownField shown(const volume::Volume& volume) const {
    if (!mesh) return {volume, nullptr};
    return {{}, makeCellField(mesh->field(*volume.host()), faces)};
  }
};

/// A scenario's frames, computed on request.
class ComputedFrames : public FrameSource {
 public:
  ComputedFrames(const LoadedScenario& input, const FrameSelection& selection, const ComputeTarget& target,
                 const StopFlag* stop)
      : selection_(selection), mesh_(selection.mesh, input), unposed_(input) {
    emfield::FieldOptions options = fieldOptionsOf(selection, target, *input.scenario);
    options.surface = mesh_.surface();
    series_ = std::make_unique<FieldSeries>(input, timesOf(selection, *input.scenario), options, stop);
    channelOf(series_->channels(), selection.quantity);  // throws if there is none
  }

  int count() const override { return series_->count(); }
  double time_s(int index) const override { return series_->time_s(index); }
  bool isContinuous() const override { return true; }
  std::string name() const override { return series_->input().scenario->name; }
  const LoadedScenario* scene() const override { return &series_->input(); }
  scenario::Clock clock() const override { return series_->input().scenario->clock; }
  std::vector<std::string> warnings() const override { return series_->warnings(); }

  std::optional<Frame> withoutField(double time_s) override {
    if (mesh_.mesh) return std::nullopt;
    const scenario::Scenario& scenario = *series_->input().scenario;
    const std::vector<emfield::Channel> channels =
        emfield::channelsOf(scenario, quantitiesOf(selection_.quantity, scenario));
    const emfield::Channel& channel = channels[channelOf(channels, selection_.quantity)];
    volume::DenseVolume none;
    none.grid = emfield::gridOf(scenario.region);
    none.info.quantity = channel.name;
    none.info.unit = scenario::info(channel.quantity).unit;
    none.info.time_s = time_s;
    none.info.time_utc = scenario::utcAt(scenario.clock, time_s);
    none.values.resize(static_cast<std::size_t>(none.grid.dims.count()));
    std::fill(none.values.begin(), none.values.end(), none.info.floor);
    none.first_valid_k.assign(static_cast<std::size_t>(none.grid.dims.x) * none.grid.dims.y,
                              static_cast<std::uint16_t>(none.grid.dims.z));
    Frame frame{{volume::Volume(std::move(none)), nullptr}, {}, {}, true, false, {}};
    setObjects(frame, time_s);
    return frame;
  }

  void setScenario(std::shared_ptr<const scenario::Scenario> scenario) override {
    std::vector<double> times_s = timesOf(selection_, *scenario);
    LoadedScenario edited = withScenario(unposed_, std::move(scenario));
    const bool has_same_ground = sameGround(unposed_, edited);
    if (mesh_.mesh && !has_same_ground) {
      const ComputedMesh mesh(selection_.mesh, edited);
      emfield::FieldOptions options = series_->options();
      options.surface = mesh.surface();
      series_ = std::make_unique<FieldSeries>(edited, std::move(times_s), options, series_->stopFlag());
      mesh_ = mesh;
    } else {
      series_->setScenario(edited, std::move(times_s));
    }
    unposed_ = std::move(edited);
  }
  void setPoses(PosesPtr poses) override {
    LoadedScenario moved = unposed_;
    if (poses) moved.scenario = scenario::withPoses(*unposed_.scenario, poses->platforms);
    series_->setScenario(std::move(moved), series_->times_s());
    live_ = poses ? poses->told : "";
  }
  void setQuantity(const std::string& quantity) override {
    const scenario::Scenario& scenario = *series_->input().scenario;
    const std::vector<std::string> quantities = quantitiesOf(quantity, scenario);
    channelOf(emfield::channelsOf(scenario, quantities), quantity);  // throws if there is none
    series_->setQuantities(quantities);
    selection_.quantity = quantity;
  }
  void setTimeGoal(double goal_ms) override { series_->setTimeGoal(goal_ms); }

 protected:
  Frame makeFrame(int index) override { return makeFrameAt(series_->time_s(index)); }
  Frame makeFrameAt(double time_s) override {
    const std::vector<volume::Volume> volumes = series_->computeAt(time_s);
    const std::size_t channel = channelOf(series_->channels(), selection_.quantity);
    Frame frame{mesh_.shown(volumes[channel]), {}, {}, series_->changed(), true, {}};
    frame.column_step = series_->columnStep();
    setObjects(frame, time_s);
    return frame;
  }

 private:
  void setObjects(Frame& frame, double time_s) {
    const LoadedScenario& input = series_->input();
    frame.markers = markersOf(series_->snapshotAt(time_s), input.terrain, frame.grid());
    frame.tracks = tracks_.at(time_s, input, frame.grid());
    frame.live = live_;
  }

  FrameSelection selection_;
  ComputedMesh mesh_;
  LoadedScenario unposed_;  ///< without the poses of setPoses()
  std::string live_;        ///< of the poses
  std::unique_ptr<FieldSeries> series_;
  PlatformTracks tracks_;
};

bool sameMesh(const volume::TetrahedralMesh& a, const volume::TetrahedralMesh& b) {
  return a.points_m == b.points_m && a.cells == b.cells;
}

/// Volumes or fields on tetrahedra from files.
class StoredFrames : public FrameSource {
 public:
  StoredFrames(const FrameSelection& selection, const StopFlag* stop)
      : stop_(stop),
        quantity_(selection.quantity),
        selection_(selection),
        holds_meshes_(holdsMeshes(selection.input)),
        files_(filesOf(quantity_)) {
    if (!selection.scenario.empty()) {
      scene_ = loadScenarioWithTerrain(selection.scenario, selection.edits);
    } else if (!selection.edits.empty()) {
      throw Error(ErrorCode::usage, "edits change a scenario; volumes have none unless --scenario names one");
    }
    namespace fs = std::filesystem;
    const fs::path input = selection.input;
    if (const std::string others = otherFormatsText(input); !others.empty()) warnings_.push_back(others);
    name_ = scene_ ? scene_->scenario->name
                   : (input.has_filename() ? input : input.parent_path()).stem().string();
  }

  int count() const override { return static_cast<int>(files_.size()); }
  double time_s(int index) const override { return files_[static_cast<std::size_t>(index)].time_s; }
  std::string name() const override { return name_; }
  const LoadedScenario* scene() const override { return scene_ ? &*scene_ : nullptr; }
  scenario::Clock clock() const override { return clockOf(files_); }
  std::vector<std::string> warnings() const override { return warnings_; }
  std::vector<std::string> quantities() const override { return quantities_; }

  void setScenario(std::shared_ptr<const scenario::Scenario> scenario) override {
    if (!scene_) return FrameSource::setScenario(std::move(scenario));
    scene_ = withScenario(*scene_, std::move(scenario));
    name_ = scene_->scenario->name;
  }
  void setQuantity(const std::string& quantity) override {
    std::string chosen = quantity;
    files_ = filesOf(chosen);
    quantity_ = chosen;
  }

 protected:
  Frame makeFrame(int index) override {
    throwIfStopped(stop_);
    const VolumeFile& file = files_[static_cast<std::size_t>(index)];
    Frame frame{holds_meshes_ ? readCells(file) : readVoxels(file), {}, {}, true, true, {}};
    if (scene_ && frame.grid().georeferenced) {
      const double time_s = frame.info().time_s;
      const scenario::Snapshot snapshot =
          scenario::snapshotAt(scene_->scenario, scene_->terrain.get(), time_s);
      frame.markers = markersOf(snapshot, scene_->terrain, frame.grid());
      frame.tracks = tracks_.at(time_s, *scene_, frame.grid());
    }
    return frame;
  }

 private:
  /// The files to be shown. @param quantity  as for volumeFilesOf()
  std::vector<VolumeFile> filesOf(std::string& quantity) {
    const auto list = holds_meshes_ ? meshFilesOf : volumeFilesOf;
    return chosenFiles(list(selection_.input, quantity, &quantities_), selection_.times,
                       selection_.first_only);
  }

  ShownField readVoxels(const VolumeFile& file) const {
    volume::DenseVolume read = volume::readVolume(file.file, quantity_);
    read.info.time_s = file.time_s;
    read.info.has_time = file.has_time;
    return {volume::Volume(std::move(read)), nullptr};
  }
  ShownField readCells(const VolumeFile& file) {
    volume::MeshFile read = volume::readMesh(file.file, quantity_);
    volume::MeshField& field = read.fields.front();
    field.info.time_s = file.time_s;
    field.info.has_time = file.has_time;
    if (mesh_ && sameMesh(*mesh_, *read.mesh)) {
      field.mesh = mesh_;
    } else {
      mesh_ = read.mesh;
      faces_ = read.faces;
    }
    return {{}, makeCellField(std::move(field), faces_)};
  }

  const StopFlag* const stop_;
  std::string quantity_;
  const FrameSelection selection_;
  const bool holds_meshes_;
  std::vector<std::string> quantities_;
  std::vector<VolumeFile> files_;
  std::optional<LoadedScenario> scene_;
  std::string name_;
  std::vector<std::string> warnings_;
  PlatformTracks tracks_;
  std::shared_ptr<const volume::TetrahedralMesh> mesh_;  ///< of the last file
  std::shared_ptr<const volume::MeshFaces> faces_;
};

}  // namespace

double FrameSource::firstTime_s() const {
  const LoadedScenario* const loaded = scene();
  if (loaded == nullptr) return time_s(0);
  std::vector<double> times_s;
  for (int index = 0; index < count(); ++index) times_s.push_back(time_s(index));
  return firstPresentTime_s(*loaded->scenario, times_s);
}

// NOLINTNEXTLINE(performance-unnecessary-value-param): implementations keep it
void FrameSource::setScenario(std::shared_ptr<const scenario::Scenario> /*scenario*/) {
  throw Error(ErrorCode::usage, name() + ": volumes without a scenario cannot be edited");
}

// NOLINTNEXTLINE(performance-unnecessary-value-param): implementations keep it
void FrameSource::setPoses(PosesPtr poses) {
  if (poses) throw Error(ErrorCode::usage, name() + ": the fields of files do not move with platforms");
}

void FrameSource::setComparison(Comparison comparison) {
  if (comparison != Comparison::none)
    throw Error(ErrorCode::usage, name() + ": there is nothing to compare with");
}

void FrameSource::setQuantity(const std::string& quantity) {
  throw Error(ErrorCode::usage, fmt::format("quantity '{}': {} has only one quantity", quantity, name()));
}

const volume::Volume& comparableVolume(const Frame& frame) {
  const volume::VolumeInfo& info = frame.info();
  if (frame.cells) {
    throw Error(ErrorCode::usage,
                info.quantity + ": fields on tetrahedra are not compared; their volumes are");
  }
  volume::requireDifference(info.quantity, info.categorical);
  return frame.volume;
}

namespace {

LoadedScenario scenarioOf(const FrameSelection& selection) {
  if (!selection.opened) return loadScenarioWithTerrain(selection.input, selection.edits);
  LoadedScenario loaded;
  loaded.scenario = scenario::withEdits(*selection.opened, selection.edits);
  loaded.terrain = scenario::loadTerrain(*loaded.scenario);
  return loaded;
}

std::unique_ptr<FrameSource> openField(const FrameSelection& selection, const ComputeTarget& target,
                                       const StopFlag* stop) {
  const InputKind kind = inputKindOf(selection.input);
  if (!selection.mesh.empty() && kind != InputKind::scenario) {
    throw Error(ErrorCode::usage,
                selection.input + " is not a scenario: --mesh applies to a field to be computed");
  }
  if (!selection.scenario.empty() && kind == InputKind::scenario) {
    throw Error(ErrorCode::usage,
                selection.input + " is a scenario: --scenario has an effect on volumes only");
  }
  switch (kind) {
    case InputKind::scenario:
      return std::make_unique<ComputedFrames>(scenarioOf(selection), selection, target, stop);
    case InputKind::volume:
    case InputKind::mesh:
      return std::make_unique<StoredFrames>(selection, stop);
    case InputKind::recording:
      throw Error(ErrorCode::usage,
                  selection.input + " is a recording: `emscape import` makes a scenario of it");
    default:
      throw Error(ErrorCode::usage, selection.input + " is neither a scenario nor a volume");
  }
}

/// The reference of a selection's comparison.
FrameSelection referenceOf(const FrameSelection& selection) {
  FrameSelection reference = selection;
  reference.scenario.clear();
  reference.edits.clear();
  if (selection.compare.empty() || selection.compare == kOriginal) {
    if (inputKindOf(selection.input) != InputKind::scenario) {
      throw Error(ErrorCode::usage, selection.input +
                                        ": volumes have no original to compare with; name the other volumes "
                                        "in its place");
    }
    return reference;
  }
  reference.input = selection.compare;
  reference.opened = nullptr;
  return reference;
}

std::unique_ptr<FrameSource> openComparison(const FrameSelection& selection, const ComputeTarget& target,
                                            const StopFlag* stop) {
  FrameSelection field = selection;
  field.independent = true;
  const bool compares = !selection.compare.empty();
  if (compares) referenceOf(field);  // throws its faults here
  std::unique_ptr<FrameSource> source = openField(field, target, stop);
  if (inputKindOf(field.input) == InputKind::scenario) field.opened = source->scene()->scenario;
  const auto openReference = [field, target, stop] { return openField(referenceOf(field), target, stop); };
  const bool is_scenario = !compares || inputKindOf(referenceOf(field).input) == InputKind::scenario;
  const std::string name =
      !compares || selection.compare == kOriginal ? "the original scenario" : selection.compare;
  return std::make_unique<DifferenceSource>(std::move(source), openReference,
                                            DifferenceReference{name, is_scenario, selection.cache_bytes},
                                            selection.comparison());
}

/// The range of the values of a series.
render::ColorRange rangeOf(FrameSource& source, const ProgressSink& progress) {
  RangeSearch search(source.count());
  while (const std::optional<int> step = search.next()) {
    search.add(source.frame(*step).info());
    if (progress) progress("value range", static_cast<double>(*step + 1) / source.count());
  }
  return search.range().empty() ? render::ColorRange() : search.range();
}

}  // namespace

std::unique_ptr<FrameSource> openFrameSource(const FrameSelection& selection, const ComputeTarget& target,
                                             const ProgressSink& progress, const StopFlag* stop) {
  const bool compares = !selection.compare.empty();
  std::unique_ptr<FrameSource> source = compares || selection.independent
                                            ? openComparison(selection, target, stop)
                                            : openField(selection, target, stop);
  // Files state the range of their series.
  const bool has_range = !compares && inputKindOf(selection.input) != InputKind::scenario;
  if (selection.range || selection.independent || has_range || source->count() == 1) {
    source->setColorRange(selection.range);
  } else {
    source->setColorRange(rangeOf(*source, progress));
  }
  return source;
}

}  // namespace emscape::playback
