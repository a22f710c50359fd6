/// Frames of a source as finished pictures: one camera, one set of colours.
#pragma once

#include <string>

#include "apps/emscape/frame_source.h"
#include "emscape/base/progress.h"
#include "emscape/render/camera.h"
#include "emscape/render/image.h"
#include "emscape/render/overlay.h"
#include "emscape/render/renderer.h"

namespace emscape::app {

/// How pictures look.
struct Look {
  render::ImageSize size;
  render::CameraSpec camera;
  render::Theme theme = render::Theme::dark;
  render::RenderSettings settings;
  std::string transfer;            ///< file of the transfer function; empty: fitted to the first volume
  bool colors_span_range = false;  ///< fitted to the range of its values alone, not to how frequent they are
  bool show_terrain = true;
  bool show_emitters = true;
};

/// Draws frames of one source; camera and colours stay as they were fitted to the first. One thread at a
/// time uses it.
class Painter {
 public:
  /// @throws Error (bad_input, device)
  Painter(const Look& look, const FrameSource& source, const Place& place);

  /// What the next pictures show.
  void setFrame(const Frame& frame);
  /// Turns an orbiting camera to another azimuth. A frame must be set.
  void setAzimuth(double azimuth_deg);

  render::FrameReport draw(const render::FramePlan& plan, const StopFlag* stop = nullptr);
  /// Casts what the last draw() left out.
  render::FrameReport restore(const StopFlag* stop = nullptr);
  /// What was drawn last, bare.
  const render::Image& image();
  /// A full cast of what draw() and restore() show, beside it.
  render::Image fullCast();
  /// What was drawn last, with its labels. @param note  small, at the bottom
  render::Image8 picture(const std::string& note);

 private:
  void fitTo(const volume::Volume& volume);
  render::TransferFunction functionFor(const volume::Volume& volume) const;
  void placeCamera(const render::CameraSpec& spec);

  const Look& look_;
  const FrameSource& source_;
  render::Renderer renderer_;
  render::Annotations annotations_;
  render::Image image_;
  bool fetched_ = false;  ///< image_ is what was drawn last
  bool fitted_ = false;
};

}  // namespace emscape::app
