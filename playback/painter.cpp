#include "apps/emscape/painter.h"

#include <fmt/core.h>

#include "apps/emscape/scene.h"
#include "render/isosurface.h"

namespace emscape::app {

Painter::Painter(const Look& look, const FrameSource& source, const Place& place)
    : look_(look), source_(source), renderer_(place.rendererOptions()) {
  renderer_.setSettings(look.settings);
  annotations_.title = source.name();
  annotations_.theme = look.theme;
}

void Painter::setFrame(const Frame& frame) {
  renderer_.setVolume(frame.volume);
  annotations_.time = fmt::format("t = {:g} s", frame.volume.info().time_s);
  annotations_.time_utc = frame.volume.info().time_utc;
  if (look_.show_emitters) annotations_.markers = frame.markers;
  if (!fitted_) fitTo(frame.volume);
}

void Painter::setAzimuth(double azimuth_deg) {
  render::CameraSpec spec = look_.camera;
  spec.azimuth_deg = azimuth_deg;
  placeCamera(spec);
}

render::FrameReport Painter::draw(const render::FramePlan& plan, const StopFlag* stop) {
  // Where the picture lies in the host's memory anyway, it need not be fetched.
  fetched_ = renderer_.backend() == Backend::cpu;
  return fetched_ ? renderer_.draw(plan, look_.size, image_, stop) : renderer_.draw(plan, look_.size, stop);
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

render::Image Painter::fullCast() {
  return renderer_.render(look_.size);
}

render::Image8 Painter::picture(const std::string& note) {
  annotations_.note = note;
  return render::compose(image(), renderer_.camera(), renderer_.sceneBox(), annotations_,
                         [this](const Vec3d& position_m) { return renderer_.isHidden(position_m); });
}

render::TransferFunction Painter::functionFor(const volume::Volume& volume) const {
  if (!look_.transfer.empty()) return render::readTransferFunction(look_.transfer, volume.info());
  return look_.colors_span_range ? render::defaultTransferFunction(volume.info())
                                 : render::defaultTransferFunction(*volume.host());
}

void Painter::placeCamera(const render::CameraSpec& spec) {
  renderer_.setCamera(render::makeCamera(spec, renderer_.sceneBox(), look_.size,
                                         render::overlayMargins(look_.size, annotations_)));
}

void Painter::fitTo(const volume::Volume& volume) {
  const LoadedScenario* scene = source_.scene();
  const render::TransferFunction function = functionFor(volume);
  renderer_.setTransferFunction(function);
  if (look_.show_terrain && scene && scene->terrain) {
    renderer_.setHeightField(heightFieldOf(*scene->terrain, volume.grid()));
  }
  const bool shows_surface = look_.settings.mode == render::CompositingMode::iso;
  if (shows_surface) render::checkIsoValue(renderer_.isoValue(), *volume.host());
  annotations_.georeferenced = volume.grid().georeferenced;
  annotations_.legend = render::legendOf(volume.info(), function);
  if (shows_surface) annotations_.legend->iso_value = renderer_.isoValue();
  if (scene && volume.info().categorical) annotations_.legend->categories = categoriesOf(*scene->scenario);
  placeCamera(look_.camera);
  fitted_ = true;
}

}  // namespace emscape::app
