#include "emscape/playback/series/series_writer.h"

#include <fmt/core.h>
#include <sys/stat.h>

#include <algorithm>
#include <optional>
#include <set>

#include "base/files/file_digest.h"
#include "base/files/folder.h"
#include "base/files/folder_lock.h"
#include "base/files/own_file.h"
#include "base/files/unfinished_file.h"
#include "base/worker.h"
#include "emscape/base/error.h"
#include "emscape/base/log.h"
#include "emscape/base/work.h"
#include "emscape/scenario/file/scenario_file.h"
#include "playback/series/series_files.h"
#include "playback/series/series_journal.h"
#include "playback/series/series_state.h"
#include "volume/format/vdb.h"

namespace emscape::playback {
namespace {

namespace fs = std::filesystem;
using Existing = SeriesOptions::Existing;

std::vector<std::string> namesOf(const std::vector<emfield::Channel>& channels) {
  std::vector<std::string> names;
  for (const emfield::Channel& channel : channels) names.push_back(channel.name);
  return names;
}

/// The scenarios of a series, with the files that they name.
std::vector<fs::path> inputsOf(const FieldSeries& series) {
  std::vector<fs::path> inputs;
  for (const LoadedScenario* loaded : {&series.input(), series.reference()}) {
    if (loaded == nullptr) continue;
    for (const std::string& file : scenario::filesOf(*loaded->scenario)) {
      if (!file.empty()) inputs.emplace_back(file);
    }
  }
  return inputs;
}

const fs::path& made(const fs::path& folder) {
  makeFolder(folder);
  return folder;
}

/// The path of a file, relative to a folder if it is below it.
std::string pathFrom(const fs::path& folder, const std::string& file) {
  if (file.empty()) return "";
  std::error_code ignored;
  const fs::path path = fs::weakly_canonical(fs::absolute(file, ignored), ignored);
  const fs::path relative = path.lexically_relative(fs::weakly_canonical(folder, ignored));
  return relative.empty() || *relative.begin() == ".." ? path.string() : relative.string();
}

/// While it exists, the process makes files with these permissions at most.
class LargestPermissions {
 public:
  explicit LargestPermissions(fs::perms allowed) : before_(::umask(~static_cast<mode_t>(allowed) & kAll)) {
    ::umask(before_ | (~static_cast<mode_t>(allowed) & kAll));
  }
  ~LargestPermissions() { ::umask(before_); }
  LargestPermissions(const LargestPermissions&) = delete;
  LargestPermissions& operator=(const LargestPermissions&) = delete;

 private:
  static constexpr mode_t kAll = 0777;
  const mode_t before_;
};

/// The work of writeSeries().
class SeriesWriter {
 public:
  SeriesWriter(FieldSeries& series, const SeriesOptions& options, const ProgressSink& progress)
      : series_(series),
        options_(options),
        progress_(progress),
        lock_(made(options.folder), "series.lock"),
        files_(options.folder, series.input().scenario->name, options.formats, namesOf(series.channels()),
               series.times_s(), options.mesh),
        journal_(options.folder),
        steps_(static_cast<std::size_t>(series.count())) {
    if (options.range && series.channels().size() != 1) {
      throw Error(ErrorCode::usage,
                  fmt::format("a range is for one quantity, these are {}", series.channels().size()));
    }
    files_.requireNone(inputsOf(series));
    removeAbandonedFiles(options.folder);
    if (!hasSeriesState(options.folder)) {
      files_.requireFree();
    } else if (options.existing == Existing::replace) {
      permissions_.emplace(files_.removeOld());
    }
  }

  SeriesResult run() {
    beginState();
    for (const std::optional<StepRecord>& step : steps_) {
      if (step) addToRange(step->own);
    }
    SeriesResult result;
    try {
      result.steps_computed = computeMissing();
      setFinalRanges();
    } catch (...) {
      // Finished files are listed; the first failure is rethrown.
      const WorkScope not_stopped(nullptr);
      try {
        writeIndex();
      } catch (const std::exception&) {
      }
      throw;
    }
    writeIndex();
    state_.ranges = ranges_;
    state_.complete = true;
    writeSeriesState(options_.folder, state_);
    result.steps = series_.count();
    result.channels = state_.channels;
    result.ranges = ranges_;
    return result;
  }

 private:
  /// Starts a new series, or resumes that of the folder.
  void beginState() {
    state_.recipe = recipeOf(series_, options_);
    state_.channels = namesOf(series_.channels());
    const scenario::Scenario& scenario = *series_.input().scenario;
    state_.scenario_file = pathFrom(options_.folder, scenario.file);
    for (const scenario::Edit& edit : scenario.edits()) state_.edits.push_back(scenario::toString(edit));
    ranges_.assign(state_.channels.size(), options_.range.value_or(ValueRange{}));
    const std::optional<SeriesState> found = readSeriesState(options_.folder);
    if (!found) {
      writeSeriesState(options_.folder, state_);
      return;
    }
    if (options_.existing == Existing::refuse) {
      throw Error(ErrorCode::usage, options_.folder.string() + " holds a series");
    }
    checkSameRecipe(options_.folder, *found, state_);
    files_.requireOwnDescription();
    steps_ = journal_.read(series_.count(), state_.channels.size());
    checkFiles();
    const bool is_whole =
        std::all_of(steps_.begin(), steps_.end(), [](const auto& step) { return step.has_value(); });
    if (found->complete && !is_whole) writeSeriesState(options_.folder, state_);
  }

  /// Drops the steps whose files do not match the journal.
  void checkFiles() {
    int finished = 0;
    std::string first_forgotten;
    std::vector<std::optional<StepRecord>*> forgotten;
    for (std::size_t n = 0; n < steps_.size(); ++n) {
      std::optional<StepRecord>& step = steps_[n];
      if (!step) {
        files_.requireOwnFilesOf(static_cast<int>(n));
        continue;
      }
      stopIfAsked();
      const std::vector<std::string> wrong = wrongFiles(*step);
      if (wrong.empty()) {
        ++finished;
        continue;
      }
      // Before the first file is removed: those that the user changed stay.
      for (const std::string& name : wrong) requireOwn(options_.folder / name);
      if (forgotten.empty()) first_forgotten = wrong.front();
      forgotten.push_back(&step);
    }
    for (std::optional<StepRecord>* const step : forgotten) {
      for (const std::string& name : files_.namesOf((*step)->step)) {
        const fs::path file = options_.folder / name;
        if (fs::is_regular_file(fs::symlink_status(file))) fs::remove(file);
      }
      step->reset();
    }
    if (!forgotten.empty()) {
      logWarning(
          fmt::format("{} of the finished steps are computed again, as files of theirs are missing or not as "
                      "they were written: {}{}",
                      forgotten.size(), first_forgotten, forgotten.size() > 1 ? ", ..." : ""));
    }
    if (finished > 0) logInfo(fmt::format("{} of {} steps are there already", finished, series_.count()));
  }

  /// The files that do not match the journal.
  std::vector<std::string> wrongFiles(const StepRecord& step) const {
    std::vector<std::string> wrong;
    for (const std::string& name : files_.namesOf(step.step)) {
      const auto file =
          std::find_if(step.files.begin(), step.files.end(),
                       [&](const StepRecord::File& candidate) { return candidate.name == name; });
      const fs::path path = options_.folder / name;
      std::error_code error;
      if (file == step.files.end() || fs::file_size(path, error) != file->digest.bytes || error ||
          digestOf(path) != file->digest) {
        wrong.push_back(name);
      }
    }
    return wrong;
  }

  void addToRange(const std::vector<ValueRange>& own) {
    if (options_.range) return;
    for (std::size_t c = 0; c < ranges_.size(); ++c) ranges_[c].add(own[c]);
  }

  /// @return how many
  int computeMissing() {
    finished_count_ =
        static_cast<int>(std::count_if(steps_.begin(), steps_.end(), [](const auto& s) { return s; }));
    int computed = 0;
    const int found = finished_count_;
    // While one step is written the next is computed, and one more may wait.
    Worker writer(1);
    std::vector<int> missing;
    for (int step = 0; step < series_.count(); ++step) {
      if (!steps_[static_cast<std::size_t>(step)]) missing.push_back(step);
    }
    for (const int step : missing) {
      std::vector<volume::Volume> volumes = series_.compute(step);
      StepRecord record;
      record.step = step;
      record.own = rangesOf(volumes);
      addToRange(record.own);
      record.stored = ranges_;
      writer.push([this, volumes = std::move(volumes), record = std::move(record), work = currentWork()] {
        const WorkScope scope(work);  // a large file is not written to its end
        write(volumes, record);
      });
      tell("computing", found + ++computed);
    }
    const WorkPart part("writing the last files", 0, 0);
    writer.finish();
    return computed;
  }

  /// On the writer's thread.
  void write(const std::vector<volume::Volume>& volumes, StepRecord record) {
    files_.write(record.step, volumes, record.stored, fogRange(record));
    for (const std::string& name : files_.namesOf(record.step)) {
      record.files.push_back({name, recordedDigestOf(options_.folder / name)});
    }
    journal_.append(record);
    steps_[static_cast<std::size_t>(record.step)] = std::move(record);
    if (++finished_count_ >= next_index_at_) {
      writeIndex();
      next_index_at_ = finished_count_ + (finished_count_ + 1) / 2;
    }
  }

  /// The range of the fog's look, the same in all steps: that of the options, else of the first step, which
  /// is written first.
  const ValueRange* fogRange(const StepRecord& record) const {
    if (!options_.with_fog) return nullptr;
    if (options_.range) return &*options_.range;
    return &(steps_.front() ? steps_.front()->own : record.own).front();
  }

  /// Writes the range over the series into all files that have another one.
  void setFinalRanges() {
    int done = 0;
    for (std::optional<StepRecord>& step : steps_) {
      if (step->stored != ranges_) {
        stopIfAsked();
        const std::set<std::string> changed = files_.setRanges(step->step, ranges_);
        for (StepRecord::File& file : step->files) {
          if (changed.count(file.name) != 0) file.digest = recordedDigestOf(options_.folder / file.name);
        }
        step->stored = ranges_;
        journal_.append(*step);
      }
      tell("final range", ++done);
    }
  }

  void writeIndex() const {
    if (!files_.hasIndex()) return;
    std::vector<bool> finished;
    for (const auto& step : steps_) finished.push_back(step.has_value());
    if (std::count(finished.begin(), finished.end(), true) > 0) files_.writeIndex(finished);
  }

  void tell(const char* what, int done) const {
    if (progress_) progress_(what, static_cast<double>(done) / series_.count());
  }
  void stopIfAsked() const { throwIfStopped(series_.stopFlag()); }

  FieldSeries& series_;
  const SeriesOptions& options_;
  const ProgressSink& progress_;
  const FolderLock lock_;
  const SeriesFiles files_;
  std::optional<LargestPermissions> permissions_;  ///< of a series that is replaced
  SeriesJournal journal_;
  SeriesState state_;
  std::vector<ValueRange> ranges_;  // over the steps so far, or the given range
  std::vector<std::optional<StepRecord>>
      steps_;  // steps with complete files; used by the writer's thread while it runs
  int finished_count_ = 0;
  int next_index_at_ = 1;
};

}  // namespace

SeriesResult writeSeries(FieldSeries& series, const SeriesOptions& options, const ProgressSink& progress) {
  const std::set<std::string> formats(options.formats.begin(), options.formats.end());
  if (formats.count("vdb") + formats.count("nvdb") > 0) volume::requireVdb();  // before the first file
  return SeriesWriter(series, options, progress).run();
}

std::optional<SeriesStatus> findSeries(const fs::path& folder) {
  const std::optional<SeriesState> state = readSeriesState(folder);
  if (!state) return std::nullopt;
  SeriesStatus status;
  status.steps = stepsOf(*state);
  status.complete = state->complete;
  for (const auto& step : SeriesJournal(folder).read(status.steps, state->channels.size())) {
    status.finished_steps += step ? 1 : 0;
  }
  return status;
}

}  // namespace emscape::playback
