/// What X knows of the window: a file that another program drags onto it (both sides of XDND), and resizes.
#include <X11/Xatom.h>
#include <X11/Xlib.h>
#include <X11/Xutil.h>
// X11's macros spoil other headers
#undef None
#undef Bool
#undef Status

#include <gmock/gmock.h>

#include <chrono>
#include <string>
#include <thread>

#include "tests/view/window_fixture.h"

namespace emscape::test {
namespace {

/// Drags one file, as a file manager does: https://freedesktop.org/wiki/Specifications/XDND version 5.
class DragSource {
 public:
  DragSource(const std::string& display, const std::string& file) : display_(XOpenDisplay(display.c_str())) {
    if (!display_) return;
    uri_ = "file://" + file + "\r\n";
    window_ = XCreateSimpleWindow(display_, DefaultRootWindow(display_), 0, 0, 1, 1, 0, 0, 0);
    XSetSelectionOwner(display_, atom("XdndSelection"), window_, CurrentTime);
  }
  ~DragSource() {
    if (display_) XCloseDisplay(display_);
  }
  DragSource(const DragSource&) = delete;
  DragSource& operator=(const DragSource&) = delete;

  /// @return whether the target took it within some seconds
  bool dropOn(::Window target, int x, int y) {
    if (!display_ || target == 0) return false;
    constexpr long kVersion = 5;
    tell(target, "XdndEnter", kVersion << 24, static_cast<long>(atom("text/uri-list")), 0, 0);
    tell(target, "XdndPosition", 0, x << 16 | y, CurrentTime, static_cast<long>(atom("XdndActionCopy")));
    for (int i = 0; i < 1000; ++i) {
      while (XPending(display_) > 0) {
        XEvent event;
        XNextEvent(display_, &event);
        if (event.type == SelectionRequest) give(event.xselectionrequest);
        if (event.type != ClientMessage) continue;
        if (event.xclient.message_type == atom("XdndFinished")) return true;
        if (event.xclient.message_type != atom("XdndStatus")) continue;
        if ((event.xclient.data.l[1] & 1) == 0) return false;
        tell(target, "XdndDrop", 0, CurrentTime, 0, 0);
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
  }

 private:
  Atom atom(const char* name) const { return XInternAtom(display_, name, 0); }

  void tell(::Window target, const char* message, long a, long b, long c, long d) {
    XEvent event{};
    event.xclient.type = ClientMessage;
    event.xclient.window = target;
    event.xclient.message_type = atom(message);
    event.xclient.format = 32;
    const long data[5] = {static_cast<long>(window_), a, b, c, d};
    for (int i = 0; i < 5; ++i) event.xclient.data.l[i] = data[i];
    XSendEvent(display_, target, 0, NoEventMask, &event);
    XFlush(display_);
  }

  void give(const XSelectionRequestEvent& request) {
    XChangeProperty(display_, request.requestor, request.property, request.target, 8, PropModeReplace,
                    reinterpret_cast<const unsigned char*>(uri_.data()), static_cast<int>(uri_.size()));
    XEvent event{};
    event.xselection.type = SelectionNotify;
    event.xselection.requestor = request.requestor;
    event.xselection.selection = request.selection;
    event.xselection.target = request.target;
    event.xselection.property = request.property;
    event.xselection.time = request.time;
    XSendEvent(display_, request.requestor, 0, NoEventMask, &event);
    XFlush(display_);
  }

  Display* const display_;
  ::Window window_ = 0;
  std::string uri_;
};

/// The window with a name in its title, among all of a display.
::Window windowNamed(Display* display, ::Window below, const std::string& name) {
  XTextProperty title{};
  const bool is_named = XGetWMName(display, below, &title) != 0 && title.value &&
                        std::string(reinterpret_cast<const char*>(title.value)).find(name) == 0;
  if (title.value) XFree(title.value);
  if (is_named) return below;
  ::Window root = 0, parent = 0, *children = nullptr, found = 0;
  unsigned count = 0;
  if (XQueryTree(display, below, &root, &parent, &children, &count) == 0) return 0;
  for (unsigned i = 0; i < count && found == 0; ++i) found = windowNamed(display, children[i], name);
  if (children) XFree(children);
  return found;
}

TEST_F(Window, AFileThatIsDroppedOnItIsOpened) {
  const std::string other = folder_ / "other.yaml";
  writeFile(other, readFile(quick()));
  RunningProgram program(viewOf(quick(), R"({"do":"wait_state","state":"exact"}
{"do":"mark","text":"ready"}
{"do":"wait_s","seconds":5}
{"do":"wait_state","state":"exact"}
{"do":"expect","key":"input","op":"==","value":")" +
                                             other + R"("}
{"do":"quit"}
)"),
                         environment());
  ASSERT_TRUE(comesToLog("mark"));
  Display* const display = XOpenDisplay(display_->name().c_str());
  ASSERT_NE(display, nullptr);
  const ::Window window = windowNamed(display, DefaultRootWindow(display), "quick.yaml");
  DragSource source(display_->name(), other);
  EXPECT_TRUE(source.dropOn(window, 100, 100));
  XCloseDisplay(display);
  const ProgramResult result = program.wait();
  EXPECT_EQ(result.status, 0) << result.err;
}

/// Else X clears the window at each step of a resize, and it flashes.
TEST_F(Window, AResizeLeavesTheLastPictureUntilTheNextIsDrawn) {
  RunningProgram program(viewOf(quick(), R"({"do":"wait_state","state":"exact"}
{"do":"mark","text":"ready"}
{"do":"wait_s","seconds":2}
{"do":"quit"}
)"),
                         environment());
  ASSERT_TRUE(comesToLog("mark"));
  Display* const display = XOpenDisplay(display_->name().c_str());
  ASSERT_NE(display, nullptr);
  XWindowAttributes attributes{};
  const ::Window window = windowNamed(display, DefaultRootWindow(display), "quick.yaml");
  EXPECT_NE(XGetWindowAttributes(display, window, &attributes), 0);
  EXPECT_EQ(attributes.bit_gravity, NorthWestGravity);
  XCloseDisplay(display);
  EXPECT_EQ(program.wait().status, 0);
}

}  // namespace
}  // namespace emscape::test
