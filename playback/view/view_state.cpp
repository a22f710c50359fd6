#include "emscape/playback/view/view_state.h"

#include "emscape/base/enum_names.h"

namespace emscape::playback {

CellMethod parseCellMethod(const std::string& name) {
  return parseName<CellMethod>("way of drawing cells", name);
}

void dropColors(ViewState& view) {
  view.transfer.reset();
  view.range.reset();
  view.settings.iso_value = render::RenderSettings{}.iso_value;
}

void changeQuantity(ViewState& view, const std::string& quantity) {
  if (quantity == view.quantity) return;
  view.quantity = quantity;
  dropColors(view);
}

void changeComparison(ViewState& view, const std::string& compare) {
  if (compare.empty() != view.compare.empty()) dropColors(view);
  view.compare = compare;
}

void changeRange(ViewState& view, const ValueRange& range) {
  view.range = range;
  view.transfer.reset();
}

void setInput(ViewState& view, const ViewState& opened) {
  view.input = opened.input;
  view.scenario = opened.scenario;
  view.mesh = opened.mesh;
  view.allow_missing_terrain = opened.allow_missing_terrain;
  view.transfer_file = opened.transfer_file;
  view.cells = opened.cells;
  view.pattern = opened.pattern;
}

}  // namespace emscape::playback
