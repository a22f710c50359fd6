/// A scenario's field over time, written as volume files into a folder.
///
/// The folder holds, beside the volumes,
///   series.json   what was asked for (the recipe); at the end also the value range of each channel over the
///   series.
///                 Written at the beginning and at the end.
///   series.steps  the journal: a line of JSON for each step whose files are whole, with the range of its
///   values, the
///                 range that its files state, and size and CRC-32 of each file. A later line replaces an
///                 earlier one.
///   NAME.pvd      with .vti files: the list for ParaView. Brought up to date each time that the number of
///   steps has
///                 grown by half, at the end, and when the work is stopped.
/// Each step is computed once. Its files are whole at once and state the range over the steps so far; at the
/// end the range over the series is put into all of them (volume::setStoredRange). A folder whose work was
/// interrupted is then the same to the byte (but for FieldOptions::move_tolerance_m, which counts from the
/// step at which the work began again).
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "emscape/base/progress.h"
#include "emscape/playback/field_series.h"

namespace emscape::playback {

struct SeriesOptions {
  enum class Existing {
    refuse,  ///< a folder that holds a series is an error
    resume,  ///< only what is missing is computed
    replace  ///< the files of the series that was there are removed
  };
  std::filesystem::path folder;             ///< made if need be
  std::vector<std::string> formats{"vdb"};  ///< of writableFormats()
  std::optional<ValueRange> range;          ///< of the values, where it is known; for one channel
  Existing existing = Existing::refuse;
};

struct SeriesResult {
  int steps = 0;
  int steps_computed = 0;  ///< the others were there
  std::vector<std::string> channels;
  std::vector<ValueRange> ranges;  ///< one per channel, over the series
};

/// Names of the formats that can be written.
std::vector<std::string> writableFormats();

/// Computes and writes what the folder lacks. Files are written on a thread of their own while the next step
/// is computed.
///
/// With Existing::resume a finished step is believed if its files have the size and the CRC-32 that the
/// journal says; otherwise it is computed again. Recipe and elevation files (by their CRC-32) must be those
/// of the beginning; trusted is what a .vrt elevation file refers to.
/// @param progress  told the part of the steps that are done; may be empty
/// @throws Error (usage) for a series that is in the way, or a range for several channels; (bad_input) for a
/// series.json or series.steps that is damaged or of another recipe; (other) where writing fails or another
/// process writes the folder; (device); Stopped, after which the folder can be resumed
SeriesResult writeSeries(FieldSeries& series, const SeriesOptions& options,
                         const ProgressSink& progress = {});

/// How far the series of a folder is.
struct SeriesStatus {
  int steps = 0;
  int finished_steps = 0;  ///< by the journal; the files are not looked at
  bool complete = false;   ///< all of them, with their final range
};
/// None where the folder holds no series. @throws Error (bad_input) if what describes it is damaged
std::optional<SeriesStatus> findSeries(const std::filesystem::path& folder);

}  // namespace emscape::playback
