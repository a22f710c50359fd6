/// What the benches of the renderer draw: one volume, alone, from views around it.
#pragma once

#include <memory>
#include <string>

#include "apps/emscape/command.h"
#include "apps/emscape/console.h"
#include "apps/emscape/target.h"
#include "emscape/playback/frame_source.h"
#include "emscape/render/renderer.h"
#include "render/ray_load.h"

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

void addBenchSceneOptions(CLI::App& command, BenchSceneOptions& options);
void addToleranceOption(CLI::App& command, double& tolerance_levels);

/// How long something took.
struct Duration {
  double ms = 0;  ///< by the clock of the processor that cast: events of a GPU, on the CPU the wall's
  double wall_ms = 0;
  double cpu_ms = 0;  ///< of all threads together; on busy cores the steadier of the two
};

/// A scene that is ready to be drawn. No ground, no labels.
class BenchScene {
 public:
  /// @throws Error (usage, bad_input, device)
  BenchScene(const BenchSceneOptions& options, const GlobalOptions& global, const ComputeTarget& target);

  render::ImageSize size() const { return size_; }
  bool onGpu() const { return target_.onGpu(); }
  const render::Renderer& renderer() const { return renderer_; }

  /// Turns the camera about the vertical through its target, away from where the option put it. What was
  /// computed for the view before is not used again, even if it is the same.
  void turnTo(double angle_deg);
  /// The picture stays where it was cast.
  Duration draw(const render::FramePlan& plan, render::FrameReport& report);
  Duration restore();
  /// What was drawn or restored last.
  render::Image image() {
    render::Image image;
    renderer_.fetch(image);
    return image;
  }

  /// Work of a set of pixels in this view.
  render::RayLoad loadOf(const std::vector<render::Lattice>& pixels) const;

  /// What was drawn and how: device, threads, volume, size, mode, step_voxels, ...
  Json json() const;
  /// The same in a line.
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

/// Opened where --backend says. @throws Error (usage, bad_input, device)
std::unique_ptr<BenchScene> openBenchScene(const BenchSceneOptions& options, const GlobalOptions& global);

}  // namespace emscape::app
