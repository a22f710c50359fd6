/// Parts of the extension module, and their shared functions.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/function.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "emscape/base/progress.h"
#include "emscape/scenario/model/scenario.h"
#include "emscape/volume/grid.h"

namespace emscape::python {

namespace nb = nanobind;

using Edits = std::vector<std::pair<std::string, std::string>>;  ///< path, value in YAML
using ProgressCall = std::optional<nb::typed<nb::callable, void(std::string, double)>>;  ///< step, fraction
using Dict = nb::typed<nb::dict, nb::str, nb::any>;

/// The Python object of a scenario; nanobind classes cannot hold pointers to const.
struct ScenarioHandle {
  std::shared_ptr<const scenario::Scenario> scenario;
};

// Each adds its functions and classes to the module.
void bindErrors(nb::module_& module);
void bindScenario(nb::module_& module);
void bindField(nb::module_& module);
void bindCoverage(nb::module_& module);
void bindPicture(nb::module_& module);
void bindStudies(nb::module_& module);

/// To be called at the start of work that uses threads or a GPU.
/// @throws Error (usage) in a process that was forked from one that had called it: neither oneTBB nor CUDA
/// survives fork()
void refuseForkedProcess();

/// Calls a Python function with the interpreter locked, at most ten times a second and at the end of each
/// step; signals are handled in between, so that Ctrl-C ends the work with KeyboardInterrupt.
ProgressSink progressSink(const ProgressCall& call);

/// @param unit  for the message, with a space before it, or empty. @throws Error (usage) with the name, the
/// value and the limits
void requireWithin(const char* name, double value, double min, double max, const char* unit);

std::vector<scenario::Edit> editsOf(const Edits& edits);

/// dims, spacing_m, first_center_m; frame, latitude_deg, longitude_deg and height_msl_m of its origin if it
/// has a position on the earth.
Dict describeGrid(const volume::Grid& grid);

/// An array that owns its values. @param shape  of all axes
template <class Value>
nb::object ownedArray(std::vector<Value> values, std::initializer_list<std::size_t> shape) {
  auto owner = std::make_unique<std::vector<Value>>(std::move(values));
  const nb::capsule capsule(owner.get(),
                            [](void* held) noexcept { delete static_cast<std::vector<Value>*>(held); });
  Value* const data = owner.release()->data();
  return nb::cast(nb::ndarray<nb::numpy, Value>(data, shape.size(), shape.begin(), capsule));
}

}  // namespace emscape::python
