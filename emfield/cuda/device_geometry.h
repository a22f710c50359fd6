/// Stages 1 and 2 of the emitters on the device: the results in each slot, and the memory to compute them.
#pragma once

#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include "base/cuda/cuda_memory.h"
#include "emfield/cuda/device_terrain.h"
#include "emfield/cuda/diffraction_kernels.h"
#include "emfield/cuda/excess_kernels.h"
#include "emfield/cuda/geometry_kernels.h"
#include "emfield/cuda/interpolation_kernels.h"
#include "emfield/cuda/stage_clock.h"
#include "emfield/solver/field_engine.h"
#include "propagation/cuda/field_march_cuda.h"

namespace emscape::emfield::cuda {

class DeviceGeometry {
 public:
  /// @param setup  must outlive this object
  /// @throws Error (device)
  DeviceGeometry(const FieldSetup& setup, int slots);

  /// Computes all requests in one batch of launches and waits for the results.
  std::vector<GeometryResult> compute(const std::vector<GeometryRequest>& requests, cudaStream_t stream,
                                      StageClock& clock);
  /// Inputs of the last computation of a slot.
  ColumnGeometryView view(int slot) const;
  /// Surface clutter of the last computation of a slot; without cells: none.
  ClutterMapView clutterMap(int slot) const;
  /// Exchanges the results of a slot with those of another object of the same grid and terrain; both are
  /// complete.
  void exchange(int slot, DeviceGeometry& other, int other_slot) {
    std::swap(slots_[slot], other.slots_[other_slot]);
  }
  const DeviceColumns& columns() const { return columns_; }
  /// Null without terrain.
  const std::uint16_t* firstValidK() const { return excess_grid_.first_valid_k; }
  std::size_t bytes() const;

 private:
  /// A request in progress.
  struct Work {
    LocateTask task;
    std::vector<double> ranges_m;
    GroundPosts ground;  ///< on the device, from place() on
    /// With its tables on the device, from place() on; for an equation from planEquation() on, with tables
    /// after the march.
    std::optional<EmitterExcess> model;
    bool is_equation = false;
    std::vector<propagation::BlockInput> march_inputs;  ///< of its march
    ExcessOutputs excess;
    std::optional<ClutterMapTask> clutter;  ///< its ground on the device, from place() on
    bool has_excess = false, has_shadow = false, has_reflected_ray = false, has_mechanisms = false;
    bool can_interpolate = false;  ///< a part of its columns suffices: see GeometryRequest::part
  };

  /// Marches of one emitter after another, on a separate stream.
  struct Marcher {
    emscape::cuda::Stream stream;
    propagation::FieldMarchCuda march;
    emscape::cuda::Buffer<float> model_tables, air_tables;  ///< tables from the host
    emscape::cuda::Event marched;                           ///< its losses are complete
    emscape::cuda::Event read;                              ///< and were read
  };

  Work prepare(const GeometryRequest& request) const;
  /// Milliseconds of the host.
  void planEquation(const GeometryRequest& request, Work& work) const;
  void place(std::vector<Work>& works, cudaStream_t stream);
  void placeTables(std::vector<Work>& works, cudaStream_t stream);
  void computeUnmarched(const std::vector<GeometryRequest>& requests, std::vector<Work>& works,
                        cudaStream_t stream, StageClock& clock);
  void findShadows(const std::vector<Work>& works, const ExcessGrid& grid, bool of_part, cudaStream_t stream);
  void fillDiffractions(const std::vector<GeometryRequest>& requests, const std::vector<Work>& works,
                        const ExcessGrid& grid, bool of_part, cudaStream_t stream);
  void interpolate(const std::vector<Work>& works, const ExcessGrid& grid, cudaStream_t stream);
  DiffractionExcess besideEquation(const GeometryRequest& request, const Work& work) const;
  void startMarch(Work& work, Marcher& marcher);
  void readMarch(const Work& work, Marcher& marcher, cudaStream_t stream, StageClock& clock);
  ScratchMemory scratch();
  void copyColumns();

  const FieldSetup& setup_;
  std::shared_ptr<const DeviceTerrain> terrain_;  ///< null: none
  float highest_post_m_ = HUGE_VALF;              ///< see highestPost_m(); not of maps
  // Copies of columns that are on the host:
  emscape::cuda::Buffer<GridColumn> grid_columns_;  ///< or, of a surface:
  emscape::cuda::Buffer<PositionColumn> position_columns_;
  emscape::cuda::Buffer<std::uint16_t> first_valid_k_;
  emscape::cuda::Buffer<float> ground_msl_m_;  ///< empty: none, or tilted columns

  emscape::cuda::Buffer<float> t_m_;
  DeviceColumns columns_;
  ExcessGrid excess_grid_;
  struct Slot {
    emscape::cuda::Buffer<float> numbers;      ///< of the columns, then the shadow's edges
    emscape::cuda::Buffer<ExcessCode> excess;  ///< or, over a surface:
    emscape::cuda::Buffer<float> excess_db;
    emscape::cuda::Buffer<ReflectedRayCode> reflected;
    emscape::cuda::Buffer<std::uint8_t> mechanisms;
    emscape::cuda::Buffer<ClutterCell> clutter;
    ClutterGrid clutter_grid;
    bool has_excess = false, has_reflected = false, has_mechanisms = false, has_clutter = false;
  };
  std::vector<Slot> slots_;

  /// Made for the first march. Each waits for the longest of its azimuths; several fill the device.
  std::array<std::unique_ptr<Marcher>, 8> marchers_;
  emscape::cuda::Event placed_;

  // for the emitters being computed; kept for the next update
  emscape::cuda::Buffer<LocateTask> tasks_;
  emscape::cuda::Buffer<double> ranges_m_;
  emscape::cuda::Buffer<float> model_tables_;
  emscape::cuda::Buffer<DeviceShadowTask> shadows_[2];  ///< of all columns; of a part that can be left out
  emscape::cuda::Buffer<RangeTerms<float>> terms_[2];
  emscape::cuda::Buffer<DeviceDiffractionTask> diffraction_[2];
  emscape::cuda::Buffer<DevicePartTask> parts_;
  emscape::cuda::Timer part_timer_;  ///< of the columns that can be left out
  emscape::cuda::Buffer<double> scratch_;
  emscape::cuda::Buffer<GeometryCounts> counts_;
  emscape::cuda::Buffer<std::uint8_t> unknown_;
};

}  // namespace emscape::emfield::cuda
