#include "render/cells/cell_rasterizer.h"

#include <epoxy/gl.h>
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <limits>
#include <thread>
#include <utility>

#include "emscape/base/error.h"
#include "render/cells/gl/cell_shaders.h"
#include "render/cells/gl/offscreen_context.h"

namespace emscape::render::gl {
namespace {

/// Owner of an OpenGL object, which it deletes.
template <auto kDelete>
class Name {
 public:
  Name() = default;
  explicit Name(GLuint name) : name_(name) {}
  Name(Name&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
  Name& operator=(Name&& other) noexcept {
    std::swap(name_, other.name_);
    return *this;
  }
  ~Name() {
    if (name_ != 0) kDelete(name_);
  }
  operator GLuint() const { return name_; }

 private:
  GLuint name_ = 0;
};
// libepoxy's functions are pointers that it sets at the first call: no template arguments.
void deleteBuffer(GLuint name) {
  glDeleteBuffers(1, &name);
}
void deleteTexture(GLuint name) {
  glDeleteTextures(1, &name);
}
void deleteFramebuffer(GLuint name) {
  glDeleteFramebuffers(1, &name);
}
void deleteVertexArray(GLuint name) {
  glDeleteVertexArrays(1, &name);
}
void deleteQuery(GLuint name) {
  glDeleteQueries(1, &name);
}
void deleteProgram(GLuint name) {
  glDeleteProgram(name);
}
using Buffer = Name<deleteBuffer>;
using Texture = Name<deleteTexture>;
using Framebuffer = Name<deleteFramebuffer>;
using VertexArray = Name<deleteVertexArray>;
using Query = Name<deleteQuery>;
using Program = Name<deleteProgram>;

template <class Named, class Generate>
Named made(Generate generate) {
  GLuint name = 0;
  generate(1, &name);
  return Named(name);
}

GLuint compiled(GLenum kind, const char* text) {
  const GLuint shader = glCreateShader(kind);
  glShaderSource(shader, 1, &text, nullptr);
  glCompileShader(shader);
  GLint ok = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &ok);
  if (ok) return shader;
  std::array<char, 1024> log{};
  glGetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), nullptr, log.data());
  throw Error(ErrorCode::device, fmt::format("OpenGL does not compile a shader: {}", log.data()));
}

Program linked() {
  Program program(glCreateProgram());
  for (const GLuint shader :
       {compiled(GL_VERTEX_SHADER, kCellVertexShader), compiled(GL_FRAGMENT_SHADER, kCellFragmentShader)}) {
    glAttachShader(program, shader);
    glDeleteShader(shader);
  }
  glLinkProgram(program);
  GLint ok = 0;
  glGetProgramiv(program, GL_LINK_STATUS, &ok);
  if (ok) return program;
  std::array<char, 1024> log{};
  glGetProgramInfoLog(program, static_cast<GLsizei>(log.size()), nullptr, log.data());
  throw Error(ErrorCode::device, fmt::format("OpenGL does not link the shaders: {}", log.data()));
}

/// Buffer texture, whose elements shaders fetch by index.
struct BufferTexture {
  Buffer buffer = made<Buffer>(glGenBuffers);
  Texture texture = made<Texture>(glGenTextures);

  explicit BufferTexture(GLenum format) {
    glBindBuffer(GL_TEXTURE_BUFFER, buffer);
    glBindTexture(GL_TEXTURE_BUFFER, texture);
    glTexBuffer(GL_TEXTURE_BUFFER, format, buffer);
  }
};

void setNearest() {
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
}

/// Units of the textures.
enum Unit : GLint { kCellNumbers, kIntervals, kPsi, kEnd };

constexpr int kBatches = 3;  ///< being filled, waiting, being drawn
/// Triangle strip with each face once, all with the same winding.
constexpr GLuint kStrip[] = {0, 1, 2, 3, 0, 1};
constexpr GLsizeiptr kVertexBytes = CellRasterizer::kBatchCells * 4 * kFloatsOfVertex * sizeof(float);
GLsizeiptr numberBytes(CellProjection projection) {
  return static_cast<GLsizeiptr>(CellRasterizer::kBatchCells *
                                 static_cast<std::size_t>(cellNumbers(projection)) * sizeof(float));
}
constexpr GLuint kRestart = 0xffffffffu;

/// To clip coordinates from positions relative to the eye; their depth is always within.
std::array<float, 16> clipFromEye(const CameraView& camera) {
  const DepthAxes axes(camera);
  const double narrow = static_cast<double>(camera.size.height) / camera.size.width;
  const Vec3d x = axes.right * (narrow / camera.half_height), y = axes.up * (1 / camera.half_height);
  std::array<float, 16> matrix{};
  const auto setRow = [&](int row, const Vec3d& v, double last) {
    const double numbers[] = {v.x, v.y, v.z, last};
    std::transform(numbers, numbers + 4, matrix.begin() + 4 * row,
                   [](double n) { return static_cast<float>(n); });
  };
  if (camera.orthographic) {
    setRow(0, x, -camera.shift_x * narrow);
    setRow(1, y, -camera.shift_y);
    setRow(3, {0, 0, 0}, 1);
  } else {
    setRow(0, x - axes.depth * (camera.shift_x * narrow), 0);
    setRow(1, y - axes.depth * camera.shift_y, 0);
    setRow(3, axes.depth, 0);
  }
  return matrix;
}

void setVector(GLint place, const Vec3d& v) {
  glUniform3f(place, static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z));
}

}  // namespace

struct CellRasterizer::Impl {
  OffscreenContext context;
  Program program = linked();
  std::array<VertexArray, kBatches> arrays;
  std::array<Buffer, kBatches> vertices;
  std::vector<BufferTexture> cell_numbers;
  Buffer strips = made<Buffer>(glGenBuffers);
  BufferTexture intervals{GL_RGBA32F};
  Texture psi = made<Texture>(glGenTextures), end = made<Texture>(glGenTextures),
          picture = made<Texture>(glGenTextures);
  Framebuffer framebuffer = made<Framebuffer>(glGenFramebuffers);
  ImageSize size;
  CellProjection projection = CellProjection::exact;
  int batch = 0;
  std::size_t sent = 0;
  std::vector<Query> timers;  ///< of each batch
  std::size_t drawn = 0;      ///< batches
  double draw_ms = 0;

  GLint placeOf(const char* name) const { return glGetUniformLocation(program, name); }

  Impl() {
    std::vector<GLuint> indices;
    indices.reserve(kBatchCells * 7);
    for (GLuint cell = 0; cell < kBatchCells; ++cell) {
      for (const GLuint corner : kStrip) indices.push_back(4 * cell + corner);
      indices.push_back(kRestart);
    }
    for (int b = 0; b < kBatches; ++b) {
      arrays[b] = made<VertexArray>(glGenVertexArrays);
      vertices[b] = made<Buffer>(glGenBuffers);
      cell_numbers.emplace_back(GL_R32F);
      glBindVertexArray(arrays[b]);
      glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, strips);
    }
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(indices.size() * sizeof(GLuint)),
                 indices.data(), GL_STATIC_DRAW);
    for (const GLuint texture : {GLuint(psi), GLuint(end), GLuint(picture)}) {
      glBindTexture(GL_TEXTURE_2D, texture);
      setNearest();
    }
    glBindTexture(GL_TEXTURE_2D, psi);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_R32F, PsiLookup::kEntries, PsiLookup::kEntries, 0, GL_RED, GL_FLOAT,
                 PsiTable::shared().lookup().values);
    glUseProgram(program);
    glUniform1i(placeOf("cell_numbers"), kCellNumbers);
    glUniform1i(placeOf("intervals"), kIntervals);
    glUniform1i(placeOf("psi_table"), kPsi);
    glUniform1i(placeOf("end_depth"), kEnd);
  }

  void setSize(ImageSize wanted) {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    if (size == wanted) return;
    size = wanted;
    glActiveTexture(GL_TEXTURE0 + kEnd);
    glBindTexture(GL_TEXTURE_2D, picture);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, size.width, size.height, 0, GL_RGBA, GL_FLOAT, nullptr);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, picture, 0);
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
      throw Error(ErrorCode::device, "OpenGL does not draw into pictures of 32-bit floats");
    }
  }

  void setEnd(const std::vector<float>& depths) {
    glUniform1i(placeOf("has_end"), depths.empty() ? 0 : 1);
    if (depths.empty()) return;
    // OpenGL's first row is the lowest.
    std::vector<float> rows(depths.size());
    const auto width = static_cast<std::size_t>(size.width);
    for (std::size_t y = 0; y < static_cast<std::size_t>(size.height); ++y) {
      std::copy_n(depths.end() - static_cast<std::ptrdiff_t>((y + 1) * width), width,
                  rows.begin() + static_cast<std::ptrdiff_t>(y * width));
    }
    glActiveTexture(GL_TEXTURE0 + kEnd);
    glBindTexture(GL_TEXTURE_2D, end);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_R32F, size.width, size.height, 0, GL_RED, GL_FLOAT, rows.data());
  }
};

CellRasterizer::CellRasterizer() : impl_(std::make_unique<Impl>()) {
  impl_->context.release();
}
CellRasterizer::~CellRasterizer() {
  // On a thread without a context: the caller's may have that of a window, which EGL does not replace.
  std::thread([this] {
    try {
      impl_->context.makeCurrent();
      impl_.reset();
    } catch (const Error&) {
      impl_.release();  // its names cannot be deleted
    }
  }).join();
}

CellRasterizer::Use::Use(CellRasterizer& rasterizer) : rasterizer_(rasterizer) {
  rasterizer_.impl_->context.makeCurrent();
}
CellRasterizer::Use::~Use() {
  rasterizer_.impl_->context.release();
}

const std::string& CellRasterizer::device() const {
  return impl_->context.name();
}
std::size_t CellRasterizer::sentFloats() const {
  return impl_->sent;
}
double CellRasterizer::drawMs() const {
  return impl_->draw_ms;
}

void CellRasterizer::setTransfer(const LinearTransfer& transfer) {
  std::vector<float> texels;
  const auto put = [&](double value) {
    constexpr double kLargest = std::numeric_limits<float>::max();
    texels.push_back(static_cast<float>(std::clamp(value, -kLargest, kLargest)));
  };
  for (const TransferInterval& interval : transfer.intervals()) {
    put(interval.lower), put(interval.upper), put(interval.extinction[0]), put(interval.extinction[1]);
    texels.insert(texels.end(), {interval.color[0].r, interval.color[0].g, interval.color[0].b,
                                 interval.clear     ? 0.0f
                                 : interval.uniform ? 1.0f
                                                    : 2.0f});
    texels.insert(texels.end(), {interval.color[1].r, interval.color[1].g, interval.color[1].b, 0.0f});
  }
  glBindBuffer(GL_TEXTURE_BUFFER, impl_->intervals.buffer);
  glBufferData(GL_TEXTURE_BUFFER, static_cast<GLsizeiptr>(texels.size() * sizeof(float)), texels.data(),
               GL_STATIC_DRAW);
  glUseProgram(impl_->program);
  glUniform1i(impl_->placeOf("interval_count"), static_cast<GLint>(transfer.intervals().size()));
}

void CellRasterizer::begin(const CellView& view) {
  Impl& impl = *impl_;
  impl.setSize(view.camera.size);
  impl.sent = impl.drawn = 0;
  impl.projection = view.projection;
  const bool is_published = view.projection == CellProjection::published;
  glUseProgram(impl.program);
  glUniformMatrix4fv(impl.placeOf("clip_from_eye"), 1, GL_TRUE, clipFromEye(view.camera).data());
  glUniform2f(impl.placeOf("picture_size"), static_cast<float>(view.camera.size.width),
              static_cast<float>(view.camera.size.height));
  glUniform1i(impl.placeOf("is_perspective"), view.camera.orthographic ? 0 : 1);
  glUniform1i(impl.placeOf("sends_changes"), is_published ? 1 : 0);
  setVector(impl.placeOf("depth_of"), DepthAxes(view.camera).depth);
  glUniform1f(impl.placeOf("steps_per_depth"), static_cast<float>(length(view.camera.forward)));
  glUniform1i(impl.placeOf("holds_eye"), 0);
  impl.setEnd(view.end_depth);

  const auto bind = [](Unit unit, GLenum kind, GLuint texture) {
    glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    glBindTexture(kind, texture);
  };
  bind(kIntervals, GL_TEXTURE_BUFFER, impl.intervals.texture);
  bind(kPsi, GL_TEXTURE_2D, impl.psi);
  bind(kEnd, GL_TEXTURE_2D, impl.end);

  for (int b = 0; b < kBatches; ++b) {
    glBindVertexArray(impl.arrays[b]);
    glBindBuffer(GL_ARRAY_BUFFER, impl.vertices[b]);
    glBufferData(GL_ARRAY_BUFFER, kVertexBytes, nullptr, GL_STREAM_DRAW);
    glBindBuffer(GL_TEXTURE_BUFFER, impl.cell_numbers[b].buffer);
    glBufferData(GL_TEXTURE_BUFFER, numberBytes(impl.projection), nullptr, GL_STREAM_DRAW);
    const auto attribute = [&](GLuint place, int count, int first) {
      glEnableVertexAttribArray(place);
      glVertexAttribPointer(place, count, GL_FLOAT, GL_FALSE, kFloatsOfVertex * sizeof(float),
                            reinterpret_cast<const void*>(first * sizeof(float)));
    };
    attribute(0, 3, 0);
    attribute(1, 1, 3);
  }
  glViewport(0, 0, view.camera.size.width, view.camera.size.height);
  glDisable(GL_DEPTH_TEST);
  glEnable(GL_CULL_FACE);
  glCullFace(GL_BACK);
  glFrontFace(GL_CW);  // of the strip's triangles, seen from outside
  glEnable(GL_PRIMITIVE_RESTART);
  glPrimitiveRestartIndex(kRestart);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  glClearColor(0, 0, 0, 0);
  glClear(GL_COLOR_BUFFER_BIT);
}

CellRasterizer::Batch CellRasterizer::nextBatch() {
  Impl& impl = *impl_;
  impl.batch = (impl.batch + 1) % kBatches;
  constexpr GLbitfield kAccess = GL_MAP_WRITE_BIT | GL_MAP_INVALIDATE_BUFFER_BIT;
  Batch batch;
  glBindBuffer(GL_ARRAY_BUFFER, impl.vertices[impl.batch]);
  batch.vertices = static_cast<float*>(glMapBufferRange(GL_ARRAY_BUFFER, 0, kVertexBytes, kAccess));
  glBindBuffer(GL_TEXTURE_BUFFER, impl.cell_numbers[impl.batch].buffer);
  batch.numbers =
      static_cast<float*>(glMapBufferRange(GL_TEXTURE_BUFFER, 0, numberBytes(impl.projection), kAccess));
  if (batch.vertices == nullptr || batch.numbers == nullptr) {
    throw Error(ErrorCode::device, "OpenGL has no memory for the cells");
  }
  return batch;
}

void CellRasterizer::draw(std::size_t cells) {
  Impl& impl = *impl_;
  glBindBuffer(GL_ARRAY_BUFFER, impl.vertices[impl.batch]);
  glUnmapBuffer(GL_ARRAY_BUFFER);
  glBindBuffer(GL_TEXTURE_BUFFER, impl.cell_numbers[impl.batch].buffer);
  glUnmapBuffer(GL_TEXTURE_BUFFER);
  glActiveTexture(GL_TEXTURE0 + kCellNumbers);
  glBindTexture(GL_TEXTURE_BUFFER, impl.cell_numbers[impl.batch].texture);
  glBindVertexArray(impl.arrays[impl.batch]);
  if (impl.drawn == impl.timers.size()) impl.timers.push_back(made<Query>(glGenQueries));
  glBeginQuery(GL_TIME_ELAPSED, impl.timers[impl.drawn++]);
  glDrawElements(GL_TRIANGLE_STRIP, static_cast<GLsizei>(7 * cells), GL_UNSIGNED_INT, nullptr);
  glEndQuery(GL_TIME_ELAPSED);
  impl.sent += cells * static_cast<std::size_t>(floatsOfCell(impl.projection));
}

void CellRasterizer::drawAround(float eye_value) {
  glCullFace(GL_FRONT);
  glUniform1i(impl_->placeOf("holds_eye"), 1);
  glUniform1f(impl_->placeOf("eye_value"), eye_value);
  draw(1);
  glUniform1i(impl_->placeOf("holds_eye"), 0);
  glCullFace(GL_BACK);
}

void CellRasterizer::fetch(Image& image) {
  image = Image(impl_->size);
  const auto width = static_cast<std::size_t>(image.size.width);
  std::vector<Rgba> rows(image.pixels.size());
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  glReadPixels(0, 0, image.size.width, image.size.height, GL_RGBA, GL_FLOAT, rows.data());
  if (const GLenum fault = glGetError(); fault != GL_NO_ERROR) {
    throw Error(ErrorCode::device, fmt::format("OpenGL: error 0x{:04x} while cells were drawn", fault));
  }
  impl_->draw_ms = 0;
  for (std::size_t n = 0; n < impl_->drawn; ++n) {
    GLuint64 elapsed_ns = 0;
    glGetQueryObjectui64v(impl_->timers[n], GL_QUERY_RESULT, &elapsed_ns);
    impl_->draw_ms += 1e-6 * static_cast<double>(elapsed_ns);
  }
  for (std::size_t y = 0; y < static_cast<std::size_t>(image.size.height); ++y) {
    std::copy_n(rows.end() - static_cast<std::ptrdiff_t>((y + 1) * width), width,
                image.pixels.begin() + static_cast<std::ptrdiff_t>(y * width));
  }
}

}  // namespace emscape::render::gl
