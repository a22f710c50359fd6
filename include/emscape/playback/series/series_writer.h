/// A scenario's field over time, written as volume files into a folder.
///
/// Besides the volumes, the folder contains
///   series.json   the inputs; at the end also the value range of each channel over the series.
///                 Written at the beginning and at the end.
///   series.steps  the journal: a line of JSON for each step whose files are complete, with the range of its
///   values, the range in its files, and size and CRC-32 of each file. A later line replaces an
///                 earlier one.
///   NAME.pvd      with .vti or .vtu files: the list for ParaView. Updated each time the number of steps has
///   grown by half, at the end, and when the work is stopped.
/// Each step is computed once. Its files are complete at once, with the range over the steps so far; at the
/// end the range over the series is written into all of them (volume::setStoredRange). An interrupted and
/// resumed series is then identical to the byte (except for FieldOptions::move_tolerance_m, which is measured
/// from the step of the resumption).
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "emscape/base/progress.h"
#include "emscape/emfield/columns/terrain_mesh.h"
#include "emscape/playback/frames/field_series.h"

namespace emscape::playback {

struct SeriesOptions {
  enum class Existing {
    refuse,  ///< a folder that holds a series is an error
    resume,  ///< only missing steps are computed
    replace  ///< the files of the present series are removed
  };
  std::filesystem::path folder;             ///< created if necessary
  std::vector<std::string> formats{"vdb"};  ///< of writableFormats(); kMeshFormat alone with a mesh
  /// Null: volumes are written. Else fields on this mesh, which is the same in all steps.
  std::shared_ptr<const emfield::TerrainMesh> mesh;
  std::string mesh_text;            ///< the mesh option as text; part of the recorded inputs
  std::optional<ValueRange> range;  ///< of the values, if it is known; for one channel
  /// Files of the formats vdb and nvdb hold a grid "density" (0..1) too: what the default transfer function
  /// makes of the first channel, so that programs that expect a fog draw it without settings.
  bool with_fog = false;
  Existing existing = Existing::refuse;
};

struct SeriesResult {
  int steps = 0;
  int steps_computed = 0;  ///< the others existed already
  std::vector<std::string> channels;
  std::vector<ValueRange> ranges;  ///< one per channel, over the series
};

/// The format of fields on meshes.
constexpr const char* kMeshFormat = "vtu";
/// Names of the formats of volumes that can be written.
std::vector<std::string> writableFormats();

/// Computes and writes the missing steps. Files are written on a separate thread while the next step is
/// computed.
///
/// With Existing::resume a finished step is accepted if its files have the size and the CRC-32 in the
/// journal; otherwise it is recomputed. The inputs and the elevation files (by their CRC-32) must be
/// unchanged; files that a .vrt elevation file refers to are not checked.
/// @param progress  receives the fraction of steps that are done; may be empty
/// @throws Error (usage) if the folder has a series, or with Existing::replace volumes of other origin, if a
/// file that the scenario names is in the folder with the name of one of the series, or for a range with
/// several channels; (bad_input) for a series.json or series.steps that is damaged or has other inputs;
/// (other) where writing fails or another process writes the folder; (device); Stopped, after which the
/// folder can be resumed
SeriesResult writeSeries(FieldSeries& series, const SeriesOptions& options,
                         const ProgressSink& progress = {});

/// Progress of the series of a folder.
struct SeriesStatus {
  int steps = 0;
  int finished_steps = 0;  ///< according to the journal; the files are not read
  bool complete = false;   ///< all of them, with their final range
};
/// Empty if the folder has no series. @throws Error (bad_input) if its description is damaged
std::optional<SeriesStatus> findSeries(const std::filesystem::path& folder);

}  // namespace emscape::playback
