#include "emfield/cuda/device_geometry.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "base/cuda/staged_copy.h"
#include "emfield/columns/column_geometry.h"
#include "emfield/cuda/device_positions.h"
#include "emfield/geometry/emitter_geometry.h"
#include "emscape/base/parallel.h"
#include "propagation/diffraction/model.h"
#include "propagation/parabolic_equation/field_march.h"
#include "propagation/registry/model_info.h"

namespace emscape::emfield::cuda {
namespace {

using emscape::cuda::check;
using emscape::cuda::downloadStaged;
using emscape::cuda::uploadStaged;

bool isDiffraction(const EmitterExcess& excess) {
  return std::holds_alternative<DiffractionExcess>(excess.model);
}

/// Work of the march on the GPU; 0: nothing.
double marchedHeights(const EmitterExcess& excess) {
  return excess.march == nullptr ? 0 : excess.march->heights();
}

}  // namespace

DeviceGeometry::DeviceGeometry(const FieldSetup& setup, int slots) : setup_(setup), slots_(slots) {
  const GridColumns& columns = setup.columns;
  t_m_.upload(columns.t_m);
  columns_.count = static_cast<int>(columns.count());
  columns_.row = columns.dims.x;
  columns_.t_m = t_m_.data();
  columns_.layers = static_cast<int>(columns.t_m.size());
  columns_.middle_m = columns.middle_m();
  excess_grid_ = excessGrid(columns, setup.terrain.get());
  excess_grid_.t_m = t_m_.data();
  if (columns.on_device != nullptr) {
    const DevicePositions& positions = *columns.on_device;
    terrain_ = positions.terrain;
    columns_.columns.of_surface = positions.columns.data();
    excess_grid_.first_valid_k = positions.first_valid_k.data();
    excess_grid_.ground_msl_m = positions.ground_msl_m.data();
  } else {
    copyColumns();
    if (setup.terrain != nullptr) highest_post_m_ = highestPost_m(setup.terrain->view());
  }
  excess_grid_.columns = columns_.columns;
}

/// Copies the terrain and the columns to the device.
void DeviceGeometry::copyColumns() {
  const emscape::cuda::Stream stream;
  const GridColumns& columns = setup_.columns;
  if (setup_.terrain != nullptr)
    terrain_ = std::make_shared<const DeviceTerrain>(setup_.terrain->view(), stream);
  uploadStaged(grid_columns_, columns.of_grid.data(), columns.of_grid.size(), stream);
  uploadStaged(position_columns_, columns.of_surface.data(), columns.of_surface.size(), stream);
  uploadStaged(first_valid_k_, columns.first_valid_k.data(), columns.first_valid_k.size(), stream);
  columns_.columns = {grid_columns_.data(), position_columns_.data()};
  excess_grid_.first_valid_k = first_valid_k_.data();
  if (excess_grid_.ground_msl_m != nullptr) {
    uploadStaged(ground_msl_m_, columns.ground_msl_m.data(), columns.ground_msl_m.size(), stream);
    excess_grid_.ground_msl_m = ground_msl_m_.data();
  }
  stream.wait();
}

ColumnGeometryView DeviceGeometry::view(int slot) const {
  const float* numbers = slots_[slot].numbers.data();
  const std::size_t columns = static_cast<std::size_t>(columns_.count);
  return columnGeometryView(numbers, columns, numbers + kColumnNumbers * columns,
                            slots_[slot].has_excess
                                ? ExcessView{slots_[slot].excess.data(), slots_[slot].excess_db.data()}
                                : ExcessView{},
                            slots_[slot].has_reflected ? slots_[slot].reflected.data() : nullptr,
                            slots_[slot].has_mechanisms ? slots_[slot].mechanisms.data() : nullptr);
}

ClutterMapView DeviceGeometry::clutterMap(int slot) const {
  const Slot& from = slots_[slot];
  return clutterMapView(from.clutter_grid, from.has_clutter ? from.clutter.data() : nullptr);
}

DeviceGeometry::Work DeviceGeometry::prepare(const GeometryRequest& request) const {
  Work work;
  const scenario::Scenario& scenario = *setup_.scenario;
  const Station station =
      makeStation(request.state.position, request.state.height_msl_m, scenario.atmosphere);
  const scenario::Emitter& emitter = scenario.emitters[request.emitter];
  const propagation::ModelInfo& model = propagation::modelInfo(emitter.propagation.model);
  work.has_shadow = model.casts_shadow;
  work.has_reflected_ray = model.has_reflected_ray;
  work.has_excess = hasExcess(scenario, emitter);
  work.is_equation = work.has_excess && model.radial != nullptr;
  if (work.has_excess && !work.is_equation) {
    work.model =
        planExcess(scenario, emitter, request.state.beam, station, setup_.terrain.get(), setup_.columns);
  }
  const propagation::PathExtent extent = pathExtent(station, setup_.columns);
  work.ranges_m = postRanges(extent.farthest_m, postSpacing_m(setup_.terrain.get()));
  work.ground = groundPosts(setup_.terrain.get(), work.ranges_m);
  if (terrain_ != nullptr) {
    work.ground.terrain = terrain_->view();
    work.ground.tiles = terrain_->tiles();
  }
  work.has_mechanisms = setup_.needs[request.emitter].mechanisms && hasMechanisms(model);
  if (setup_.needs[request.emitter].clutter_map)
    work.clutter = clutterMapTask(scenario, emitter, station, &extent);
  if (work.clutter) {
    std::vector<double> farther_m =
        clutterPostRanges(work.clutter->grid, postSpacing_m(setup_.terrain.get()));
    work.clutter->ground = work.ground;
    work.clutter->ground.range_count = static_cast<int>(farther_m.size());
    if (farther_m.size() > work.ranges_m.size()) work.ranges_m = std::move(farther_m);
  }
  work.can_interpolate =
      (work.has_shadow || (work.model && isDiffraction(*work.model))) &&
      EmitterGeometry::interpolates(scenario, emitter, setup_.columns, setup_.needs[request.emitter]);
  const double far_m = setup_.far_field_m[request.emitter];
  work.task.station = station;
  work.task.near2_m2 = static_cast<float>(far_m * far_m);
  return work;
}

void DeviceGeometry::planEquation(const GeometryRequest& request, Work& work) const {
  const scenario::Emitter& emitter = setup_.scenario->emitters[request.emitter];
  work.model = planExcess(*setup_.scenario, emitter, request.state.beam, work.task.station,
                          setup_.terrain.get(), setup_.columns);
  if (work.model->march == nullptr) return;
  if (!isForGpu(*work.model->march)) {
    marchTables(emitter, *work.model);
  } else {
    inModel(emitter, [&] { work.march_inputs = propagation::FieldMarchCuda::inputs(*work.model->march); });
  }
}

/// Assigns memory to the tasks.
void DeviceGeometry::place(std::vector<Work>& works, cudaStream_t stream) {
  // All lists of ranges are prefixes of the longest.
  const auto longest = std::max_element(works.begin(), works.end(), [](const Work& a, const Work& b) {
    return a.ranges_m.size() < b.ranges_m.size();
  });
  const double* const ranges_m = ranges_m_.send(longest->ranges_m, stream);
  GeometryCounts* counts = counts_.atLeast(works.size());
  check(cudaMemsetAsync(counts, 0, works.size() * sizeof(GeometryCounts), stream), "cudaMemsetAsync");
  std::vector<LocateTask> tasks;
  for (Work& work : works) {
    work.ground.ranges_m = ranges_m;
    if (work.clutter) work.clutter->ground.ranges_m = ranges_m;
    work.task.counts = work.excess.counts = counts++;
    tasks.push_back(work.task);
  }
  tasks_.send(tasks, stream);
}

/// Copies the models' tables, one after another, through pinned memory: for a hundred emitters they are
/// megabytes.
void DeviceGeometry::placeTables(std::vector<Work>& works, cudaStream_t stream) {
  struct Piece {
    const char* from;
    std::size_t begin, end;  // bytes of the copy
  };
  std::vector<Piece> pieces;
  std::size_t bytes = 0;
  for (const Work& work : works) {
    if (work.is_equation || !work.model) continue;
    for (const auto& table : {work.model->model_tables, work.model->air_tables}) {
      const std::size_t end = bytes + table->size() * sizeof(float);
      pieces.push_back({reinterpret_cast<const char*>(table->data()), bytes, end});
      bytes = end;
    }
  }
  model_tables_.atLeast(bytes / sizeof(float));
  const auto fill = [&](char* to, std::size_t begin, std::size_t end) {
    for (const Piece& piece : pieces) {
      const std::size_t first = std::max(begin, piece.begin), last = std::min(end, piece.end);
      if (first < last) std::memcpy(to + (first - begin), piece.from + (first - piece.begin), last - first);
    }
  };
  uploadStaged(model_tables_.data(), bytes, fill, stream);
  const float* table = model_tables_.data();
  for (Work& work : works) {
    if (work.is_equation || !work.model) continue;
    const float* const air = table + work.model->model_tables->size();
    const float* const next = air + work.model->air_tables->size();
    work.model = work.model->withTablesAt(table, air);
    table = next;
  }
}

std::vector<GeometryResult> DeviceGeometry::compute(const std::vector<GeometryRequest>& requests,
                                                    cudaStream_t stream, StageClock& clock) {
  std::vector<Work> works(requests.size());
  parallelFor(static_cast<int>(requests.size()), 1, [&](int begin, int end) {
    for (int r = begin; r < end; ++r) works[r] = prepare(requests[r]);
  });
  const auto columns = static_cast<std::size_t>(columns_.count);
  for (std::size_t r = 0; r < requests.size(); ++r) {
    Slot& slot = slots_[requests[r].slot];
    LocateTask& task = works[r].task;
    task.numbers = slot.numbers.atLeast((kColumnNumbers + 1) * columns);
    task.shadow_edge_m = task.numbers + kColumnNumbers * columns;
    slot.has_excess = works[r].has_excess;
    slot.has_reflected = works[r].has_reflected_ray;
    slot.has_mechanisms = works[r].has_mechanisms;
    slot.has_clutter = works[r].clutter.has_value();
    if (slot.has_clutter) {
      slot.clutter_grid = works[r].clutter->grid;
      slot.clutter.atLeast(slot.clutter_grid.cells());
    }
    if (!slot.has_excess) continue;
    const std::size_t voxels = columns * static_cast<std::size_t>(columns_.layers);
    const bool in_db = setup_.columns.every_height;
    works[r].excess.out = {
        {in_db ? nullptr : slot.excess.atLeast(voxels), in_db ? slot.excess_db.atLeast(voxels) : nullptr},
        slot.has_reflected ? slot.reflected.atLeast(voxels) : nullptr,
        slot.has_mechanisms ? slot.mechanisms.atLeast(voxels) : nullptr,
        task.shadow_edge_m};
  }
  std::vector<std::size_t> equations;
  for (std::size_t r = 0; r < works.size(); ++r) {
    if (works[r].is_equation) equations.push_back(r);
  }
  // While the device computes the other models, the host plans the marches.
  const auto count_of_equations = static_cast<int>(equations.size());
  const int device = emscape::cuda::currentDevice();
  parallelFor(1 + count_of_equations, 1, [&](int begin, int end) {
    const emscape::cuda::OnDevice here(device);  // the thread may be another one
    for (int i = begin; i < end; ++i) {
      if (i == 0) {
        computeUnmarched(requests, works, stream, clock);
      } else {
        planEquation(requests[equations[i - 1]], works[equations[i - 1]]);
      }
    }
  });
  std::vector<Work*> marched;
  for (const std::size_t r : equations) marched.push_back(&works[r]);
  std::stable_sort(marched.begin(), marched.end(), [](const Work* a, const Work* b) {
    return marchedHeights(*a->model) > marchedHeights(*b->model);
  });
  const auto marcherOf = [&](std::size_t n) -> Marcher& {
    std::unique_ptr<Marcher>& marcher = marchers_[n % marchers_.size()];
    if (marcher == nullptr) marcher = std::make_unique<Marcher>();
    return *marcher;
  };
  clock.begin(stream);  // before the host waits for a march's memory, as it may for most of its time
  for (std::size_t n = 0; n < std::min(marched.size(), marchers_.size()); ++n)
    startMarch(*marched[n], marcherOf(n));
  for (std::size_t n = 0; n < marched.size(); ++n) {
    readMarch(*marched[n], marcherOf(n), stream, clock);
    const std::size_t next = n + marchers_.size();
    if (next < marched.size()) startMarch(*marched[next], marcherOf(next));
  }

  std::vector<GeometryCounts> counts(works.size());
  check(cudaMemcpyAsync(counts.data(), counts_.data(), counts.size() * sizeof(GeometryCounts),
                        cudaMemcpyDeviceToHost, stream),
        "cudaMemcpyAsync from the GPU");
  check(cudaStreamSynchronize(stream), "cudaStreamSynchronize");
  const ColumnPart part{requests.front().part.step, 0};
  const auto interpolated =
      std::count_if(works.begin(), works.end(), [](const Work& work) { return work.can_interpolate; });
  const double every_column_ms =
      interpolated == 0
          ? 0
          : part_timer_.elapsed_ms() / part.fraction(setup_.grid.dims) / static_cast<double>(interpolated);
  std::vector<GeometryResult> all;
  for (std::size_t r = 0; r < works.size(); ++r) {
    GeometryResult found;
    if (works[r].can_interpolate) {
      found.column_step = part.step;
      found.every_column_ms = every_column_ms;
    }
    found.unknown_columns = counts[r].unknown_columns;
    found.warnings = counts[r].warnings;
    if (works[r].model) found.steep = works[r].model->steep;
    found.near_voxels = static_cast<long long>(counts[r].near_voxels);
    if (found.unknown_columns > 0) {
      found.unknown.resize(columns);
      markUnknownColumns(works[r].task.shadow_edge_m, columns_.count, unknown_.atLeast(columns), stream);
      downloadStaged(found.unknown.data(), unknown_.data(), columns, stream);
    }
    all.push_back(std::move(found));
  }
  return all;
}

/// All models without a march, in order.
void DeviceGeometry::computeUnmarched(const std::vector<GeometryRequest>& requests, std::vector<Work>& works,
                                      cudaStream_t stream, StageClock& clock) {
  clock.begin(stream);
  place(works, stream);
  locateColumns(tasks_.data(), static_cast<int>(works.size()), columns_, stream);
  clock.end(&StageTimes::columns_ms, stream);
  placed_.record(stream);
  clock.begin(stream);
  placeTables(works, stream);
  findShadows(works, excess_grid_, false, stream);
  fillDiffractions(requests, works, excess_grid_, false, stream);
  ExcessGrid part = excess_grid_;
  part.part.step = requests.front().part.step;
  part_timer_.begin(stream);
  findShadows(works, part, true, stream);
  fillDiffractions(requests, works, part, true, stream);
  part_timer_.end(stream);
  if (part.part.step > 1) interpolate(works, part, stream);
  for (const Work& work : works) {
    if (work.is_equation || !work.model || isDiffraction(*work.model)) continue;
    fillExcess(*work.model, work.task.station, excess_grid_, work.ground, work.excess, scratch(), stream);
  }
  for (std::size_t r = 0; r < requests.size(); ++r) {
    if (works[r].clutter) fillClutterMap(*works[r].clutter, slots_[requests[r].slot].clutter.data(), stream);
  }
  clock.end(&StageTimes::excess_ms, stream);
}

/// @param of_part  of those that can interpolate, else of the others
void DeviceGeometry::findShadows(const std::vector<Work>& works, const ExcessGrid& grid, bool of_part,
                                 cudaStream_t stream) {
  std::vector<DeviceShadowTask> shadows;
  std::size_t all_ranges = 0;
  int most_ranges = 0;
  for (const Work& work : works) {
    if (!work.has_shadow || work.can_interpolate != of_part) continue;
    shadows.push_back({{work.task.station, work.ground, nullptr, highest_post_m_},
                       nullptr,
                       work.task.shadow_edge_m,
                       work.task.counts});
    all_ranges += work.ranges_m.size();
    most_ranges = std::max(most_ranges, work.ground.range_count);
  }
  if (shadows.empty()) return;
  RangeTerms<float>* terms = terms_[of_part].atLeast(all_ranges);
  for (DeviceShadowTask& shadow : shadows) {
    shadow.task.terms = shadow.terms = terms;
    terms += shadow.task.ground.range_count;
  }
  findShadowEdges(shadows_[of_part].send(shadows, stream), static_cast<int>(shadows.size()), most_ranges,
                  grid, columns_.row, stream);
}

/// @param of_part  as findShadows()
void DeviceGeometry::fillDiffractions(const std::vector<GeometryRequest>& requests,
                                      const std::vector<Work>& works, const ExcessGrid& grid, bool of_part,
                                      cudaStream_t stream) {
  std::vector<DeviceDiffractionTask> tasks;
  for (std::size_t r = 0; r < works.size(); ++r) {
    const Work& work = works[r];
    if (work.can_interpolate != of_part) continue;
    if (work.is_equation ? setup_.terrain == nullptr : !work.model) continue;
    // Of models that read the diffraction beside their own excess it is without air and refraction.
    DiffractionTask task{{}, AirLoss{}, work.task.station, work.ground, work.excess.out};
    task.station.refraction.exponential = false;
    if (work.is_equation) {
      task.model = besideEquation(requests[r], work);
    } else if (const auto* itm = std::get_if<propagation::ItmExcess>(&work.model->model)) {
      task.model = itm->diffraction;
      task.ground.is_raised = work.model->is_raised && work.ground.terrain.hasCover();
      task.ground.has_clutter = work.model->has_clutter;
    } else if (isDiffraction(*work.model)) {
      task = {std::get<DiffractionExcess>(work.model->model),
              work.model->air,
              work.task.station,
              work.ground,
              work.excess.out,
              work.model->terminal};
      task.ground.is_raised = work.model->is_raised && work.ground.terrain.hasCover();
      task.ground.has_clutter = work.model->has_clutter;
      task.at_crossings = true;
    } else {
      continue;
    }
    tasks.push_back({task, work.excess.counts});
  }
  if (tasks.empty()) return;
  fillDiffraction(diffraction_[of_part].send(tasks, stream), static_cast<int>(tasks.size()), grid,
                  columns_.row, stream);
}

/// The columns that are not of the part.
void DeviceGeometry::interpolate(const std::vector<Work>& works, const ExcessGrid& grid,
                                 cudaStream_t stream) {
  std::vector<DevicePartTask> tasks;
  for (const Work& work : works) {
    if (!work.can_interpolate) continue;
    const bool has_codes = work.model && isDiffraction(*work.model);
    tasks.push_back(
        {has_codes ? work.excess.out.excess.codes : nullptr, work.task.shadow_edge_m, work.task.counts});
  }
  if (tasks.empty()) return;
  interpolateColumns(parts_.send(tasks, stream), static_cast<int>(tasks.size()), grid, columns_.row, stream);
}

/// PeOthers::diffraction of an equation before its plan.
DiffractionExcess DeviceGeometry::besideEquation(const GeometryRequest& request, const Work& work) const {
  const scenario::Emitter& emitter = setup_.scenario->emitters[request.emitter];
  return propagation::diffractionExcess(pathInputs(*setup_.scenario, emitter, request.state.beam,
                                                   work.task.station, setup_.terrain.get(),
                                                   pathExtent(work.task.station, setup_.columns)));
}

/// Copies an equation's tables to the device, and begins the march if the host has not done it.
void DeviceGeometry::startMarch(Work& work, Marcher& marcher) {
  placed_.holdBack(marcher.stream);
  marcher.read.holdBack(marcher.stream);
  EmitterExcess& model = *work.model;
  const float* const tables =
      model.march == nullptr
          ? marcher.model_tables.send(*model.model_tables, marcher.stream)
          : marcher.march.start(*model.march, std::move(work.march_inputs), marcher.stream);
  model = model.withTablesAt(tables, marcher.air_tables.send(*model.air_tables, marcher.stream));
  marcher.marched.record(marcher.stream);
}

/// The voxels of an emitter whose march has begun; the clock runs since the voxels of the one before.
void DeviceGeometry::readMarch(const Work& work, Marcher& marcher, cudaStream_t stream, StageClock& clock) {
  marcher.marched.holdBack(stream);
  clock.end(&StageTimes::march_ms, stream);
  clock.countMarch(marchedHeights(*work.model));
  clock.begin(stream);
  fillEquation({std::get<propagation::PeExcess>(work.model->model), work.model->air, work.task.station,
                work.ground, work.excess},
               excess_grid_, columns_.row, scratch(), stream);
  clock.end(&StageTimes::excess_ms, stream);
  marcher.read.record(stream);
  clock.begin(stream);  // of the next wait
}

ScratchMemory DeviceGeometry::scratch() {
  return {scratch_.atLeast(kDeviceScratchBytes / sizeof(double)), kDeviceScratchBytes};
}

std::size_t DeviceGeometry::bytes() const {
  const auto bytesOf = [](const auto& buffer) { return buffer.size() * sizeof(*buffer.data()); };
  std::size_t bytes = bytesOf(grid_columns_) + bytesOf(position_columns_) + bytesOf(t_m_) +
                      bytesOf(first_valid_k_) + bytesOf(tasks_) + bytesOf(ranges_m_) + bytesOf(parts_) +
                      bytesOf(scratch_) + bytesOf(ground_msl_m_) + bytesOf(model_tables_) + bytesOf(unknown_);
  for (const int of : {0, 1})
    bytes += bytesOf(shadows_[of]) + bytesOf(terms_[of]) + bytesOf(diffraction_[of]);
  if (setup_.columns.on_device != nullptr) bytes += setup_.columns.on_device->bytes();
  for (const std::unique_ptr<Marcher>& marcher : marchers_) {
    if (marcher == nullptr) continue;
    bytes += marcher->march.bytes() + bytesOf(marcher->model_tables) + bytesOf(marcher->air_tables);
  }
  for (const Slot& slot : slots_) {
    bytes += bytesOf(slot.numbers) + bytesOf(slot.excess) + bytesOf(slot.excess_db) +
             bytesOf(slot.reflected) + bytesOf(slot.mechanisms) + bytesOf(slot.clutter);
  }
  return bytes + (setup_.terrain == nullptr ? 0 : postBytes(setup_.terrain->view()));
}

}  // namespace emscape::emfield::cuda
