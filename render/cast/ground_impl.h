/// The path of a ray over the ground; included by ground.h.
#pragma once

namespace emscape::render {

/// A ray in post space, from its entry into the block; its parameter is in voxels of index space.
struct GroundView::PostRay {
  float x, y, z;
  float dx, dy, dz;
};

namespace ground_detail {

EMSCAPE_HD inline float held(float value, float least, float largest) {
  return value < least ? least : (value > largest ? largest : value);
}
EMSCAPE_HD inline int held(int value, int least, int largest) {
  return value < least ? least : (value > largest ? largest : value);
}
EMSCAPE_HD inline float distanceTo(float value, float a, float b) {
  const float to_a = std::fabs(value - a);
  const float to_b = std::fabs(value - b);
  return to_a < to_b ? to_a : to_b;
}
EMSCAPE_HD inline Rgba grey(float level) {
  return {level, level, level, 1.0F};
}

/// Distance along a ray to the far face of the cells first .. first + count along one axis.
EMSCAPE_HD inline float leaveAxis(float position, float direction, int first, int count) {
  if (direction == 0.0F) return 1e30F;
  return (static_cast<float>(direction > 0.0F ? first + count : first) - position) / direction;
}

/// The smaller root of a s^2 + b s + c in (0, limit], for c > 0; negative if there is none.
EMSCAPE_HD inline float firstRoot(float a, float b, float c, float limit) {
  const float discriminant = b * b - 4.0F * a * c;
  if (discriminant < 0.0F) return -1.0F;
  const float root = std::sqrt(discriminant);
  const float q = -0.5F * (b < 0.0F ? b - root : b + root);
  const float s1 = q != 0.0F ? c / q : -1.0F;
  const float s2 = a != 0.0F ? q / a : -1.0F;
  const bool first = s1 > 0.0F && s1 <= limit;
  const bool second = s2 > 0.0F && s2 <= limit;
  if (first && second) return s1 < s2 ? s1 : s2;
  return first ? s1 : (second ? s2 : -1.0F);
}

}  // namespace ground_detail

EMSCAPE_HD inline Rgba GroundView::surfaceColor(int i, int j, float x, float y) const {
  const Rgba* row = colors + static_cast<long long>(j) * columns + i;
  const Rgba south = row[0] * (1.0F - x) + row[1] * x;
  const Rgba north = row[columns] * (1.0F - x) + row[columns + 1] * x;
  return south * (1.0F - y) + north * y;
}

EMSCAPE_HD inline Rgba GroundView::wallColor(float z, float distance_x, float distance_y) const {
  const float height = (z - static_cast<float>(lower.z)) / static_cast<float>(upper.z - lower.z);
  const float face = distance_x < distance_y ? 0.82F : 1.0F;
  const float level = (wall_light + wall_rise * ground_detail::held(height, 0.0F, 1.0F)) * face;
  return {level * 1.08F, level, level * 0.92F, 1.0F};
}

EMSCAPE_HD inline Rgba GroundView::pitColor(float x, float y) const {
  const float phase = (x + y) / hatch_period;
  const float part = phase - std::floor(phase);
  return part < 0.5F ? ground_detail::grey(0.16F) : Rgba{0.62F, 0.30F, 0.28F, 1.0F};
}

EMSCAPE_HD inline bool GroundView::hitsCell(const PostRay& ray, int i, int j, float enter, float leave,
                                            GroundHit& hit) const {
  using namespace ground_detail;
  const float* post = heights + static_cast<long long>(j) * columns + i;
  const float h00 = post[0];
  const float slope_x = post[1] - h00;
  const float slope_y = post[columns] - h00;
  const float twist = post[columns + 1] - post[1] - slope_y;
  const float x = held(ray.x + ray.dx * enter - static_cast<float>(i), 0.0F, 1.0F);
  const float y = held(ray.y + ray.dy * enter - static_cast<float>(j), 0.0F, 1.0F);
  const float z = ray.z + ray.dz * enter;
  const float base = static_cast<float>(lower.z);
  if (!(twist == twist)) {  // a pit: only its floor
    const bool enters_floor = z <= base;
    if (!enters_floor && !(ray.dz < 0.0F && z + ray.dz * (leave - enter) <= base + kRounding)) return false;
    const float distance = enters_floor ? enter : enter + (base - z) / ray.dz;
    hit = {true, false, distance, pitColor(ray.x + ray.dx * distance, ray.y + ray.dy * distance)};
    return true;
  }
  const float above = z - (h00 + slope_x * x + slope_y * y + twist * x * y);
  if (above <= -kRounding) {
    const float west = held(static_cast<float>(i), static_cast<float>((lower.x - first_x) * scale_x), 1e9F);
    const float east =
        held(static_cast<float>(i + 1), -1e9F, static_cast<float>((upper.x - first_x) * scale_x));
    const float south = held(static_cast<float>(j), static_cast<float>((lower.y - first_y) * scale_y), 1e9F);
    const float north =
        held(static_cast<float>(j + 1), -1e9F, static_cast<float>((upper.y - first_y) * scale_y));
    hit = {true, false, enter,
           wallColor(z, distanceTo(ray.x + ray.dx * enter, west, east),
                     distanceTo(ray.y + ray.dy * enter, south, north))};
    return true;
  }
  float s = 0.0F;
  if (above > 0.0F) {
    const float b = ray.dz - (slope_x * ray.dx + slope_y * ray.dy + twist * (x * ray.dy + y * ray.dx));
    s = firstRoot(-twist * ray.dx * ray.dy, b, above, leave - enter);
    if (s < 0.0F) return false;
  }
  hit = {true, true, enter + s,
         surfaceColor(i, j, held(x + ray.dx * s, 0.0F, 1.0F), held(y + ray.dy * s, 0.0F, 1.0F))};
  return true;
}

EMSCAPE_HD inline GroundHit GroundView::firstHit(const Vec3d& origin, const Vec3d& direction, double begin,
                                                 double end) const {
  using namespace ground_detail;
  const Vec3d entry = origin + direction * begin;
  const PostRay ray{static_cast<float>((entry.x - first_x) * scale_x),
                    static_cast<float>((entry.y - first_y) * scale_y),
                    static_cast<float>(entry.z),
                    static_cast<float>(direction.x * scale_x),
                    static_cast<float>(direction.y * scale_y),
                    static_cast<float>(direction.z)};
  const float length = static_cast<float>(end - begin);
  GroundHit hit;
  int i = held(static_cast<int>(ray.x), 0, columns - 2);
  int j = held(static_cast<int>(ray.y), 0, rows - 2);
  int level = levels - 1;
  float at = 0.0F;
  while (true) {
    const int node_i = i >> level;
    const int node_j = j >> level;
    const int count = 1 << level;
    const float leave_x = leaveAxis(ray.x, ray.dx, node_i << level, count);
    const float leave_y = leaveAxis(ray.y, ray.dy, node_j << level, count);
    float leave = leave_x < leave_y ? leave_x : leave_y;
    leave = leave < length ? (leave > at ? leave : at) : length;
    const float lowest = ray.z + ray.dz * (ray.dz < 0.0F ? leave : at);
    if (lowest <= highest[level][static_cast<long long>(node_j) * level_columns[level] + node_i]) {
      if (level > 0) {
        --level;
        continue;
      }
      if (hitsCell(ray, i, j, at, leave, hit)) {
        hit.distance += begin;
        return hit;
      }
    }
    if (leave >= length) return hit;
    at = leave;
    if (leave_x < leave_y) {
      i = ray.dx > 0.0F ? (node_i + 1) << level : (node_i << level) - 1;
      j = held(static_cast<int>(ray.y + ray.dy * at), node_j << level, ((node_j + 1) << level) - 1);
    } else {
      j = ray.dy > 0.0F ? (node_j + 1) << level : (node_j << level) - 1;
      i = held(static_cast<int>(ray.x + ray.dx * at), node_i << level, ((node_i + 1) << level) - 1);
    }
    if (i < 0 || j < 0 || i > columns - 2 || j > rows - 2) return hit;
    if (level + 1 < levels) ++level;
  }
}

}  // namespace emscape::render
