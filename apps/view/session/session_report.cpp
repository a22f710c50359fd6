/// Report of a frame, for the log and for script comparisons.
#include <algorithm>
#include <cmath>

#include "apps/view/session/session.h"
#include "playback/view/view_settings.h"

namespace emscape::view {
namespace {

double rounded(double value, double unit) {
  return std::round(value / unit) * unit;
}

double mebibytes(std::size_t bytes) {
  return static_cast<double>(bytes) / (1 << 20);
}

}  // namespace

Json Session::report() const {
  const render::CameraSpec& camera = camera_.spec();
  const render::RenderSettings& settings = view_.settings;
  const ProgramState program = programState();
  Json report{{"frame", status_.frame},
              {"program", emscape::toString(program.activity)},
              {"progress", program.fraction < 0 ? Json() : Json(rounded(program.fraction, 1e-3))},
              {"computing_what", program.what},
              {"state", render::toString(status_.state)},
              {"pattern", render::toString(status_.pattern)},
              {"rays_fraction", rounded(status_.rays_fraction, 1e-4)},
              {"cells", status_.cells},
              {"cast_ms", rounded(status_.cast_ms, 1e-2)},
              {"labels_ms", rounded(status_.labels_ms, 1e-2)},
              {"field_ms", rounded(status_.field_ms, 1e-2)},
              {"input_to_picture_ms", rounded(status_.input_to_picture_ms, 1e-2)},
              {"input_to_frame_ms", rounded(status_.input_to_frame_ms, 1e-2)},
              {"fields_computed", status_.fields_computed},
              {"fields_abandoned", status_.fields_abandoned},
              {"abandon_ms", rounded(status_.abandon_ms, 1e-2)},
              {"fields_per_s", rounded(status_.fields_per_s, 1e-2)},
              {"asked_s", timeline_.asked_s()},
              {"shown_s", status_.shown_s},
              {"exact", exact()},
              {"column_step", status_.column_step},
              {"settled", settled()},
              {"computing", status_.computing},
              {"cached_steps", status_.cached_steps.size()},
              {"cache_mib", rounded(mebibytes(status_.cached_bytes), 1e-2)},
              {"cache_limit_mib", rounded(mebibytes(cache_limit_bytes_), 1e-2)},
              {"device", status_.device},
              {"error", notice_.is_error ? notice_.text : std::string()},
              {"playing", timeline_.playing()},
              {"rate", timeline_.rate()},
              {"loop", timeline_.loop()},
              {"play_from_s", timeline_.playRange().begin_s},
              {"play_to_s", timeline_.playRange().end_s},
              {"visible_from_s", timeline_.visible().begin_s},
              {"visible_to_s", timeline_.visible().end_s},
              {"azimuth_deg", rounded(camera.azimuth_deg, 1e-6)},
              {"elevation_deg", rounded(camera.elevation_deg, 1e-6)},
              {"distance", camera.distance.value_or(0)},
              {"orthographic", camera.projection == render::Projection::orthographic},
              {"iso_value", std::isnan(settings.iso_value) ? Json() : Json(settings.iso_value)},
              {"planes", std::count_if(settings.planes.begin(), settings.planes.end(),
                                       [](const render::CutPlane& plane) { return plane.on; })},
              {"map_layer", settings.map_height_agl_m ? Json(*settings.map_height_agl_m) : Json()},
              {"map_opacity", settings.map_opacity},
              {"following", view_.follow},
              {"compare", compares()},
              {"split", view_.split},
              {"shows_edits",
               picture_ && !edit_queue_.isBusy() && (!edits_ || picture_->scenario == edits_->scenario())},
              {"edits", edits_ ? edits_->edits().size() : 0},
              {"unsaved", hasUnsavedEdits()},
              {"input", options_.view.input},
              {"working", working()},
              {"typing", files_->is_typing},
              {"kept", kept_view_.has_value()},
              {"changed_on_disk", changed_files_.size()},
              {"copied", copied_},
              {"recording", files_->recorder.running()},
              {"warnings", warnings_.size()},
              {"unsaved_colors", hasUnsavedColors()},
              {"can_undo", canUndo()},
              {"can_redo", canRedo()},
              {"picture_width", picture_ ? picture_->size.width : 0},
              {"picture_height", picture_ ? picture_->size.height : 0},
              {"scale", window_.scale()}};
  for (const playback::ViewSetting& setting : playback::viewSettings()) {
    if (setting.verb.empty()) continue;
    report[setting.verb] = std::visit([](const auto& value) { return Json(value); }, setting.get(view_));
  }
  if (picture_) {
    report["range_min"] = picture_->transfer.lowest();
    report["quantity"] = picture_->info().quantity;
    report["range_max"] = picture_->transfer.highest();
  }
  if (options_.stream) {
    report["stream"] = stream_.text;
    report["stream_records"] = stream_.records;
    report["stream_entities"] = stream_.entities;
  }
  report.update(probeReport());
  report.update(selectionReport());
  report.update(transferReport());
  report["rss_mib"] = rounded(residentMemory_mib(), 0.1);
  report["cpu_s"] = rounded(processorTime_s(), 1e-3);
  return report;
}

}  // namespace emscape::view
