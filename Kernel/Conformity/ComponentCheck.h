// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ComponentCheck.h
 * @brief Ensures that no connected component of the image is missing from the mesh.
 */
#ifndef voxplex_ComponentCheck_h
#define voxplex_ComponentCheck_h

#include "Conformity/ComponentStatistics.h"
#include "Conformity/LocalSampling.h"
#include "Image/Components.h"
#include "Mesh/LabelledTriangulation.h"
#include "Quality/LostComponents.h"

#include <cstdint>
#include <stop_token>
#include <vector>

namespace voxplex
{

/**
 * @brief Chooses where to sample more finely so that every component gets elements.
 *
 * If an interface is sampled with delta, objects much thinner than delta can be lost: a Delaunay
 * mesh of too few points joins the regions on both sides. So some components may have no element
 * after refinement. FindLost() finds them, and SampleFiner() has them sampled as a whole (LocalSampling),
 * more finely each time.
 *
 * The largest component of each label is checked however small it is, so that the mesh has all
 * labels of its image.
 *
 * If components are to be exact, components that are thin compared with delta are sampled as a
 * whole from the start. The mean thickness of a component is estimated from the ratio of its volume
 * to its surface. This ratio is a third of the thickness for a ball or cube, and half of it for a
 * sheet or a rod. If the thickness is small compared with delta, the component's surroundings get a
 * smaller delta, and points on all of its faces are inserted before refinement. Rules
 * alone may never see a small component, because they look only at the interface closest to a
 * circumcentre.
 *
 * This goes beyond the thesis, which samples uniformly or by the local feature size and gives no
 * guarantee for objects that are small compared with delta.
 */
template <int D>
class ComponentCheck
{
public:
  /**
   * @param image, components must outlive the check
   * @param sizing the sampling distances elsewhere; needed during construction only
   * @param fewestVoxels smaller components are not checked, except the largest of each label
   * @param exact whether components that are thin compared with delta are sampled as a whole from
   *   the start
   * @param mayRefine false: nothing is requested
   * @param sampling where to sample more finely; must outlive the check
   * @param statistics counts rounds and points
   * @param threads 0 means all cores; results do not depend on it
   * @throws Cancelled if a stop was requested before the end
   */
  ComponentCheck(const LabelImage<D>& image, const Components<D>& components,
    const SizingField<D>& sizing, std::int64_t fewestVoxels, bool exact, bool mayRefine,
    LocalSampling<D>& sampling, ComponentStatistics& statistics, unsigned threads,
    const std::stop_token& stop);

  /**
   * Requests finer sampling for components without elements. Gives up those that cannot get one.
   * @return whether anything was requested
   */
  bool Inspect(const LabelledTriangulation<D>& elements);

  /**
   * Components without an element of their label within a voxel of them, in increasing order.
   * @param elements a SimplexMesh or a LabelledTriangulation
   */
  template <typename Elements>
  std::vector<std::uint32_t> FindLost(const Elements& elements) const
  {
    return FindLostComponents(
      this->All, this->Image, elements, this->Wanted, this->Threads, this->Stop);
  }

  /**
   * Requests finer sampling for these components.
   * @return false if none of them can be sampled more finely
   */
  bool SampleFiner(const std::vector<std::uint32_t>& lost);

private:
  /** The delta that suits the mean thickness of a component. */
  double OwnDelta(std::uint32_t component) const;
  void Sample(std::uint32_t component, double delta);

  const LabelImage<D>& Image;
  const Components<D>& All;
  LocalSampling<D>& Sampling;
  std::vector<double> Delta; ///< by component
  std::vector<bool> Wanted;  ///< by component
  const bool MayRefine;
  unsigned Threads;
  std::stop_token Stop;
  ComponentStatistics& Statistics;
};

extern template class ComponentCheck<3>;
extern template class ComponentCheck<4>;

} // namespace voxplex

#endif
