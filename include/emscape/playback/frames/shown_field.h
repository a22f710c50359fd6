/// A field as it is drawn: on the voxels of a grid, or at the points of tetrahedra.
#pragma once

#include <memory>

#include "emscape/render/transfer/transfer_function.h"
#include "emscape/volume/mesh/mesh.h"
#include "emscape/volume/volume.h"

namespace emscape::playback {

/// A field on tetrahedra with the data that drawing it requires. Immutable.
struct CellField {
  volume::MeshField field;
  std::shared_ptr<const volume::MeshFaces> faces;  ///< of its mesh
  volume::Grid grid;                               ///< render::referenceGridOf() its mesh
};

/// @param faces  of the field's mesh
std::shared_ptr<const CellField> makeCellField(volume::MeshField field,
                                               std::shared_ptr<const volume::MeshFaces> faces);

/// Either a volume or a field on tetrahedra. Copies share the values.
struct ShownField {
  volume::Volume volume;                   ///< empty for a field on tetrahedra
  std::shared_ptr<const CellField> cells;  ///< null for a volume

  bool isEmpty() const { return volume.isEmpty() && !cells; }
  // The functions below require a field.
  const volume::VolumeInfo& info() const { return cells ? cells->field.info : volume.info(); }
  /// For tetrahedra: the reference grid of their box.
  const volume::Grid& grid() const { return cells ? cells->grid : volume.grid(); }
  /// The values in host memory; for tetrahedra the values at the points as a row of voxels, without NaN.
  /// @throws Error (device)
  std::shared_ptr<const volume::DenseVolume> values() const;
  /// Fitted to the histogram of the values. @param range  as for render::defaultTransferFunction()
  /// @throws Error (device)
  render::TransferFunction defaultColors(const render::ColorRange& range = {}) const;
};

/// True if the values are the same object; false for empty fields.
bool sameValues(const ShownField& a, const ShownField& b);

}  // namespace emscape::playback
