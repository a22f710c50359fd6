#include "apps/view/picture_texture.h"

#include <epoxy/gl.h>

namespace emscape::view {

PictureTexture::PictureTexture() {
  glGenTextures(1, &texture_);
  glBindTexture(GL_TEXTURE_2D, texture_);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
  glGenFramebuffers(1, &framebuffer_);
  glGenBuffers(1, &buffer_);
}

PictureTexture::~PictureTexture() {
  shared_buffer_.reset();
  glDeleteBuffers(1, &buffer_);
  glDeleteFramebuffers(1, &framebuffer_);
  glDeleteTextures(1, &texture_);
}

void PictureTexture::set(const render::Image8& image) {
  setPixels(image.size, image.rgba.data());
}

void PictureTexture::set(const render::DevicePicture& picture) {
  if (buffer_size_ != picture.size()) {
    shared_buffer_.reset();
    buffer_size_ = {};
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, buffer_);
    glBufferData(GL_PIXEL_UNPACK_BUFFER, static_cast<GLsizeiptr>(4 * picture.size().count()), nullptr,
                 GL_STREAM_DRAW);
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
    shared_buffer_ = std::make_unique<render::GlPixelBuffer>(buffer_, picture.size());
    buffer_size_ = picture.size();
  }
  shared_buffer_->fill(picture);
  glBindBuffer(GL_PIXEL_UNPACK_BUFFER, buffer_);
  setPixels(picture.size(), nullptr);
  glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
}

void PictureTexture::setPixels(render::ImageSize size, const void* pixels) {
  glBindTexture(GL_TEXTURE_2D, texture_);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  if (size_ == size) {
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, size.width, size.height, GL_RGBA, GL_UNSIGNED_BYTE, pixels);
    return;
  }
  size_ = size;
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, size.width, size.height, 0, GL_RGBA, GL_UNSIGNED_BYTE, pixels);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_);
  glFramebufferTexture2D(GL_READ_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture_, 0);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
}

void PictureTexture::draw(int left, int bottom, int width, int height) const {
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_FRAMEBUFFER_SRGB);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_);
  // The first row of the picture is the top one.
  glBlitFramebuffer(0, 0, size_.width, size_.height, left, bottom + height, left + width, bottom,
                    GL_COLOR_BUFFER_BIT, GL_NEAREST);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
}

}  // namespace emscape::view
