/// The pattern `adaptive`: rays are cast where the picture cannot be predicted.
///
/// A lattice of every fourth pixel is cast. The pixels between are filled in four passes, at half and then at
/// a quarter of the lattice's spacing: the centres of the cells, then the middles of their sides. Each
/// midpoint is predicted from the pixels known so far (adaptive_predict.h); if the estimated error of the
/// prediction exceeds a tolerance, the ray is cast. The rays of a pass are collected and cast together.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "emscape/render/picture/image.h"
#include "render/patterns/adaptive_pass.h"
#include "render/patterns/adaptive_tolerance.h"
#include "render/patterns/reconstruction.h"
#include "render/scene/silhouette.h"

namespace emscape::render {

/// Classes of a prediction's estimated error; each is about twice the previous one.
constexpr int kErrorClasses = 16;

/// Draws frames of this pattern; keeps its buffers between them. Results do not depend on the number of
/// threads. For one thread.
class AdaptiveFrame {
 public:
  /// Casts pixels into the current image; neighbours in the list are usually neighbours in the picture.
  /// @return false if stopped
  using Caster = std::function<bool(const std::vector<Pixel>& pixels)>;

  /// Draws a frame.
  /// @param image   of the picture's size; every pixel is written, those outside as transparent black
  /// @param inside  the pixels that may be visible; one entry per row of the image
  /// @param tolerance_levels  see kDefaultTolerance_levels; 0: only pixels with a certain prediction are not
  /// cast
  /// @param max_rays  > 0: while frames cast more, the tolerance is raised from frame to frame; otherwise it
  /// is lowered again
  /// @return false if it was stopped
  bool draw(Image& image, const Silhouette& inside, double tolerance_levels, double max_rays,
            const Caster& cast);

  /// The predicted pixels of the last frame, in order of decreasing estimated error (to a factor of two,
  /// neighbours together). When all are cast, the image is that of the pattern `full`.
  const std::vector<Pixel>& missing();

 private:
  /// Appends the rays of a row of blocks that begins at an image row.
  using RowQueuer = std::function<void(int first_y, std::vector<Pixel>& queue)>;

  void clear(Image& image, const Silhouette& inside);
  void queueRows(int block_height, const RowQueuer& row);
  void joinQueues();

  ImageSize size_;
  ToleranceController hold_;
  std::vector<std::uint8_t>
      classes_;  ///< class of the estimated error, one byte per pixel; 0: the pixel was cast
  std::vector<std::vector<Pixel>> queues_;  ///< rays to be cast, by rows of blocks
  std::vector<Pixel> queue_;                ///< the same, joined
  std::vector<Pixel> missing_;
  std::vector<std::array<std::uint32_t, kErrorClasses>>
      places_;  ///< in missing_, by rows of blocks and class
};

}  // namespace emscape::render
