#include "apps/view/picture_layers.h"

#include <epoxy/gl.h>

#include <string>

#include "emscape/base/error.h"

namespace emscape::view {
namespace {

constexpr const char* kVertexShader = R"(#version 330 core
out vec2 position;
void main() {
  position = vec2(gl_VertexID & 1, gl_VertexID >> 1);
  gl_Position = vec4(2.0 * position - 1.0, 0.0, 1.0);
})";
constexpr const char* kFragmentShader = R"(#version 330 core
uniform sampler2D picture;
in vec2 position;
out vec4 color;
void main() { color = texture(picture, vec2(position.x, 1.0 - position.y)); })";

unsigned compiled(GLenum kind, const char* source) {
  const unsigned shader = glCreateShader(kind);
  glShaderSource(shader, 1, &source, nullptr);
  glCompileShader(shader);
  int ok = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &ok);
  if (ok != 0) return shader;
  std::string log(1024, '\0');
  glGetShaderInfoLog(shader, static_cast<int>(log.size()), nullptr, log.data());
  throw Error(ErrorCode::device, "OpenGL does not compile a shader: " + std::string(log.c_str()));
}

}  // namespace

PictureLayers::PictureLayers() {
  const unsigned vertex = compiled(GL_VERTEX_SHADER, kVertexShader);
  const unsigned fragment = compiled(GL_FRAGMENT_SHADER, kFragmentShader);
  program_ = glCreateProgram();
  glAttachShader(program_, vertex);
  glAttachShader(program_, fragment);
  glLinkProgram(program_);
  glDeleteShader(vertex);
  glDeleteShader(fragment);
  glGenVertexArrays(1, &vertices_);
  glGenTextures(kCount, textures_.data());
  for (const unsigned texture : textures_) {
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  }
}

PictureLayers::~PictureLayers() {
  glDeleteTextures(kCount, textures_.data());
  glDeleteVertexArrays(1, &vertices_);
  glDeleteProgram(program_);
}

void PictureLayers::set(int layer, const render::Image8& image) {
  const auto index = static_cast<std::size_t>(layer);
  glBindTexture(GL_TEXTURE_2D, textures_[index]);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  if (sizes_[index] == image.size) {
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, image.size.width, image.size.height, GL_RGBA, GL_UNSIGNED_BYTE,
                    image.rgba.data());
  } else {
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, image.size.width, image.size.height, 0, GL_RGBA,
                 GL_UNSIGNED_BYTE, image.rgba.data());
    sizes_[index] = image.size;
  }
}

void PictureLayers::draw(int left, int bottom, int width, int height) const {
  glViewport(left, bottom, width, height);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_FRAMEBUFFER_SRGB);
  glEnable(GL_BLEND);
  glBlendEquation(GL_FUNC_ADD);
  glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  glUseProgram(program_);
  glBindVertexArray(vertices_);
  glActiveTexture(GL_TEXTURE0);
  for (std::size_t i = 0; i < kCount; ++i) {
    if (sizes_[i].count() == 0) continue;
    glBindTexture(GL_TEXTURE_2D, textures_[i]);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  }
  glBindVertexArray(0);
  glUseProgram(0);
}

}  // namespace emscape::view
