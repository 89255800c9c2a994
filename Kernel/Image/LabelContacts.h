// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file LabelContacts.h
 * @brief Which labels touch in an image, near a point.
 */
#ifndef voxplex_LabelContacts_h
#define voxplex_LabelContacts_h

#include "Image/LabelImage.h"

#include <boost/container/small_vector.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace voxplex
{

/**
 * @brief Local questions about the topology of a label image: who touches whom, and what is connected.
 *
 * Two labels *touch* where a voxel of one and a voxel of the other share a face, an edge or a corner.
 * A label is *connected* through faces of its voxels, as its components are. So two voxels of one label
 * that share an edge or a corner only are neither torn apart nor held together by these rules. Outside
 * of the image there is background.
 *
 * Immutable; safe to use from any thread. A question takes time linear in the voxels of the box that it
 * is about, but little for most: it ends at the first voxels that answer it.
 */
template <int D>
class LabelContacts
{
public:
  using Index = typename GridGeometry<D>::Index;

  /** The image must outlive this object. */
  explicit LabelContacts(const LabelImage<D>& image)
    : Image(image)
    , VoxelsPerLength(image.Grid().VoxelsPerLength())
    , Diagonal(image.Grid().VoxelDiagonal())
  {
  }

  /**
   * Whether two labels touch near the facet of a mesh: in a box around its centroid that reaches
   * half as far as its vertices, and the diagonal of a voxel farther.
   * @param corners D points
   */
  bool TouchNear(const std::array<const Point<D>*, static_cast<std::size_t>(D)>& corners, LabelId a,
    LabelId b) const;

  /** What two voxels share that are beside each other. */
  enum class Through
  {
    Faces,
    Corners ///< and edges and faces
  };

  /**
   * Whether a label connects two places within a few voxels of them. Places that have no voxel of
   * the label beside them count as connected: nothing is known about them.
   */
  bool AreConnected(
    const Point<D>& p, const Point<D>& q, LabelId label, Through through = Through::Faces) const;

  /** A part of a line in voxels of one label: those nearest to it. */
  struct Run
  {
    LabelId Label;
    double Begin; ///< 0 to 1 along the line: a place in its first voxel
    double End;   ///< and one in its last
  };
  using Runs = boost::container::small_vector<Run, 8>;

  /**
   * The labels of the voxels along a line, to half a voxel. What lies outside of the crop is one run, if
   * any. A layer that separates two sides is always met: a line that meets no voxel of it leads through
   * voxels that touch each other.
   */
  Runs LabelsAlong(const Point<D>& from, const Point<D>& to) const;

private:
  /** How far beyond both places a connection may run, in diagonals of a voxel. */
  static constexpr double Detour = 3.0;

  /** The voxel of a label nearest to a point, if there is one in or beside the point's voxel. */
  std::optional<Index> VoxelOf(LabelId label, const Point<D>& p) const;
  bool AreInBox(const Index& low, const Index& high, LabelId a, LabelId b) const;
  bool TouchInBox(const Index& low, const Index& high, LabelId a, LabelId b) const;

  const LabelImage<D>& Image;
  const Point<D> VoxelsPerLength;
  const double Diagonal;
};

extern template class LabelContacts<3>;
extern template class LabelContacts<4>;

} // namespace voxplex

#endif
