// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file RefinementContext.h
 * @brief The data that all refinement threads share, and the data of each thread.
 */
#ifndef voxplex_RefinementContext_h
#define voxplex_RefinementContext_h

#include "Delaunay/Triangulation.h"
#include "Domain/Domain.h"
#include "Parallel/CacheLine.h"
#include "Refinement/PoorElementList.h"
#include "Refinement/RefinementStatistics.h"
#include "Refinement/Rules/FeatureGrid.h"
#include "Refinement/Rules/FeatureSeed.h"
#include "Refinement/Rules/RegionalWork.h"
#include "Refinement/Rules/RuleOptions.h"
#include "Sizing/SizingField.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>
#include <vector>

namespace voxplex
{

/**
 * The spacing factor of points that are inserted for the sake of facets, where a region has taken
 * too much work.
 */
inline constexpr double RelaxedSpacingFraction = 0.5;

/** The clearance of a feature point that is inserted for the sake of facets. */
constexpr double FacetClearance(double spacing, Relaxation step)
{
  return (step < Relaxation::Spacing ? SpacingFloorFraction : RelaxedSpacingFraction) * spacing;
}

/** A feature point nearer to a flat end than this, in delta, is moved onto it. */
inline constexpr double EndMargin = 0.8;

/** A feature point nearer to a flat end than this, in delta, is on it but for rounding. */
inline constexpr double NextToEnd = 1e-6;

/** Parameters of the rules, in the unit of length of the mesher's frame. */
template <int D>
struct RefinementSettings
{
  SizingSources<D> Sizing;
  ShapeOptions Shape;
  SpaceTimeRuleOptions SpaceTime;
};

/** The data that all threads share. */
template <int D>
struct RefinementContext
{
  RefinementContext(const Domain<D>& image, const RefinementSettings<D>& settings,
    const Box<D>& box, std::uint64_t expectedFeatures)
    : Image(image)
    , Settings(settings)
    , Sizing(image, settings.Sizing)
    , HasTimeBorder{ image.HasTimeBorder(0), image.HasTimeBorder(1) }
    , Border(image.Border())
    , Mesh(box)
    , Features(box.Min, std::sqrt(settings.Sizing.Base.Finest() * settings.Sizing.Base.Delta),
        expectedFeatures)
    , Work(expectedFeatures)
  {
  }

  /** The time of the nearest flat end (Domain::HasTimeBorder); infinite if there is none. */
  double NearestFlatEnd(double time) const
  {
    constexpr std::size_t Time = static_cast<std::size_t>(D) - 1;
    const Box<D>& box = this->Mesh.GetBox();
    if (this->HasTimeBorder[0] &&
      (!this->HasTimeBorder[1] || time - box.Min[Time] <= box.Max[Time] - time))
    {
      return box.Min[Time];
    }
    return this->HasTimeBorder[1] ? box.Max[Time] : std::numeric_limits<double>::infinity();
  }

  /**
   * Whether z is too near to a flat end to be a feature vertex; `onEnd` receives its projection
   * there.
   */
  bool IsNearEnd(const Point<D>& z, double delta, Point<D>& onEnd) const
  {
    constexpr std::size_t Time = static_cast<std::size_t>(D) - 1;
    onEnd = z;
    onEnd[Time] = this->NearestFlatEnd(z[Time]);
    const double distance = std::abs(z[Time] - onEnd[Time]);
    return distance > 0.0 && distance < EndMargin * delta;
  }

  /**
   * z, or its projection onto a flat end if it is so near that a vertex there would make pentatopes
   * without a volume. Interfaces along an end lie there up to rounding.
   */
  Point<D> OnEndIfNextTo(const Point<D>& z, double delta) const
  {
    constexpr std::size_t Time = static_cast<std::size_t>(D) - 1;
    Point<D> onEnd;
    const bool isNext =
      this->IsNearEnd(z, delta, onEnd) && std::abs(z[Time] - onEnd[Time]) < NextToEnd * delta;
    return isNext ? onEnd : z;
  }

  /**
   * Finds where an interface meets a flat end that is near z.
   * @return false if no end is near, z lies on one already, or no interface was found there
   */
  bool SnapToEnd(const Point<D>& z, double delta, Point<D>& snapped) const
  {
    Point<D> onEnd = z;
    return this->IsNearEnd(z, delta, onEnd) && this->Image.ClosestSurfacePointOnEnd(onEnd, snapped);
  }

  /** Whether a point of the box is on a face of the box that is not a flat end. */
  bool IsOnSide(const Point<D>& p) const
  {
    const Box<D>& box = this->Mesh.GetBox();
    for (std::size_t a = 0; a < static_cast<std::size_t>(D); ++a)
    {
      const bool time = a + 1 == static_cast<std::size_t>(D);
      if ((p[a] == box.Min[a] && !(time && this->HasTimeBorder[0])) ||
        (p[a] == box.Max[a] && !(time && this->HasTimeBorder[1])))
      {
        return true;
      }
    }
    return false;
  }

  /** Whether a flat end is a plane between slabs. */
  bool HasPlanes() const { return this->IsPlane[0] || this->IsPlane[1]; }

  /** Whether a point of the box lies on a flat end where rules may insert nothing any more. */
  bool IsOnClosedEnd(const Point<D>& p) const
  {
    constexpr std::size_t Time = static_cast<std::size_t>(D) - 1;
    return D == 4 &&
      ((this->IsClosed[0] && p[Time] == this->Mesh.GetBox().Min[Time]) ||
        (this->IsClosed[1] && p[Time] == this->Mesh.GetBox().Max[Time]));
  }

  const Domain<D>& Image;
  const RefinementSettings<D> Settings;
  SizingField<D> Sizing;
  const std::array<bool, 2> HasTimeBorder; ///< Domain::HasTimeBorder; the box ends there
  /**
   * Flat ends that are planes between slabs: pentatopes with a facet there get the label of the
   * plane (SlabRefinement). To be set before refinement.
   */
  std::array<bool, 2> IsPlane{ false, false };
  /** Flat ends where the rules insert nothing. To be set between refinements. */
  std::array<bool, 2> IsClosed{ false, false };
  const ImageBorder<D>* const Border; ///< Domain::Border; may be null
  Triangulation<D> Mesh;
  FeatureGrid<D> Features;
  RegionalWork<D> Work;
};

/** The outcome of an element's evaluation, or of another task of a worker. */
enum class RuleOutcome
{
  Good,     ///< no rule applies or can be applied: nothing changed
  Changed,  ///< the triangulation changed
  Contended ///< given up because another thread owns a vertex; to be tried again
};

/** A removal by the removal rule that was given up because of another thread. */
template <int D>
struct PendingRemoval
{
  VertexId Vertex;
  Point<D> Position; ///< of the vertex; if it is elsewhere, the id belongs to another one
  VertexId Feature;  ///< the vertex is removed if it is nearer than ...
  double Radius;     ///< ... this to the feature vertex
};

/**
 * @brief Where a worker may refine while others refine in their zones (TiledRefiner).
 *
 * What the worker does must not depend on the others. So it reads nothing that they may write: no
 * vertex, no feature point and no count outside of its zone. If an evaluation needs to know
 * something there, it changes nothing, and the element is put off.
 */
template <int D>
struct WorkerZone
{
  HalfOpenBox<D> Extent;
  /** The sliver rule waits until the rest of the box has been refined. */
  bool DefersSlivers = false;
  /** The current evaluation needs to know something outside. */
  bool NeedsOutside = false;
  /** The insertions that this worker has counted here, by region. RegionalWork gets them later. */
  std::unordered_map<typename RegionalWork<D>::Region, std::uint32_t> Work;

  std::uint32_t WorkIn(typename RegionalWork<D>::Region region) const
  {
    const auto found = this->Work.find(region);
    return found == this->Work.end() ? 0 : found->second;
  }
};

/** A region where rules give way, given by a point in it. */
template <int D>
struct RelaxedRegion
{
  Point<D> Position;
  Relaxation Step;
};

/** The data of one thread. Running threads write to no common cache line. */
template <int D>
struct alignas(CacheLineSize) RefinementWorker
{
  explicit RefinementWorker(const RefinementContext<D>& context, WorkerId id = 0)
    : Kernel(context.Mesh, id)
  {
    this->Poor.DropDeadBy([&mesh = context.Mesh](const PoorElementList::Entry& e)
      { return mesh.State(e.Id).CurrentGeneration() == e.Generation; });
  }

  typename Triangulation<D>::Worker Kernel;
  PoorElementList Poor;
  std::vector<PoorElementList::Entry> Deferred; ///< rolled back; tried again after the next success
  std::vector<PendingRemoval<D>> PendingRemovals;
  std::vector<RelaxedRegion<D>> RelaxedRegions; ///< the regions where rules began to give way
  WorkerZone<D>* Zone = nullptr;                ///< null: the worker may refine everywhere
  /** New simplices are not screened now. The caller screens them at the end. */
  bool ScreensLater = false;
  RuleStatistics Statistics;
};

} // namespace voxplex

#endif
