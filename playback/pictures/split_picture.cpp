#include "playback/pictures/split_picture.h"

#include <algorithm>
#include <cmath>

namespace emscape::playback {
namespace {

/// @return left and right, beside each other
void join(const std::array<render::Image, 2>& parts, render::ImageSize size, render::Image& picture) {
  if (picture.size != size) picture = render::Image(size);
  for (int y = 0; y < size.height; ++y) {
    auto to = picture.pixels.begin() + static_cast<std::ptrdiff_t>(y) * size.width;
    for (const render::Image& part : parts) {
      const auto row = part.pixels.begin() + static_cast<std::ptrdiff_t>(y) * part.size.width;
      to = std::copy(row, row + part.size.width, to);
    }
  }
}

}  // namespace

void SplitPicture::setView(const render::Camera& camera, render::ImageSize size, double part,
                           render::Renderer& right) {
  size_ = size;
  column_ = std::clamp(static_cast<int>(std::lround(part * size.width)), 1, std::max(size.width - 1, 1));
  sizes_ = {render::ImageSize{column_, size.height}, render::ImageSize{size.width - column_, size.height}};
  render::Camera of_part = camera;
  of_part.shift_x = camera.shift_x + static_cast<double>(column_ - size.width) / size.height;
  left_.setCamera(of_part);
  of_part.shift_x = camera.shift_x + static_cast<double>(column_) / size.height;
  right.setCamera(of_part);
}

render::FrameReport SplitPicture::draw(const render::FramePlan& plan, render::Renderer& right,
                                       render::Image& picture, const StopFlag* stop) {
  const render::FrameReport of_left = left_.draw(plan, sizes_[0], images_[0], stop);
  if (!of_left.complete) return of_left;
  return joined(of_left, right.draw(plan, sizes_[1], images_[1], stop), picture);
}

render::FrameReport SplitPicture::restore(render::Renderer& right, render::Image& picture,
                                          const StopFlag* stop, render::Edges edges) {
  const render::FrameReport of_left = left_.restore(images_[0], stop, edges);
  if (!of_left.complete) return of_left;
  return joined(of_left, right.restore(images_[1], stop, edges), picture);
}

render::Image SplitPicture::fullCast(render::Renderer& right) {
  render::Image picture;
  join({left_.render(sizes_[0]), right.render(sizes_[1])}, size_, picture);
  return picture;
}

render::FrameReport SplitPicture::joined(const render::FrameReport& left, const render::FrameReport& right,
                                         render::Image& picture) const {
  render::FrameReport both = right;
  both.rays += left.rays;
  both.samples += left.samples;
  both.cast_ms += left.cast_ms;
  both.interpolate_ms += left.interpolate_ms;
  if (both.complete) join(images_, size_, picture);
  return both;
}

}  // namespace emscape::playback
