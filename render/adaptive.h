/// The pattern `adaptive`: rays are cast where the picture cannot be predicted.
///
/// A lattice of every fourth pixel is cast. What lies between is filled in four passes, at half and then at a
/// quarter of its distance: the centres of the cells, then the middles of their sides. Each such midpoint is
/// predicted from the pixels that are known by then (adaptive_predict.h); where the prediction's estimated
/// error exceeds a tolerance the ray is cast. Rays are collected a pass at a time and cast together.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "render/image.h"
#include "render/reconstruction.h"
#include "render/silhouette.h"

namespace emscape::render {

/// Estimated error (levels of 255) above which a pixel is cast. The first passes, whose errors spread, are
/// held to a part of it.
constexpr double kDefaultTolerance_levels = 0.6;
constexpr double kLeastTolerance_levels = 1.0 / 16;
constexpr double kLargestTolerance_levels = 64;

/// Part of the pixels whose rays meet the volume's box that a frame aims to cast at most: that of `quarter`.
constexpr double kDefaultRayShare = 0.25;

/// The tolerance of the next frame: that of the last one, moved such that what a frame costs (time, or rays)
/// approaches a budget smoothly, at most by a factor of two a frame.
/// @param cost    of the last frame, >= 0
/// @param budget  in the unit of `cost`, > 0
/// @return        kLeastTolerance_levels..kLargestTolerance_levels
double nextTolerance_levels(double tolerance_levels, double cost, double budget);

/// Draws frames of this pattern; keeps its buffers between them. Results do not depend on the number of
/// threads. One thread calls it.
class AdaptiveFrame {
 public:
  static constexpr int kErrorClasses = 16;

  /// Casts pixels into the image that is being drawn; neighbours in the list mostly are neighbours in the
  /// picture. @return false: stopped
  using Caster = std::function<bool(const std::vector<Pixel>& pixels)>;

  /// Draws a frame.
  /// @param image   of the size that the picture has; every pixel is written, those outside as transparent
  /// black
  /// @param inside  the pixels that may show something; one row for each of the image's
  /// @param tolerance_levels  see kDefaultTolerance_levels; 0: only what is predicted without doubt is not
  /// cast
  /// @param most_rays  > 0: while frames cast more, the tolerance is raised from one frame to the next, and
  /// lowered again when they do not
  /// @return false if it was stopped
  bool draw(Image& image, const Silhouette& inside, double tolerance_levels, double most_rays,
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

  void holdTo(double tolerance_levels, double rays, double most_rays);

  ImageSize size_;
  double held_tolerance_levels_ = 0;  ///< keeps to most_rays; counts where it is the larger one
  double last_tolerance_levels_ = 1, last_rays_ = 1;  ///< of the last frame
  double power_ = 0.5;                      ///< rays are taken as proportional to 1 / tolerance to this power
  std::vector<std::uint8_t> classes_;       ///< of the estimated error, a byte a pixel; 0: is as it was cast
  std::vector<std::vector<Pixel>> queues_;  ///< rays to be cast, by rows of blocks
  std::vector<Pixel> queue_;                ///< the same, joined
  std::vector<Pixel> missing_;
  std::vector<std::array<std::uint32_t, kErrorClasses>>
      places_;  ///< in missing_, by rows of blocks and class
};

}  // namespace emscape::render
