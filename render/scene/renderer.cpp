#include "emscape/render/scene/renderer.h"

#include <mutex>
#include <utility>

#include "emscape/base/backend.h"
#include "emscape/base/error.h"
#include "emscape/base/log.h"
#include "render/scene/frame_caster.h"
#include "render/scene/scene.h"

namespace emscape::render {

struct Renderer::Impl {
  Backend backend = Backend::cpu;
  std::unique_ptr<FrameCaster> caster;
  Scene scene;
  volume::Volume volume;
  std::mutex volume_mutex;  ///< held while the volume is set, and while it is drawn

  FrameReport draw(const FramePlan& plan, ImageSize size, const StopFlag* stop) {
    scene.prepare();
    return caster->draw(scene, plan, size, stop);
  }
  FrameReport restore(const StopFlag* stop, Edges edges) {
    scene.prepare();
    return caster->restore(scene, stop, edges);
  }
};

Renderer::Renderer(const RendererOptions& options) : impl_(std::make_unique<Impl>()) {
  impl_->caster = withBackendFallback(
      options.backend,
      [&](const ResolvedBackend& resolved) {
        impl_->backend = resolved.backend;
        return resolved.backend == Backend::cuda ? makeCudaCaster(options.precision) : makeCpuCaster();
      },
      logInfo);
}
Renderer::~Renderer() = default;

Backend Renderer::backend() const {
  return impl_->backend;
}

void Renderer::setVolume(const volume::Volume& volume) {
  if (volume.isEmpty()) throw Error(ErrorCode::other, "Renderer: no volume is given");
  const std::lock_guard<std::mutex> lock(impl_->volume_mutex);
  if (volume.isOnDevice()) {
    impl_->caster->setVolume(volume.device());
  } else {
    impl_->caster->setVolume(volume.dense());
  }
  impl_->scene.setVolume(volume.grid(), volume.info());
  impl_->volume = volume;
}

std::size_t Renderer::volumeBytes() const {
  return impl_->caster->volumeBytes();
}

void Renderer::setHeightField(std::shared_ptr<const HeightField> height_field) {
  impl_->scene.setHeightField(std::move(height_field));
}
void Renderer::setTransferFunction(const TransferFunction& function) {
  impl_->scene.setTransferFunction(function);
}
void Renderer::setCamera(const Camera& camera) {
  impl_->scene.setCamera(camera);
}
void Renderer::setSettings(const RenderSettings& settings) {
  impl_->scene.setSettings(settings);
}

const RenderSettings& Renderer::settings() const {
  return impl_->scene.settings();
}
const TransferFunction& Renderer::transferFunction() const {
  return impl_->scene.transferFunction();
}
double Renderer::isoValue() const {
  return impl_->scene.isoValue();
}
const Camera& Renderer::camera() const {
  return impl_->scene.camera();
}
SceneBox Renderer::sceneBox() const {
  return impl_->scene.box();
}
bool Renderer::isHidden(const Vec3d& frame_m) const {
  return impl_->scene.isHidden(frame_m, &impl_->volume);
}

FrameReport Renderer::draw(const FramePlan& plan, ImageSize size, const StopFlag* stop) {
  const std::lock_guard<std::mutex> lock(impl_->volume_mutex);
  return impl_->draw(plan, size, stop);
}

FrameReport Renderer::restore(const StopFlag* stop, Edges edges) {
  const std::lock_guard<std::mutex> lock(impl_->volume_mutex);
  return impl_->restore(stop, edges);
}

void Renderer::fetch(Image& image) {
  impl_->caster->fetch(image);
}
void Renderer::fetch(Image8& image) {
  impl_->caster->fetch(image);
}

std::shared_ptr<const DevicePicture> Renderer::compose(const OverlayLayers& layers) {
  return impl_->caster->compose(layers);
}

FrameReport Renderer::draw(const FramePlan& plan, ImageSize size, Image& image, const StopFlag* stop) {
  const std::lock_guard<std::mutex> lock(impl_->volume_mutex);
  impl_->caster->bindTarget(image);
  const FrameReport report = impl_->draw(plan, size, stop);
  impl_->caster->unbindTarget(image, report);
  return report;
}

FrameReport Renderer::restore(Image& image, const StopFlag* stop, Edges edges) {
  const std::lock_guard<std::mutex> lock(impl_->volume_mutex);
  impl_->caster->bindTarget(image);
  const FrameReport report = impl_->restore(stop, edges);
  impl_->caster->unbindTarget(image, report);
  return report;
}

Image Renderer::render(ImageSize size, const FramePlan& plan, FrameReport* report) {
  Image image;
  const FrameReport drawn = draw(plan, size, image);
  if (report != nullptr) *report = drawn;
  return image;
}

}  // namespace emscape::render
