/// Cells drawn by OpenGL: the rasteriser's side of cell projection.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "emscape/render/image.h"
#include "render/cells/linear_transfer.h"
#include "render/cells/projected_cells.h"
#include "render/raycast.h"

namespace emscape::render::gl {

/// From where cells are drawn.
struct CellView {
  CameraView camera;
  CellProjection projection = CellProjection::exact;
  /// Per pixel, rows from the top, the depth at which its ray ends; empty: none ends.
  std::vector<float> end_depth;
};

/// Draws batches of cells, the farthest first, into a picture of 32-bit floats. One thread at a time uses it.
class CellRasterizer {
 public:
  /// With an OpenGL context of its own, without a window.
  /// @throws Error (device)
  CellRasterizer();
  ~CellRasterizer();

  /// While it lives, its thread calls the functions below; threads take turns.
  class Use {
   public:
    /// @throws Error (device)
    explicit Use(CellRasterizer& rasterizer);
    ~Use();
    Use(const Use&) = delete;
    Use& operator=(const Use&) = delete;

   private:
    CellRasterizer& rasterizer_;
  };

  /// Name of the device that draws.
  const std::string& device() const;

  void setTransfer(const LinearTransfer& transfer);

  /// Starts a picture.
  void begin(const CellView& view);
  /// The memory of the next batch, to be filled before draw().
  struct Batch {
    float* vertices = nullptr;  ///< cells x 4 x kFloatsOfVertex
    float* numbers = nullptr;   ///< cells x cellNumbers()
  };
  static constexpr std::size_t kBatchCells = 1 << 16;
  /// Memory for kBatchCells cells.
  Batch nextBatch();
  /// Draws the first `cells` of the batch over what was drawn before, in their order.
  void draw(std::size_t cells);
  /// Draws the batch's one cell, which holds the eye.
  /// @param eye_value  of the field at the eye
  void drawAround(float eye_value);
  /// Ends the picture: colours are premultiplied, the first row is the top one.
  void fetch(Image& image);

  /// Floats sent since begin().
  std::size_t sentFloats() const;
  /// Time that the device spent on drawing the batches of the last picture fetched, by its own clock.
  double drawMs() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace emscape::render::gl
