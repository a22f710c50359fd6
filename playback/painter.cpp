#include "emscape/playback/painter.h"

#include <fmt/core.h>

#include "emscape/playback/scene.h"

namespace emscape::playback {

Painter::Painter(const PictureStyle& style, const FrameSource& source, const ComputeTarget& target)
    : style_(style), source_(source), renderer_(target.rendererOptions()) {
  renderer_.setSettings(style.settings);
  annotations_.title = source.name();
  annotations_.theme = style.theme;
}

void Painter::setFrame(const Frame& frame) {
  renderer_.setVolume(frame.volume);
  annotations_.time = fmt::format("t = {:g} s", frame.volume.info().time_s);
  annotations_.time_utc = frame.volume.info().time_utc;
  if (style_.show_emitters) annotations_.markers = frame.markers;
  if (!fitted_) fitTo(frame.volume);
}

void Painter::setAzimuth(double azimuth_deg) {
  render::CameraSpec spec = style_.camera;
  spec.azimuth_deg = azimuth_deg;
  setCamera(spec);
}

render::FrameReport Painter::draw(const render::FramePlan& plan, const StopFlag* stop) {
  // Where the picture lies in the host's memory anyway, it need not be fetched.
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

render::TransferFunction Painter::functionFor(const volume::Volume& volume) const {
  if (!style_.transfer.empty()) return render::readTransferFunction(style_.transfer, volume.info());
  if (style_.function && !volume.info().categorical) {
    render::requireUnitOf(*style_.function, volume.info());
    return *style_.function;
  }
  return style_.colors_span_range ? render::defaultTransferFunction(volume.info())
                                  : render::defaultTransferFunction(*volume.host());
}

void Painter::setCamera(const render::CameraSpec& spec) {
  renderer_.setCamera(render::makeCamera(spec, renderer_.sceneBox(), style_.size,
                                         render::overlayMargins(style_.size, annotations_)));
}

void Painter::fitTo(const volume::Volume& volume) {
  const LoadedScenario* scene = source_.scene();
  const render::TransferFunction function = functionFor(volume);
  renderer_.setTransferFunction(function);
  if (style_.show_terrain && scene && scene->terrain) {
    renderer_.setHeightField(heightFieldOf(*scene->terrain, volume.grid()));
  }
  const bool shows_surface = style_.settings.mode == render::CompositingMode::iso;
  if (shows_surface) render::checkIsoValue(renderer_.isoValue(), *volume.host());
  annotations_.georeferenced = volume.grid().georeferenced;
  annotations_.legend = render::legendOf(volume.info(), function);
  if (shows_surface) annotations_.legend->iso_value = renderer_.isoValue();
  if (scene && volume.info().categorical) annotations_.legend->categories = categoriesOf(*scene->scenario);
  setCamera(style_.camera);
  fitted_ = true;
}

}  // namespace emscape::playback
