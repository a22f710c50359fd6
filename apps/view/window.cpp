#include "apps/view/window.h"

#include <epoxy/gl.h>
// epoxy first
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <dlfcn.h>
#include <imgui.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <mutex>
#include <utility>
#include <vector>

#include "apps/view/widgets/glyphs.h"
#include "apps/view/widgets/theme.h"
#include "base/limits/address_limit.h"
#include "base/memory.h"
#include "emscape/base/error.h"

namespace emscape::view {
namespace {

constexpr const char* kFont = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
constexpr float kFont_px = 14.5F;
constexpr ImWchar kMissing = 0x25A1;  // a box

std::string last_error;
std::mutex alive_mutex;
bool alive = false;
std::atomic<bool> woken{false};

void keepError(int, const char* text) {
  last_error = text;
}

[[noreturn]] void refuse(const std::string& what) {
  // GLFW appends the display's name, which may be empty.
  last_error.erase(last_error.find_last_not_of(' ') + 1);
  throw Error(ErrorCode::device, what + (last_error.empty() ? "" : ": " + last_error) +
                                     "; 'emscape render' draws pictures and videos without a window");
}

/// Xlib ends the process when this returns.
[[noreturn]] int endWithoutDisplay(void* /*display*/) {
  std::fputs("emscape-view: error: the connection to the display is lost\n", stderr);
  std::_Exit(static_cast<int>(ErrorCode::device));
}

/// The library is GLFW's: with other systems of windows it is not loaded.
void catchLostDisplay() {
  using Handler = int (*)(void*);
  void* const xlib = dlopen("libX11.so.6", RTLD_LAZY | RTLD_NOLOAD);
  if (!xlib) return;
  if (void* const set = dlsym(xlib, "XSetIOErrorHandler")) {
    reinterpret_cast<Handler (*)(Handler)>(set)(endWithoutDisplay);
  }
  dlclose(xlib);
}

/// The icon of desktop/emscape.svg: waves from an antenna over the ground.
void setIcon(GLFWwindow* window) {
  constexpr int kSide = 64;
  std::vector<unsigned char> pixels(std::size_t{kSide} * kSide * 4, 0);
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const double right = x - 18.5, up = 45.5 - y, away = std::hypot(right, up);
      const bool is_wave = up > 0 && right > 0 && std::fmod(away + 3, 13) < 6 && away > 7;
      const bool is_mast = away < 5.5 || (std::abs(right) < 2 && up < 0 && y < 54);
      const bool is_ground = y >= 54;
      const unsigned color = is_mast ? 0xF2F4F7 : is_wave ? 0x4FA3E3 : is_ground ? 0x6E7A4D : 0x181D25;
      unsigned char* const pixel =
          &pixels[4 * (static_cast<std::size_t>(y) * kSide + static_cast<std::size_t>(x))];
      pixel[0] = static_cast<unsigned char>(color >> 16);
      pixel[1] = static_cast<unsigned char>(color >> 8 & 0xFF);
      pixel[2] = static_cast<unsigned char>(color & 0xFF);
      pixel[3] = 255;
    }
  }
  const GLFWimage icon{kSide, kSide, pixels.data()};
  glfwSetWindowIcon(window, 1, &icon);
}

/// Keeps a resize from flashing: X leaves the last picture where it is until the next one is drawn, and fills
/// what is uncovered with a pixel.
void setBackground(GLFWwindow* window, unsigned long pixel) {
  using DisplayOf = void* (*)();
  using WindowOf = unsigned long (*)(GLFWwindow*);
  struct Attributes {  // the begin of XSetWindowAttributes, whose rest is not read
    unsigned long background_pixmap, background_pixel, border_pixmap, border_pixel;
    int bit_gravity;
  };
  constexpr unsigned long kBackPixel = 1 << 1, kBitGravity = 1 << 4;  // of the X protocol
  constexpr int kNorthWest = 1;
  using Set = int (*)(void* display, unsigned long window, unsigned long mask, Attributes* attributes);
  void* const xlib = dlopen("libX11.so.6", RTLD_LAZY | RTLD_NOLOAD);
  if (!xlib) return;
  void* const set = dlsym(xlib, "XChangeWindowAttributes");
  void* const display_of = dlsym(RTLD_DEFAULT, "glfwGetX11Display");
  void* const window_of = dlsym(RTLD_DEFAULT, "glfwGetX11Window");
  if (set && display_of && window_of) {
    Attributes attributes{0, pixel, 0, 0, kNorthWest};
    reinterpret_cast<Set>(set)(reinterpret_cast<DisplayOf>(display_of)(),
                               reinterpret_cast<WindowOf>(window_of)(window), kBackPixel | kBitGravity,
                               &attributes);
  }
  dlclose(xlib);
}

void setModifiers(int modifiers) {
  ImGuiIO& io = ImGui::GetIO();
  io.KeyShift = (modifiers & GLFW_MOD_SHIFT) != 0;
  io.KeyCtrl = (modifiers & GLFW_MOD_CONTROL) != 0;
  io.KeyAlt = (modifiers & GLFW_MOD_ALT) != 0;
  io.KeySuper = (modifiers & GLFW_MOD_SUPER) != 0;
}

Window& windowOf(GLFWwindow* window) {
  return *static_cast<Window*>(glfwGetWindowUserPointer(window));
}

void pushEvent(GLFWwindow* window, const InputEvent& event) {
  windowOf(window).input().push(event);
}

void installCallbacks(GLFWwindow* window) {
  using Kind = InputEvent::Kind;
  glfwSetKeyCallback(window, [](GLFWwindow* w, int key, int scancode, int action, int modifiers) {
    pushEvent(w, {Kind::key, key, scancode, action, modifiers, 0, 0});
  });
  glfwSetCharCallback(window, [](GLFWwindow* w, unsigned code) {
    pushEvent(w, {Kind::text, static_cast<int>(code), 0, 0, 0, 0, 0});
  });
  glfwSetMouseButtonCallback(window, [](GLFWwindow* w, int button, int action, int modifiers) {
    pushEvent(w, {Kind::button, button, 0, action, modifiers, 0, 0});
  });
  glfwSetCursorPosCallback(window, [](GLFWwindow* w, double x, double y) {
    pushEvent(w, {Kind::cursor, 0, 0, 0, 0, x, y});
  });
  glfwSetScrollCallback(window, [](GLFWwindow* w, double x, double y) {
    pushEvent(w, {Kind::wheel, 0, 0, 0, 0, x, y});
  });
  glfwSetCursorEnterCallback(window, [](GLFWwindow* w, int entered) {
    if (entered == 0) pushEvent(w, {Kind::left_window, 0, 0, 0, 0, 0, 0});
  });
  glfwSetWindowRefreshCallback(window, [](GLFWwindow* w) { windowOf(w).markDirty(); });
  glfwSetFramebufferSizeCallback(window, [](GLFWwindow* w, int, int) { windowOf(w).markDirty(); });
  glfwSetDropCallback(window, [](GLFWwindow* w, int count, const char** paths) {
    windowOf(w).drop({paths, paths + count});
    windowOf(w).markDirty();
  });
  glfwSetWindowCloseCallback(window, [](GLFWwindow* w) { windowOf(w).markDirty(); });
  glfwSetWindowFocusCallback(window, [](GLFWwindow* w, int focused) {
    ImGui_ImplGlfw_WindowFocusCallback(w, focused);
    windowOf(w).markDirty();
  });
}

/// Gives the window the size at a scale, as large as the screen at most.
void enlarge(GLFWwindow* window, render::ImageSize size, double scale) {
  GLFWmonitor* const monitor = glfwGetPrimaryMonitor();
  if (monitor == nullptr) return;
  int x = 0, y = 0, width = 0, height = 0;
  glfwGetMonitorWorkarea(monitor, &x, &y, &width, &height);
  glfwSetWindowSize(window, std::clamp(static_cast<int>(scale * size.width), 1, std::max(1, width)),
                    std::clamp(static_cast<int>(scale * size.height), 1, std::max(1, height)));
}

}  // namespace

Window::Window(const std::string& title, render::ImageSize size, bool scales, double scale) {
  // Of Mesa's, which ends the program where less is left.
  constexpr std::size_t kDriver_bytes = std::size_t{384} << 20;
  if (hasAddressLimit())
    requireMemory(
        {"a window with its driver of OpenGL", kDriver_bytes, "a higher limit is needed (ulimit -v)"}, {});
  last_error.clear();
  glfwSetErrorCallback(keepError);
  if (glfwInit() == GLFW_FALSE) refuse("no window can be opened");
  catchLostDisplay();
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_SRGB_CAPABLE, GLFW_FALSE);
  glfwWindowHint(GLFW_DEPTH_BITS, 0);
  // By these desktops find the program's icon and group its windows.
  glfwWindowHintString(GLFW_X11_CLASS_NAME, "emscape");
  glfwWindowHintString(GLFW_X11_INSTANCE_NAME, "emscape");
  window_ = glfwCreateWindow(size.width, size.height, title.c_str(), nullptr, nullptr);
  if (!window_) {
    glfwTerminate();
    refuse("no window with OpenGL 3.3 can be opened");
  }
  float content_x = 1, content_y = 1;
  glfwGetWindowContentScale(window_, &content_x, &content_y);
  setScale(scale > 0 ? scale : content_x);
  if (scales && scale_ > 1) enlarge(window_, size, scale_);
  setIcon(window_);
  glfwSetWindowUserPointer(window_, this);
  glfwMakeContextCurrent(window_);
  glfwSwapInterval(1);
  IMGUI_CHECKVERSION();
  ImGui::CreateContext();
  ImGui::GetIO().IniFilename = nullptr;
  ImGui_ImplGlfw_InitForOpenGL(window_, false);
  ImGui_ImplOpenGL3_Init("#version 330");
  installCallbacks(window_);
  const std::lock_guard lock(alive_mutex);
  alive = true;
}

Window::~Window() {
  {
    const std::lock_guard lock(alive_mutex);
    alive = false;
  }
  ImGui_ImplOpenGL3_Shutdown();
  ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext();
  glfwDestroyWindow(window_);
  glfwTerminate();
}

void Window::wake() {
  woken = true;
  const std::lock_guard lock(alive_mutex);
  if (alive) glfwPostEmptyEvent();
}

void Window::waitEvents(double timeout_s) {
  if (woken.exchange(false) || timeout_s == 0 || !input_.empty()) {
    glfwPollEvents();
  } else if (timeout_s < 0) {
    glfwWaitEvents();
  } else {
    glfwWaitEventsTimeout(timeout_s);
  }
}

bool Window::takeDirty() {
  const bool happened = dirty_ || !input_.empty();
  dirty_ = false;
  return happened;
}

bool Window::takeCloseRequest() {
  const bool wanted = glfwWindowShouldClose(window_) != 0;
  glfwSetWindowShouldClose(window_, GLFW_FALSE);
  return wanted;
}

std::vector<std::string> Window::takeDropped() {
  return std::exchange(dropped_, {});
}

render::ImageSize Window::framebufferSize() const {
  if (glfwGetWindowAttrib(window_, GLFW_ICONIFIED) != 0) return {0, 0};
  int width = 0, height = 0;
  glfwGetFramebufferSize(window_, &width, &height);
  return {width, height};
}

void Window::resize(int width, int height) {
  glfwSetWindowSize(window_, std::max(1, width), std::max(1, height));
  dirty_ = true;
}

void Window::setTitle(const std::string& title) {
  glfwSetWindowTitle(window_, title.c_str());
}

void Window::setClipboard(const std::string& text) {
  glfwSetClipboardString(window_, text.c_str());
}

void Window::setScale(double scale) {
  scale_ = std::clamp(scale, kMinScale, kMaxScale);
  style_changed_ = dirty_ = true;
}

void Window::setTheme(render::Theme theme) {
  if (theme == theme_) return;
  theme_ = theme;
  style_changed_ = dirty_ = true;
}

void Window::applyStyle() {
  style_changed_ = false;
  ImGuiIO& io = ImGui::GetIO();
  ImGui::GetStyle() = styleOf(theme_, static_cast<float>(scale_));
  setBackground(window_, theme_ == render::Theme::dark ? 0x181D25 : 0xF3F5F8);
  io.Fonts->Clear();
  const float size_px = std::max(8.0F, std::round(kFont_px * static_cast<float>(scale_)));
  std::error_code ignored;
  ImFont* font = nullptr;
  if (std::filesystem::exists(kFont, ignored)) {
    font = io.Fonts->AddFontFromFileTTF(kFont, size_px, nullptr, Glyphs::ranges());
  } else {
    ImFontConfig config;
    config.SizePixels = size_px;
    font = io.Fonts->AddFontDefault(&config);
  }
  font->FallbackChar = kMissing;
  io.Fonts->TexDesiredWidth = kAtlasWidth;
  Glyphs::ofWindow().addTo(*io.Fonts, font, size_px);
  io.Fonts->Build();
  Glyphs::ofWindow().drawInto(*io.Fonts);
  ImGui_ImplOpenGL3_DestroyFontsTexture();
  ImGui_ImplOpenGL3_CreateFontsTexture();
}

void Window::forward(const InputEvent& event) {
  switch (event.kind) {
    case InputEvent::Kind::key:
      if (event.code >= 0 && event.code < 512) keys_[event.code] = event.action != GLFW_RELEASE;
      ImGui_ImplGlfw_KeyCallback(window_, event.code, event.scancode, event.action, event.modifiers);
      setModifiers(event.modifiers);  // the backend knows only those whose keys it has seen
      break;
    case InputEvent::Kind::text:
      Glyphs::ofWindow().need(static_cast<char32_t>(event.code));
      ImGui_ImplGlfw_CharCallback(window_, static_cast<unsigned>(event.code));
      break;
    case InputEvent::Kind::button:
      if (event.code >= 0 && event.code < 8) buttons_[event.code] = event.action == GLFW_PRESS;
      setModifiers(event.modifiers);
      break;
    case InputEvent::Kind::cursor:
      cursor_x_ = event.x;
      cursor_y_ = event.y;
      break;
    case InputEvent::Kind::wheel:
      ImGui_ImplGlfw_ScrollCallback(window_, event.x, event.y);
      break;
    case InputEvent::Kind::left_window:
      break;
  }
}

std::vector<InputEvent> Window::beginFrame() {
  if (style_changed_ || Glyphs::ofWindow().hasNew()) applyStyle();
  std::vector<InputEvent> events = input_.takeFrame(ImGui::GetIO().WantTextInput);
  for (const InputEvent& event : events) forward(event);
  ImGui_ImplOpenGL3_NewFrame();
  ImGui_ImplGlfw_NewFrame();
  // The backend sets the present state of the mouse; this sets the state in the events.
  ImGuiIO& io = ImGui::GetIO();
  io.MousePos = {static_cast<float>(cursor_x_), static_cast<float>(cursor_y_)};
  for (int i = 0; i < 5; ++i) io.MouseDown[i] = buttons_[i];
  // In menus and lists Dear ImGui takes Space alone.
  for (const InputEvent& event : events) {
    const bool is_enter = event.code == GLFW_KEY_ENTER || event.code == GLFW_KEY_KP_ENTER;
    if (event.kind == InputEvent::Kind::key && event.action == GLFW_PRESS && is_enter)
      io.NavInputs[ImGuiNavInput_Activate] = 1;
  }
  ImGui::NewFrame();
  return events;
}

void Window::endFrame() {
  ImGui::Render();
  const render::ImageSize size = framebufferSize();
  glViewport(0, 0, size.width, size.height);
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
  if (Glyphs::ofWindow().hasNew()) dirty_ = true;  // drawn as boxes in this frame
}

void Window::dropFrame() {
  ImGui::EndFrame();
}

void Window::swap() {
  glfwSwapBuffers(window_);
}

render::Image8 Window::readPixels() const {
  render::Image8 image;
  image.size = framebufferSize();
  image.rgba.resize(static_cast<std::size_t>(image.size.count()) * 4);
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  glReadBuffer(GL_BACK);
  glReadPixels(0, 0, image.size.width, image.size.height, GL_RGBA, GL_UNSIGNED_BYTE, image.rgba.data());
  const std::size_t row = static_cast<std::size_t>(image.size.width) * 4;
  for (std::size_t top = 0, bottom = static_cast<std::size_t>(image.size.height); top + 1 < bottom; ++top) {
    --bottom;
    std::swap_ranges(image.rgba.begin() + static_cast<std::ptrdiff_t>(top * row),
                     image.rgba.begin() + static_cast<std::ptrdiff_t>((top + 1) * row),
                     image.rgba.begin() + static_cast<std::ptrdiff_t>(bottom * row));
  }
  for (std::size_t i = 3; i < image.rgba.size(); i += 4) image.rgba[i] = 255;
  return image;
}

std::string Window::renderer() const {
  const auto* name = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  return name ? name : "";
}

bool Window::keyDown(int key) const {
  return key >= 0 && key < 512 && keys_[key];
}

}  // namespace emscape::view
