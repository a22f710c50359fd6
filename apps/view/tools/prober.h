/// Probe readings under the cursor, or at a locked point, on a background thread.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/worker.h"
#include "playback/editing/probe.h"
#include "playback/live/live_view.h"

namespace emscape::view {

/// Contribution of one emitter to a reading.
struct Contribution {
  std::size_t emitter = 0;     ///< index into ProbeReading::emitters
  double value = 0;            ///< -infinity without a field
  std::string unit;            ///< of the value; empty if there is none
  std::string text;            ///< value with unit, or the reason why there is none
  bool is_of_quantity = true;  ///< false: power density, in place of a quantity that the emitter has not
};
/// The contributions, strongest first. @param quantity  to list; power density for emitters without a term of
/// it
std::vector<Contribution> contributionsOf(const playback::ProbeReading& reading, const std::string& quantity);

/// One reading and its source.
struct ProbeResult {
  std::optional<playback::ProbeReading> reading;  ///< empty: nothing is under the cursor
  std::vector<Contribution> contributions;
  std::string error;  ///< reason why nothing could be read
  std::shared_ptr<const scenario::Scenario> scenario;
  std::string quantity;  ///< of the volume
  float floor = 0;       ///< of the volume: values at or below it are no field
  double time_s = 0;
  bool is_beside = false;  ///< of the other scenario of a split picture, on its left
};

/// The value of the field at the point itself, from the contributions: -infinity without a field. None where
/// it is not known (a refused path, a mean over time, a difference) and where the volume has no value to
/// compare with.
std::optional<double> pointValueOf(const ProbeResult& result);

/// What the volume and the point itself say of a field at one time.
enum class PointField {
  same,            ///< within 3 dB, or neither has a field, or they cannot be compared
  of_volume_only,  ///< the voxels around have one, the point itself has none: at the edge of the field
  differs          ///< the point itself has another one
};
PointField pointFieldOf(const ProbeResult& result);

/// Reads the picture on screen under the cursor, or at a locked point whenever the field changes. While a
/// reading is in progress, only the latest request is kept. For use by the window's thread.
class Prober {
 public:
  using PicturePtr = std::shared_ptr<const playback::LivePicture>;
  /// What is read: the values, or also their explanation, emitter by emitter.
  enum class Detail { value, explained };

  /// @param wake  called on another thread when update() has a result
  Prober(Detail detail, std::function<void()> wake);

  /// Nothing is read while it is turned off.
  void turnOn(bool on);
  bool isOn() const { return is_on_; }
  /// Reports the pixel of the picture under the cursor; empty: none.
  void hover(std::optional<render::Projected> pixel);
  /// Locks the position under a pixel.
  void lockAtPixel(double x, double y);
  /// Locks a position. @param position_m  frame metres
  void lockAt(const Vec3d& position_m);
  /// Locks the last reading, or unlocks.
  void toggleLock();
  void unlock();
  bool isLocked() const { return is_locked_; }
  /// True if the cursor is over the picture; else the result is an earlier one.
  bool isOver() const { return pixel_.has_value(); }
  /// Position of the locked point; empty before it has been found.
  const std::optional<Vec3d>& locked_m() const { return locked_m_; }

  /// Requests readings needed by a new picture, and takes results. @return true if there is a new one
  bool update(const PicturePtr& picture);
  /// The latest result; null before the first one.
  const ProbeResult* result() const { return result_ ? &*result_ : nullptr; }
  /// True if a reading is pending.
  bool isBusy() const { return is_on_ && (is_due_ || task_.active()); }

 private:
  struct Pixel {
    double x = 0, y = 0;
  };
  struct Question {
    PicturePtr picture;
    std::optional<Pixel> pixel;  ///< empty: the position is used
    Vec3d position_m;
    long long lock = 0;
    bool is_beside = false;  ///< of the position
  };
  struct Answer {
    ProbeResult result;
    long long lock = 0;
  };
  class Reader;

  void ask(const PicturePtr& picture);

  bool is_on_ = false;
  bool is_due_ = false;  // a reading different from the last request is needed
  std::optional<Pixel> pixel_;
  bool is_locked_ = false;
  long long lock_ = 0;  // counts locks: results of requests before the last lock are dropped
  std::optional<Vec3d> locked_m_;
  bool locked_beside_ = false;
  // The last request
  PicturePtr asked_picture_;
  std::optional<ProbeResult> result_;
  std::shared_ptr<Reader> reader_;
  AsyncTasks<Answer> task_;
};

/// The `emscape profile` command for the path from an emitter to the reading's position.
/// @throws Error (bad_input) if there is no scenario, or no such emitter
std::string profileCommand(const ProbeResult& result, const std::string& emitter);

}  // namespace emscape::view
