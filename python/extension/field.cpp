/// The solver and its fields.
#include "python/extension/field.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <map>
#include <mutex>

#include "emscape/base/error.h"
#include "emscape/base/log.h"
#include "emscape/emfield/solver/field_solver.h"
#include "emscape/scenario/model/poses.h"
#include "emscape/scenario/model/snapshot.h"
#include "emscape/volume/format/file.h"
#include "python/extension/module.h"

namespace emscape::python {

std::size_t Field::indexOf(const std::string& name) const {
  if (name.empty()) return 0;
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) {
    throw Error(ErrorCode::usage,
                fmt::format("the field has no quantity '{}'; it has {}", name, fmt::join(names, ", ")));
  }
  return static_cast<std::size_t>(found - names.begin());
}

const std::shared_ptr<const volume::DenseVolume>& Field::host(std::size_t index) const {
  const std::lock_guard<std::mutex> one_at_a_time(mutex);
  std::shared_ptr<const volume::DenseVolume>& kept = on_host[index];
  if (kept == nullptr) kept = volumes[index].isOnDevice() ? volumes[index].host() : volumes[index].dense();
  return kept;
}

const std::shared_ptr<const float>& Field::device(std::size_t index) const {
  const std::lock_guard<std::mutex> one_at_a_time(mutex);
  std::shared_ptr<const float>& kept = on_device[index];
  if (kept == nullptr) kept = volumes[index].device()->linearCopy();
  return kept;
}

Dict describeGrid(const volume::Grid& grid) {
  Dict result;
  result["dims"] = std::tuple(grid.dims.x, grid.dims.y, grid.dims.z);
  result["spacing_m"] = std::tuple(grid.spacing_m.x, grid.spacing_m.y, grid.spacing_m.z);
  result["first_center_m"] = std::tuple(grid.first_center_m.x, grid.first_center_m.y, grid.first_center_m.z);
  if (grid.georeferenced) {
    for (const auto& [key, text] : volume::standardWords(true, grid.frame)) result[key.c_str()] = text;
    result["frame"] = toString(grid.frame.kind);
    result["latitude_deg"] = grid.frame.latitude_deg;
    result["longitude_deg"] = grid.frame.longitude_deg;
    result["height_msl_m"] = grid.frame.height_msl_m;
  }
  return result;
}

namespace {

std::shared_ptr<Field> fieldOf(std::vector<std::string> names, std::vector<volume::Volume> volumes,
                               double time_s) {
  auto field = std::make_shared<Field>();
  field->names = std::move(names);
  field->on_host.resize(volumes.size());
  field->on_device.resize(volumes.size());
  field->volumes = std::move(volumes);
  field->time_s = time_s;
  return field;
}

std::vector<std::string> namesOf(const emfield::FieldSolver& solver) {
  std::vector<std::string> names;
  for (const emfield::Channel& channel : solver.channels()) names.push_back(channel.name);
  return names;
}

/// FieldSolver for several threads, one at a time. The lock is taken with the interpreter unlocked, since its
/// holder may wait for the interpreter in order to log.
class Solver {
  /// The result of a query, made between updates.
  template <class Question>
  auto asked(const Question& question) {
    const nb::gil_scoped_release unlocked;
    const std::lock_guard<std::mutex> one_at_a_time(mutex_);
    return question();
  }

 public:
  Solver(const ScenarioHandle& scenario, const std::string& backend, int threads,
         std::vector<std::string> quantities, bool allow_missing_terrain, double cache_mib,
         double move_tolerance_m)
      : arena_(threads > 0 ? threads : tbb::task_arena::automatic), is_limited_(threads > 0) {
    refuseForkedProcess();
    requireWithin("threads", threads, 0, 4096, "");
    requireWithin("cache_mib", cache_mib, 0, 1e6, " MiB");
    requireWithin("move_tolerance_m", move_tolerance_m, 0, 1e6, " m");
    constexpr double kMebibyte = 1 << 20;
    emfield::FieldOptions options;
    options.quantities = std::move(quantities);
    options.backend = parseBackend(backend);
    options.allow_missing_terrain = allow_missing_terrain;
    options.cache_bytes = static_cast<std::size_t>(cache_mib * kMebibyte);
    options.move_tolerance_m = move_tolerance_m;
    const nb::gil_scoped_release unlocked;
    within([&] {
      scene_ = {scenario.scenario, scenario::loadTerrain(*scenario.scenario)};
      solver_ = std::make_unique<emfield::FieldSolver>(scene_.scenario, scene_.terrain, options);
    });
  }

  /// Latitude, longitude (deg), height above mean sea level (m), heading, pitch and roll (deg) by platform.
  using Poses = std::map<std::string, std::array<double, 6>>;

  std::shared_ptr<Field> at(double t_s, const std::optional<ScenarioHandle>& edited, const Poses& poses) {
    refuseForkedProcess();
    const nb::gil_scoped_release unlocked;
    const std::lock_guard<std::mutex> one_at_a_time(mutex_);
    std::shared_ptr<Field> field;
    within([&] {
      playback::LoadedScenario scene = edited && edited->scenario != scene_.scenario
                                           ? playback::withScenario(scene_, edited->scenario)
                                           : scene_;
      playback::LoadedScenario posed = scene;
      if (!poses.empty())
        posed.scenario = scenario::withPoses(*scene.scenario, posesOf(*scene.scenario, poses));
      const emfield::FieldChanged changed =
          solver_->update(scenario::snapshotAt(posed.scenario, posed.terrain.get(), t_s), posed.terrain);
      scene_ = std::move(scene);
      if (changed.grid) {
        const std::vector<float>& ground = solver_->groundHeights_m();
        ground_ = ground.empty() ? nullptr : std::make_shared<const std::vector<float>>(ground);
      }
      field = fieldOf(namesOf(*solver_), solver_->volumes(), t_s);
      field->scene = std::move(posed);
      field->ground_msl_m = ground_;
    });
    return field;
  }

  ScenarioHandle scenario() {
    return asked([&] { return ScenarioHandle{scene_.scenario}; });
  }
  std::string backend() {
    return asked([&] { return std::string(toString(solver_->backend())); });
  }
  std::vector<std::string> warnings() {
    return asked([&] { return solver_->warnings(); });
  }
  std::vector<std::string> quantities() {
    return asked([&] { return namesOf(*solver_); });
  }

 private:
  static std::vector<scenario::PlatformPose> posesOf(const scenario::Scenario& of, const Poses& poses) {
    std::vector<scenario::PlatformPose> list;
    for (const auto& [name, at] : poses) {
      list.push_back({scenario::platformNamed(of, name),
                      scenario::positionMsl(at[0], at[1], at[2]),
                      {at[3], at[4], at[5]}});
    }
    return list;
  }

  /// Runs work within the arena of this solver's threads; rethrows its exceptions.
  template <class Work>
  void within(const Work& work) {
    if (is_limited_) {
      arena_.execute(work);
    } else {
      work();
    }
  }

  std::mutex mutex_;
  tbb::task_arena arena_;
  bool is_limited_;
  playback::LoadedScenario scene_;
  std::unique_ptr<emfield::FieldSolver> solver_;
  std::shared_ptr<const std::vector<float>> ground_;
};

std::vector<std::size_t> shapeOf(const volume::Grid& grid) {
  return {static_cast<std::size_t>(grid.dims.z), static_cast<std::size_t>(grid.dims.y),
          static_cast<std::size_t>(grid.dims.x)};
}

/// The values in host memory as a read-only array of (z, y, x) that keeps the field alive.
template <class Kind>
nb::object hostArray(const nb::handle_t<Field>& self, std::size_t index) {
  const Field& field = nb::cast<const Field&>(self);
  if (field.on_host[index] == nullptr && field.volumes[index].isOnDevice()) {
    const nb::gil_scoped_release unlocked;
    field.host(index);
  }
  const volume::DenseVolume& volume = *field.host(index);
  const std::vector<std::size_t> shape = shapeOf(volume.grid);
  return nb::cast(nb::ndarray<Kind, const float, nb::ndim<3>, nb::c_contig, nb::device::cpu>(
      volume.values.data(), 3, shape.data(), self));
}

nb::object numpyOf(const nb::handle_t<Field>& self, const std::string& quantity) {
  return hostArray<nb::numpy>(self, nb::cast<const Field&>(self).indexOf(quantity));
}

/// The values in their present memory, the host's or a GPU's. Keeps the field alive.
nb::object dlpackOf(const nb::handle_t<Field>& self, const std::string& quantity) {
  const Field& field = nb::cast<const Field&>(self);
  const std::size_t index = field.indexOf(quantity);
  const volume::Volume& volume = field.volumes[index];
  if (!volume.isOnDevice()) return hostArray<nb::array_api>(self, index);
  {
    const nb::gil_scoped_release unlocked;
    field.device(index);
  }
  const std::vector<std::size_t> shape = shapeOf(volume.grid());
  return nb::cast(nb::ndarray<nb::array_api, const float, nb::ndim<3>, nb::c_contig, nb::device::cuda>(
      field.device(index).get(), 3, shape.data(), self));
}

Dict infoOf(const Field& field, const std::string& quantity) {
  const volume::VolumeInfo& info = field.volumes[field.indexOf(quantity)].info();
  Dict result;
  result["quantity"] = info.quantity;
  result["unit"] = info.unit;
  result["time_s"] = info.time_s;
  result["time_utc"] = info.time_utc;
  result["floor"] = info.floor;
  result["range_min"] = info.range_min;
  result["range_max"] = info.range_max;
  result["categorical"] = info.categorical;
  nb::dict extra;
  for (const auto& [key, value] : info.extra) extra[key.c_str()] = value;
  result["extra"] = extra;
  return result;
}

void write(const Field& field, const std::string& file, const std::vector<std::string>& quantities) {
  const nb::gil_scoped_release unlocked;
  std::vector<std::shared_ptr<const volume::DenseVolume>> held;
  std::vector<const volume::DenseVolume*> volumes;
  for (const std::string& name : quantities.empty() ? field.names : quantities) {
    // Copied only if a caller has changed the description.
    held.push_back(field.volumes[field.indexOf(name)].host());
    volumes.push_back(held.back().get());
  }
  volume::writeVolumes(file, volumes);
}

std::shared_ptr<Field> read(const std::string& file) {
  const nb::gil_scoped_release unlocked;
  std::vector<std::string> names;
  std::vector<volume::Volume> volumes;
  for (const volume::DenseVolume& listed : volume::listVolume(file).volumes) {
    names.push_back(listed.info.quantity);
    volumes.emplace_back(volume::readVolume(file, listed.info.quantity));
  }
  const double time_s = volumes.front().info().time_s;
  return fieldOf(std::move(names), std::move(volumes), time_s);
}

std::tuple<double, double, double> geodeticOf(const Field& field, double x_m, double y_m, double z_m) {
  const volume::Grid& grid = field.volumes.front().grid();
  if (!grid.georeferenced) throw Error(ErrorCode::usage, "the volume has no position on the earth");
  const GeodeticPosition position = GeoFrame(grid.frame).toGeodetic({x_m, y_m, z_m});
  return {position.latitude_deg, position.longitude_deg, position.height_ellipsoid_m};
}

}  // namespace

void bindField(nb::module_& module) {
  nb::class_<Field>(module, "Field", "Volumes of one instant.")
      .def_ro("names", &Field::names)
      .def_ro("time_s", &Field::time_s)
      .def_prop_ro("is_on_gpu", [](const Field& field) { return field.volumes.front().isOnDevice(); })
      .def_prop_ro("scenario",
                   [](const Field& field) -> std::optional<ScenarioHandle> {
                     if (!field.scene) return std::nullopt;
                     return ScenarioHandle{field.scene->scenario};
                   })
      .def("grid", [](const Field& field) { return describeGrid(field.volumes.front().grid()); })
      .def("info", &infoOf, nb::arg("quantity"))
      .def("array", &numpyOf, nb::arg("quantity"),
           nb::sig("def array(self, quantity: str) -> numpy.typing.NDArray[numpy.float32]"))
      .def("dlpack", &dlpackOf, nb::arg("quantity"), nb::sig("def dlpack(self, quantity: str) -> typing.Any"))
      .def(
          "first_valid",
          [](const nb::handle_t<Field>& self, const std::string& quantity) -> nb::object {
            const Field& field = nb::cast<const Field&>(self);
            const volume::DenseVolume& volume = *field.host(field.indexOf(quantity));
            if (volume.first_valid_k.empty()) return nb::none();
            const std::vector<std::size_t> shape = shapeOf(volume.grid);
            return nb::cast(nb::ndarray<nb::numpy, const std::uint16_t>(volume.first_valid_k.data(), 2,
                                                                        shape.data() + 1, self));
          },
          nb::arg("quantity"),
          nb::sig("def first_valid(self, quantity: str) -> numpy.typing.NDArray[numpy.uint16] | None"))
      .def(
          "ground",
          [](const Field& field) -> nb::object {
            if (field.ground_msl_m == nullptr) return nb::none();
            const std::vector<std::size_t> shape = shapeOf(field.volumes.front().grid());
            return ownedArray(std::vector<float>(*field.ground_msl_m), {shape[1], shape[2]});
          },
          nb::sig("def ground(self) -> numpy.typing.NDArray[numpy.float32] | None"))
      .def("geodetic", &geodeticOf, nb::arg("x_m"), nb::arg("y_m"), nb::arg("z_m"))
      .def("write", &write, nb::arg("file"), nb::arg("quantities"));

  nb::class_<Solver>(module, "Solver", "Computes fields; keeps what time and edits do not change.")
      .def(nb::init<const ScenarioHandle&, const std::string&, int, std::vector<std::string>, bool, double,
                    double>(),
           nb::arg("scenario"), nb::arg("backend"), nb::arg("threads"), nb::arg("quantities"),
           nb::arg("allow_missing_terrain"), nb::arg("cache_mib"), nb::arg("move_tolerance_m"))
      .def("at", &Solver::at, nb::arg("t_s"), nb::arg("scenario").none(), nb::arg("poses"))
      .def_prop_ro("scenario", &Solver::scenario)
      .def_prop_ro("backend", &Solver::backend)
      .def_prop_ro("quantities", &Solver::quantities)
      .def("warnings", &Solver::warnings);

  module.def("read", &read, nb::arg("file"), "The volumes of a file.");
}

}  // namespace emscape::python
