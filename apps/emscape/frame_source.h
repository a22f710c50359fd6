/// What is drawn, one instant after another: a scenario as it is computed, or volumes from files.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/emscape/console.h"
#include "apps/emscape/field_series.h"
#include "apps/emscape/place.h"
#include "emscape/render/height_field.h"
#include "emscape/render/legend.h"
#include "emscape/render/overlay.h"
#include "emscape/volume/volume.h"

namespace emscape::app {

/// One instant.
struct Frame {
  volume::Volume volume;
  std::vector<render::Marker> markers;
  bool changed = true;  ///< false: the volume's values are those of the frame asked for before
};

/// What to draw of an input.
struct FrameSelection {
  std::string input;                ///< scenario or volume file, .pvd, folder of volumes
  std::string quantity;             ///< empty: the first
  std::string times;                ///< as on the command line; empty: all
  bool first_only = false;          ///< without times: the first alone
  std::optional<ValueRange> range;  ///< of the colours; none: that of the series
  std::string scenario;             ///< beside volumes: whose ground and emitters are drawn; may be empty
  bool allow_missing_terrain = false;
  std::vector<scenario::Edit> edits;  ///< to the scenario
};

class FrameSource {
 public:
  virtual ~FrameSource() = default;
  virtual int count() const = 0;
  /// Of the scenario, ascending.
  virtual double time_s(int index) const = 0;
  /// The frame with index 0..count() - 1. @throws Error, Interrupted
  virtual Frame frame(int index) = 0;

  /// For titles and names of files.
  virtual std::string name() const = 0;
  /// The scenario that the pictures show; null without one.
  virtual const LoadedScenario* scene() const = 0;
  /// What the models have to say about the frames so far.
  virtual std::vector<std::string> warnings() const = 0;
};

/// @param place  where a scenario's field is computed
/// @throws Error (usage, bad_input, device)
std::unique_ptr<FrameSource> openFrameSource(const FrameSelection& selection, const Place& place,
                                             const GlobalOptions& global);

}  // namespace emscape::app
