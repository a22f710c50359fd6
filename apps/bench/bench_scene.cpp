#include "apps/bench/bench_scene.h"

#include <fmt/core.h>

#include <cmath>
#include <ctime>
#include <filesystem>

#include "apps/bench/paper_transfer.h"
#include "apps/common/interrupt.h"
#include "base/files/inputs.h"
#include "base/stopwatch.h"
#include "emscape/base/error.h"
#include "emscape/base/log.h"
#include "emscape/base/parallel.h"
#include "emscape/base/units.h"
#include "emscape/playback/frames/inputs.h"
#include "report/warnings.h"

namespace emscape::app {
namespace {

render::RenderSettings settingsOf(const BenchSceneOptions& options) {
  render::RenderSettings settings;
  settings.mode = render::parseCompositingMode(options.mode);
  settings.step_voxels = options.step_voxels;
  settings.mida_gamma = options.mida_gamma;
  settings.exact = options.exact;
  settings.skip_empty = options.skip_empty;
  settings.vertical_exaggeration = options.exaggeration;
  return settings;
}

/// @param work  -> render::FrameReport
template <class Work>
Duration durationOf(const ComputeTarget& target, const Work& work) {
  const std::clock_t cpu_begin = std::clock();
  Stopwatch watch;
  const render::FrameReport report = work();
  const double wall_ms = watch.lap_ms();
  return {target.onGpu() ? report.total_ms() : wall_ms, wall_ms,
          1000.0 * static_cast<double>(std::clock() - cpu_begin) / CLOCKS_PER_SEC};
}

}  // namespace

render::TransferFunction benchFunction(const playback::Frame& frame, const std::string& file) {
  const volume::VolumeInfo& info = frame.info();
  if (!file.empty()) return render::readTransferFunction(file, info, frame.color_range);
  const volume::ValueRange range = render::colorRangeOf(info, frame.color_range);
  if (info.categorical || !(range.max > range.min)) return render::defaultTransferFunction(info, range);
  return render::parseTransferFunction(kPaperTransfer, "scenarios/transfer/paper.json", info, range);
}

render::CameraSpec turned(render::CameraSpec spec, double angle_deg) {
  if (spec.kind == render::CameraSpec::Kind::orbit) {
    spec.azimuth_deg = std::remainder(spec.azimuth_deg + angle_deg, 360.0);
    return spec;
  }
  const double s = std::sin(degToRad(angle_deg));
  const double c = std::cos(degToRad(angle_deg));
  const Vec3d from_target = *spec.eye_m - *spec.target_m;
  spec.eye_m = *spec.target_m + Vec3d{c * from_target.x + s * from_target.y,
                                      c * from_target.y - s * from_target.x, from_target.z};
  return spec;
}

void writeOnBlack(const std::string& file, const render::Image& image) {
  render::Image8 picture = render::quantize(image);
  for (std::size_t i = 3; i < picture.rgba.size(); i += 4) picture.rgba[i] = 255;
  render::writePng(file, picture);
}

Json triple(const Vec3d& v) {
  return {v.x, v.y, v.z};
}

Json cameraJson(const render::Camera& camera) {
  return {
      {"projection", camera.projection == render::Projection::perspective ? "perspective" : "orthographic"},
      {"eye_m", triple(camera.eye_m)},
      {"forward", triple(camera.forward)},
      {"up", triple(camera.up)},
      {"half_height", camera.half_height},
      {"shift", {camera.shift_x, camera.shift_y}}};
}

Json transferJson(const render::TransferFunction& function) {
  Json colors = Json::array();
  for (const auto& point : function.colors)
    colors.push_back({point.at, point.color.r, point.color.g, point.color.b});
  Json opacities = Json::array();
  for (const auto& point : function.opacities) opacities.push_back({point.at, point.opacity});
  return {{"name", function.name}, {"colors", colors}, {"opacities", opacities}};
}

BenchScene::BenchScene(const BenchSceneOptions& options, const GlobalOptions& global,
                       const ComputeTarget& target)
    : target_(target),
      mode_(options.mode),
      camera_text_(options.camera),
      size_(render::parseImageSize(options.size)),
      camera_(render::parseCamera(options.camera)),
      renderer_(target.rendererOptions()) {
  renderer_.setSettings(settingsOf(options));
  playback::FrameSelection selection = options.selection;
  if (inputExists(selection.input) && playback::inputKindOf(selection.input) == playback::InputKind::mesh)
    throw Error(ErrorCode::usage, selection.input + " is a field on tetrahedra; use emscape bench cells");
  selection.first_only = selection.times.empty();
  const std::unique_ptr<playback::FrameSource> source =
      playback::openFrameSource(selection, target, progressSink(global), &stopFlag());
  name_ = source->name();
  const playback::Frame frame = source->frame(0);
  volume_ = frame.volume;
  report::logWarnings(source->warnings());
  renderer_.setVolume(volume_);
  renderer_.setTransferFunction(benchFunction(frame, options.transfer));
  turnTo(0);
}

void BenchScene::turnTo(double angle_deg) {
  renderer_.setCamera(render::makeCamera(turned(camera_, angle_deg), renderer_.sceneBox(), size_));
}

Duration BenchScene::draw(const render::FramePlan& plan, render::FrameReport& report) {
  return durationOf(target_, [&] { return report = renderer_.draw(plan, size_); });
}

Duration BenchScene::restore() {
  return durationOf(target_, [&] { return renderer_.restore(); });
}

render::RayLoad BenchScene::loadOf(const std::vector<render::Lattice>& pixels) const {
  return render::rayLoadOf(pixels, size_, renderer_.camera(), volume_.grid(), renderer_.sceneBox(),
                           renderer_.settings().step_voxels);
}

Json BenchScene::json() const {
  const Dims& dims = volume_.grid().dims;
  const render::SceneBox box = renderer_.sceneBox();
  return {{"device", target_.device()},
          {"threads", threadCount()},
          {"volume",
           {{"name", name_},
            {"quantity", volume_.info().quantity},
            {"dims", {dims.x, dims.y, dims.z}},
            {"device_bytes", renderer_.volumeBytes()},
            {"drawn_lower_m", triple(box.lower_m)},
            {"drawn_upper_m", triple(box.drawnUpper_m())},
            {"vertical_exaggeration", box.vertical_exaggeration}}},
          {"size", {size_.width, size_.height}},
          {"mode", mode_},
          {"step_voxels", renderer_.settings().step_voxels},
          {"early_termination", !renderer_.settings().exact},
          {"skip_empty", renderer_.settings().skip_empty},
          {"camera_option", camera_text_},
          {"camera", cameraJson(renderer_.camera())},
          {"transfer", transferJson(renderer_.transferFunction())}};
}

std::string BenchScene::summary() const {
  const Dims& dims = volume_.grid().dims;
  return fmt::format("{}: {} x {} x {} voxels, {} x {} pixels, {}, step {:g} voxel; device {} ({} threads)",
                     name_, dims.x, dims.y, dims.z, size_.width, size_.height, mode_,
                     renderer_.settings().step_voxels, target_.device(), threadCount());
}

std::unique_ptr<BenchScene> openBenchScene(const BenchSceneOptions& options, const GlobalOptions& global) {
  return openOnTarget(global, options.device_volume, [&](const ComputeTarget& target) {
    return std::make_unique<BenchScene>(options, global, target);
  });
}

void addBenchSceneOptions(CLI::App& command, BenchSceneOptions& options) {
  command
      .add_option("INPUT", options.selection.input,
                  "Volume (.raw .dat .vdb .nvdb .vti) or scenario, which is computed for one instant")
      ->required();
  addSetOption(command, options.selection.edits);
  command.add_option("--size", options.size, "Picture size in pixels, WxH");
  command.add_option("--mode", options.mode, "Compositing mode, as for render");
  command.add_option("--step", options.step_voxels, "Distance between samples, in voxels")
      ->check(within(render::kStepLimits));
  command.add_option("--mida-gamma", options.mida_gamma, "-1 (dvr) .. 0 (mida) .. 1 (mip)")
      ->check(within(render::kMidaGammaLimits));
  command.add_flag("--exact", options.exact, "No early termination of rays");
  command.add_flag("!--no-skip", options.skip_empty, "Sample empty bricks too");
  command.add_option("--camera", options.camera, "As for render");
  command.add_option("--transfer", options.transfer,
                     "Colours and opacities (JSON); default: scenarios/transfer/paper.json");
  command.add_option("--exaggeration", options.exaggeration, "Vertical exaggeration; 0: chosen from the box")
      ->check(within(render::kExaggerationLimits));
  command.add_option("--quantity", options.selection.quantity, "Quantity or channel; default: the first");
  command.add_option("--time", options.selection.times, "Instant, in seconds; default: the first");
  addDeviceVolumeOption(command, options.device_volume);
  command.add_flag("--allow-missing-terrain", options.selection.allow_missing_terrain,
                   "Compute although elevation data is missing");
}

void addToleranceOption(CLI::App& command, double& tolerance_levels) {
  command
      .add_option(
          "--tolerance", tolerance_levels,
          "Adaptive rays: expected error, in levels of 255, above which a pixel is cast; raised if more "
          "than a quarter of the pixels would be cast")
      ->check(CLI::Range(0.0, 255.0));
}

}  // namespace emscape::app
