#include "emscape/playback/painter.h"

#include <fmt/core.h>

#include <utility>

#include "emscape/playback/scene.h"
#include "playback/difference_source.h"

namespace emscape::playback {
namespace {

/// Below the title: that a difference is shown, and to what.
std::string subtitleOf(const volume::VolumeInfo& info) {
  const auto reference = info.extra.find(kDifferenceToKey);
  return reference == info.extra.end() ? "" : "difference to " + reference->second;
}

}  // namespace

Painter::Painter(const PictureStyle& style, const FrameSource& source, const ComputeTarget& target)
    : Painter(style, target) {
  setScene(source.name(), source.scene());
}

Painter::Painter(const PictureStyle& style, const ComputeTarget& target)
    : style_(style), renderer_(target.rendererOptions()) {
  renderer_.setSettings(style.settings);
  annotations_.theme = style.theme;
}

void Painter::setScene(const std::string& title, const LoadedScenario* scene) {
  annotations_.title = title;
  scene_ = scene ? std::optional(*scene) : std::nullopt;
}

void Painter::setFrame(const Frame& frame) {
  const bool is_first_of_colors = !has_colors_;
  if (is_first_of_colors) {
    renderer_.setTransferFunction(functionFor(frame.volume));
    has_colors_ = true;
  }
  const bool is_other_grid = !frame_ || frame_->volume.grid() != frame.volume.grid();
  renderer_.setVolume(frame.volume);
  frame_ = frame;
  annotations_.time = fmt::format("t = {:g} s", frame.volume.info().time_s);
  annotations_.time_utc = frame.volume.info().time_utc;
  annotations_.subtitle = subtitleOf(frame.volume.info());
  annotations_.georeferenced = frame.volume.grid().georeferenced;
  setMarkers();
  setLegend();
  if (is_other_grid) setGround(nullptr);
  setGround();
  if (is_other_grid) fitCamera();
  if (is_first_of_colors && style_.settings.mode == render::CompositingMode::iso) {
    render::checkIsoValue(renderer_.isoValue(), *frame.volume.host());
  }
}

void Painter::setAzimuth(double azimuth_deg) {
  render::CameraSpec spec = style_.camera;
  spec.azimuth_deg = azimuth_deg;
  renderer_.setCamera(cameraOf(spec));
}

void Painter::setCamera(const render::CameraSpec& spec) {
  if (frame_) renderer_.setCamera(cameraOf(spec));
  style_.camera = spec;
}

void Painter::setSize(render::ImageSize size) {
  style_.size = size;
  fitCamera();
}

void Painter::setSettings(const render::RenderSettings& settings) {
  renderer_.setSettings(settings);
  style_.settings = settings;
  setLegend();
  fitCamera();  // heights may be stretched otherwise
}

void Painter::setTransferFunction(const render::TransferFunction& function) {
  renderer_.setTransferFunction(function);
  has_colors_ = true;
  setLegend();
}

void Painter::fitColors() {
  style_.transfer.clear();
  style_.colors_span_range = false;
  has_colors_ = false;
  if (frame_) setTransferFunction(functionFor(frame_->volume));
}

void Painter::fitColors(const volume::ValueRange& range) {
  volume::VolumeInfo info = frame_->volume.info();
  info.range_min = range.min;
  info.range_max = range.max;
  setTransferFunction(render::defaultTransferFunction(info));
}

void Painter::showTerrain(bool show) {
  style_.show_terrain = show;
  if (frame_) setGround();
}

void Painter::showEmitters(bool show) {
  style_.show_emitters = show;
  setMarkers();
}

render::FrameReport Painter::draw(const render::FramePlan& plan, const StopFlag* stop) {
  // A picture in host memory need not be fetched.
  fetched_ = renderer_.backend() == Backend::cpu;
  return fetched_ ? renderer_.draw(plan, style_.size, image_, stop) : renderer_.draw(plan, style_.size, stop);
}

render::FrameReport Painter::restore(const StopFlag* stop) {
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
  return renderer_.render(style_.size);
}

render::Image8 Painter::picture(const std::string& note) {
  annotations_.note = note;
  return render::compose(image(), renderer_.camera(), renderer_.sceneBox(), annotations_,
                         [this](const Vec3d& position_m) { return renderer_.isHidden(position_m); });
}

render::Image8 Painter::annotated(const render::Image8& fetched, const std::string& note) {
  annotations_.note = note;
  return render::compose(fetched, renderer_.camera(), renderer_.sceneBox(), annotations_,
                         [this](const Vec3d& position_m) { return renderer_.isHidden(position_m); });
}

std::shared_ptr<const render::DevicePicture> Painter::annotatedOnDevice(const std::string& note) {
  if (renderer_.backend() == Backend::cpu) return nullptr;
  annotations_.note = note;
  render::drawLayers(layers_, style_.size, renderer_.camera(), renderer_.sceneBox(), annotations_,
                     [this](const Vec3d& position_m) { return renderer_.isHidden(position_m); });
  return renderer_.compose(layers_);
}

render::TransferFunction Painter::functionFor(const volume::Volume& volume) const {
  if (!style_.transfer.empty()) return render::readTransferFunction(style_.transfer, volume.info());
  if (style_.function && !volume.info().categorical) {
    render::requireUnitOf(*style_.function, volume.info());
    return *style_.function;
  }
  return style_.colors_span_range ? render::defaultTransferFunction(volume.info())
                                  : render::defaultTransferFunction(*volume.host());
}

render::Camera Painter::cameraOf(const render::CameraSpec& spec) const {
  return render::makeCamera(spec, renderer_.sceneBox(), style_.size,
                            render::overlayMargins(style_.size, annotations_));
}

void Painter::fitCamera() {
  if (frame_) renderer_.setCamera(cameraOf(style_.camera));
}

void Painter::setGround() {
  setGround(style_.show_terrain && scene_ ? scene_->terrain : nullptr);
}

void Painter::setGround(const scenario::TerrainPtr& ground) {
  if (ground == ground_) return;
  height_field_ = ground ? heightFieldOf(*ground, frame_->volume.grid()) : nullptr;
  renderer_.setHeightField(height_field_);
  ground_ = ground;
}

void Painter::setMarkers() {
  const bool shows = style_.show_emitters && frame_;
  annotations_.markers = shows ? frame_->markers : std::vector<render::Marker>{};
  annotations_.tracks = shows ? frame_->tracks : std::vector<render::Track>{};
}

void Painter::setLegend() {
  if (!frame_) return;
  annotations_.legend = render::legendOf(frame_->volume.info(), renderer_.transferFunction());
  if (style_.settings.mode == render::CompositingMode::iso)
    annotations_.legend->iso_value = renderer_.isoValue();
  if (scene_ && frame_->volume.info().categorical) {
    annotations_.legend->categories = categoriesOf(frame_->volume.info(), *scene_->scenario);
  }
  const double space = render::overlayMargins(style_.size, annotations_).right;
  if (std::exchange(legend_space_, space) != space) fitCamera();
}

}  // namespace emscape::playback
