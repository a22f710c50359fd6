/// A picture of two fields with one camera: the left part of one, the right part of the other.
#pragma once

#include <array>

#include "emscape/render/scene/renderer.h"

namespace emscape::playback {

/// The renderer of the left part, and the casts of both parts. The right part has a renderer of its own.
class SplitPicture {
 public:
  explicit SplitPicture(const render::RendererOptions& options) : left_(options) {}

  render::Renderer& left() { return left_; }
  /// Columns of the left part: at least one, as of the right part.
  int column() const { return column_; }
  /// @param size  of the picture, at least two pixels wide  @param part  of its width, for the left
  void setView(const render::Camera& camera, render::ImageSize size, double part, render::Renderer& right);

  /// As Renderer::draw() and restore(), of the size of the view. @param right  of setView()
  render::FrameReport draw(const render::FramePlan& plan, render::Renderer& right, render::Image& picture,
                           const StopFlag* stop);
  render::FrameReport restore(render::Renderer& right, render::Image& picture, const StopFlag* stop,
                              render::Edges edges);
  render::Image fullCast(render::Renderer& right);

 private:
  render::FrameReport joined(const render::FrameReport& left, const render::FrameReport& right,
                             render::Image& picture) const;

  render::Renderer left_;
  render::ImageSize size_;
  int column_ = 0;
  std::array<render::ImageSize, 2> sizes_;
  std::array<render::Image, 2> images_;  ///< of the last frame
};

}  // namespace emscape::playback
