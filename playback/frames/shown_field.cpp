#include "emscape/playback/frames/shown_field.h"

#include <utility>

#include "emscape/render/cells/cell_renderer.h"

namespace emscape::playback {

std::shared_ptr<const CellField> makeCellField(volume::MeshField field,
                                               std::shared_ptr<const volume::MeshFaces> faces) {
  const volume::Grid grid = render::referenceGridOf(*field.mesh);
  return std::make_shared<const CellField>(CellField{std::move(field), std::move(faces), grid});
}

std::shared_ptr<const volume::DenseVolume> ShownField::values() const {
  return cells ? std::make_shared<const volume::DenseVolume>(volume::valuesOf(cells->field)) : volume.host();
}

render::TransferFunction ShownField::defaultColors(const render::ColorRange& range) const {
  return cells ? render::defaultTransferFunction(cells->field, range)
               : render::defaultTransferFunction(*volume.host(), range);
}

bool sameValues(const ShownField& a, const ShownField& b) {
  return !a.isEmpty() && !b.isEmpty() && a.cells == b.cells && a.volume.dense() == b.volume.dense() &&
         a.volume.device() == b.volume.device();
}

}  // namespace emscape::playback
