/// OpenGL rasteriser of projected cells.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "emscape/render/picture/image.h"
#include "render/cast/raycast.h"
#include "render/cells/integral/linear_transfer.h"
#include "render/cells/projected_cells.h"

namespace emscape::render::gl {

/// View of the cells.
struct CellView {
  CameraView camera;
  CellProjection projection = CellProjection::exact;
  /// Depth at which the ray of each pixel ends, rows from the top; empty: no ray ends.
  std::vector<float> end_depth;
};

/// Draws batches of cells, the farthest first, into a picture of 32-bit floats. Not thread-safe.
class CellRasterizer {
 public:
  /// Creates an OpenGL context without a window.
  /// @throws Error (device)
  CellRasterizer();
  ~CellRasterizer();

  /// Makes the context current; the functions below may be called in its thread during its lifetime. Only one
  /// thread may hold it at a time.
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
  /// Memory of the next batch, to be filled before draw().
  struct Batch {
    float* vertices = nullptr;  ///< cells x 4 x kFloatsOfVertex
    float* numbers = nullptr;   ///< cells x cellNumbers()
  };
  static constexpr std::size_t kBatchCells = 1 << 16;
  /// Memory for kBatchCells cells.
  Batch nextBatch();
  /// Draws the first `cells` of the batch over the earlier ones, in their order.
  void draw(std::size_t cells);
  /// Draws the batch's single cell, which contains the eye.
  /// @param eye_value  the field's value at the eye
  void drawAround(float eye_value);
  /// Ends the picture: colours are premultiplied, the first row is the top one.
  void fetch(Image& image);

  /// Floats sent since begin().
  std::size_t sentFloats() const;
  /// Drawing time of the last fetched picture's batches on the device, by its clock.
  double drawMs() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace emscape::render::gl
