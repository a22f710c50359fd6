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
/// A thread reads this many samples along its azimuth, so that a chord serves several.
constexpr int kRun = 16;
constexpr int kRuns = 8;  ///< threads of a block along an azimuth
/// Samples on their way from memory while the slopes before them are compared.
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

  const ColumnGeometryView numbers =
      columnGeometryView(task.numbers, static_cast<std::size_t>(columns.count), task.shadow_edge_m, nullptr);
  const int near = nearVoxels(numbers, c, columns.t_m, columns.layers, task.near2_m2);
  if (near > 0) atomicAdd(&task.counts->near_voxels, static_cast<unsigned long long>(near));

  if (task.fan.range_count == 0) return;
  const double azimuth_index = task.fan.azimuthIndex(point.azimuth_rad);
  task.places[c] = {azimuth_index, point.range_m};
  const int used = task.fan.lastBefore(point.range_m) + 1;
  int* azimuth = task.used_ranges + static_cast<int>(azimuth_index);
  if (azimuth[0] < used) atomicMax(azimuth, used);
  if (azimuth[1] < used) atomicMax(azimuth + 1, used);
}

__global__ void termsKernel(const FanPiece* pieces) {
  const FanPiece& piece = pieces[blockIdx.y];
  const FanView& fan = piece.emitter.fan;
  const int i = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
  if (i < fan.range_count) {
    piece.terms[i] = horizonGeometry<float>(piece.emitter.station).termsAt(fan.ranges_m[i]);
  }
}

__global__ void __launch_bounds__(kWarp* kRuns) readKernel(const FanPiece* pieces) {
  const FanPiece& piece = pieces[blockIdx.z];
  const FanView& fan = piece.emitter.fan;
  const int azimuths = piece.interval_count + 1;
  const int a = static_cast<int>(blockIdx.x) * kWarp + static_cast<int>(threadIdx.x);
  const int begin = (static_cast<int>(blockIdx.y) * kRuns + static_cast<int>(threadIdx.y)) * kRun;
  if (a >= azimuths) return;
  const int used = piece.usedRanges(a);
  const int end = begin + kRun < used ? begin + kRun : used;
  if (begin >= end) return;

  const Station& station = piece.emitter.station;
  const HorizonGeometry<float> geometry = horizonGeometry<float>(station);
  const double azimuth_rad = fan.first_azimuth_rad + (piece.first_interval + a) * fan.azimuth_step_rad;
  const double sine = sin(azimuth_rad), cosine = cos(azimuth_rad);
  const double chord_m = fanChordLength_m(station);
  int index = -1;
  FanChord chord;
  for (int i = begin; i < end; ++i) {
    const double range_m = fan.ranges_m[i];
    float height_msl_m = 0;
    if (piece.has_terrain) {
      const int here = fanChordAt(range_m, chord_m);
      if (here != index) chord = fanChord(station, sine, cosine, index = here, chord_m);
      height_msl_m = chord.heightAt(piece.terrain, range_m);
    }
    float sample = height_msl_m;
    if (piece.holds_slopes) sample = i == 0 ? -HUGE_VALF : geometry.slopeTo(height_msl_m, piece.terms[i]);
    piece.samples[i * piece.range_stride + a * piece.azimuth_stride] = sample;
  }
}

/// A thread walks along one azimuth.
__global__ void grazeKernel(const FanPiece* pieces) {
  const FanPiece& piece = pieces[blockIdx.y];
  const int a = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
  if (a > piece.interval_count || !piece.holds_slopes) return;
  const int used = piece.usedRanges(a);
  float* slopes = piece.samples + a * piece.azimuth_stride;
  float highest = -HUGE_VALF;
  for (int begin = 0; begin < used; begin += kAhead) {
    float here[kAhead];
#pragma unroll
    for (int n = 0; n < kAhead; ++n) {
      if (begin + n < used) here[n] = slopes[(begin + n) * piece.range_stride];
    }
#pragma unroll
    for (int n = 0; n < kAhead; ++n) {
      if (begin + n >= used) break;
      highest = propagation::steeper(highest, here[n]);
      slopes[(begin + n) * piece.range_stride] = highest;
    }
  }
}

__global__ void edgesKernel(const FanPiece* pieces, DeviceColumns columns) {
  const int c = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
  if (c >= columns.count) return;
  const FanPiece& piece = pieces[blockIdx.y];
  if (!piece.holds_slopes) return;
  const LocateTask& emitter = piece.emitter;
  SlopePlanes planes;
  planes.geometry = horizonGeometry<float>(emitter.station);
  planes.fan = emitter.fan;
  planes.first_interval = piece.first_interval;
  planes.slopes = piece.samples;
  planes.azimuth_stride = piece.azimuth_stride;
  planes.range_stride = piece.range_stride;
  float edge_m;
  if (columns.tilted) {
    edge_m = edgeInLeaningColumn(emitter.station, planes, columns.columns[c], columns.t_m, columns.layers);
  } else {
    const FanPlace place = emitter.places[c];
    const int interval = static_cast<int>(place.azimuth_index) - piece.first_interval;
    if (interval < 0 || interval >= piece.interval_count) return;
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

void readFans(const FanPiece* pieces, const PieceExtent& extent, cudaStream_t stream) {
  const auto count = static_cast<unsigned>(extent.pieces);
  termsKernel<<<dim3(blocksFor(extent.ranges), count), kThreads, 0, stream>>>(pieces);
  checkLaunch("rangeTerms");
  const dim3 blocks(blocksFor(extent.azimuths, kWarp), blocksFor(extent.ranges, kRun * kRuns), count);
  readKernel<<<blocks, dim3(kWarp, kRuns), 0, stream>>>(pieces);
  checkLaunch("readFans");
}

void findShadowEdges(const FanPiece* pieces, const PieceExtent& extent, const DeviceColumns& columns,
                     cudaStream_t stream) {
  const auto count = static_cast<unsigned>(extent.pieces);
  grazeKernel<<<dim3(blocksFor(extent.azimuths, kWarp), count), kWarp, 0, stream>>>(pieces);
  checkLaunch("grazingSlopes");
  edgesKernel<<<dim3(blocksFor(columns.count), count), kThreads, 0, stream>>>(pieces, columns);
  checkLaunch("shadowEdges");
}

}  // namespace emscape::emfield::cuda
