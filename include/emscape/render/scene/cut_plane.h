/// Planes that cut a volume open, and their text form.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace emscape::render {

/// The volume on the removed side of a plane is not drawn. The section on the plane is drawn as an opaque
/// surface in the colours of the transfer function; it is transparent where the volume is masked or holds no
/// field (its floor). Several planes leave what all of them keep. A vertical plane may cut the ground as
/// well, a horizontal one leaves it whole.
struct CutPlane {
  enum class Kind { horizontal, vertical };
  /// Side that is drawn: of a horizontal plane below or above it, of a vertical one the left or the right of
  /// its line, looking along the bearing.
  enum class Side { below, above, left, right };

  Kind kind = Kind::horizontal;
  Side keep = Side::below;
  bool on = true;          ///< false: the plane cuts nothing
  double altitude_m = 0;   ///< horizontal: height in the frame of the volume, not exaggerated; -1e6..1e6
  double bearing_deg = 0;  ///< vertical: of the line, clockwise from frame y (north); -360..360
  /// vertical: a point of the line in frame metres, -1e9..1e9; none: the centre of the box
  std::optional<double> x_m, y_m;
  double offset_m = 0;      ///< vertical: distance of the line to the right of that point; -1e9..1e9
  bool cuts_ground = true;  ///< vertical

  /// True if it cuts the ground now.
  bool cutsGround() const { return on && kind == Kind::vertical && cuts_ground; }
  bool operator==(const CutPlane& other) const;
  bool operator!=(const CutPlane& other) const { return !(*this == other); }
};

constexpr int kMaxCutPlanes = 3;

/// Parses `horizontal:altitude_m=1500,keep=below` or
/// `vertical:bearing_deg=90,x_m=..,y_m=..,offset_m=..,keep=left,ground=cut`, or a vertical plane through two
/// points, `vertical:x1_m=..,y1_m=..,x2_m=..,y2_m=..`. All keys but altitude_m have defaults; on=false
/// switches it off.
/// @throws Error (usage) that names the key, the value and what is allowed
CutPlane parseCutPlane(const std::string& text);
/// The text that parseCutPlane() reads back to the same plane.
std::string toString(const CutPlane& plane);
/// The same plane that keeps the other side.
CutPlane flipped(CutPlane plane);

/// @throws Error (bad_input) for more than kMaxCutPlanes, a value out of its range, or a side that the kind
/// of plane does not have
void checkCutPlanes(const std::vector<CutPlane>& planes);

}  // namespace emscape::render
