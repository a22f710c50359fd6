/// Frames of a source as finished pictures: one camera, one set of colours.
#pragma once

#include <optional>
#include <string>

#include "emscape/base/progress.h"
#include "emscape/playback/frame_source.h"
#include "emscape/render/camera.h"
#include "emscape/render/image.h"
#include "emscape/render/overlay.h"
#include "emscape/render/renderer.h"

namespace emscape::playback {

/// How pictures look.
struct PictureStyle {
  render::ImageSize size;
  render::CameraSpec camera;
  render::Theme theme = render::Theme::dark;
  render::RenderSettings settings;
  std::string transfer;  ///< file of the transfer function; empty: fitted to the first volume
  std::optional<render::TransferFunction> function;  ///< without such a file; not used for categories
  bool colors_span_range = false;  ///< fitted to the range of its values alone, not to how frequent they are
  bool show_terrain = true;
  bool show_emitters = true;
};

/// Draws frames of one source; camera and colours stay as they were fitted to the first. Casting a picture
/// and writing its labels are apart: who draws labels of its own takes image() or fetch(), annotations() and
/// renderer(). One thread at a time uses it.
class Painter {
 public:
  /// @param style, source  outlive this
  /// @throws Error (bad_input, device)
  Painter(const PictureStyle& style, const FrameSource& source, const ComputeTarget& target);

  /// What the next pictures show. @throws Error (bad_input) for a transfer file, (device)
  void setFrame(const Frame& frame);
  /// Turns an orbiting camera to another azimuth. A frame must be set.
  void setAzimuth(double azimuth_deg);
  /// Another camera, fitted to the box of the volume. A frame must be set. @throws Error (bad_input)
  void setCamera(const render::CameraSpec& spec);

  render::FrameReport draw(const render::FramePlan& plan, const StopFlag* stop = nullptr);
  /// Casts what the last draw() left out.
  render::FrameReport restore(const StopFlag* stop = nullptr);
  /// What was drawn last, bare: premultiplied, no background, no labels.
  const render::Image& image();
  /// The same in 8 bits a channel; a GPU quantises it, which makes it the cheaper one.
  void fetch(render::Image8& picture);
  /// A full cast of what draw() and restore() show, beside it.
  render::Image fullCast();

  /// What is written on a picture of the frame.
  const render::Annotations& annotations() const { return annotations_; }
  /// Its camera, box and hidden positions are those of the picture. Colours and settings may be changed after
  /// the first frame was set.
  render::Renderer& renderer() { return renderer_; }

  /// What was drawn last on its background, with its labels. @param note  small, at the bottom
  render::Image8 picture(const std::string& note);

 private:
  void fitTo(const volume::Volume& volume);
  render::TransferFunction functionFor(const volume::Volume& volume) const;

  const PictureStyle& style_;
  const FrameSource& source_;
  render::Renderer renderer_;
  render::Annotations annotations_;
  render::Image image_;
  bool fetched_ = false;  ///< image_ is what was drawn last
  bool fitted_ = false;
};

}  // namespace emscape::playback
