/// Fields on tetrahedra: a mesh of points and cells, and values at its points.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "emscape/base/error.h"
#include "emscape/base/geodesy/geo_frame.h"
#include "emscape/base/vec.h"
#include "emscape/volume/dense_volume.h"
#include "emscape/volume/statistics.h"

namespace emscape::volume {

constexpr long long kMaxMeshPoints = (1LL << 31) - 1;
constexpr long long kMaxMeshCells = 1LL << 29;  ///< faces are counted in 31 bits

/// Points and tetrahedra. The vertices (p0, p1, p2, p3) of each cell are ordered so that
/// (p1 - p0) x (p2 - p0) points towards p3, as in VTK: see orientCells().
struct TetrahedralMesh {
  std::vector<Vec3d> points_m;  ///< in the frame of `frame`; finite
  std::vector<std::array<std::int32_t, 4>> cells;
  FrameOrigin frame;
  /// False for a mesh without a position on the earth: frame is then undefined.
  bool georeferenced = false;
};

/// Vertices of the face opposite each vertex of a cell, counter-clockwise as seen from outside.
constexpr int kFaceVertices[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};

/// A scalar field at the points of a mesh, linear in each cell. NaN: no field is known there, and the cells
/// at that point have none.
struct MeshField {
  std::shared_ptr<const TetrahedralMesh> mesh;
  VolumeInfo info;
  std::vector<float> values;  ///< one per point
};

/// Corners of the box of the points.
struct MeshBounds {
  Vec3d lower_m, upper_m;
};
MeshBounds boundsOf(const TetrahedralMesh& mesh);

/// Checks a mesh and orders the vertices of each cell as TetrahedralMesh states: those of inverted cells are
/// reordered, as their order carries no other information.
/// @return the number of inverted cells
/// @throws Error (bad_input) at `location` that names the point or cell: for no cells or too many,
/// coordinates that are not finite, vertices that are not points, and degenerate cells: with a repeated
/// vertex, or with a volume below 1e-12 of the cube of the longest edge
long long orientCells(TetrahedralMesh& mesh, const SourceLocation& location);

/// A face as 4 * cell + index of the vertex opposite to it.
using FaceId = std::int32_t;
constexpr FaceId kNoFace = -1;

/// Adjacency of the cells of a mesh across their faces.
struct MeshFaces {
  /// Element FaceId: the same face as seen from the cell on its other side; kNoFace on the boundary.
  std::vector<FaceId> other_side;
  std::vector<FaceId> boundary;  ///< ascending
};

/// Finds the adjacency. orientCells() must have been called.
/// @throws Error (bad_input) at `location` that names the cells of a face that belongs to three cells, or to
/// two cells on the same side, which overlap
MeshFaces facesOf(const TetrahedralMesh& mesh, const SourceLocation& location);

/// Compares the boundary faces with each other, along lines through their insides and near their vertices: at
/// most about 6e7 pairs of lines and faces; of more lines every n-th. Overlaps thinner than rounding
/// (1e-6 of the box's diagonal and 2e-7 of the largest coordinate) are none.
/// @return the number of boundary faces, of those examined, whose inside lies on a boundary face of another
/// cell: vertices in faces of other cells (T-junctions) and points that are there twice. The mesh has no gap
/// there, but the field may jump
/// @throws Error (bad_input) at `location` that names two cells which overlap
long long touchingFaces(const TetrahedralMesh& mesh, const MeshFaces& faces, const SourceLocation& location);

/// The tetrahedra of a lattice of hexahedra: six for each, about the diagonal from its lowest to its highest
/// corner, so that neighbours share the diagonals of their faces. The vertices are the indices of the
/// lattice's points, x fastest, then y, then z. Where the columns of points are vertical no cell is inverted,
/// however steep and twisted the layers are.
/// @param points  at least 2 along each axis
std::vector<std::array<std::int32_t, 4>> latticeCells(const Dims& points);

/// Checks that a field has a name and a finite or NaN value for each point. @throws Error (bad_input)
void checkMeshField(const MeshField& field, const SourceLocation& location);

/// Statistics of the values at the points; NaN is not valid, and nothing is masked. The mean is over points,
/// not over volume.
Statistics statisticsOf(const MeshField& field);

/// Sets info.range_min and range_max as for a DenseVolume.
void setRangeFromValues(MeshField& field);

/// The values at the points as a row of voxels, without NaN: for histograms.
DenseVolume valuesOf(const MeshField& field);

}  // namespace emscape::volume
