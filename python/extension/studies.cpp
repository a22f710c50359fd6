/// Explanations and studies: the JSON of the subcommands of the same names.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iostream>

#include "base/files/folder_lock.h"
#include "base/files/json_writing.h"
#include "base/stopwatch.h"
#include "emscape/base/log.h"
#include "emscape/base/parallel.h"
#include "emscape/playback/series/series_writer.h"
#include "emscape/scenario/file/scenario_file.h"
#include "emscape/study/exposure/exposure.h"
#include "emscape/study/vertical/vertical.h"
#include "playback/frames/open_on_target.h"
#include "propagation/registry/model_info.h"
#include "python/extension/module.h"
#include "report/maps/compare_report.h"
#include "report/maps/exposure_report.h"
#include "report/maps/output_files.h"
#include "report/maps/study_results.h"
#include "report/maps/vertical_report.h"
#include "report/paths/link_report.h"
#include "report/paths/profile_report.h"
#include "report/runs/check_report.h"
#include "report/runs/series_report.h"
#include "report/warnings.h"
#include "scenario/file/named_index.h"
#include "study/sweep/results/part_processes.h"

namespace emscape::python {
namespace {

using playback::ComputeTarget;
using Names = std::vector<std::string>;

/// NaN for no value. @throws Error (usage) for one that is not finite
double orNan(const char* name, const std::optional<double>& value) {
  if (value && !std::isfinite(*value))
    throw Error(ErrorCode::usage, fmt::format("{} {} is not a number", name, *value));
  return value.value_or(NAN);
}

std::string profileJson(const ScenarioHandle& handle, const std::string& emitter,
                        const std::tuple<double, double, double>& to, bool agl, double time_s,
                        const Names& models) {
  refuseForkedProcess();
  const nb::gil_scoped_release unlocked;
  const scenario::Scenario& scenario = *handle.scenario;
  report::ProfileRequest request;
  request.emitter = scenario::namedIndex(scenario.emitters, emitter, "emitter", "emitter", scenario.file);
  const auto& [latitude_deg, longitude_deg, height_m] = to;
  requireWithin("latitude", latitude_deg, -90, 90, " deg");
  requireWithin("longitude", longitude_deg, -180, 180, " deg");
  requireWithin("height", height_m, -100000, 100000, " m");
  request.to.latitude_deg = latitude_deg;
  request.to.longitude_deg = longitude_deg;
  (agl ? request.to.height_agl_m : request.to.height_msl_m) = height_m;
  request.option = "to";
  request.agl_option = "agl=True";
  request.time_s = time_s;
  for (const std::string& model : models) request.models.push_back(propagation::modelNamed(model)->model);
  return dumpJson(report::toJson(report::profileReport(scenario.file, scenario, request)));
}

std::string linkJson(const ScenarioHandle& handle, const Names& emitters, const Names& receivers,
                     const Names& targets, const std::vector<double>& times_s, const std::string& model,
                     const ProgressCall& progress) {
  refuseForkedProcess();
  const ProgressSink sink = progressSink(progress);
  const nb::gil_scoped_release unlocked;
  emfield::LinkOptions options =
      report::linkOptions(*handle.scenario, {"", "0", emitters, receivers, targets, model});
  options.times_s = times_s;
  report::NamedLinks links{handle.scenario->file, handle.scenario, {}};
  links.report = report::computeLinks(handle.scenario, options, sink);
  report::logWarnings(links.report.warnings, {handle.scenario});
  return dumpJson(report::toJson(links));
}

std::string exposureJson(const ScenarioHandle& handle, const std::string& platform,
                         const std::string& quantity, const std::optional<double>& threshold,
                         const std::vector<double>& times_s, const std::string& look,
                         const std::string& rcs_target, const std::string& backend,
                         const ProgressCall& progress) {
  refuseForkedProcess();
  const ProgressSink sink = progressSink(progress);
  const nb::gil_scoped_release unlocked;
  const scenario::Scenario& scenario = *handle.scenario;
  study::ExposureRequest request;
  request.platform =
      scenario::namedIndex(scenario.platforms, platform, "platform", "platform", scenario.file);
  request.quantity = scenario::quantityFromName(quantity);
  request.threshold = study::thresholdOf(orNan("threshold", threshold), request.quantity, "threshold");
  request.times_s = times_s;
  if (look != "target" && look != "scan")
    throw Error(ErrorCode::usage, fmt::format("look '{}' must be target or scan", look));
  if (look == "scan") request.look = scenario::RadarAim::scan;
  if (rcs_target.empty()) {
    request.target = study::targetOn(scenario, request.platform);
  } else if (rcs_target != "none") {
    request.target =
        scenario::namedIndex(scenario.targets, rcs_target, "rcs_target", "target", scenario.file);
  }
  const scenario::TerrainPtr terrain = scenario::loadTerrain(scenario);
  const study::Exposure result = playback::openOnTarget(backend, [&](const ComputeTarget& target) {
    return study::computeExposure(handle.scenario, terrain, request, target.fieldOptions(), sink);
  });
  report::logWarnings(result.warnings, {handle.scenario});
  return dumpJson(report::exposureJson(result));
}

std::string verticalJson(const ScenarioHandle& handle, const std::string& emitter,
                         const std::vector<double>& azimuths_deg, const std::string& quantity,
                         const std::optional<double>& threshold, double time_s,
                         const std::string& height_axis, bool blake, const std::optional<double>& range_m,
                         const std::optional<double>& max_height_m, const std::string& backend,
                         const ProgressCall& progress) {
  refuseForkedProcess();
  const ProgressSink sink = progressSink(progress);
  const nb::gil_scoped_release unlocked;
  const scenario::Scenario& scenario = *handle.scenario;
  study::VerticalRequest request;
  request.emitter = scenario::namedIndex(scenario.emitters, emitter, "emitter", "emitter", scenario.file);
  for (const double azimuth_deg : azimuths_deg) requireWithin("azimuth", azimuth_deg, -360, 360, " deg");
  request.azimuths_deg = azimuths_deg;
  if (!quantity.empty()) request.quantity = scenario::quantityFromName(quantity);
  request.threshold = orNan("threshold", threshold);
  request.time_s = time_s;
  if (height_axis != "msl" && height_axis != "agl")
    throw Error(ErrorCode::usage, fmt::format("height_axis '{}' must be msl or agl", height_axis));
  if (height_axis == "agl") request.axis = emfield::HeightReference::ground;
  request.smooth_earth = blake;
  request.range_m = orNan("range_m", range_m);
  request.max_height_m = orNan("max_height_m", max_height_m);
  request = study::withDefaults(request, scenario, !quantity.empty(), "threshold");
  const scenario::TerrainPtr terrain = study::loadVerticalTerrain(scenario, request);
  sink("vertical coverage", 0);
  const study::VerticalDiagram diagram = playback::openOnTarget(backend, [&](const ComputeTarget& target) {
    return study::computeVertical(handle.scenario, terrain, request, target.fieldOptions());
  });
  sink("vertical coverage", 1);
  report::logWarnings(diagram.warnings, {handle.scenario});
  return dumpJson(report::verticalJson(diagram, true));
}

std::string compareJson(const ScenarioHandle& a, const ScenarioHandle& b, const std::string& folder,
                        const std::string& heights, const Names& products, const std::string& quantity,
                        const std::optional<double>& threshold, const std::vector<double>& times_s,
                        const std::optional<double>& cell_m, const std::string& area, const std::string& crs,
                        const Names& formats, int explain, const std::string& backend,
                        const ProgressCall& progress) {
  refuseForkedProcess();
  const ProgressSink sink = progressSink(progress);
  const nb::gil_scoped_release unlocked;
  requireWithin("explain", explain, 0, 100, "");
  report::MapOptions maps;
  maps.heights = heights;
  if (!products.empty()) maps.products = products;
  maps.quantity = quantity;
  maps.threshold = orNan("threshold", threshold);
  maps.times_s = times_s;
  maps.cell_m = orNan("cell_m", cell_m);
  maps.area = area;
  maps.crs = crs;
  if (!formats.empty()) maps.formats = formats;
  report::ScenarioComparison run(a.scenario, b.scenario, maps, explain, folder,
                                 b.scenario->file == a.scenario->file ? "its change" : b.scenario->name);
  const study::Comparison comparison = playback::openOnTarget(
      backend, [&](const ComputeTarget& target) { return run.compute(target.fieldOptions(), sink); });
  return run.finish(comparison);
}

std::string checkJson(const std::string& folder) {
  refuseForkedProcess();
  const nb::gil_scoped_release unlocked;
  return dumpJson(report::toJson(report::checkReport(folder, [](const std::string&, double) {
    const nb::gil_scoped_acquire locked;
    if (PyErr_CheckSignals() != 0) throw nb::python_error();
  })));
}

std::string simulateJson(const ScenarioHandle& handle, const std::string& folder, const Names& formats,
                         const std::vector<double>& times_s, const Names& quantities, bool resume, bool force,
                         const std::string& backend, const ProgressCall& progress) {
  refuseForkedProcess();
  const ProgressSink sink = progressSink(progress);
  const nb::gil_scoped_release unlocked;
  Stopwatch watch;
  const Names writable = playback::writableFormats();
  for (const std::string& format : formats) {
    if (std::find(writable.begin(), writable.end(), format) == writable.end()) {
      throw Error(ErrorCode::usage,
                  fmt::format("format '{}' must be one of {}", format, fmt::join(writable, ", ")));
    }
  }
  using Existing = playback::SeriesOptions::Existing;
  playback::SeriesOptions options;
  options.folder = folder;
  if (!formats.empty()) options.formats = formats;
  options.existing = resume ? Existing::resume : force ? Existing::replace : Existing::refuse;
  if (options.existing == Existing::refuse && playback::findSeries(folder))
    throw Error(ErrorCode::usage,
                folder + " holds a series; resume=True continues it, force=True replaces it");
  const playback::LoadedScenario input{handle.scenario, scenario::loadTerrain(*handle.scenario)};
  std::string device;
  const auto series = playback::openOnTarget(backend, [&](const ComputeTarget& target) {
    device = target.device();
    emfield::FieldOptions field_options = target.fieldOptions();
    field_options.quantities = quantities;
    auto opened = std::make_unique<playback::FieldSeries>(input, times_s, field_options);
    opened->rehearse();
    return opened;
  });
  const playback::SeriesResult result = playback::writeSeries(*series, options, sink);
  report::logWarnings(series->warnings());
  std::vector<std::string> warnings = warningsOf(*handle.scenario);
  for (const std::string& warning : series->warnings()) warnings.push_back(warning);
  return dumpJson(
      report::seriesJson(device, folder, result, report::joinedWarnings(warnings), watch.lap_ms() / 1000));
}

/// A study in its folder, and the limit of threads, which is removed at the end.
struct OpenStudy {
  study::LoadedStudy loaded;
  study::StudyFolder folder;
  int threads;

  OpenStudy(const std::string& file, const Edits& edits, const std::string& path, int threads_wanted,
            bool tries_values)
      : loaded(file, editsOf(edits), tries_values),
        folder(loaded.folder(path)),
        threads(threads_wanted > 0 ? threads_wanted : study::allowedProcessors()) {
    setThreadLimit(threads);
  }
  ~OpenStudy() { setThreadLimit(0); }
  OpenStudy(const OpenStudy&) = delete;
  OpenStudy& operator=(const OpenStudy&) = delete;

  /// Begins the folder with the parts of its manifest, else with a number of parts; 0: the usual one.
  void begin(int parts) {
    if (const std::optional<int> planned = folder.partsOfManifest(); planned && parts == 0) parts = *planned;
    if (parts == 0) parts = study::usualParts(loaded.spec.variants.count());
    study::checkParts(parts, loaded.spec.variants.count());
    folder.begin(parts);
  }
};

std::string studyJson(const std::string& file, const Edits& edits, const std::string& folder, int jobs,
                      bool resume, const std::string& backend, Names worker, const ProgressCall& progress) {
  refuseForkedProcess();
  const ProgressSink sink = progressSink(progress);
  const nb::gil_scoped_release unlocked;
  requireWithin("jobs", jobs, 1, 1024, "");
  OpenStudy open(file, edits, folder, 0, true);
  report::checkStudyFolder(folder, open.loaded.spec, "output");
  open.begin(0);
  const FolderLock lock(open.folder.path(), ".study.lock");
  const std::vector<int> missing = open.folder.missingParts();
  if (!resume && static_cast<int>(missing.size()) < open.folder.parts()) {
    throw Error(ErrorCode::usage,
                folder + " holds parts of this study; resume=True computes the others and joins all");
  }
  worker.push_back(fmt::format("{}", std::max(1, open.threads / jobs)));
  study::computeParts(open.loaded, open.folder, missing, backend, {jobs, worker}, sink);
  const report::StudyReport merged = report::mergeParts(open.loaded, open.folder);
  report::logWarnings(merged.warnings, {open.loaded.spec.base});
  return dumpJson(report::toJson(merged));
}

void beginStudy(const std::string& file, const Edits& edits, const std::string& folder, int parts) {
  refuseForkedProcess();
  const nb::gil_scoped_release unlocked;
  OpenStudy open(file, edits, folder, 0, true);
  report::checkStudyFolder(folder, open.loaded.spec, "output");
  open.begin(parts);
}

std::string mergeStudy(const std::string& file, const Edits& edits, const std::string& folder) {
  refuseForkedProcess();
  const nb::gil_scoped_release unlocked;
  OpenStudy open(file, edits, folder, 0, true);
  open.begin(0);
  const FolderLock lock(open.folder.path(), ".study.lock");
  const report::StudyReport merged = report::mergeParts(open.loaded, open.folder);
  report::logWarnings(merged.warnings, {open.loaded.spec.base});
  return dumpJson(report::toJson(merged));
}

void serveStudy(const std::string& file, const Edits& edits, const std::string& folder,
                const std::string& backend, int threads) {
  refuseForkedProcess();
  const ProgressSink sink = progressSink({});
  const nb::gil_scoped_release unlocked;
  OpenStudy open(file, edits, folder, threads, false);
  open.begin(0);
  study::PartComputer(open.loaded, open.folder, backend)
      .serve(
          std::cin, [](int part) { std::cout << part << std::endl; }, sink);
}

}  // namespace

void bindStudies(nb::module_& module) {
  module.def("profile", &profileJson, nb::arg("scenario"), nb::arg("emitter"), nb::arg("to"), nb::arg("agl"),
             nb::arg("time_s"), nb::arg("models"));
  module.def("link", &linkJson, nb::arg("scenario"), nb::arg("emitters"), nb::arg("receivers"),
             nb::arg("targets"), nb::arg("times_s"), nb::arg("model"), nb::arg("progress").none());
  module.def("exposure", &exposureJson, nb::arg("scenario"), nb::arg("platform"), nb::arg("quantity"),
             nb::arg("threshold").none(), nb::arg("times_s"), nb::arg("look"), nb::arg("rcs_target"),
             nb::arg("backend"), nb::arg("progress").none());
  module.def("vertical", &verticalJson, nb::arg("scenario"), nb::arg("emitter"), nb::arg("azimuths_deg"),
             nb::arg("quantity"), nb::arg("threshold").none(), nb::arg("time_s"), nb::arg("height_axis"),
             nb::arg("blake"), nb::arg("range_m").none(), nb::arg("max_height_m").none(), nb::arg("backend"),
             nb::arg("progress").none());
  module.def("compare", &compareJson, nb::arg("a"), nb::arg("b"), nb::arg("folder"), nb::arg("heights"),
             nb::arg("products"), nb::arg("quantity"), nb::arg("threshold").none(), nb::arg("times_s"),
             nb::arg("cell_m").none(), nb::arg("area"), nb::arg("crs"), nb::arg("formats"),
             nb::arg("explain"), nb::arg("backend"), nb::arg("progress").none());
  module.def("check", &checkJson, nb::arg("folder"));
  module.def("simulate", &simulateJson, nb::arg("scenario"), nb::arg("folder"), nb::arg("formats"),
             nb::arg("times_s"), nb::arg("quantities"), nb::arg("resume"), nb::arg("force"),
             nb::arg("backend"), nb::arg("progress").none());
  module.def("study", &studyJson, nb::arg("file"), nb::arg("edits"), nb::arg("folder"), nb::arg("jobs"),
             nb::arg("resume"), nb::arg("backend"), nb::arg("worker"), nb::arg("progress").none(),
             "worker: command of a process that calls serve_study(); the number of threads is appended.");
  module.def("begin_study", &beginStudy, nb::arg("file"), nb::arg("edits"), nb::arg("folder"),
             nb::arg("parts"), "Divides the study of a folder into parts.");
  module.def("serve_study", &serveStudy, nb::arg("file"), nb::arg("edits"), nb::arg("folder"),
             nb::arg("backend"), nb::arg("threads"),
             "Computes the parts whose numbers are read from standard input, and prints each number.");
  module.def("merge_study", &mergeStudy, nb::arg("file"), nb::arg("edits"), nb::arg("folder"),
             "Joins the parts of a folder; the JSON of the study.");
}

}  // namespace emscape::python
