/// The GLSL 3.30 programs of cell projection.
#pragma once

namespace emscape::render::gl {

/// Of a vertex the weights of the cell's vertices are 1 for itself: interpolated, they are the barycentric
/// coordinates of a point of a face.
constexpr char kCellVertexShader[] = R"(#version 330 core
layout(location = 0) in vec3 position;
layout(location = 1) in float value;
uniform mat4 clip_from_eye;
uniform bool sends_changes;
uniform samplerBuffer cell_numbers;
smooth out vec3 near_entry;
smooth out float near_value;
smooth out vec4 near_weights;
flat out vec4 exits;
flat out vec4 changes;
flat out float ray_value;

vec4 four(int first) {
  return vec4(texelFetch(cell_numbers, first).r, texelFetch(cell_numbers, first + 1).r,
              texelFetch(cell_numbers, first + 2).r, texelFetch(cell_numbers, first + 3).r);
}

void main() {
  near_weights = vec4(0);
  near_weights[gl_VertexID & 3] = 1;
  near_entry = position;
  near_value = value;
  int first = (gl_VertexID >> 2) * (sends_changes ? 8 : 5);
  exits = four(first);
  changes = sends_changes ? four(first + 4) : vec4(0);
  ray_value = sends_changes ? 0.0 : texelFetch(cell_numbers, first + 4).r;
  gl_Position = clip_from_eye * vec4(position, 1);
}
)";

/// The colour of the segment between the entry and the nearest exit, premultiplied, as RayIntegral adds it.
constexpr char kCellFragmentShader[] = R"(#version 330 core
smooth in vec3 near_entry;
smooth in float near_value;
smooth in vec4 near_weights;
flat in vec4 exits;
flat in vec4 changes;
flat in float ray_value;
uniform mat4 clip_from_eye;
uniform vec2 picture_size;
uniform bool is_perspective;
uniform bool sends_changes;
uniform samplerBuffer intervals;  // three texels each: (lower, upper, extinctions), (colour, kind), (colour, 0)
uniform int interval_count;
uniform sampler2D psi_table;
uniform sampler2D end_depth;  // of the rays, by what hides the field
uniform bool has_end;
uniform float eye_value;
uniform bool holds_eye;  // the cell's exit faces are drawn: it is entered at the eye
uniform vec3 depth_of;       // depth along the camera's axis = dot(depth_of, position)
uniform float steps_per_depth;  // of parallel rays
out vec4 color;

const float kSmallDepth = 0.02, kMaxDepth = 8.0, kOpaque = 1e-6;

float psi(float back, float front) {
  if (max(back, front) < kSmallDepth) {
    float apart = back - front;
    return 1 - front / 3 - back / 6 + 0.5 * (front * front / 3 + front * apart / 4 + apart * apart / 20);
  }
  float size = float(textureSize(psi_table, 0).x);
  vec2 at = vec2(back / (1 + back), front / (1 + front)) * (size - 1);
  // Filters of textures have weights of 8 bits.
  ivec2 low = min(ivec2(at), ivec2(size) - 2);
  vec2 w = at - vec2(low);
  float p00 = texelFetch(psi_table, low, 0).r, p10 = texelFetch(psi_table, low + ivec2(1, 0), 0).r;
  float p01 = texelFetch(psi_table, low + ivec2(0, 1), 0).r, p11 = texelFetch(psi_table, low + ivec2(1, 1), 0).r;
  return mix(mix(p00, p10, w.x), mix(p01, p11, w.x), w.y);
}

// 1 - exp(-depth)
float opacityOf(float depth) {
  return depth < 0.01 ? depth * (1 - depth * (0.5 - depth / 6)) : 1 - exp(-depth);
}

vec4 result = vec4(0);

void add(vec3 color_front, float front, vec3 color_back, float back) {
  float opacity = opacityOf(0.5 * (front + back));
  float through = 1 - result.a;
  if (front == back && color_front == color_back) {
    result += through * vec4(opacity * color_front, opacity);
    return;
  }
  float weight_front = 1 - psi(back, front);
  result += through * vec4(weight_front * color_front + (opacity - weight_front) * color_back, opacity);
}

// A segment within one interval of the transfer function.
void addPiece(int interval, float front, float back, float steps) {
  vec4 range = texelFetch(intervals, 3 * interval);
  vec4 color_low = texelFetch(intervals, 3 * interval + 1);
  if (color_low.a == 0 || steps <= 0) return;  // clear
  vec3 color_high = texelFetch(intervals, 3 * interval + 2).rgb;
  float at_front = 0, at_back = 0;
  if (color_low.a > 1.5) {  // not uniform
    at_front = clamp((front - range.x) / (range.y - range.x), 0.0, 1.0);
    at_back = clamp((back - range.x) / (range.y - range.x), 0.0, 1.0);
  }
  float tau_front = mix(range.z, range.w, at_front), tau_back = mix(range.z, range.w, at_back);
  vec3 color_front = mix(color_low.rgb, color_high, at_front), color_behind = mix(color_low.rgb, color_high, at_back);
  // Deeper than the table is good for: in parts.
  float parts = max(1.0, ceil(max(tau_front, tau_back) * steps / kMaxDepth));
  for (float n = 0; n < parts && result.a < 1 - kOpaque; ++n) {
    float a = n / parts, b = (n + 1) / parts;
    add(mix(color_front, color_behind, a), mix(tau_front, tau_back, a) * steps / parts,
        mix(color_front, color_behind, b), mix(tau_front, tau_back, b) * steps / parts);
  }
}

void main() {
  // Rasterisers round vertices to 1/256 pixel: the interpolated entry is that much beside the ray of the pixel,
  // along its face. The change from pixel to pixel brings it back.
  vec4 clip = clip_from_eye * vec4(near_entry, 1);
  vec2 off = (0.5 * clip.xy / clip.w + 0.5) * picture_size - gl_FragCoord.xy;
  vec3 entry = near_entry - dFdx(near_entry) * off.x - dFdy(near_entry) * off.y;
  float entry_value = near_value - dFdx(near_value) * off.x - dFdy(near_value) * off.y;
  vec4 weights = near_weights - dFdx(near_weights) * off.x - dFdy(near_weights) * off.y;
  if (any(lessThan(weights, vec4(-0.01)))) {  // a face on edge: the change is not that of one pixel
    entry = near_entry;
    entry_value = near_value;
    weights = near_weights;
  }

  float nearest = 3.0e38, back_value = 0;
  bool bounded = is_perspective && !sends_changes;
  for (int i = 0; i < 4; ++i) {
    // A pixel at an edge may be just outside.
    float weight = max(weights[i], 0.0);
    float here = exits[i] * weight;
    if (exits[i] > 0 && (!bounded || here < 1) && here < nearest) {
      nearest = here;
      back_value = entry_value + weight * changes[i];
    }
  }
  float front_value = entry_value;
  if (holds_eye) {
    front_value = eye_value;
    back_value = entry_value;
    nearest = 0;
  }
  if (nearest > 2.9e38) discard;
  // From the entry on: in units of its distance from the eye, or of depth where rays are parallel.
  float t = nearest;
  if (holds_eye) {
    t = 1;
  } else if (bounded) {
    t = nearest / (1 - nearest);
    back_value = entry_value + t * (entry_value - ray_value);
  } else if (is_perspective) {
    t = nearest / length(entry);
  } else if (!sends_changes) {
    back_value = entry_value + t * ray_value;
  }
  if (has_end) {
    float depth = dot(depth_of, entry);
    float left = texelFetch(end_depth, ivec2(gl_FragCoord.xy), 0).r - (holds_eye ? 0.0 : depth);
    left /= is_perspective ? depth : 1.0;
    if (left <= 0) discard;
    if (left < t) {
      back_value = mix(front_value, back_value, left / t);
      t = left;
    }
  }
  float steps = t * (is_perspective ? length(entry) : steps_per_depth);

  int low = 0, high = interval_count;  // the first interval that begins above the entry's value
  while (low < high) {
    int middle = (low + high) / 2;
    if (texelFetch(intervals, 3 * middle).x > front_value) high = middle; else low = middle + 1;
  }
  int interval = max(low - 1, 0);
  bool rises = back_value > front_value;
  float per_value = steps / (back_value - front_value);
  float value = front_value;
  for (int n = 0; n < interval_count; ++n) {
    vec4 range = texelFetch(intervals, 3 * interval);
    bool ends_here = rises ? back_value <= range.y : back_value >= range.x;
    if (ends_here) {
      addPiece(interval, value, back_value, front_value == back_value ? steps : (back_value - value) * per_value);
      break;
    }
    float end = rises ? range.y : range.x;
    addPiece(interval, value, end, (end - value) * per_value);
    value = end;
    interval += rises ? 1 : -1;
  }
  color = result;
}
)";

}  // namespace emscape::render::gl
