/// Scene of the renderer's benchmarks: one volume, without ground, from views around it.
#pragma once

#include <memory>
#include <string>

#include "apps/common/command.h"
#include "apps/common/console.h"
#include "apps/common/target.h"
#include "emscape/playback/frames/frame_source.h"
#include "emscape/render/scene/renderer.h"
#include "render/patterns/ray_load.h"

namespace emscape::app {

struct BenchSceneOptions {
  playback::FrameSelection selection;
  std::string size = "1200x900";
  std::string mode = "dvr";
  std::string camera = "orbit";
  std::string transfer;
  std::string device_volume = "float";
  double step_voxels = 1;
  double mida_gamma = 0;
  double exaggeration = 0;
  bool exact = false;
  bool skip_empty = true;
};

/// The transfer function of a file, or scenarios/transfer/paper.json for all fields, so that measurements can
/// be compared.
render::TransferFunction benchFunction(const playback::Frame& frame, const std::string& file);
/// A camera rotated clockwise, as seen from above, about the vertical through its target.
render::CameraSpec turned(render::CameraSpec spec, double angle_deg);
/// Writes the image over black.
void writeOnBlack(const std::string& file, const render::Image& image);

Json triple(const Vec3d& v);
/// The camera in drawn coordinates, as in render::Camera.
Json cameraJson(const render::Camera& camera);
Json transferJson(const render::TransferFunction& function);

void addBenchSceneOptions(CLI::App& command, BenchSceneOptions& options);
void addToleranceOption(CLI::App& command, double& tolerance_levels);

/// A measured time.
struct Duration {
  double ms = 0;  ///< by events on a GPU, by wall clock on the CPU
  double wall_ms = 0;
  double cpu_ms = 0;  ///< of all threads; on a loaded machine less noisy than ms
};

/// A scene that is ready to be drawn. No ground, no labels.
class BenchScene {
 public:
  /// @throws Error (usage, bad_input, device)
  BenchScene(const BenchSceneOptions& options, const GlobalOptions& global, const ComputeTarget& target);

  render::ImageSize size() const { return size_; }
  bool onGpu() const { return target_.onGpu(); }
  const render::Renderer& renderer() const { return renderer_; }

  /// Turns the camera about the vertical through its target, relative to the option's camera. Results of the
  /// previous view are not reused, even if it is the same.
  void turnTo(double angle_deg);
  /// The picture stays in the memory of the processor.
  Duration draw(const render::FramePlan& plan, render::FrameReport& report);
  Duration restore();
  /// The last picture drawn or restored.
  render::Image image() {
    render::Image image;
    renderer_.fetch(image);
    return image;
  }

  /// Work of a set of pixels in this view.
  render::RayLoad loadOf(const std::vector<render::Lattice>& pixels) const;

  /// Description of the scene: device, threads, volume, size, mode, step_voxels, ...
  Json json() const;
  /// The description of json() on one line.
  std::string summary() const;

 private:
  const ComputeTarget target_;
  const std::string mode_;
  const std::string camera_text_;
  const render::ImageSize size_;
  const render::CameraSpec camera_;
  std::string name_;
  volume::Volume volume_;
  render::Renderer renderer_;
};

/// Opens a scene on the processor of --backend. @throws Error (usage, bad_input, device)
std::unique_ptr<BenchScene> openBenchScene(const BenchSceneOptions& options, const GlobalOptions& global);

}  // namespace emscape::app
