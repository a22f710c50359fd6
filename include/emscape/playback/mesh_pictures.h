/// Pictures of fields on tetrahedra from files, with labels.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "emscape/base/backend.h"
#include "emscape/base/progress.h"
#include "emscape/playback/frame_source.h"
#include "emscape/playback/painter.h"
#include "emscape/playback/picture_sink.h"
#include "emscape/playback/volume_input.h"
#include "emscape/render/cell_renderer.h"

namespace emscape::playback {

/// Draws the steps of a series of .vtu files. Colours are those fitted to the first step; the camera is kept
/// as long as steps have the same box. One thread uses it.
class MeshPictures {
 public:
  /// @param selection  of an input for which holdsMeshes(); without a comparison
  /// @param style      its settings as for CellRenderer
  /// @param backend    where rays are cast, as for CellRenderer
  /// @param stop       ends the work of picture() with Stopped; may be null, else outlives this
  /// @throws Error (usage, bad_input, device)
  MeshPictures(const FrameSelection& selection, const PictureStyle& style, Backend backend = Backend::cpu,
               const StopFlag* stop = nullptr);

  /// cpu or cuda.
  Backend backend() const { return renderer_.backend(); }

  /// At least 1.
  int count() const { return static_cast<int>(files_.size()); }
  /// For titles and file names.
  const std::string& name() const { return annotations_.title; }
  /// The picture with background and labels of step 0..count() - 1, in any order after 0.
  /// @throws Error, Stopped
  render::Image8 picture(int index);
  /// Time of casting so far.
  double cast_ms() const { return cast_ms_; }

 private:
  void setStep(int index);
  void setScene(const volume::MeshField& field);
  render::TransferFunction functionFor(const volume::MeshField& field) const;

  const FrameSelection selection_;
  const PictureStyle style_;
  const StopFlag* const stop_;
  std::string quantity_;
  std::vector<VolumeFile> files_;
  std::optional<LoadedScenario> scene_;
  render::CellRenderer renderer_;
  render::Annotations annotations_;
  std::shared_ptr<const volume::TetrahedralMesh> mesh_;  ///< of the last step
  std::shared_ptr<const volume::MeshFaces> faces_;
  volume::Grid grid_;  ///< reference grid of the last step
  bool has_colors_ = false;
  double cast_ms_ = 0;
};

/// Draws every step. Files are written on a thread of their own while the next picture is cast.
/// @param sinks  each gets every picture; finished at the end
/// @param done   called after each picture with the number of pictures so far; may be empty
/// @throws Error, Stopped; the sinks are then not finished
void drawPictures(MeshPictures& pictures, const std::vector<std::unique_ptr<PictureSink>>& sinks,
                  const std::function<void(int pictures)>& done = {});

}  // namespace emscape::playback
