/// Drawing commands of the timeline: ticks, computed steps, active intervals of emitters, playing range,
/// bookmarks and hands.
#pragma once

#include <algorithm>

#include "apps/view/panels/panels.h"

namespace emscape::view {

constexpr int kMaxTimelineRows = 5;  ///< of emitters; more are scrolled
/// Heights in pixels at scale 1: row of an emitter, row of marks, strip of computed steps.
constexpr float kTimelineRow = 17, kTimelineMarks = 16, kTimelineCached = 5;

/// Mapping of times to the screen.
struct TimeAxis {
  double begin_s, end_s;
  float left, width;

  float right() const { return left + width; }
  double perPixel_s() const { return (end_s - begin_s) / static_cast<double>(width); }
  float x(double time_s) const { return left + static_cast<float>((time_s - begin_s) / perPixel_s()); }
  /// x of a time, clamped to the axis.
  float clampedX(double time_s) const { return x(std::clamp(time_s, begin_s, end_s)); }
  double time_s(float at) const { return begin_s + static_cast<double>(at - left) * perPixel_s(); }
  bool shows(double time_s) const { return time_s >= begin_s && time_s <= end_s; }
};

void drawTicks(ImDrawList& list, const TimeAxis& axis, const Session& session, float top, float bottom,
               float scale);
/// Bookmarks and the ends of the playing range.
void drawMarks(ImDrawList& list, const TimeAxis& axis, const Session& session, float top, float scale);
/// Steps whose field is computed.
void drawCached(ImDrawList& list, const TimeAxis& axis, const Session& session, float top, float scale);
/// Names and bars of the emitters, in a child of the window that scrolls.
void drawRows(ImDrawList& list, const TimeAxis& axis, const Session& session, float names_left, float scale);
void drawHandGrip(ImDrawList& list, const TimeAxis& axis, const Session& session, float top, float scale);
/// Shades the time outside the playing range.
void drawShade(ImDrawList& list, const TimeAxis& axis, const Session& session, float top, float bottom);
/// The picture's time and the requested time.
void drawHands(ImDrawList& list, const TimeAxis& axis, const Session& session, float top, float bottom,
               float scale);

}  // namespace emscape::view
