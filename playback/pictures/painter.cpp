#include "emscape/playback/pictures/painter.h"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "base/text/display_units.h"
#include "base/text/time_text.h"
#include "emscape/base/error.h"
#include "emscape/base/log.h"
#include "emscape/playback/frames/scene.h"
#include "emscape/scenario/file/scenario_file.h"
#include "emscape/volume/statistics.h"
#include "playback/frames/busy_field.h"
#include "playback/frames/difference_series.h"
#include "playback/frames/platform_tracks.h"
#include "playback/pictures/followed_camera.h"
#include "playback/pictures/scenery.h"
#include "playback/pictures/silence.h"
#include "playback/pictures/split_picture.h"
#include "volume/difference.h"

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
      renderer_(target.rendererOptions()),
      renderer_options_(target.rendererOptions()) {
  renderer_.setSettings(view.settings);
  annotations_.theme = view.theme;
  annotations_.planes = view.settings.planes;
  annotations_.scale = view.label_scale;
}

Painter::~Painter() = default;

template <class Use>
void Painter::onRenderer(const Use& use) {
  if (cells_) return use(*cells_);
  use(renderer_);
  if (split_) use(split_->left());
}

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
  const bool is_first_of_colors =
      !has_colors_ && frame.has_field && !std::exchange(was_fitted_, frame.has_field);
  if (!has_colors_) onRenderer([&](auto& to) { to.setTransferFunction(functionFor(frame)); });
  has_colors_ = has_colors_ || (frame.has_field && !isFittedToNothing(frame));
  const bool is_other_grid = !frame_ || frame_->grid() != frame.grid();
  if (frame.cells) {
    cells_->setField(frame.cells->field, frame.cells->faces);
  } else {
    renderer_.setVolume(frame.volume);
  }
  frame_ = frame;
  updateSplit();
  const volume::VolumeInfo& info = frame.info();
  const double span_s = scene_ ? scene_->scenario->clock.duration_s : 0;
  annotations_.time = info.has_time ? "t = " + timeText(info.time_s, span_s) : "";
  if (speed_ && info.has_time) annotations_.time += fmt::format("   ×{:.3g}", *speed_);
  annotations_.time_utc = info.time_utc;
  if (!frame.live.empty()) {  // the scenario's clock moves only its scans
    annotations_.time_utc = "time line: " + annotations_.time;
    annotations_.time = frame.live;
  }
  annotations_.subtitle = subtitleOf(info);
  annotations_.georeferenced = frame.grid().georeferenced;
  setMarkers();
  setGround();
  setLegend();
  if (is_first_of_colors && view_.settings.map_height_agl_m && !showsMap())
    logWarning("map_layer: no ground is drawn below the field; nothing is painted on it");
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
  setView(cameraOf(spec));
}

void Painter::setCamera(const render::CameraSpec& spec) {
  if (frame_) setView(cameraOf(spec));
  view_.camera = spec;
}

void Painter::setView(const render::Camera& camera) {
  camera_ = camera;
  if (split_) return split_->setView(camera, view_.size, view_.split, renderer_);
  onRenderer([&](auto& to) { to.setCamera(camera); });
}

void Painter::setSplit(double split) {
  view_.split = split;
  updateSplit();
}

int Painter::splitColumn() const {
  return split_ ? split_->column() : 0;
}

void Painter::updateSplit() {
  const bool splits = frame_ && frame_->beside && view_.split > 0 && view_.size.width > 1;
  if (!splits) {
    if (std::exchange(split_, nullptr)) setView(camera_);
    return;
  }
  if (!split_) {
    split_ = std::make_unique<SplitPicture>(renderer_options_);
    split_->left().setSettings(view_.settings);
    split_->left().setTransferFunction(renderer_.transferFunction());
    split_->left().setHeightField(scenery_->heightField());
  }
  split_->left().setVolume(frame_->beside->frame->volume);
  setView(camera_);
}

void Painter::setFollowed(const ViewState& view) {
  view_.follow = view.follow;
  view_.follow_mode = view.follow_mode;
  fitCamera();
}

void Painter::setSize(render::ImageSize size) {
  view_.size = size;
  updateSplit();
  fitCamera();
}

void Painter::setSettings(const render::RenderSettings& settings) {
  if (cells_) render::checkCellSettings(settings);
  renderer_.setSettings(settings);
  onRenderer([&](auto& to) { to.setSettings(settings); });
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
    has_colors_ = was_fitted_ = false;
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
  if (split_) {
    fetched_ = true;
    return split_->draw(plan, renderer_, image_, stop);
  }
  // A picture in host memory need not be fetched.
  fetched_ = renderer_.backend() == Backend::cpu;
  return fetched_ ? renderer_.draw(plan, view_.size, image_, stop) : renderer_.draw(plan, view_.size, stop);
}

render::FrameReport Painter::restore(const StopFlag* stop, render::Edges edges) {
  if (cells_) return drawCells(true, stop);
  if (split_) {
    fetched_ = true;
    return split_->restore(renderer_, image_, stop, edges);
  }
  fetched_ = renderer_.backend() == Backend::cpu;
  return fetched_ ? renderer_.restore(image_, stop, edges) : renderer_.restore(stop, edges);
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
  return split_ ? split_->fullCast(renderer_) : renderer_.render(view_.size);
}

render::Image8 Painter::picture(const std::string& note) {
  annotations_.note = note;
  return composed(image());
}

render::Image8 Painter::annotated(const render::Image8& fetched, const std::string& note) {
  annotations_.note = note;
  return composed(fetched);
}

template <class AnyImage>
render::Image8 Painter::composed(const AnyImage& cast) {
  const auto compose = [&](const render::Annotations& annotations) {
    return render::compose(cast, camera_, sceneBox(), annotations,
                           [this](const Vec3d& position_m) { return isHidden(position_m); });
  };
  if (!split_) return compose(annotations_);
  const FieldBeside& beside = *frame_->beside;
  render::Annotations of_left = annotations_, of_right = annotations_;
  of_left.end_column = of_right.first_column = split_->column();
  of_right.end_column = view_.size.width;
  render::Image8 picture = compose(of_right);
  mark(of_left, *beside.frame);
  scenery_->annotate(of_left, view_, beside.frame->markers);
  render::joinParts(compose(of_left), split_->column(), {beside.caption, beside.own_caption}, annotations_,
                    picture);
  return picture;
}

std::shared_ptr<const render::DevicePicture> Painter::annotatedOnDevice(const std::string& note) {
  if (cells_ || split_ || renderer_.backend() == Backend::cpu) return nullptr;
  annotations_.note = note;
  render::drawLayers(layers_, view_.size, camera_, renderer_.sceneBox(), annotations_,
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

/// Whether the colours are those of a field without a value, so that the next field gets its own.
bool Painter::isFittedToNothing(const Frame& frame) const {
  const bool is_given = !view_.transfer_file.empty() || view_.transfer || view_.range || frame.color_range;
  return !is_given && !frame.info().categorical && volume::holdsNothing(frame.info());
}

const render::TransferFunction& Painter::transferFunction() const {
  return cells_ ? cells_->transferFunction() : renderer_.transferFunction();
}
render::SceneBox Painter::sceneBox() const {
  return cells_ ? cells_->sceneBox() : renderer_.sceneBox();
}
bool Painter::isHidden(const Vec3d& frame_m) const {
  return cells_ ? cells_->isHidden(frame_m) : renderer_.isHidden(frame_m);
}

std::string Painter::note(render::Pattern pattern) const {
  if (frame_ && !frame_->has_field) return "without the field";
  const char* const mode = wordsOf(view_.settings.mode);
  if (frame_ && frame_->cells) {
    return fmt::format("{}, {} tetrahedra{}", mode, frame_->cells->field.mesh->cells.size(),
                       cell_picture_ ? ", " + cell_picture_->text() : "");
  }
  std::string text =
      fmt::format("{}, {}", mode, pattern == render::Pattern::full ? "every pixel computed" : "preview");
  if (frame_ && frame_->column_step > 1) text += ", " + columnsText(frame_->column_step);
  if (const std::string changes = scene_ ? changeCountOf(*scene_->scenario) : ""; !changes.empty())
    text += ", " + changes;
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
  if (frame_) setView(cameraOf(view_.camera));
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

bool Painter::showsMap() const {
  return view_.settings.map_height_agl_m && heightField() != nullptr;
}

void Painter::setMarkers() {
  if (frame_) mark(annotations_, *frame_);
}

void Painter::mark(render::Annotations& annotations, const Frame& frame) const {
  annotations.markers = view_.show_emitters ? frame.markers : std::vector<render::Marker>{};
  annotations.tracks = view_.show_emitters ? frame.tracks : std::vector<render::Track>{};
  if (view_.trail_s > 0) {
    const double time_s = frame.info().time_s;
    for (render::Track& track : annotations.tracks) track = partOf(track, time_s - view_.trail_s, time_s);
  }
  const auto isShown = [this](render::Affiliation side) {
    return view_.sides == ShownSides::all || static_cast<int>(view_.sides) == static_cast<int>(side);
  };
  for (render::Marker& marker : annotations.markers) {
    marker.is_shown = marker.is_shown && isShown(marker.side);
    if (view_.labels != Labels::all) {
      marker.detail.clear();
      marker.height_m.reset();
    }
    if (view_.labels == Labels::off) marker.label.clear();
  }
  std::vector<render::Track>& tracks = annotations.tracks;
  tracks.erase(
      std::remove_if(tracks.begin(), tracks.end(), [&](const auto& track) { return !isShown(track.side); }),
      tracks.end());
}

void Painter::setLegend() {
  if (!frame_) return;
  annotations_.reserves_legend = !frame_->has_field;
  if (!frame_->has_field) return annotations_.legend.reset();
  annotations_.legend = render::legendOf(frame_->info(), transferFunction(), view_.field_unit);
  if (view_.settings.mode == render::CompositingMode::iso)
    annotations_.legend->iso_value = renderer_.isoValue();
  if (showsMap()) {
    const DisplayUnit unit = heightUnit(view_.units);
    annotations_.legend->map_note = fmt::format("map: at {:.4g} {} above ground",
                                                *view_.settings.map_height_agl_m / unit.factor, unit.name);
    const double quiet = volume::isDifference(frame_->info()) ? render::quietBelow(transferFunction()) : 0;
    if (quiet > 0)
      annotations_.legend->map_note += fmt::format(", from ±{:.2g} {}", quiet, frame_->info().unit);
  }
  // Of volumes the scenario is another file, whose emitters may be others.
  const bool is_of_scenario = scene_ && view_.scenario.empty() && !volume::isDifference(frame_->info());
  const std::string silence =
      is_of_scenario ? silenceText(*scene_->scenario, frame_->info().quantity, frame_->info().time_s) : "";
  if (!silence.empty()) annotations_.legend->note = silence;
  if (frame_->info().categorical) {
    annotations_.legend->categories =
        categoriesOf(frame_->info(), render::colorRangeOf(frame_->info(), frame_->color_range),
                     scene_ ? scene_->scenario.get() : nullptr);
  }
}

}  // namespace emscape::playback
