/// Frames of a source as finished pictures: one camera, one set of colours.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "emscape/base/progress.h"
#include "emscape/playback/frames/frame_source.h"
#include "emscape/playback/view/view_state.h"
#include "emscape/render/annotate/overlay.h"
#include "emscape/render/cells/cell_renderer.h"
#include "emscape/render/picture/image.h"
#include "emscape/render/scene/camera.h"
#include "emscape/render/scene/height_field.h"
#include "emscape/render/scene/renderer.h"

namespace emscape::playback {

class Scenery;
class SplitPicture;

/// Method and cost of the last picture of a field on tetrahedra.
struct CellPicture {
  bool projected = false;
  render::CellSorting sorting = render::CellSorting::visibility;  ///< this and the following: if projected
  std::string device;
  long long cells = 0;
  long long cycles = 0;
  std::size_t sent_bytes = 0;

  /// "marched", "projected by centroids".
  std::string text() const;
};

/// Draws frames. Colours are fitted to the first frame; the camera is kept as long as frames have the same
/// grid. Fields on tetrahedra have two kinds of picture: the complete one (Pattern::full and restore()), and
/// a quick one for every other pattern (CellMethod). Casting and labelling are separate: a program with its
/// own labels uses image() or fetch(), annotations() and renderer(). One thread at a time may use it.
class Painter {
 public:
  /// Draws frames of one source.
  /// @param view  its style; which field the frames show is up to the source
  /// @param must_show_isosurface  true: an isosurface that shows nothing of the first volume is an error;
  /// false: a warning
  /// @throws Error (bad_input) for settings, (device)
  Painter(const ViewState& view, const FrameSource& source, const ComputeTarget& target,
          bool must_show_isosurface = true);
  /// A painter without title and scene, until setScene(). @throws Error (bad_input, device) as above
  Painter(const ViewState& view, const ComputeTarget& target, bool must_show_isosurface = true);
  ~Painter();

  /// Sets the scene of the next frames. A different terrain object is treated as a different ground.
  /// @param scene  null: volumes without a scenario
  void setScene(const std::string& title, const LoadedScenario* scene);
  /// Sets the frame of the next pictures.
  /// @throws Error (bad_input) for the transfer file, after which nothing is changed; or if the isosurface
  /// shows nothing of the first frame (must_show_isosurface), or for a file of places or of a picture on the
  /// ground; the frame is set all the same. Error
  /// (usage) for settings that tetrahedra do not have (render::checkCellSettings()), after which nothing is
  /// changed. Error (device)
  void setFrame(const Frame& frame);
  bool hasFrame() const { return frame_.has_value(); }
  /// Turns an orbiting camera to another azimuth. A frame must be set.
  void setAzimuth(double azimuth_deg);
  /// Sets another camera, fitted to the box of the volume. A frame must be set.
  /// @throws Error (usage) if eye and target coincide; the camera is then unchanged
  void setCamera(const render::CameraSpec& spec);

  /// Sets the platform that the camera follows, and how (ViewState::follow); its position is that at the time
  /// of the frame. Without such a platform the camera is not changed.
  void setFollowed(const ViewState& view);
  /// States the speed of a film beside the time of the next frames; none: does not.
  void setSpeed(std::optional<double> scenario_seconds_per_second) { speed_ = scenario_seconds_per_second; }

  /// Sets the size. This and the following functions change the view of the next pictures, before or after
  /// the first frame.
  /// @param size  both sides at least 1
  void setSize(render::ImageSize size);
  render::ImageSize size() const { return view_.size; }
  /// Sets the render settings. An isosurface is not checked against the volume. @throws Error (bad_input) for
  /// a value out of its range, (usage) as setFrame(); the settings are then unchanged
  void setSettings(const render::RenderSettings& settings);
  /// Takes over the colours of a view: its transfer function, else fitted to its range, else to the
  /// histogram of the frame, or of the next one if there is none yet.
  /// @return true if the picture has other colours now
  /// @throws Error (bad_input) for a function in another unit than the frame's; nothing is changed on screen
  bool setColors(const ViewState& view);
  /// True if colours have been fitted, read or set.
  bool hasColors() const { return has_colors_; }
  /// Takes over what a view shows besides the field: ground, emitters, labels, references, units, theme.
  /// @throws Error (bad_input) for a file of places or of a picture on the ground; it is left out
  void setScenery(const ViewState& view);

  /// Moves the line between the two fields of frames that have one beside them (ViewState::split).
  void setSplit(double split);
  /// Columns of the picture left of that line; 0: there is none.
  int splitColumn() const;

  render::FrameReport draw(const render::FramePlan& plan, const StopFlag* stop = nullptr);
  /// Casts the pixels that the last draw() interpolated.
  render::FrameReport restore(const StopFlag* stop = nullptr, render::Edges edges = render::Edges::as_cast);
  /// The last picture: premultiplied, without background and labels.
  const render::Image& image();
  /// The same in 8 bits per channel; cheaper on a GPU, which quantises it.
  void fetch(render::Image8& picture);
  /// A separate full cast of the picture of draw() and restore().
  render::Image fullCast();

  /// The drawn ground; null if there is none.
  const std::shared_ptr<const render::HeightField>& heightField() const;
  /// The annotations of a picture of the frame.
  const render::Annotations& annotations() const { return annotations_; }
  // Of the picture.
  const render::RenderSettings& settings() const { return view_.settings; }
  const render::TransferFunction& transferFunction() const;
  const render::Camera& camera() const { return camera_; }
  render::SceneBox sceneBox() const;
  bool isHidden(const Vec3d& frame_m) const;
  /// cpu or cuda.
  Backend backend() const { return renderer_.backend(); }
  /// None unless the last picture was of tetrahedra.
  const std::optional<CellPicture>& cellPicture() const { return cell_picture_; }
  /// True if incomplete pictures of the frame are projected tetrahedra.
  bool projectsCells() const { return cells_ && projects_; }
  /// The small text at the bottom of a picture: "dvr, full rays, step 1 voxel", of tetrahedra
  /// "dvr, 1200 tetrahedra, marched".
  std::string note(render::Pattern pattern) const;

  /// The last picture with background and labels. @param note  small, at the bottom
  render::Image8 picture(const std::string& note);
  /// The same for a fetched picture; differs by at most one level.
  render::Image8 annotated(const render::Image8& fetched, const std::string& note);
  /// The picture of annotated() in GPU memory; differs by at most two levels. Null on the CPU.
  std::shared_ptr<const render::DevicePicture> annotatedOnDevice(const std::string& note);

 private:
  /// The renderer of tetrahedra, if the frame has some. @throws Error as setFrame()
  void prepareCells(const Frame& frame);
  /// Calls use() for the renderers of the frames.
  template <class Use>
  void onRenderer(const Use& use);
  /// Splits the picture if the frame and the view want that, or joins it again.
  void updateSplit();
  void setView(const render::Camera& camera);
  template <class AnyImage>
  render::Image8 composed(const AnyImage& cast);
  /// Draws the tetrahedra into image_.
  render::FrameReport drawCells(bool is_complete, const StopFlag* stop);
  /// Sets the ground of the scene below the grid of the frame, and what is drawn on it.
  void setGround();
  void setMarkers();
  void mark(render::Annotations& annotations, const Frame& frame) const;
  /// True if the map layer is painted on the ground.
  bool showsMap() const;
  void setTransferFunction(const render::TransferFunction& function);
  void setLegend();
  render::Camera cameraOf(const render::CameraSpec& given) const;
  void fitCamera();
  render::TransferFunction functionFor(const Frame& frame) const;
  bool isFittedToNothing(const Frame& frame) const;

  ViewState view_;
  const bool must_show_isosurface_;
  std::optional<LoadedScenario> scene_;
  std::optional<Frame> frame_;
  std::unique_ptr<Scenery> scenery_;
  render::Renderer renderer_;  ///< of volumes
  const render::RendererOptions renderer_options_;
  std::unique_ptr<SplitPicture> split_;          ///< null if the picture is not split
  render::Camera camera_;                        ///< of the whole picture
  std::unique_ptr<render::CellRenderer> cells_;  ///< of tetrahedra; null if the frames are volumes
  bool projects_ = false;                        ///< as projectsCells(), if there are tetrahedra
  std::optional<CellPicture> cell_picture_;
  render::Annotations annotations_;
  render::OverlayLayers layers_;
  render::Image image_;
  bool fetched_ = false;  ///< image_ is the last picture
  bool has_colors_ = false;
  bool was_fitted_ = false;  ///< to a field, perhaps to one without a value
  std::optional<double> speed_;
};

}  // namespace emscape::playback
