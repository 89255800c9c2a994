// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file LocalSampling.h
 * @brief Samples interfaces more finely where a check found something wrong.
 */
#ifndef voxplex_LocalSampling_h
#define voxplex_LocalSampling_h

#include "Conformity/HiddenLayers.h"
#include "Domain/Domain.h"
#include "Image/BitMask.h"
#include "Image/Components.h"
#include "Image/FacesNear.h"
#include "Image/LabelImage.h"
#include "Refinement/Rules/FeatureSeed.h"
#include "Sizing/SizingField.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <stop_token>
#include <vector>

namespace voxplex
{

/**
 * @brief The only one who lowers local sampling distances, and proposes points for it.
 *
 * Checks say which faces of voxels, or which components, need finer sampling. This class decides how
 * fine: points on the interfaces there (FeatureSeed), finer at each visit of a place, and mostly a
 * bound of Delta(z) for R1 (LocalDelta). Points alone do not give elements to a part that is thinner
 * than their spacing: if no circumcentre lies in the part, no element has its label. R1 with a smaller
 * sampling distance makes circumballs small enough.
 *
 * A place is a cell of LocalDelta. No place is sampled more finely than a fraction of a voxel, because
 * the label field has no finer features; then nothing more is proposed.
 *
 * Not thread safe.
 */
template <int D>
class LocalSampling
{
public:
  /**
   * All references must outlive the object.
   * @param image of the components and of LocalDelta
   * @param ofDomain of the faces; it may have more frames (4D), whose numbers are taken for those of
   *   `image` where bounds are set
   * @param sites surface voxels of `ofDomain` (FindSurfaceVoxels)
   * @param local receives the spacing of the points, and bounds
   */
  LocalSampling(const LabelImage<D>& image, const LabelImage<D>& ofDomain, const BitMask<D>& sites,
    const Domain<D>& domain, const SizingField<D>& sizing, LocalDelta<D>& local,
    const std::stop_token& stop);

  ///@{
  /**
   * Each returns the number of points that it has proposed.
   * @throws Cancelled if a stop was requested before the end
   */

  /** Around faces that are far from the mesh, and around the midpoints of non-manifold edges. */
  std::size_t SampleInterfaces(
    const std::vector<VoxelFace<D>>& far, const std::vector<Point<D>>& edges);

  /** On faces of components whose elements have gaps. */
  std::size_t SampleGaps(const std::vector<VoxelFace<D>>& faces);

  /**
   * Where dual edges enter and leave hidden layers.
   * @param thinnest layers that are thinner on the dual edge are left out, in spacings of the mesh there
   */
  std::size_t SampleLayers(const std::vector<HiddenLayer<D>>& layers, double thinnest);

  /** On all faces of a component, and inside of it a bound. */
  std::size_t SampleComponent(
    const Components<D>& components, std::uint32_t component, double spacing);
  ///@}

  /** The faces that SampleInterfaces() has sampled so far, ascending. */
  const std::vector<VoxelFace<D>>& Sampled() const { return this->Faces; }

  /** The finest spacing of a component. */
  double FinestOfComponents() const { return this->FinestOfComponent; }

  /** The points since the last call. Bounds are graded then, and LocalDelta tells which are new. */
  std::vector<FeatureSeed<D>> TakeSeeds();

private:
  using Index = typename GridGeometry<D>::Index;

  struct Place
  {
    double Spacing = 0.0; ///< at the last visit; 0: no more
    unsigned Visits = 0;
    unsigned Request = 0; ///< at the last visit
  };

  /** How finely the faces of places are sampled. */
  struct Schedule
  {
    double First;         ///< spacing at the first visit, in sampling distances
    double Next;          ///< spacing at the next visit, in spacings of the one before
    double Finest;        ///< spacing, a length
    unsigned FirstBound;  ///< the visit from which on the sampling distance of R1 is bounded, too
    double BoundAtFinest; ///< this bound in spacings, at the finest; before, BoundFactor
    std::map<Index, Place> Places = {};
  };

  Index VoxelAt(const Point<D>& p) const;
  double AskedDistance(const VoxelFace<D>& face) const;
  Place& PlaceAt(const Index& voxel, Schedule& schedule);
  void Visit(Place& place, const Schedule& schedule, double first);
  void Begin();
  template <typename DistanceOf>
  std::size_t SampleFaces(
    const std::vector<VoxelFace<D>>& faces, Schedule& schedule, const DistanceOf& distanceOf);
  void Bound(const std::vector<VoxelFace<D>>& faces, Schedule& schedule);

  const LabelImage<D>& Image;
  const LabelImage<D>& OfDomain;
  const BitMask<D>& Sites;
  const Domain<D>& Surfaces;
  const SizingField<D>& Sizing;
  LocalDelta<D>& Local;
  const std::stop_token Stop;
  Schedule OfInterfaces;
  Schedule OfGaps;
  Schedule OfLayers;
  double FinestOfComponent;
  std::vector<VoxelFace<D>> Faces;
  std::vector<FeatureSeed<D>> Seeds; ///< not taken yet
  unsigned Requests = 0;
  bool AreTaken = false; ///< and nothing was requested since
};

extern template class LocalSampling<3>;
extern template class LocalSampling<4>;

} // namespace voxplex

#endif
