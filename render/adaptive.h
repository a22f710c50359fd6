/// The pattern `adaptive`: rays are cast where the picture cannot be predicted.
///
/// A lattice of every fourth pixel is cast. The pixels between are filled in four passes, at half and then at
/// a quarter of its distance: the centres of the cells, then the middles of their sides. Each such midpoint
/// is predicted from the pixels that are known by then (adaptive_predict.h); where the prediction's estimated
/// error exceeds a tolerance the ray is cast. Rays are collected a pass at a time and cast together.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "emscape/render/image.h"
#include "render/adaptive_pass.h"
#include "render/adaptive_tolerance.h"
#include "render/reconstruction.h"
#include "render/silhouette.h"

namespace emscape::render {

/// Classes of a prediction's estimated error; each is about twice the one before.
constexpr int kErrorClasses = 16;

/// Draws frames of this pattern; keeps its buffers between them. Results do not depend on the number of
/// threads. One thread calls it.
class AdaptiveFrame {
 public:
  /// Casts pixels into the image that is being drawn; neighbours in the list mostly are neighbours in the
  /// picture. @return false: stopped
  using Caster = std::function<bool(const std::vector<Pixel>& pixels)>;

  /// Draws a frame.
  /// @param image   of the size that the picture has; every pixel is written, those outside as transparent
  /// black
  /// @param inside  the pixels that may show something; one row for each of the image's
  /// @param tolerance_levels  see kDefaultTolerance_levels; 0: only what is predicted without doubt is not
  /// cast
  /// @param max_rays  > 0: while frames cast more, the tolerance is raised from one frame to the next, and
  /// lowered again when they do not
  /// @return false if it was stopped
  bool draw(Image& image, const Silhouette& inside, double tolerance_levels, double max_rays,
            const Caster& cast);

  /// The pixels of the last frame that were predicted, those with the largest estimated error first (to a
  /// factor of two, neighbours together). All of them cast, the image is that of the pattern `full`.
  const std::vector<Pixel>& missing();

 private:
  /// Appends the rays of a row of blocks that begins at an image row.
  using RowQueuer = std::function<void(int first_y, std::vector<Pixel>& queue)>;

  void clear(Image& image, const Silhouette& inside);
  void queueRows(int block_height, const RowQueuer& row);
  void joinQueues();

  ImageSize size_;
  ToleranceController hold_;
  std::vector<std::uint8_t> classes_;       ///< of the estimated error, a byte a pixel; 0: is as it was cast
  std::vector<std::vector<Pixel>> queues_;  ///< rays to be cast, by rows of blocks
  std::vector<Pixel> queue_;                ///< the same, joined
  std::vector<Pixel> missing_;
  std::vector<std::array<std::uint32_t, kErrorClasses>>
      places_;  ///< in missing_, by rows of blocks and class
};

}  // namespace emscape::render
