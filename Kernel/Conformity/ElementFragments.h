// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ElementFragments.h
 * @brief The elements of a mesh that hang together through faces, before it is extracted (3D).
 */
#ifndef voxplex_ElementFragments_h
#define voxplex_ElementFragments_h

#include "Image/Components.h"
#include "Mesh/LabelledTriangulation.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <stop_token>
#include <vector>

namespace voxplex
{

/**
 * @brief The fragments of each label: maximal sets of its elements that are connected through faces.
 *
 * Fragments are numbered from 0 in the order of their first elements.
 */
class ElementFragments
{
public:
  struct Fragment
  {
    LabelId Label = 0;
    std::uint32_t Component = None; ///< of the image, that it belongs to; see FindComponents()
    double Volume = 0.0;            ///< see MeasureVolumes()
  };

  /**
   * Takes time linear in the number of elements, and memory of 10 bytes for each.
   * @param elements must outlive this object
   * @throws Cancelled if a stop was requested before the end; std::bad_alloc
   */
  ElementFragments(const LabelledTriangulation<3>& elements, const std::stop_token& stop);

  /**
   * Finds the component of each fragment: the first one that has the label of the fragment, and the
   * centroid of one of its elements in its voxels; if there is none, in a voxel beside them.
   */
  void FindComponents(const Components<3>& components, const LabelImage<3>& image);

  /** Finds the volumes of some fragments. Call it once. */
  void MeasureVolumes(const std::vector<bool>& which);

  const std::vector<Fragment>& All() const { return this->List; }

  /** LabelledTriangulation::Size(). */
  std::size_t Size() const { return this->Numbers.size(); }

  /** The fragment of an element; None if it is outside of all labels. */
  std::uint32_t Of(std::size_t element) const { return this->Numbers[element]; }

  std::array<Point<3>, 4> PointsOf(std::size_t element) const;

private:
  const LabelledTriangulation<3>& Elements;
  std::vector<std::uint32_t> Numbers; ///< by element
  std::vector<Fragment> List;
};

} // namespace voxplex

#endif
