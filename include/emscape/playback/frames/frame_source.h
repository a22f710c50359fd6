/// A sequence of instants to draw: a computed scenario, or fields from files.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "emscape/base/progress.h"
#include "emscape/playback/frames/compute_target.h"
#include "emscape/playback/frames/field_series.h"
#include "emscape/playback/frames/shown_field.h"
#include "emscape/render/annotate/overlay.h"
#include "emscape/scenario/model/edit.h"
#include "emscape/scenario/model/poses.h"

namespace emscape::playback {

/// Where a stream has the platforms.
struct StreamedPoses {
  std::vector<scenario::PlatformPose> platforms;
  std::string told;  ///< "live, 2026-06-01T06:00:22Z": when the last record came
};
using PosesPtr = std::shared_ptr<const StreamedPoses>;

struct Frame;

/// The field beside a frame's, for a split picture.
struct FieldBeside {
  std::shared_ptr<const Frame> frame;  ///< on the same grid, at the same time
  std::string caption;                 ///< of that field
  std::string own_caption;             ///< of the frame's field
};

/// One instant.
struct Frame : ShownField {
  std::vector<render::Marker> markers;
  std::vector<render::Track> tracks;  ///< of moving platforms
  bool changed = true;                ///< false: the field's values are those of the previous call
  bool has_field = true;              ///< false: FrameSource::withoutField()
  render::ColorRange color_range;     ///< of the series; none: that of the field's values
  std::optional<FieldBeside> beside = std::nullopt;
  int column_step = 1;    ///< FieldSolver::columnStep(): above 1 columns between others are interpolated
  std::string live = {};  ///< StreamedPoses::told; empty: no stream moves its platforms
};

/// What frames show of a field and its reference.
enum class Comparison {
  none,         ///< the field
  difference,   ///< their difference
  side_by_side  ///< the field, and the reference beside it (Frame::beside)
};

/// The field to show.
struct FieldChoice {
  std::string input;     ///< scenario, volume, field on tetrahedra, .pvd, folder of them
  std::string scenario;  ///< for volumes: the scenario of the ground and emitters; may be empty
  /// For a scenario: the mesh on which its field is computed (emfield::parseTerrainMesh()); empty: the grid.
  std::string mesh;
  bool allow_missing_terrain = false;
  std::string quantity;               ///< quantity or channel; empty: the first
  render::ColorRange range;           ///< of the colours; none: that of the series
  std::vector<scenario::Edit> edits;  ///< to the scenario, in order
  /// The reference of a comparison: kOriginal (the scenario without the edits), or a scenario or volumes on
  /// the same grid. Empty: no comparison, but setComparison() can start one with the original.
  std::string compare;
  /// With a reference: the part of the picture's width, 0..1, in which the reference is drawn, at the left;
  /// 0: the difference is drawn.
  double split = 0;

  Comparison comparison() const {
    if (compare.empty()) return Comparison::none;
    return split > 0 ? Comparison::side_by_side : Comparison::difference;
  }
};

/// The frames of a field to draw.
struct FrameSelection : FieldChoice {
  std::string times;        ///< "BEGIN:END:STEP", "BEGIN:END" or "T" (s); empty: all
  bool first_only = false;  ///< without times: only firstTime_s() of the scenario, or the first volume
  /// Frames of a scenario are independent of each other and of their order: each has the range of its own
  /// values, and there is no tolerance for the movement of emitters.
  bool independent = false;
  /// Limit of the cached volumes of the reference; the last one is kept in any case.
  std::size_t cache_bytes = std::size_t{512} << 20;
  /// If `input` is a scenario: as it was read, with any edits; its file, which may have changed since, is not
  /// read again. Null: it is read.
  std::shared_ptr<const scenario::Scenario> opened;

  FrameSelection() = default;
  explicit FrameSelection(const FieldChoice& choice) : FieldChoice(choice) {}
};

constexpr const char* kOriginal = "original";

/// The volume of a frame that is to be compared.
/// @throws Error (usage) for a field on tetrahedra, (bad_input) for indices
const volume::Volume& comparableVolume(const Frame& frame);

/// Frames in order of time; either all are volumes or all are fields on tetrahedra. One thread at a time
/// calls frame(); the other functions, except warnings(), may be called at the same time.
class FrameSource : public VolumeSeries {
 public:
  /// The frame with index 0..count() - 1; fields on one mesh share it. @throws Error, Stopped
  Frame frame(int index) {
    Frame made = makeFrame(index);
    made.color_range = color_range_;
    return made;
  }
  /// The frame at a time between the first and the last step; if the source is not continuous, that of the
  /// nearest step. @throws Error, Stopped
  Frame frameAt(double time_s) {
    Frame made = makeFrameAt(time_s);
    made.color_range = color_range_;
    return made;
  }
  /// The ground and the emitters at a time of frameAt(), without waiting for the field: all voxels are
  /// masked. None if the source has no such frame. As frame(). @throws Error (usage) if there is no such
  /// channel
  virtual std::optional<Frame> withoutField(double /*time_s*/) { return std::nullopt; }
  /// Sets the range of the colours of all frames; none: each has that of its values.
  void setColorRange(const render::ColorRange& range) { color_range_ = range; }
  /// The volume of frame(). @throws Error, Stopped; as comparableVolume()
  std::vector<volume::Volume> compute(int index) override { return {comparableVolume(frame(index))}; }
  std::vector<volume::Volume> computeAt(double time_s) override {
    return {comparableVolume(frameAt(time_s))};
  }

  /// The first step at which an emitter of scene() is present, else any platform; else the first step.
  double firstTime_s() const;

  /// For titles and file names.
  virtual std::string name() const = 0;
  /// The scenario that the pictures show; null without one.
  virtual const LoadedScenario* scene() const = 0;
  /// The time line, for times that are typed.
  virtual scenario::Clock clock() const { return {}; }
  /// The quantities that the input's files hold; empty if the field is computed.
  virtual std::vector<std::string> quantities() const { return {}; }

  /// Changes the scenario to an edit of that of scene(). The number and times of frames may change. Called by
  /// the thread that calls frame(), while no other one uses the source.
  /// @throws Error (bad_input) if its ground cannot be read, (usage) without a scenario; nothing is changed
  /// then
  virtual void setScenario(std::shared_ptr<const scenario::Scenario> scenario);
  /// Platforms are at these poses, whatever the time; null: where the scenario has them. As setScenario(),
  /// which comes first if it changes the platforms. @throws Error (usage) for fields from files
  virtual void setPoses(PosesPtr poses);
  /// Another quantity or channel; empty: the first. As setScenario().
  /// @throws Error (bad_input, usage, device); nothing is changed then
  virtual void setQuantity(const std::string& quantity);

  /// Shows the field, its difference to the reference (FieldChoice::compare), or both fields; for independent
  /// frames. As setScenario(); frame() throws if the two cannot be compared. @throws Error (usage) if there
  /// is no reference
  virtual void setComparison(Comparison comparison);

  /// Of the next frames of a computed field: FieldSolver::setTimeGoal(). As setScenario().
  virtual void setTimeGoal(double /*goal_ms*/) {}

  /// Memory of cached volumes (bytes).
  virtual std::size_t cachedBytes() const { return 0; }

 protected:
  virtual Frame makeFrame(int index) = 0;
  virtual Frame makeFrameAt(double time_s) { return makeFrame(nearestIndex(time_s)); }

 private:
  render::ColorRange color_range_;
};

/// @param target    the processor for a scenario's field
/// @param progress  called while the range of the colours is searched; may be empty
/// @param stop      ends the work of this call and of frame() with Stopped; may be null, else must outlive
/// the source
/// @throws Error (usage, bad_input, device), Stopped
std::unique_ptr<FrameSource> openFrameSource(const FrameSelection& selection, const ComputeTarget& target,
                                             const ProgressSink& progress = {},
                                             const StopFlag* stop = nullptr);

}  // namespace emscape::playback
