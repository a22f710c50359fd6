/// The stages of the field on the GPU of the thread that makes it.
#pragma once

#include <memory>
#include <vector>

#include "emfield/solver/field_engine.h"

namespace emscape::emfield::cuda {

class DeviceEngine : public FieldEngine {
 public:
  /// Volumes will be of the emitters of these engines also, which have the same setup and outlive this one's
  /// use. The sums of the engines are merged in their order.
  virtual void setOthers(std::vector<DeviceEngine*> others) = 0;
};

/// @param setup  must outlive the engine
std::unique_ptr<DeviceEngine> makeDeviceEngine(const FieldSetup& setup, int slots,
                                               volume::VoxelPrecision precision);

}  // namespace emscape::emfield::cuda
