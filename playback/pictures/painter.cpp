#include "emscape/playback/pictures/painter.h"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "base/text/time_text.h"
#include "emscape/base/error.h"
#include "emscape/base/log.h"
#include "emscape/playback/frames/scene.h"
#include "playback/frames/difference_series.h"
#include "playback/frames/platform_tracks.h"
#include "playback/pictures/followed_camera.h"
#include "playback/pictures/scenery.h"

namespace emscape::playback {
namespace {

/// Subtitle of a difference, with its reference.
std::string subtitleOf(const volume::VolumeInfo& info) {
  const auto reference = info.extra.find(kDifferenceToKey);
  return reference == info.extra.end() ? "" : "difference to " + reference->second;
}

const char* wordsOf(render::CompositingMode mode) {
  switch (mode) {
    case render::CompositingMode::dvr:
      return "translucent";
    case render::CompositingMode::mida:
      return "translucent, maxima stressed";
    case render::CompositingMode::mip:
      return "maximum along each ray";
    case render::CompositingMode::iso:
      break;
  }
  return "surface of equal value";
}

}  // namespace

std::string CellPicture::text() const {
  return projected ? std::string("projected by ") + render::toString(sorting) : "marched";
}

Painter::Painter(const ViewState& view, const FrameSource& source, const ComputeTarget& target,
                 bool must_show_isosurface)
    : Painter(view, target, must_show_isosurface) {
  setScene(source.name(), source.scene());
}

Painter::Painter(const ViewState& view, const ComputeTarget& target, bool must_show_isosurface)
    : view_(view),
      must_show_isosurface_(must_show_isosurface),
      scenery_(std::make_unique<Scenery>()),
      renderer_(target.rendererOptions()) {
  renderer_.setSettings(view.settings);
  annotations_.theme = view.theme;
  annotations_.planes = view.settings.planes;
  annotations_.scale = view.label_scale;
}

Painter::~Painter() = default;

void Painter::setScene(const std::string& title, const LoadedScenario* scene) {
  annotations_.title = title;
  scene_ = scene ? std::optional(*scene) : std::nullopt;
}

void Painter::prepareCells(const Frame& frame) {
  if (!frame.cells || cells_) return;
  auto cells = std::make_unique<render::CellRenderer>(renderer_.backend());
  cells->setSettings(view_.settings);
  if (has_colors_) cells->setTransferFunction(renderer_.transferFunction());
  projects_ = view_.cells.method == CellMethod::project;
  if (view_.cells.method == CellMethod::automatic && renderer_.backend() == Backend::cpu) {
    try {
      projects_ = !cells->projectsOnCpu();
    } catch (const Error& error) {
      if (error.code() != ErrorCode::device) throw;
      logInfo(std::string("tetrahedra are marched, not projected: ") + error.what());
    }
  }
  cells_ = std::move(cells);
}

void Painter::setFrame(const Frame& frame) {
  prepareCells(frame);
  const bool is_first_of_colors = !has_colors_;
  if (is_first_of_colors) onRenderer([&](auto& to) { to.setTransferFunction(functionFor(frame)); });
  has_colors_ = true;
  const bool is_other_grid = !frame_ || frame_->grid() != frame.grid();
  if (frame.cells) {
    cells_->setField(frame.cells->field, frame.cells->faces);
  } else {
    renderer_.setVolume(frame.volume);
  }
  frame_ = frame;
  const volume::VolumeInfo& info = frame.info();
  const double span_s = scene_ ? scene_->scenario->clock.duration_s : 0;
  annotations_.time = info.has_time ? "t = " + timeText(info.time_s, span_s) : "";
  if (speed_ && info.has_time) annotations_.time += fmt::format("   ×{:.3g}", *speed_);
  annotations_.time_utc = info.time_utc;
  annotations_.subtitle = subtitleOf(info);
  annotations_.georeferenced = frame.grid().georeferenced;
  setMarkers();
  setLegend();
  setGround();
  if (is_other_grid || !view_.follow.empty()) fitCamera();
  if (is_first_of_colors && view_.settings.mode == render::CompositingMode::iso) {
    const std::string missing =
        render::missingIsosurface(renderer_.isoValue(), *frame.volume.host(), frame.color_range);
    if (!missing.empty() && must_show_isosurface_) throw Error(ErrorCode::bad_input, missing);
    if (!missing.empty()) logWarning(missing + "; no surface is drawn");
  }
  if (const std::optional<Error> fault = scenery_->takeFault()) throw Error(*fault);
}

void Painter::setAzimuth(double azimuth_deg) {
  render::CameraSpec spec = view_.camera;
  spec.azimuth_deg = azimuth_deg;
  onRenderer([&](auto& to) { to.setCamera(cameraOf(spec)); });
}

void Painter::setCamera(const render::CameraSpec& spec) {
  if (frame_) onRenderer([&](auto& to) { to.setCamera(cameraOf(spec)); });
  view_.camera = spec;
}

void Painter::setFollowed(const ViewState& view) {
  view_.follow = view.follow;
  view_.follow_mode = view.follow_mode;
  fitCamera();
}

void Painter::setSize(render::ImageSize size) {
  view_.size = size;
  fitCamera();
}

void Painter::setSettings(const render::RenderSettings& settings) {
  if (cells_) render::checkCellSettings(settings);
  renderer_.setSettings(settings);
  if (cells_) cells_->setSettings(settings);
  view_.settings = settings;
  annotations_.planes = settings.planes;
  setLegend();
  fitCamera();  // the vertical exaggeration may have changed
}

void Painter::setTransferFunction(const render::TransferFunction& function) {
  onRenderer([&](auto& to) { to.setTransferFunction(function); });
  has_colors_ = true;
  setLegend();
}

bool Painter::setColors(const ViewState& view) {
  view_.transfer_file.clear();
  view_.transfer = view.transfer;
  view_.range = view.range;
  if (!frame_) {
    has_colors_ = false;
    return false;
  }
  const render::TransferFunction function = functionFor(*frame_);
  if (function == transferFunction()) return false;
  setTransferFunction(function);
  return true;
}

void Painter::setScenery(const ViewState& view) {
  view_.show_terrain = view.show_terrain;
  view_.show_emitters = view.show_emitters;
  view_.labels = view.labels;
  view_.trail_s = view.trail_s;
  view_.sides = view.sides;
  view_.theme = annotations_.theme = view.theme;
  view_.label_scale = annotations_.scale = view.label_scale;
  view_.coast = view.coast;
  view_.graticule = view.graticule;
  view_.show_compass = view.show_compass;
  view_.show_scale_bar = view.show_scale_bar;
  view_.range_rings = view.range_rings;
  view_.places = view.places;
  view_.drape = view.drape;
  view_.units = view.units;
  view_.field_unit = view.field_unit;
  view_.positions = view.positions;
  setMarkers();
  if (frame_) {
    setGround();
    setLegend();
  }
  if (const std::optional<Error> fault = scenery_->takeFault()) throw Error(*fault);
}

render::FrameReport Painter::drawCells(bool is_complete, const StopFlag* stop) {
  render::FrameReport frame;
  CellPicture picture;
  fetched_ = true;
  if (projects_ && (!is_complete || view_.cells.method == CellMethod::project)) {
    render::ProjectionOptions options = view_.cells.projection;
    if (!is_complete) options.sorting = render::CellSorting::centroids;
    render::ProjectionReport report;
    image_ = cells_->project(view_.size, options, &report);
    picture = {true, options.sorting, report.device, report.cells, report.cycles, report.sent_bytes};
    frame.rays = view_.size.count();
    frame.cast_ms = report.order_ms + report.draw_ms;
  } else {
    render::CellReport report;
    image_ = cells_->render(view_.size, stop, &report);
    frame.rays = view_.size.count();
    frame.cast_ms = report.cast_ms;
    frame.complete = report.complete;
  }
  cell_picture_ = picture;
  return frame;
}

render::FrameReport Painter::draw(const render::FramePlan& plan, const StopFlag* stop) {
  if (cells_) {
    render::FrameReport report = drawCells(plan.pattern == render::Pattern::full, stop);
    report.pattern = plan.pattern;
    return report;
  }
  // A picture in host memory need not be fetched.
  fetched_ = renderer_.backend() == Backend::cpu;
  return fetched_ ? renderer_.draw(plan, view_.size, image_, stop) : renderer_.draw(plan, view_.size, stop);
}

render::FrameReport Painter::restore(const StopFlag* stop) {
  if (cells_) return drawCells(true, stop);
  fetched_ = renderer_.backend() == Backend::cpu;
  return fetched_ ? renderer_.restore(image_, stop) : renderer_.restore(stop);
}

const render::Image& Painter::image() {
  if (!fetched_) renderer_.fetch(image_);
  fetched_ = true;
  return image_;
}

void Painter::fetch(render::Image8& picture) {
  if (fetched_) {
    picture = render::quantize(image_);
  } else {
    renderer_.fetch(picture);
  }
}

render::Image Painter::fullCast() {
  if (cells_) {
    render::Image kept = std::move(image_);
    drawCells(true, nullptr);
    return std::exchange(image_, std::move(kept));
  }
  return renderer_.render(view_.size);
}

render::Image8 Painter::picture(const std::string& note) {
  annotations_.note = note;
  return render::compose(image(), camera(), sceneBox(), annotations_,
                         [this](const Vec3d& position_m) { return isHidden(position_m); });
}

render::Image8 Painter::annotated(const render::Image8& fetched, const std::string& note) {
  annotations_.note = note;
  return render::compose(fetched, camera(), sceneBox(), annotations_,
                         [this](const Vec3d& position_m) { return isHidden(position_m); });
}

std::shared_ptr<const render::DevicePicture> Painter::annotatedOnDevice(const std::string& note) {
  if (cells_ || renderer_.backend() == Backend::cpu) return nullptr;
  annotations_.note = note;
  render::drawLayers(layers_, view_.size, renderer_.camera(), renderer_.sceneBox(), annotations_,
                     [this](const Vec3d& position_m) { return renderer_.isHidden(position_m); });
  return renderer_.compose(layers_);
}

render::TransferFunction Painter::functionFor(const Frame& frame) const {
  const volume::VolumeInfo& info = frame.info();
  if (!view_.transfer_file.empty())
    return render::readTransferFunction(view_.transfer_file, info, frame.color_range);
  if (view_.transfer && !info.categorical) {
    render::requireUnitOf(*view_.transfer, info);
    return *view_.transfer;
  }
  return view_.range ? render::defaultTransferFunction(info, view_.range)
                     : frame.defaultColors(frame.color_range);
}

const render::TransferFunction& Painter::transferFunction() const {
  return cells_ ? cells_->transferFunction() : renderer_.transferFunction();
}
const render::Camera& Painter::camera() const {
  return cells_ ? cells_->camera() : renderer_.camera();
}
render::SceneBox Painter::sceneBox() const {
  return cells_ ? cells_->sceneBox() : renderer_.sceneBox();
}
bool Painter::isHidden(const Vec3d& frame_m) const {
  return cells_ ? cells_->isHidden(frame_m) : renderer_.isHidden(frame_m);
}

std::string Painter::note(render::Pattern pattern) const {
  const char* const mode = wordsOf(view_.settings.mode);
  if (frame_ && frame_->cells) {
    return fmt::format("{}, {} tetrahedra{}", mode, frame_->cells->field.mesh->cells.size(),
                       cell_picture_ ? ", " + cell_picture_->text() : "");
  }
  std::string text =
      fmt::format("{}, {}", mode, pattern == render::Pattern::full ? "every pixel computed" : "preview");
  if (view_.settings.step_voxels != render::RenderSettings().step_voxels)
    text += fmt::format(", a sample every {:g} voxels", view_.settings.step_voxels);
  return text;
}

render::Camera Painter::cameraOf(const render::CameraSpec& given) const {
  ViewState view = view_;
  view.camera = given;
  const render::CameraSpec spec = scene_ && frame_ ? followedCamera(view, scene_->scenario, scene_->terrain,
                                                                    frame_->grid(), frame_->info().time_s)
                                                   : given;
  return render::makeCamera(spec, sceneBox(), view_.size, render::overlayMargins(view_.size, annotations_));
}

void Painter::fitCamera() {
  if (frame_) onRenderer([&](auto& to) { to.setCamera(cameraOf(view_.camera)); });
}

void Painter::setGround() {
  if (!frame_) return;
  if (scenery_->update(view_, scene_ ? &*scene_ : nullptr, frame_->grid()))
    onRenderer([&](auto& to) { to.setHeightField(scenery_->heightField()); });
  scenery_->annotate(annotations_, view_, frame_->markers);
}

const std::shared_ptr<const render::HeightField>& Painter::heightField() const {
  return scenery_->heightField();
}

void Painter::setMarkers() {
  const bool shows = view_.show_emitters && frame_;
  annotations_.markers = shows ? frame_->markers : std::vector<render::Marker>{};
  annotations_.tracks = shows ? frame_->tracks : std::vector<render::Track>{};
  if (view_.trail_s > 0) {
    const double time_s = frame_ ? frame_->info().time_s : 0;
    for (render::Track& track : annotations_.tracks) track = partOf(track, time_s - view_.trail_s, time_s);
  }
  const auto isShown = [this](render::Affiliation side) {
    return view_.sides == ShownSides::all || static_cast<int>(view_.sides) == static_cast<int>(side);
  };
  for (render::Marker& marker : annotations_.markers) {
    marker.is_shown = isShown(marker.side);
    if (view_.labels != Labels::all) {
      marker.detail.clear();
      marker.height_m.reset();
    }
    if (view_.labels == Labels::off) marker.label.clear();
  }
  std::vector<render::Track>& tracks = annotations_.tracks;
  tracks.erase(
      std::remove_if(tracks.begin(), tracks.end(), [&](const auto& track) { return !isShown(track.side); }),
      tracks.end());
}

void Painter::setLegend() {
  if (!frame_) return;
  annotations_.legend = render::legendOf(frame_->info(), transferFunction(), view_.field_unit);
  if (view_.settings.mode == render::CompositingMode::iso)
    annotations_.legend->iso_value = renderer_.isoValue();
  if (frame_->info().categorical) {
    annotations_.legend->categories =
        categoriesOf(frame_->info(), render::colorRangeOf(frame_->info(), frame_->color_range),
                     scene_ ? scene_->scenario.get() : nullptr);
  }
}

}  // namespace emscape::playback
