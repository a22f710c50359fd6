#include "base/cuda/cuda_memory.h"
#include "emfield/column_geometry.h"
#include "emfield/cuda/geometry_kernels.h"
#include "emfield/fan_chord.h"
#include "emfield/solver/field_engine.h"

namespace emscape::emfield::cuda {
namespace {

using emscape::cuda::checkLaunch;

constexpr int kThreads = 128;
constexpr int kWarp = 32;
/// A thread reads this many samples along its azimuth, so that several samples use one chord.
constexpr int kRun = 16;
constexpr int kRuns = 8;  ///< threads of a block along an azimuth
/// Samples that are loaded while the slopes before them are compared.
constexpr int kAhead = 16;

unsigned blocksFor(int threads, int block = kThreads) {
  return static_cast<unsigned>((threads + block - 1) / block);
}

__global__ void locateKernel(const LocateTask* tasks, DeviceColumns columns) {
  const int c = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
  if (c >= columns.count) return;
  const LocateTask& task = tasks[blockIdx.y];
  const GridColumn column = columns.columns[c];
  const FanCoordinates point = fanCoordinates(task.station, column, columns.middle_m);
  columnGeometry(task.station, column, point, columns.middle_m, task.numbers + c, columns.count);
  task.shadow_edge_m[c] = -HUGE_VALF;

  const ColumnGeometryView numbers = columnGeometryView(task.numbers, static_cast<std::size_t>(columns.count),
                                                        task.shadow_edge_m, nullptr, nullptr);
  const int near = nearVoxels(numbers, c, columns.t_m, columns.layers, task.near2_m2);
  if (near > 0) atomicAdd(&task.counts->near_voxels, static_cast<unsigned long long>(near));

  if (task.fan.range_count == 0) return;
  const double azimuth_index = task.fan.azimuthIndex(point.azimuth_rad);
  task.fan_indices[c] = {azimuth_index, point.range_m};
  const int used = task.fan.lastBefore(point.range_m) + 1;
  int* azimuth = task.used_ranges + static_cast<int>(azimuth_index);
  if (azimuth[0] < used) atomicMax(azimuth, used);
  if (azimuth[1] < used) atomicMax(azimuth + 1, used);
}

__global__ void termsKernel(const FanSector* sectors) {
  const FanSector& sector = sectors[blockIdx.y];
  const FanView& fan = sector.emitter.fan;
  const int i = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
  if (i < fan.range_count) {
    sector.terms[i] = horizonGeometry<float>(sector.emitter.station).termsAt(fan.ranges_m[i]);
  }
}

__global__ void __launch_bounds__(kWarp* kRuns) readKernel(const FanSector* sectors) {
  const FanSector& sector = sectors[blockIdx.z];
  const FanView& fan = sector.emitter.fan;
  const int azimuths = sector.interval_count + 1;
  const int a = static_cast<int>(blockIdx.x) * kWarp + static_cast<int>(threadIdx.x);
  const int begin = (static_cast<int>(blockIdx.y) * kRuns + static_cast<int>(threadIdx.y)) * kRun;
  if (a >= azimuths) return;
  const int used = sector.usedRanges(a);
  const int end = begin + kRun < used ? begin + kRun : used;
  if (begin >= end) return;

  const Station& station = sector.emitter.station;
  const HorizonGeometry<float> geometry = horizonGeometry<float>(station);
  const double azimuth_rad = fan.first_azimuth_rad + (sector.first_interval + a) * fan.azimuth_step_rad;
  const double sine = sin(azimuth_rad), cosine = cos(azimuth_rad);
  const double chord_m = fanChordLength_m(station);
  int index = -1;
  FanChord chord;
  for (int i = begin; i < end; ++i) {
    const double range_m = fan.ranges_m[i];
    float height_msl_m = 0;
    if (sector.has_terrain) {
      const int here = fanChordAt(range_m, chord_m);
      if (here != index) chord = fanChord(station, sine, cosine, index = here, chord_m);
      height_msl_m = chord.heightAt(sector.terrain, range_m);
    }
    float sample = height_msl_m;
    if (sector.holds_slopes) sample = i == 0 ? -HUGE_VALF : geometry.slopeTo(height_msl_m, sector.terms[i]);
    sector.samples[i * sector.range_stride + a * sector.azimuth_stride] = sample;
  }
}

/// One thread per azimuth.
__global__ void grazeKernel(const FanSector* sectors) {
  const FanSector& sector = sectors[blockIdx.y];
  const int a = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
  if (a > sector.interval_count || !sector.holds_slopes) return;
  const int used = sector.usedRanges(a);
  float* slopes = sector.samples + a * sector.azimuth_stride;
  float highest = -HUGE_VALF;
  for (int begin = 0; begin < used; begin += kAhead) {
    float here[kAhead];
#pragma unroll
    for (int n = 0; n < kAhead; ++n) {
      if (begin + n < used) here[n] = slopes[(begin + n) * sector.range_stride];
    }
#pragma unroll
    for (int n = 0; n < kAhead; ++n) {
      if (begin + n >= used) break;
      highest = propagation::steeper(highest, here[n]);
      slopes[(begin + n) * sector.range_stride] = highest;
    }
  }
}

__global__ void edgesKernel(const FanSector* sectors, DeviceColumns columns) {
  const int c = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
  if (c >= columns.count) return;
  const FanSector& sector = sectors[blockIdx.y];
  if (!sector.holds_slopes) return;
  const LocateTask& emitter = sector.emitter;
  SlopePlanes planes;
  planes.geometry = horizonGeometry<float>(emitter.station);
  planes.fan = emitter.fan;
  planes.first_interval = sector.first_interval;
  planes.slopes = sector.samples;
  planes.azimuth_stride = sector.azimuth_stride;
  planes.range_stride = sector.range_stride;
  float edge_m;
  if (columns.tilted) {
    edge_m = edgeInLeaningColumn(emitter.station, planes, columns.columns[c], columns.t_m, columns.layers);
  } else {
    const FanIndex place = emitter.fan_indices[c];
    const int interval = static_cast<int>(place.azimuth_index) - sector.first_interval;
    if (interval < 0 || interval >= sector.interval_count) return;
    edge_m = planes.edgeHeight_m(place.azimuth_index, place.range_m);
  }
  emitter.shadow_edge_m[c] = edge_m;
  if (isnan(edge_m)) atomicAdd(&emitter.counts->unknown_columns, 1);
}

}  // namespace

void locateColumns(const LocateTask* tasks, int count, const DeviceColumns& columns, cudaStream_t stream) {
  const dim3 blocks(blocksFor(columns.count), static_cast<unsigned>(count));
  locateKernel<<<blocks, kThreads, 0, stream>>>(tasks, columns);
  checkLaunch("locateColumns");
}

void readFans(const FanSector* sectors, const SectorExtent& extent, cudaStream_t stream) {
  const auto count = static_cast<unsigned>(extent.sectors);
  termsKernel<<<dim3(blocksFor(extent.ranges), count), kThreads, 0, stream>>>(sectors);
  checkLaunch("rangeTerms");
  const dim3 blocks(blocksFor(extent.azimuths, kWarp), blocksFor(extent.ranges, kRun * kRuns), count);
  readKernel<<<blocks, dim3(kWarp, kRuns), 0, stream>>>(sectors);
  checkLaunch("readFans");
}

void findShadowEdges(const FanSector* sectors, const SectorExtent& extent, const DeviceColumns& columns,
                     cudaStream_t stream) {
  const auto count = static_cast<unsigned>(extent.sectors);
  grazeKernel<<<dim3(blocksFor(extent.azimuths, kWarp), count), kWarp, 0, stream>>>(sectors);
  checkLaunch("grazingSlopes");
  edgesKernel<<<dim3(blocksFor(columns.count), count), kThreads, 0, stream>>>(sectors, columns);
  checkLaunch("shadowEdges");
}

}  // namespace emscape::emfield::cuda
