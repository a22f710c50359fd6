/// Verbs of colours and opacities, and their source.
#include <fmt/format.h>

#include <cmath>

#include "apps/view/files/file_endings.h"
#include "apps/view/session/session.h"
#include "emscape/base/error.h"
#include "emscape/volume/statistics.h"
#include "playback/editing/opacity_preset.h"

namespace emscape::view {
namespace {

constexpr NumberLimits kIndex{0, NumberLimits{}.max, true};

/// Selects the point that a command names; without one, keeps the selection.
void selectPoint(playback::TransferEditor& editor, const Command& command) {
  if (!command.has("index")) return;
  const auto count = static_cast<double>(editor.function().opacities.size());
  const double index = command.number("index");
  if (!(index < count)) {
    throw Error(ErrorCode::bad_input,
                fmt::format("{}: index {:g}: there are the points 0..{:g}", command.verb, index, count - 1));
  }
  editor.select(static_cast<int>(index));
}

void setPoint(playback::TransferEditor& editor, const Command& command) {
  if (!command.has("index")) {
    if (!command.has("value") || !command.has("opacity")) {
      throw Error(ErrorCode::bad_input,
                  "opacity_point: expected value and opacity of a new point, or the index of one");
    }
    editor.add(command.number("value"), command.number("opacity"));
    return;
  }
  selectPoint(editor, command);
  const auto& point = editor.function().opacities[static_cast<std::size_t>(*editor.selected())];
  editor.moveSelected(command.number("value", point.at), command.number("opacity", point.opacity));
}

}  // namespace

// --- source of the colours ---

void Session::takeColors() {
  // Colours of an earlier request, or fitted to a field without a value, are replaced.
  takes_colors_ = picture_->status.computing ||
                  (!view_.range && view_.transfer_file.empty() && volume::holdsNothing(picture_->info()));
  const playback::OpacityAxis axis = transfer_ ? transfer_->axis : playback::OpacityAxis{};
  undo_order_.forget(History::transfer);
  transfer_.reset();
  saved_colors_.reset();
  view_.transfer.reset();
  if (picture_->transfer.categorical) return;
  transfer_.emplace(picture_->transfer);
  transfer_->axis = axis;
  if (takes_colors_) return;
  saved_colors_ = picture_->transfer;
  view_.transfer_file.clear();
  view_.transfer = picture_->transfer;
  const auto known = field_colors_.find(fieldName(chosenQuantity()));
  if (known == field_colors_.end() || known->second.function.unit != picture_->transfer.unit) return;
  const auto& [function, saved, iso_value] = known->second;
  if (function == *view_.transfer && std::isnan(iso_value)) return;
  transfer_.emplace(function);
  transfer_->axis = axis;
  saved_colors_ = saved;
  view_.range.reset();
  view_.transfer = function;
  view_.settings.iso_value = iso_value;
  live_.show(view_);
}

std::string Session::fieldName(const std::string& quantity) const {
  return compares() ? quantity + " - " + view_.compare : quantity;
}

void Session::leaveField(const std::string& field) {
  const bool has_colors = transfer_ && !takes_colors_;
  if (has_colors) field_colors_[field] = {transfer_->function(), saved_colors_, view_.settings.iso_value};
  takes_colors_ = true;
}

playback::TransferEditor& Session::requireTransfer() {
  if (!hasField()) throw Error(ErrorCode::bad_input, "there is no field yet");
  if (!transfer_) throw Error(ErrorCode::bad_input, "categories have their own colours");
  return *transfer_;
}

void Session::changeTransfer(const std::function<void(playback::TransferEditor&)>& change) {
  playback::TransferEditor& editor = requireTransfer();
  const long long before = editor.changes();
  change(editor);
  touched_ = true;
  if (editor.changes() == before) return;
  takes_colors_ = false;
  view_.transfer = editor.function();
  view_.range.reset();
  live_.show(view_);
}

void Session::dragTransfer(const std::function<void(playback::TransferEditor&)>& change) {
  if (!transfer_) return;
  if (!dragging_) transfer_->beginDrag();
  dragging_ = true;
  changeTransfer(change);
}

void Session::countValues() {
  const bool wanted = (fit_ && fit_ != Fit::series) || (panels.colors && !panels.hidden);
  if (!wanted || counting_ || !hasField() || picture_->info().categorical) return;
  if (values_ && sameValues(values_->field, *picture_)) return;
  counting_ = true;
  jobs_.run([this, field = playback::ShownField(*picture_)]() -> BackgroundJobs::Finish {
    try {
      auto values = std::make_shared<const ValueSummary>(summaryOf(field));
      return [this, values] {
        counting_ = false;
        values_ = values;
      };
    } catch (const Error& error) {
      return [this, error] {
        counting_ = false;
        fit_.reset();
        throw error;
      };
    }
  });
}

void Session::fitColors() {
  if (!transfer_) {
    fit_.reset();
    return;
  }
  if (*fit_ == Fit::series) {
    if (status_.searching) return;
    fit_.reset();
    if (!status_.series_range) return tell("fit_series: no step of the series holds a value", true);
    changeTransfer([&](playback::TransferEditor& editor) { editor.fit(*status_.series_range); });
  } else {
    if (!values_ || !sameValues(values_->field, *picture_)) return;
    const bool anew = *fit_ == Fit::anew;
    fit_.reset();
    changeTransfer([&](playback::TransferEditor& editor) {
      if (anew) {
        editor.setFunction(values_->fitted);
      } else {
        editor.setInterval(values_->fitted.lowest(), values_->fitted.highest());
      }
    });
  }
  noteSteps();
}

// --- files ---

void Session::readTransfer(const std::string& file) {
  requireTransfer();
  jobs_.run([this, file, info = picture_->info()]() -> BackgroundJobs::Finish {
    const render::TransferFunction function = render::readTransferFunction(file, info);
    return [this, file, function] {
      changeTransfer([&](playback::TransferEditor& editor) { editor.setFunction(function); });
      saved_colors_ = function;
      tell("colours read: " + file);
    };
  });
}

std::string Session::usualColorsFile() const {
  return besideInput(options_.namesake(), ".transfer.json");
}

void Session::saveTransfer(const std::string& file) {
  jobs_.run([this, file, function = requireTransfer().function()]() -> BackgroundJobs::Finish {
    render::writeTransferFunction(file, function);
    return [this, file, function] {
      saved_colors_ = function;
      tellWritten(file);
    };
  });
}

Json Session::transferReport() const {
  Json report{{"opacity_points", 0}, {"selected_point", -1}, {"color_map", ""}};
  if (!transfer_) return report;
  const std::vector<render::TransferFunction::OpacityPoint>& points = transfer_->function().opacities;
  report["opacity_points"] = points.size();
  report["color_map"] = transfer_->colorMap();
  report["asked_range_min"] = transfer_->function().lowest();
  report["asked_range_max"] = transfer_->function().highest();
  if (!transfer_->selected()) return report;
  report["selected_point"] = *transfer_->selected();
  report["selected_value"] = points[static_cast<std::size_t>(*transfer_->selected())].at;
  report["selected_opacity"] = points[static_cast<std::size_t>(*transfer_->selected())].opacity;
  return report;
}

// --- verbs ---

std::vector<Verb> Session::transferVerbs() {
  using playback::TransferEditor;
  return {
      {"transfer",
       {{"colors", kText, false, {}, {}, [](const std::string& text) { render::colorMap(text); }},
        {"file", kText, false}},
       "Colour map by name, or colours and opacities from a file",
       [](Session& session, const Command& command) {
         if (command.has("colors") == command.has("file")) {
           throw Error(ErrorCode::bad_input, "transfer: expected either colors or file");
         }
         if (command.has("file")) return session.readTransfer(command.text("file"));
         session.changeTransfer([&](TransferEditor& editor) { editor.setColorMap(command.text("colors")); });
       }},
      {"save_transfer",
       {{"file", kText, false, {}, {}, requireJsonEnding}, {"replace", kBoolean, false}},
       "Writes colours and opacities, for `--transfer`; default: NAME.transfer.json next to the input",
       [](Session& session, const Command& command) {
         session.requireTransfer();
         const std::string given = command.text("file");
         const std::string file = given.empty() ? session.usualColorsFile() : given;
         if (!session.asksToReplace(command, file)) session.saveTransfer(file);
       }},
      {"reset_transfer",
       {},
       "Fits colours and opacities to the histogram of the step on screen",
       [](Session& session, const Command&) {
         session.requireTransfer();
         session.fit_ = Fit::anew;
       }},
      {"opacity_point",
       {{"index", kNumber, false, kIndex}, {"value", kNumber, false}, {"opacity", kNumber, false, {0, 1}}},
       "Adds a point of the opacity curve; with `index` (0, 1, ...) selects one and moves it between its "
       "neighbours",
       [](Session& session, const Command& command) {
         session.changeTransfer([&](TransferEditor& editor) { setPoint(editor, command); });
       }},
      {"remove_point",
       {{"index", kNumber, false, kIndex}},
       "Removes a point of the opacity curve; without `index` the selected one. Two stay",
       [](Session& session, const Command& command) {
         session.changeTransfer([&](TransferEditor& editor) {
           selectPoint(editor, command);
           editor.removeSelected();
         });
       }},
      {"opacity_preset",
       {{"name", kText, true, {}, namesOf(playback::opacityPresets())}, {"value", kNumber, false}},
       "Opacity curve by name: ramp, late ramp, threshold, shell, bands, opaque; a threshold or shell is "
       "at "
       "`value`, else in the middle",
       [](Session& session, const Command& command) {
         std::optional<double> value;
         if (command.has("value")) value = command.number("value");
         session.changeTransfer(
             [&](TransferEditor& editor) { editor.setOpacityPreset(command.text("name"), value); });
       }},
      {"opacity",
       {{"factor", kNumber, true, {1e-3, 1e3}}},
       "Multiplies the opacity of all points, 0.001..1000; limited to 1",
       [](Session& session, const Command& command) {
         session.changeTransfer(
             [&](TransferEditor& editor) { editor.scaleOpacities(command.number("factor")); });
       }},
      {"log_opacity",
       {{"on", kBoolean, false}},
       "The axis of the opacity curve is logarithmic, or linear",
       [](Session& session, const Command& command) {
         session.changeTransfer([&](TransferEditor& editor) {
           editor.axis.logarithmic = command.boolean("on", !editor.axis.logarithmic);
         });
       }},
      {"range",
       {{"min", kNumber, false}, {"max", kNumber, false}},
       "Range of colours and opacities, or one end of it; without numbers as fit_step",
       [](Session& session, const Command& command) {
         const render::TransferFunction& function = session.requireTransfer().function();
         if (!command.has("min") && !command.has("max")) {
           session.fit_ = Fit::step;
           return;
         }
         const double min = command.number("min", function.lowest());
         const double max = command.number("max", function.highest());
         if (!(min < max)) {
           throw Error(ErrorCode::bad_input,
                       fmt::format("range {:g}..{:g}: expected min below max", min, max));
         }
         session.changeTransfer([&](TransferEditor& editor) { editor.setInterval(min, max); });
       }},
      {"fit_step",
       {},
       "Fits the range of colours and opacities to the step on screen",
       [](Session& session, const Command&) {
         session.requireTransfer();
         session.fit_ = Fit::step;
       }},
      {"fit_series",
       {},
       "Fits the range of colours and opacities to the values of the whole series",
       [](Session& session, const Command&) {
         session.requireTransfer();
         session.fit_ = Fit::series;
         session.live_.searchSeriesRange();
       }},
  };
}

}  // namespace emscape::view
