#include "emfield/cuda/device_geometry.h"

#include <algorithm>
#include <cmath>

#include "emfield/column_geometry.h"
#include "emscape/base/parallel.h"
#include "propagation/registry/model_info.h"

namespace emscape::emfield::cuda {
namespace {

using emscape::cuda::Buffer;
using emscape::cuda::check;

/// Samples of fans in memory at once: larger fans are computed sector by sector.
constexpr long long kMaxSamples = kDeviceScratchBytes / sizeof(float);

/// Makes an array at least so long; its contents are lost. It never shrinks: sizes vary little from one
/// update to the next, and freeing memory would make every stream wait.
template <class T>
T* atLeast(Buffer<T>& buffer, std::size_t count) {
  if (buffer.size() < count) buffer.resize(buffer.size() == 0 ? count : count + count / 4);
  return buffer.data();
}

/// Copies into an array that is at least so long.
template <class T>
const T* sent(Buffer<T>& buffer, const std::vector<T>& from, cudaStream_t stream) {
  T* const to = atLeast(buffer, from.size());
  check(cudaMemcpyAsync(to, from.data(), from.size() * sizeof(T), cudaMemcpyHostToDevice, stream),
        "cudaMemcpyAsync to the GPU");
  return to;
}

/// Columns of a grid's outer rows.
std::vector<int> borderOf(const Dims& dims) {
  std::vector<int> border;
  for (int j = 0; j < dims.y; ++j) {
    const bool is_outer = j == 0 || j == dims.y - 1;
    for (int i = 0; i < dims.x; i += is_outer || i == dims.x - 1 ? 1 : dims.x - 1) {
      border.push_back(j * dims.x + i);
    }
  }
  return border;
}

}  // namespace

DeviceGeometry::DeviceGeometry(const FieldSetup& setup, int slots)
    : setup_(setup), tilt_m_(tiltOf(setup.columns)), border_(borderOf(setup.grid.dims)), slots_(slots) {
  if (setup.terrain != nullptr) terrain_ = DeviceTerrain(setup.terrain->view());
  grid_columns_.upload(setup.columns.columns);
  t_m_.upload(setup.columns.t_m);
  first_valid_k_.upload(setup.columns.first_valid_k);
  columns_.columns = grid_columns_.data();
  columns_.count = static_cast<int>(setup.columns.columns.size());
  columns_.row = setup.columns.dims.x;
  columns_.t_m = t_m_.data();
  columns_.layers = static_cast<int>(setup.columns.t_m.size());
  columns_.middle_m = setup.columns.middle_m();
  columns_.tilted = setup.columns.tilted;
  excess_grid_ = excessGrid(setup.columns, setup.resolution);
  excess_grid_.columns = grid_columns_.data();
  excess_grid_.t_m = t_m_.data();
  if (excess_grid_.ground_msl_m != nullptr) {
    ground_msl_m_.upload(setup.columns.ground_msl_m);
    excess_grid_.ground_msl_m = ground_msl_m_.data();
  }
}

ColumnGeometryView DeviceGeometry::view(int slot) const {
  const float* numbers = slots_[slot].numbers.data();
  const std::size_t columns = static_cast<std::size_t>(columns_.count);
  return columnGeometryView(numbers, columns, numbers + kColumnNumbers * columns,
                            slots_[slot].has_excess ? slots_[slot].excess.data() : nullptr,
                            slots_[slot].has_reflected ? slots_[slot].reflected.data() : nullptr);
}

/// The fan reaches every column as soon as it reaches those at the grid's border.
DeviceGeometry::Work DeviceGeometry::prepare(const GeometryRequest& request) const {
  Work work;
  const scenario::Scenario& scenario = *setup_.scenario;
  work.station =
      makeStation(request.state.position, request.state.height_msl_m, scenario.atmosphere.k_factor);
  const scenario::Emitter& emitter = scenario.emitters[request.emitter];
  const propagation::ModelInfo& model = propagation::modelInfo(emitter.propagation.model);
  work.has_shadow = model.casts_shadow;
  work.has_reflected_ray = model.has_reflected_ray;
  if (hasExcess(scenario, emitter)) {
    work.model =
        makeExcess(scenario, emitter, work.station, setup_.terrain.get(), setup_.columns, setup_.resolution);
  }
  if (work.needsFan()) {
    std::vector<FanCoordinates> coordinates;
    for (int c : border_) {
      coordinates.push_back(fanCoordinates(work.station, setup_.columns.columns[c], columns_.middle_m));
    }
    work.shape = fanShape(work.station, coordinates, setup_.terrain.get(), setup_.resolution, tilt_m_);
  }
  const double far_m = setup_.far_field_m[request.emitter];
  work.task.station = work.station;
  work.task.near2_m2 = static_cast<float>(far_m * far_m);
  return work;
}

/// Assigns memory to the tasks.
void DeviceGeometry::place(std::vector<Work>& works, cudaStream_t stream) {
  std::vector<double> ranges_m;
  std::size_t azimuths = 0;
  for (const Work& work : works) {
    ranges_m.insert(ranges_m.end(), work.shape.ranges_m.begin(), work.shape.ranges_m.end());
    azimuths += work.needsFan() ? static_cast<std::size_t>(work.shape.interval_count) + 1 : 0;
  }
  const auto columns = static_cast<std::size_t>(columns_.count);
  const double* range_m = sent(ranges_m_, ranges_m, stream);
  int* used = atLeast(used_ranges_, azimuths);
  FanIndex* fan_indices = atLeast(fan_indices_, works.size() * columns);
  GeometryCounts* counts = atLeast(counts_, works.size());
  atLeast(terms_, ranges_m.size());
  // Tilted columns extend over several azimuths: all ranges of each are used.
  check(cudaMemsetAsync(used, columns_.tilted ? 0x7f : 0, azimuths * sizeof(int), stream), "cudaMemsetAsync");
  check(cudaMemsetAsync(counts, 0, works.size() * sizeof(GeometryCounts), stream), "cudaMemsetAsync");
  std::vector<LocateTask> tasks;
  for (Work& work : works) {
    LocateTask& task = work.task;
    task.fan_indices = fan_indices;
    task.counts = work.excess.counts = counts++;
    fan_indices += columns;
    if (work.needsFan()) {
      task.fan = work.shape.view();
      task.fan.ranges_m = range_m;
      task.used_ranges = used;
      range_m += work.shape.rangeCount();
      used += work.shape.interval_count + 1;
    }
    tasks.push_back(task);
  }
  sent(tasks_, tasks, stream);

  std::vector<float> tables;
  for (const Work& work : works) {
    if (!work.model) continue;
    for (const auto& table : {work.model->model_tables, work.model->air_tables}) {
      tables.insert(tables.end(), table->begin(), table->end());
    }
  }
  const float* table = sent(model_tables_, tables, stream);
  for (Work& work : works) {
    if (!work.model) continue;
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
    task.numbers = atLeast(slot.numbers, (kColumnNumbers + 1) * columns);
    task.shadow_edge_m = task.numbers + kColumnNumbers * columns;
    slot.has_excess = works[r].model.has_value();
    slot.has_reflected = works[r].has_reflected_ray;
    if (!slot.has_excess) continue;
    const std::size_t voxels = columns * static_cast<std::size_t>(columns_.layers);
    works[r].excess.out = {atLeast(slot.excess, voxels),
                           slot.has_reflected ? atLeast(slot.reflected, voxels) : nullptr,
                           task.shadow_edge_m};
  }
  clock.begin(stream);
  place(works, stream);
  locateColumns(tasks_.data(), static_cast<int>(works.size()), columns_, stream);
  clock.end(&StageTimes::fan_ms, stream);
  for (const Work& work : works) {
    if (!work.model || work.model->needsTerrain()) continue;
    clock.begin(stream);
    fill(work, {}, stream);
    clock.end(&StageTimes::excess_ms, stream);
  }
  for (Batch& batch : batchesOf(works)) runBatch(batch, stream, clock);

  std::vector<GeometryCounts> counts(works.size());
  check(cudaMemcpyAsync(counts.data(), counts_.data(), counts.size() * sizeof(GeometryCounts),
                        cudaMemcpyDeviceToHost, stream),
        "cudaMemcpyAsync from the GPU");
  check(cudaStreamSynchronize(stream), "cudaStreamSynchronize");
  std::vector<GeometryResult> all;
  for (std::size_t r = 0; r < works.size(); ++r) {
    GeometryResult found;
    found.unknown_columns = counts[r].unknown_columns;
    found.warnings = counts[r].warnings;
    found.near_voxels = static_cast<long long>(counts[r].near_voxels);
    if (found.unknown_columns > 0) {
      std::vector<float> edges_m(columns);
      check(cudaMemcpy(edges_m.data(), works[r].task.shadow_edge_m, columns * sizeof(float),
                       cudaMemcpyDeviceToHost),
            "cudaMemcpy from the GPU");
      for (float edge_m : edges_m) found.unknown.push_back(std::isnan(edge_m));
    }
    all.push_back(std::move(found));
  }
  return all;
}

bool DeviceGeometry::isDiffraction(const Work& work) {
  return work.model && std::holds_alternative<propagation::DiffractionExcess>(work.model->model);
}

/// As many intervals at a time as fit into the memory for samples.
std::vector<DeviceGeometry::Batch> DeviceGeometry::batchesOf(const std::vector<Work>& works) {
  std::vector<Batch> batches;
  long long samples = 0, most_samples = 0;
  RangeTerms<float>* terms = terms_.data();
  for (const Work& work : works) {
    if (!work.needsFan()) continue;
    const long long ranges = work.shape.rangeCount();
    const int intervals = work.shape.interval_count;
    // A tilted column may cross intervals: it needs them all at once.
    const long long at_once = columns_.tilted ? intervals : std::max(1LL, kMaxSamples / ranges - 1);
    for (int first = 0; first < intervals; first += static_cast<int>(at_once)) {
      FanSector sector;
      sector.emitter = work.task;
      sector.first_interval = first;
      sector.interval_count = static_cast<int>(std::min<long long>(at_once, intervals - first));
      sector.terrain = terrain_.view();
      sector.has_terrain = setup_.terrain != nullptr;
      sector.terms = terms;
      sector.holds_slopes = work.has_shadow;
      // Diffraction's threads of neighbouring columns read neighbouring azimuths; other models' threads each
      // read a profile.
      const bool azimuth_fastest = work.has_shadow || isDiffraction(work);
      sector.azimuth_stride = azimuth_fastest ? 1 : ranges;
      sector.range_stride = azimuth_fastest ? sector.interval_count + 1 : 1;
      const long long here = ranges * (sector.interval_count + 1);
      if (batches.empty() || samples + here > kMaxSamples) {
        batches.emplace_back();
        samples = 0;
      }
      batches.back().works.push_back(&work);
      batches.back().sectors.push_back(sector);
      samples += here;
      most_samples = std::max(most_samples, samples);
    }
    terms += ranges;
  }
  float* const first = atLeast(samples_, static_cast<std::size_t>(most_samples));
  for (Batch& batch : batches) {
    float* next = first;
    for (FanSector& sector : batch.sectors) {
      sector.samples = next;
      next += static_cast<long long>(sector.emitter.fan.range_count) * (sector.interval_count + 1);
    }
  }
  return batches;
}

void DeviceGeometry::runBatch(Batch& batch, cudaStream_t stream, StageClock& clock) {
  SectorExtent extent;
  extent.sectors = static_cast<int>(batch.sectors.size());
  bool has_slopes = false;
  std::vector<DiffractionTask> diffraction;
  for (std::size_t p = 0; p < batch.sectors.size(); ++p) {
    const FanSector& sector = batch.sectors[p];
    const Work& work = *batch.works[p];
    extent.azimuths = std::max(extent.azimuths, sector.interval_count + 1);
    extent.ranges = std::max(extent.ranges, sector.emitter.fan.range_count);
    has_slopes = has_slopes || sector.holds_slopes;
    if (isDiffraction(work)) {
      diffraction.push_back({std::get<propagation::DiffractionExcess>(work.model->model), work.model->air,
                             sector, work.excess});
    }
  }
  clock.begin(stream);
  const FanSector* const sectors = sent(sectors_, batch.sectors, stream);
  readFans(sectors, extent, stream);
  clock.end(&StageTimes::fan_ms, stream);
  clock.begin(stream);
  if (has_slopes) findShadowEdges(sectors, extent, columns_, stream);
  if (!diffraction.empty()) fillDiffractions(diffraction, extent, stream);
  for (std::size_t p = 0; p < batch.sectors.size(); ++p) {
    const FanSector& sector = batch.sectors[p];
    const Work& work = *batch.works[p];
    if (work.has_shadow || isDiffraction(work)) continue;
    fill(work, {sector.emitter.fan, sector.samples, sector.first_interval, sector.interval_count}, stream);
  }
  clock.end(&StageTimes::excess_ms, stream);
}

void DeviceGeometry::fillDiffractions(std::vector<DiffractionTask>& tasks, SectorExtent extent,
                                      cudaStream_t stream) {
  const auto blocksOf = [](const FanSector& sector) {
    return static_cast<std::size_t>(DiffractionTask::blockCount(sector.emitter.fan.range_count)) *
           static_cast<std::size_t>(sector.interval_count + 1);
  };
  std::size_t blocks = 0;
  for (const DiffractionTask& task : tasks) blocks += blocksOf(task.sector);
  FanBlock* next_block = atLeast(blocks_, blocks);
  TerrainSums* next_sums = atLeast(sums_, blocks);
  for (DiffractionTask& task : tasks) {
    task.blocks = next_block;
    task.sums = next_sums;
    next_block += blocksOf(task.sector);
    next_sums += blocksOf(task.sector);
  }
  extent.sectors = static_cast<int>(tasks.size());
  fillDiffraction(sent(diffraction_, tasks, stream), extent, excess_grid_, columns_.row, columns_.tilted,
                  firstValidK(), stream);
}

/// The excess of any model, with memory for one column per thread.
void DeviceGeometry::fill(const Work& work, const FanHeights& fan, cudaStream_t stream) {
  double* const scratch = atLeast(scratch_, kDeviceScratchBytes / sizeof(double));
  fillExcess(*work.model, work.station, excess_grid_, fan, work.excess, scratch, kDeviceScratchBytes, stream);
}

std::size_t DeviceGeometry::bytes() const {
  const auto bytesOf = [](const auto& buffer) { return buffer.size() * sizeof(*buffer.data()); };
  std::size_t bytes = bytesOf(grid_columns_) + bytesOf(t_m_) + bytesOf(first_valid_k_) + bytesOf(tasks_) +
                      bytesOf(sectors_) + bytesOf(ranges_m_) + bytesOf(used_ranges_) + bytesOf(fan_indices_) +
                      bytesOf(terms_) + bytesOf(samples_) + bytesOf(diffraction_) + bytesOf(blocks_) +
                      bytesOf(sums_) + bytesOf(scratch_) + bytesOf(ground_msl_m_) + bytesOf(model_tables_);
  for (const Slot& slot : slots_) {
    bytes += bytesOf(slot.numbers) + bytesOf(slot.excess) + bytesOf(slot.reflected);
  }
  return bytes + (setup_.terrain == nullptr ? 0 : postBytes(setup_.terrain->view()));
}

}  // namespace emscape::emfield::cuda
