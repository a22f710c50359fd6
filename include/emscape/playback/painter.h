/// Frames of a source as finished pictures: one camera, one set of colours.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "emscape/base/progress.h"
#include "emscape/playback/frame_source.h"
#include "emscape/render/annotate/overlay.h"
#include "emscape/render/camera.h"
#include "emscape/render/height_field.h"
#include "emscape/render/image.h"
#include "emscape/render/renderer.h"

namespace emscape::playback {

/// Style of pictures.
struct PictureStyle {
  render::ImageSize size;
  render::CameraSpec camera;
  render::Theme theme = render::Theme::dark;
  render::RenderSettings settings;
  std::string transfer;  ///< file of the transfer function; empty: fitted to the first volume
  std::optional<render::TransferFunction> function;  ///< without such a file; not used for categories
  bool colors_span_range = false;  ///< fitted to the range of its values, not to their histogram
  bool show_terrain = true;
  bool show_emitters = true;
};

/// Draws frames; colours are those fitted to the first, the camera is kept as long as frames have the same
/// grid. Casting and labelling are separate: a program with its own labels uses image() or fetch(),
/// annotations() and renderer(). One thread at a time uses it.
class Painter {
 public:
  /// Draws frames of one source. @throws Error (device)
  Painter(const PictureStyle& style, const FrameSource& source, const ComputeTarget& target);
  /// The same without title and scene, until setScene(). @throws Error (bad_input) for settings, (device)
  Painter(const PictureStyle& style, const ComputeTarget& target);

  /// Sets the scene of the next frames. Another terrain object is another ground.
  /// @param scene  null: volumes without a scenario
  void setScene(const std::string& title, const LoadedScenario* scene);
  /// Sets the frame of the next pictures.
  /// @throws Error (bad_input) for a transfer file, nothing is changed then; or for an isosurface that shows
  /// nothing of the first frame, which is set anyway. Error (device)
  void setFrame(const Frame& frame);
  /// Turns an orbiting camera to another azimuth. A frame must be set.
  void setAzimuth(double azimuth_deg);
  /// Another camera, fitted to the box of the volume. A frame must be set.
  /// @throws Error (usage) if eye and target coincide; the camera is then unchanged
  void setCamera(const render::CameraSpec& spec);

  /// The functions below change the style of the next pictures, before or after the first frame.
  /// @param size  both sides at least 1
  void setSize(render::ImageSize size);
  render::ImageSize size() const { return style_.size; }
  /// An isosurface is not checked against the volume. @throws Error (bad_input) for a value out of its range;
  /// the settings are then unchanged
  void setSettings(const render::RenderSettings& settings);
  /// Sets the function, in place of a file or a fitted one.
  void setTransferFunction(const render::TransferFunction& function);
  /// Fits the function to the histogram of the frame, or of the next one if there is none yet.
  void fitColors();
  /// Fits the function to a range of values. A frame must be set.
  void fitColors(const volume::ValueRange& range);
  /// True if they have been fitted, read or set.
  bool hasColors() const { return has_colors_; }
  void showTerrain(bool show);
  void showEmitters(bool show);
  void setTheme(render::Theme theme) { annotations_.theme = theme; }

  render::FrameReport draw(const render::FramePlan& plan, const StopFlag* stop = nullptr);
  /// Casts the pixels that the last draw() interpolated.
  render::FrameReport restore(const StopFlag* stop = nullptr);
  /// The last picture: premultiplied, without background and labels.
  const render::Image& image();
  /// The same in 8 bits per channel; quantised on the GPU, hence cheaper.
  void fetch(render::Image8& picture);
  /// A separate full cast of the picture of draw() and restore().
  render::Image fullCast();

  /// The ground that is drawn; null if there is none.
  const std::shared_ptr<const render::HeightField>& heightField() const { return height_field_; }
  /// The annotations of a picture of the frame.
  const render::Annotations& annotations() const { return annotations_; }
  /// Its camera, box and hidden positions are those of the picture. Colours and settings may be changed after
  /// the first frame was set.
  render::Renderer& renderer() { return renderer_; }

  /// The last picture with background and labels. @param note  small, at the bottom
  render::Image8 picture(const std::string& note);
  /// The same for a fetched picture; differs by at most one level.
  render::Image8 annotated(const render::Image8& fetched, const std::string& note);
  /// The picture of annotated() in GPU memory; differs by at most two levels. Null with the CPU.
  std::shared_ptr<const render::DevicePicture> annotatedOnDevice(const std::string& note);

 private:
  /// The ground of the scene below the grid of the frame, if it is to be shown.
  void setGround();
  void setGround(const scenario::TerrainPtr& ground);
  void setMarkers();
  /// Fits the camera again if the width of the legend has changed.
  void setLegend();
  render::Camera cameraOf(const render::CameraSpec& spec) const;
  void fitCamera();
  render::TransferFunction functionFor(const volume::Volume& volume) const;

  PictureStyle style_;
  std::optional<LoadedScenario> scene_;
  std::optional<Frame> frame_;
  scenario::TerrainPtr ground_;  // whose height field the renderer has
  std::shared_ptr<const render::HeightField> height_field_;
  render::Renderer renderer_;
  render::Annotations annotations_;
  render::OverlayLayers layers_;
  render::Image image_;
  bool fetched_ = false;  ///< image_ is the last picture
  bool has_colors_ = false;
  double legend_space_ = 0;  ///< part of the width
};

}  // namespace emscape::playback
