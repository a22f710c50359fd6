#include "emscape/playback/mesh_pictures.h"

#include <fmt/core.h>

#include <filesystem>
#include <utility>

#include "emscape/base/error.h"
#include "emscape/playback/scene.h"
#include "emscape/playback/stop.h"
#include "emscape/volume/mesh_file.h"
#include "playback/background_writer.h"

namespace emscape::playback {
namespace {

bool sameMesh(const volume::TetrahedralMesh& a, const volume::TetrahedralMesh& b) {
  return a.points_m == b.points_m && a.cells == b.cells;
}

}  // namespace

MeshPictures::MeshPictures(const FrameSelection& selection, const PictureStyle& style, Backend backend,
                           const StopFlag* stop)
    : selection_(selection), style_(style), stop_(stop), quantity_(selection.quantity), renderer_(backend) {
  renderer_.setSettings(style.settings);
  files_ = chosenFiles(meshFilesOf(selection.input, quantity_), selection.times, selection.first_only);
  if (!selection.scenario.empty()) {
    scene_ = loadScenarioWithTerrain(selection.scenario, selection.edits);
  } else if (!selection.edits.empty()) {
    throw Error(ErrorCode::usage, "edits change a scenario; volumes have none unless --scenario names one");
  }
  const std::filesystem::path input = selection.input;
  annotations_.title =
      scene_ ? scene_->scenario->name : (input.has_filename() ? input : input.parent_path()).stem().string();
  annotations_.theme = style.theme;
  setStep(0);
}

void MeshPictures::setStep(int index) {
  throwIfStopped(stop_);
  volume::MeshFile file = volume::readMesh(files_[static_cast<std::size_t>(index)].file, quantity_);
  volume::MeshField& field = file.fields.front();
  if (mesh_ && sameMesh(*mesh_, *file.mesh)) {
    field.mesh = mesh_;
  } else {
    mesh_ = file.mesh;
    faces_ = file.faces;
  }
  if (selection_.range) {
    field.info.range_min = selection_.range->min;
    field.info.range_max = selection_.range->max;
  }
  renderer_.setField(field, faces_);
  if (!std::exchange(has_colors_, true)) renderer_.setTransferFunction(functionFor(field));
  annotations_.time = fmt::format("t = {:g} s", field.info.time_s);
  annotations_.time_utc = field.info.time_utc;
  annotations_.georeferenced = field.mesh->georeferenced;
  annotations_.legend = render::legendOf(field.info, renderer_.transferFunction());
  const volume::Grid grid = render::referenceGridOf(*field.mesh);
  const bool is_other_box = grid != grid_;
  grid_ = grid;
  if (is_other_box && scene_ && scene_->terrain && style_.show_terrain)
    renderer_.setHeightField(heightFieldOf(*scene_->terrain, grid_));
  setScene(field);
  if (is_other_box) {
    renderer_.setCamera(render::makeCamera(style_.camera, renderer_.sceneBox(), style_.size,
                                           render::overlayMargins(style_.size, annotations_)));
  }
}

void MeshPictures::setScene(const volume::MeshField& field) {
  if (!scene_ || !style_.show_emitters || !grid_.georeferenced) return;
  const scenario::Snapshot snapshot =
      scenario::snapshotAt(scene_->scenario, scene_->terrain.get(), field.info.time_s);
  annotations_.markers = markersOf(snapshot, scene_->terrain.get(), grid_);
}

render::TransferFunction MeshPictures::functionFor(const volume::MeshField& field) const {
  if (!style_.transfer.empty()) return render::readTransferFunction(style_.transfer, field.info);
  if (style_.function) {
    render::requireUnitOf(*style_.function, field.info);
    return *style_.function;
  }
  return style_.colors_span_range ? render::defaultTransferFunction(field.info)
                                  : render::defaultTransferFunction(field);
}

render::Image8 MeshPictures::picture(int index) {
  if (index > 0) setStep(index);
  render::CellReport report;
  const render::Image image = renderer_.render(style_.size, stop_, &report);
  throwIfStopped(stop_);
  cast_ms_ += report.cast_ms;
  annotations_.note = fmt::format("dvr, {} tetrahedra", mesh_->cells.size());
  return render::compose(image, renderer_.camera(), renderer_.sceneBox(), annotations_,
                         [this](const Vec3d& position_m) { return renderer_.isHidden(position_m); });
}

void drawPictures(MeshPictures& pictures, const std::vector<std::unique_ptr<PictureSink>>& sinks,
                  const std::function<void(int)>& done) {
  BackgroundWriter writer(2);
  for (int index = 0; index < pictures.count(); ++index) {
    writer.push([&sinks, index, picture = pictures.picture(index)] {
      for (const auto& sink : sinks) sink->add(index + 1, picture, 1);
    });
    if (done) done(index + 1);
  }
  writer.finish();
  for (const auto& sink : sinks) sink->finish();
}

}  // namespace emscape::playback
