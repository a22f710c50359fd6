#include "render/scene/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "emscape/base/error.h"
#include "emscape/base/units.h"
#include "volume/difference.h"

namespace emscape::render {
namespace {

/// Drawn positions to the index space of a grid, axis by axis.
struct IndexSpace {
  Vec3d origin_m;   ///< drawn position of the centre of voxel (0, 0, 0)
  Vec3d spacing_m;  ///< of voxels as drawn

  IndexSpace(const volume::Grid& grid, const SceneBox& box)
      : origin_m(box.toDrawn(grid.first_center_m)), spacing_m(grid.spacing_m) {
    spacing_m.z *= box.vertical_exaggeration;
  }
  Vec3d vector(const Vec3d& drawn) const {
    return {drawn.x / spacing_m.x, drawn.y / spacing_m.y, drawn.z / spacing_m.z};
  }
  Vec3d position(const Vec3d& drawn_m) const { return vector(drawn_m - origin_m); }
};

CameraView viewOf(const Camera& camera, const IndexSpace& space, ImageSize size) {
  CameraView view;
  view.eye = space.position(camera.eye_m);
  view.forward = space.vector(camera.forward);
  view.right = space.vector(camera.right);
  view.up = space.vector(camera.up);
  view.half_height = camera.half_height;
  view.shift_x = camera.shift_x;
  view.shift_y = camera.shift_y;
  view.orthographic = camera.projection == Projection::orthographic;
  view.size = size;
  return view;
}

/// The planes that cut the ground.
std::vector<CutPlane> planesOfGround(const std::vector<CutPlane>& planes) {
  std::vector<CutPlane> cutting;
  for (const CutPlane& plane : planes) {
    if (plane.cutsGround()) cutting.push_back(plane);
  }
  return cutting;
}

CutView::Plane viewOf(const CutPlane& plane, const volume::Grid& grid) {
  // Outward normal of the kept side, in frame metres.
  Vec3d outward{0, 0, 1};
  Vec3d point_m{0, 0, plane.altitude_m};
  const bool vertical = plane.kind == CutPlane::Kind::vertical;
  if (vertical) {
    const double bearing = degToRad(plane.bearing_deg);
    const Vec3d right{std::cos(bearing), -std::sin(bearing), 0};
    const Vec3d center_m = (grid.lower_m() + grid.upper_m()) * 0.5;
    point_m = Vec3d{plane.x_m.value_or(center_m.x), plane.y_m.value_or(center_m.y), 0};
    point_m = point_m + right * plane.offset_m;
    outward = right;
  }
  if (plane.keep == CutPlane::Side::above || plane.keep == CutPlane::Side::right) outward = -outward;
  const Vec3d normal{outward.x * grid.spacing_m.x, outward.y * grid.spacing_m.y,
                     outward.z * grid.spacing_m.z};
  const double scale = 1.0 / length(normal);
  return {normal * scale, dot(outward, point_m - grid.first_center_m) * scale, plane.cutsGround()};
}

/// The light is slightly above and to the left of the viewer.
ShadingView shadingOf(const Camera& camera, const IndexSpace& space) {
  constexpr double kLeft = 0.3, kAbove = 0.4;
  const Vec3d& spacing = space.spacing_m;
  ShadingView shading;
  shading.voxel = vecCast<float>(spacing / std::max({spacing.x, spacing.y, spacing.z}));
  shading.to_light = vecCast<float>(normalized(camera.up * kAbove - camera.right * kLeft - camera.forward));
  return shading;
}

}  // namespace

void Scene::setVolume(const volume::Grid& grid, const volume::VolumeInfo& info) {
  if (!grid_ || *grid_ != grid) dropGround();
  grid_ = grid;
  categorical_ = info.categorical;
  is_difference_ = volume::isDifference(info);
  floor_ = info.floor;
}

void Scene::setHeightField(std::shared_ptr<const HeightField> height_field) {
  height_field_ = std::move(height_field);
  dropGround();
  if (grid_) prepareGround();
}

void Scene::setTransferFunction(const TransferFunction& function) {
  function_ = function;
  table_.reset();
}

void Scene::setCamera(const Camera& camera) {
  camera_ = camera;
  ++versions_.view;
}

void Scene::setSettings(const RenderSettings& settings) {
  kStepLimits.require(settings.step_voxels);
  kMidaGammaLimits.require(settings.mida_gamma);
  kExaggerationLimits.require(settings.vertical_exaggeration);
  kIsoOpacityLimits.require(settings.iso_opacity);
  if (settings.map_height_agl_m) kMapHeightLimits.require(*settings.map_height_agl_m);
  kMapOpacityLimits.require(settings.map_opacity);
  if (std::isinf(settings.iso_value)) throw Error(ErrorCode::bad_input, "iso value: must be finite");
  checkCutPlanes(settings.planes);
  if (planesOfGround(settings.planes) != planesOfGround(settings_.planes)) ++versions_.view;
  if (settings.step_voxels != settings_.step_voxels) table_.reset();
  if (settings.vertical_exaggeration != settings_.vertical_exaggeration) dropGround();
  if (settings.mode != settings_.mode || settings.iso_value != settings_.iso_value) ++versions_.levels;
  if (settings.map_height_agl_m != settings_.map_height_agl_m ||
      settings.map_opacity != settings_.map_opacity)
    ++versions_.map;
  settings_ = settings;
}

const volume::Grid& Scene::grid() const {
  if (!grid_) throw Error(ErrorCode::other, "Renderer: no volume is set");
  return *grid_;
}

double Scene::isoValue() const {
  return std::isnan(settings_.iso_value) ? 0.5 * (function_.lowest() + function_.highest())
                                         : settings_.iso_value;
}

SceneBox Scene::box() const {
  return sceneBoxOf(grid(), settings_.vertical_exaggeration);
}

/// True if a ray meets a section with a value before a distance.
/// @param values  of the section; on a GPU all are taken for values
bool Scene::isBehindSection(const CutView& cut, const Ray& ray, double distance,
                            const volume::Volume& values) const {
  const Dims& dims = grid().dims;
  const RayInterval inside = clip(ray, {-0.5, -0.5, -0.5}, {dims.x - 0.5, dims.y - 0.5, dims.z - 0.5});
  CutInterval left{inside.begin, inside.end};
  cut.clip(ray.origin, ray.direction, false, left);
  if (!left.begins_at_plane || !(left.end > left.begin) || left.begin > distance) return false;
  const volume::DenseVolume* const dense = values.dense().get();
  if (dense == nullptr) return true;
  const Vec3d at = ray.origin + ray.direction * left.begin;
  const auto index = [](double position, int count) {
    return std::clamp(static_cast<int>(std::lround(position)), 0, count - 1);
  };
  const int i = index(at.x, dims.x), j = index(at.y, dims.y), k = index(at.z, dims.z);
  if (dense->isMasked(i, j, k)) return false;
  const std::size_t voxel = (static_cast<std::size_t>(k) * dims.y + j) * dims.x + i;
  return std::abs(dense->values[voxel] - cut.floor) > cut.near_floor;
}

bool Scene::isHidden(const Vec3d& frame_m, const volume::Volume* values) {
  const SceneBox drawn = box();
  const IndexSpace space(grid(), drawn);
  const Vec3d target = space.position(drawn.toDrawn(frame_m));
  const CutView cut = cutView();
  if (cut.removes(target)) return true;
  Vec3d eye = space.position(camera_.eye_m);
  if (camera_.projection == Projection::orthographic) {
    const Vec3d forward = normalized(space.vector(camera_.forward));
    eye = target - forward * (length(target - eye) + 1.0);
  }
  const double distance = length(target - eye);
  if (!(distance > 0)) return false;
  const Ray ray{eye, (target - eye) / distance};
  // A marker on the ground, or on a plane, is not hidden by it.
  constexpr double kStandsOn_voxels = 0.5;
  if (values != nullptr && isBehindSection(cut, ray, distance - kStandsOn_voxels, *values)) return true;
  if (!height_field_) return false;
  prepareGround();
  const GroundHit hit = groundHit(ground_->view(), cut, ray);
  return hit.found && hit.distance < distance - kStandsOn_voxels;
}

void Scene::prepare() {
  grid();
  prepareGround();
  if (!table_) {
    table_.emplace(function_, settings_.step_voxels);
    ++versions_.table;
    ++versions_.levels;
  }
}

SkipRule Scene::skipRule() const {
  return table_->skipRule(settings_.mode, static_cast<float>(isoValue()));
}

RaycastTask Scene::task(ImageSize size) const {
  RaycastTask task;
  const IndexSpace space(grid(), box());
  task.camera = viewOf(camera_, space, size);
  task.transfer = table_->view();
  task.shading = shadingOf(camera_, space);
  task.shading.shades_fog = settings_.shading && settings_.mode != CompositingMode::mip && !categorical_;
  const double iso_value = isoValue();
  const Rgb color = function_.color(iso_value);
  task.iso = {static_cast<float>(iso_value), static_cast<float>(settings_.iso_opacity), color.r, color.g,
              color.b};
  if (ground_) task.ground = ground_->view();
  task.cut = cutView();
  task.cut.colors = table_->opaque().data();
  if (isMapped()) {
    task.map = {true, static_cast<float>(*settings_.map_height_agl_m / grid().spacing_m.z),
                static_cast<float>(settings_.map_opacity),
                is_difference_ ? static_cast<float>(quietBelow(function_)) : 0.0F};
  }
  task.step_voxels = static_cast<float>(settings_.step_voxels);
  task.mida_gamma = static_cast<float>(settings_.mida_gamma);
  task.opaque_enough = settings_.exact ? kNeverOpaqueEnough : kOpaqueEnough;
  return task;
}

CutView Scene::cutView() const {
  CutView view;
  for (const CutPlane& plane : settings_.planes) {
    if (plane.on) view.planes[view.count++] = viewOf(plane, grid());
  }
  // Interpolated values may differ slightly from the floor.
  constexpr double kNearFloor = 1e-3;  // of the transfer function's interval
  view.floor = floor_;
  view.near_floor = categorical_ || function_.opacities.empty()
                        ? 0.5F
                        : static_cast<float>(kNearFloor * (function_.highest() - function_.lowest()));
  return view;
}

bool Scene::isCut() const {
  const auto cuts = [](const CutPlane& plane) { return plane.on; };
  return std::any_of(settings_.planes.begin(), settings_.planes.end(), cuts);
}

bool Scene::transparentShowsNothing() const {
  if (isCut()) return false;
  return settings_.mode == CompositingMode::dvr ||
         (settings_.mode == CompositingMode::mida && settings_.mida_gamma <= 0);
}

void Scene::dropGround() {
  ground_.reset();
  ++versions_.ground;
  ++versions_.view;
}

void Scene::prepareGround() {
  if (height_field_ && !ground_) ground_.emplace(*height_field_, grid(), box());
}

}  // namespace emscape::render
