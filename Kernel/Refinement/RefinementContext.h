// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file RefinementContext.h
 * @brief What all refinement threads share, and what each has of its own.
 */
#ifndef voxplex_RefinementContext_h
#define voxplex_RefinementContext_h

#include "Delaunay/Triangulation.h"
#include "Domain/Domain.h"
#include "Parallel/CacheLine.h"
#include "Refinement/FeatureGrid.h"
#include "Refinement/FeatureSeed.h"
#include "Refinement/PoorElementList.h"
#include "Refinement/RefinementStatistics.h"
#include "Refinement/RegionalWork.h"
#include "Refinement/RuleOptions.h"
#include "Sizing/GradedDelta.h"
#include "Sizing/InterfaceSizes.h"
#include "Sizing/LocalDelta.h"
#include "Sizing/SizeFunction.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace voxplex
{

/** Points closer to a vertex than this fraction of the spacing at their place are never inserted. */
inline constexpr double SpacingFloorFraction = 0.1;

/** Where a region has taken too much work, points for the sake of facets keep this fraction instead. */
inline constexpr double YieldingFraction = 0.5;

/** Feature points nearer to a flat end than this, in delta, are moved onto it. */
inline constexpr double EndMargin = 0.8;

/** Parameters of the rules, in the unit of length of the mesher's frame. */
template <int D>
struct RefinementSettings
{
  double Delta = 1.0;                     ///< sampling density; if it is graded, the largest
  const GradedDelta<D>* Graded = nullptr; ///< delta from place to place; null: the same everywhere
  const InterfaceSizes<D>* Interfaces = nullptr; ///< in place of delta; may be null
  const LocalDelta<D>* Local = nullptr;          ///< upper bound of delta; may be null
  double RadiusEdgeRatio = 2.0;                  ///< rho-bar
  double FacetAngle = 30.0;                      ///< degrees
  const SizeFunction<D>* Size = nullptr;
  double SizeFloor = 0.0; ///< sizes below it are raised to it; 0: a tenth of the finest delta
  RuleOrder Order = RuleOrder::RadiusEdgeFirst; ///< 4D only
  SliverOptions Slivers;                        ///< 4D only
  TetSliverOptions TetSlivers;                  ///< 3D only
};

/** The smallest sampling density, but for interface sizes, local bounds and sizes of elements. */
template <int D>
double FinestDelta(const RefinementSettings<D>& settings)
{
  return settings.Graded ? std::min(settings.Graded->Finest(), settings.Delta) : settings.Delta;
}

/** Shared by all threads. */
template <int D>
struct RefinementContext
{
  RefinementContext(const Domain<D>& image, const RefinementSettings<D>& settings,
    const Box<D>& box, std::uint64_t expectedFeatures)
    : Image(image)
    , Settings(settings)
    , SizeFloor(settings.SizeFloor > 0.0 ? settings.SizeFloor
                                         : SpacingFloorFraction * FinestDelta(settings))
    , SpacingFloor(SizeFloor)
    , IsFlatEnd{ image.IsFlatEnd(0), image.IsFlatEnd(1) }
    , IsCut(image.IsCut())
    , Mesh(box)
    , Features(box.Min, std::sqrt(FinestDelta(settings) * settings.Delta), expectedFeatures)
    , Work(expectedFeatures)
  {
    this->FollowLocalDelta();
  }

  /** To be called when bounds were added to Settings.Local; not while anybody refines. */
  void FollowLocalDelta()
  {
    double smallest = FinestDelta(this->Settings);
    if (this->Settings.Interfaces)
    {
      smallest = std::min(smallest, this->Settings.Interfaces->Smallest());
    }
    if (this->Settings.Local)
    {
      smallest = std::min(smallest, this->Settings.Local->Smallest());
    }
    this->SpacingFloor = std::min(this->SizeFloor, SpacingFloorFraction * smallest);
  }

  /** sf(p), cleaned of what is no bound and raised to the floor. */
  double Size(const Point<D>& p, LabelId label) const
  {
    if (!this->Settings.Size)
    {
      return std::numeric_limits<double>::infinity();
    }
    const double size = this->Settings.Size->Evaluate(p, this->Image.LabelValue(label));
    if (!(size > 0.0))
    {
      return std::numeric_limits<double>::infinity();
    }
    return size < this->SizeFloor ? this->SizeFloor : size;
  }

  /** The sampling density near a point, without interface sizes, local bounds and sizes of elements. */
  double GradedDeltaAt(const Point<D>& p) const
  {
    return this->Settings.Graded ? this->Settings.Graded->At(p) : this->Settings.Delta;
  }

  /**
   * Delta_dOmega(z) of the thesis for a feature point between two labels: delta or what is asked for that
   * interface in its place, or the local bound or the size that is asked for there if that is smaller. Sampling an interface more coarsely than its neighbourhood is
   * meshed would make R3 insert the missing points one by one, and R6 remove what R5 asks for.
   * The same label twice is no interface, but may be all that is known near the edge of one: then it is the spacing there.
   */
  double Delta(const Point<D>& z, LabelId a, LabelId b) const
  {
    if (a == b)
    {
      return this->Spacing(z, a);
    }
    double delta =
      this->Settings.Interfaces ? this->Settings.Interfaces->At(z, a, b) : this->GradedDeltaAt(z);
    if (this->Settings.Local)
    {
      const auto bound = this->Settings.Local->At(z);
      delta = bound.Label == a || bound.Label == b ? std::min<double>(delta, bound.Delta) : delta;
    }
    if (this->Settings.Size)
    {
      for (const LabelId label : { a, b })
      {
        delta = label != 0 ? std::min(delta, this->Size(z, label)) : delta;
      }
    }
    return delta;
  }

  /** Delta(z) for the interface point closest to p: the label of p is known, that beyond is just behind z, if one is. */
  double DeltaBehind(const Point<D>& p, LabelId label, const Point<D>& z) const
  {
    const Point<D> behind =
      Interpolate(p, z, 1.0 + this->SpacingFloor / std::max(Distance(p, z), 1e-300));
    return this->Delta(z, label, this->Image.Label(behind));
  }

  /** Whether Delta() differs from GradedDeltaAt() for any labels at z, but for sizes. */
  bool MayBeLocal(const Point<D>& z) const
  {
    return this->Settings.Interfaces ||
      (this->Settings.Local && this->Settings.Local->At(z).Delta < this->GradedDeltaAt(z));
  }

  /** The largest Delta() of all interfaces. */
  double LargestDelta() const
  {
    return this->Settings.Interfaces
      ? std::max(this->Settings.Delta, this->Settings.Interfaces->Largest())
      : this->Settings.Delta;
  }

  /**
   * The spacing of the mesh at p: the least that any interface nearby asks for, growing slowly with the distance from
   * it. All rules that keep points apart, or take points away, ask for it here: a rule that keeps less than another
   * makes what the other takes away again.
   */
  double SpacingAt(const Point<D>& p) const
  {
    const double spacing = this->Settings.Interfaces
      ? std::min(this->LargestDelta(), this->Settings.Interfaces->GradedAt(p))
      : this->GradedDeltaAt(p);
    return this->Settings.Local ? std::min(spacing, this->Settings.Local->GradedAt(p)) : spacing;
  }

  /** The same inside of a label: no more than the size that is asked for there. */
  double Spacing(const Point<D>& p, LabelId label) const
  {
    const double spacing = this->SpacingAt(p);
    return label != 0 ? std::min(spacing, this->Size(p, label)) : spacing;
  }

  /** The time of the nearest flat end (Domain::IsFlatEnd); infinite if there is none. */
  double NearestFlatEnd(double time) const
  {
    constexpr std::size_t Time = static_cast<std::size_t>(D) - 1;
    const Box<D>& box = this->Mesh.GetBox();
    if (this->IsFlatEnd[0] && (!this->IsFlatEnd[1] || time - box.Min[Time] <= box.Max[Time] - time))
    {
      return box.Min[Time];
    }
    return this->IsFlatEnd[1] ? box.Max[Time] : std::numeric_limits<double>::infinity();
  }

  /** Whether z is too near to a flat end to be a feature vertex, and its projection there. */
  bool IsNearEnd(const Point<D>& z, double delta, Point<D>& onEnd) const
  {
    constexpr std::size_t Time = static_cast<std::size_t>(D) - 1;
    onEnd = z;
    onEnd[Time] = this->NearestFlatEnd(z[Time]);
    const double distance = std::abs(z[Time] - onEnd[Time]);
    return distance > 0.0 && distance < EndMargin * delta;
  }

  const Domain<D>& Image;
  const RefinementSettings<D> Settings;
  const double SizeFloor;              ///< smaller sizes are raised to it
  double SpacingFloor;                 ///< points closer to a vertex than this are never inserted
  const std::array<bool, 2> IsFlatEnd; ///< Domain::IsFlatEnd; the box ends there
  const bool IsCut;                    ///< Domain::IsCut
  Triangulation<D> Mesh;
  FeatureGrid<D> Features;
  RegionalWork<D> Work;
};

/** What came of an element's evaluation, or of another task of a worker. */
enum class Verdict
{
  Good,     ///< no rule applies, or none can be applied: nothing changed
  Changed,  ///< the triangulation changed
  Contended ///< given up because another thread owns a vertex; to be tried again
};

/** A removal by R6 that another thread was in the way of. */
struct PendingRemoval
{
  VertexId Vertex;
  VertexId Feature; ///< the vertex goes if it is a free one nearer than ...
  double Radius;    ///< ... this to the feature vertex
};

/** A region where rules give way, by a place of it. */
template <int D>
struct YieldingRegion
{
  Point<D> Place;
  Yielding Step;
};

/** Whose list of poor elements an entry may be taken out of when its simplex dies. */
struct EagerRemoval
{
  PoorElementList::Directory Directory;
  std::vector<PoorElementList*> Lists; ///< by number
  std::vector<unsigned> Socket;        ///< of the list's thread
};

/** One thread's own; threads that run write to no common cache line. */
template <int D>
struct alignas(CacheLineSize) RefinementWorker
{
  explicit RefinementWorker(const RefinementContext<D>& context, WorkerId id = 0)
    : Kernel(context.Mesh, id)
  {
  }

  /**
   * Takes what the last operation deleted out of the lists of poor elements; those of another socket are
   * left to lazy removal (thesis, section 3.2.3). Does nothing unless removal is eager.
   */
  void RemoveDeleted(const Triangulation<D>& mesh)
  {
    if (!this->Eager)
    {
      return;
    }
    for (const SimplexId s : this->Kernel.Deleted)
    {
      const PoorElementList::Directory::Place place = this->Eager->Directory.Find(s);
      if (place.List != None &&
        this->Eager->Socket[place.List] == this->Eager->Socket[this->Number])
      {
        const std::uint32_t generation = mesh.State(s).CurrentGeneration() - 1;
        this->Eager->Lists[place.List]->Remove({ s, generation }, place.Index);
      }
    }
  }

  typename Triangulation<D>::Worker Kernel;
  PoorElementList Poor;
  EagerRemoval* Eager = nullptr;                ///< null if removal is lazy
  unsigned Number = 0;                          ///< of this worker's list
  std::vector<PoorElementList::Entry> Deferred; ///< rolled back; tried again after the next success
  std::vector<PendingRemoval> PendingRemovals;
  std::vector<YieldingRegion<D>> Yielded; ///< where rules began to give way
  bool ScreensLater = false; ///< what is made is not screened: whoever sets it does so at the end
  RuleStatistics Statistics;
};

} // namespace voxplex

#endif
