// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file RefinementContext.h
 * @brief What all refinement threads share, and what each has of its own.
 */
#ifndef voxplex_RefinementContext_h
#define voxplex_RefinementContext_h

#include "Delaunay/Triangulation.h"
#include "Image/Domain.h"
#include "Image/SizeFunction.h"
#include "MeshingStatistics.h"
#include "Refinement/FeatureGrid.h"
#include "Refinement/PoorElementList.h"

#include <algorithm>
#include <limits>

namespace voxplex
{

/** Points closer than this fraction of delta to a vertex are never inserted. */
inline constexpr double SpacingFloorFraction = 0.1;

/** Parameters of the rules, in the unit of length of the mesher's frame. */
template <int D>
struct RefinementSettings
{
  double Delta = 1.0;           ///< sampling density, the same everywhere
  double RadiusEdgeRatio = 2.0; ///< rho-bar
  double FacetAngle = 30.0;     ///< degrees
  const SizeFunction<D>* Size = nullptr;
};

/** Shared by all threads. */
template <int D>
struct RefinementContext
{
  RefinementContext(const Domain<D>& image, const RefinementSettings<D>& settings,
    const Box<D>& box, std::uint64_t expectedFeatures)
    : Image(image)
    , Settings(settings)
    , SpacingFloor(SpacingFloorFraction * settings.Delta)
    , Mesh(box)
    , Features(box.Min, settings.Delta, expectedFeatures)
  {
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
    return size < this->SpacingFloor ? this->SpacingFloor : size;
  }

  /**
   * Delta_dOmega(z) of the thesis for a feature point between two labels: delta, or the size that is
   * asked for there if that is smaller. Sampling an interface more coarsely than its neighbourhood is
   * meshed would make R3 insert the missing points one by one, and R6 remove what R5 asks for.
   */
  double Delta(const Point<D>& z, LabelId a, LabelId b) const
  {
    double delta = this->Settings.Delta;
    if (this->Settings.Size)
    {
      for (const LabelId label : { a, b })
      {
        delta = label != 0 ? std::min(delta, this->Size(z, label)) : delta;
      }
    }
    return delta;
  }

  const Domain<D>& Image;
  const RefinementSettings<D> Settings;
  const double SpacingFloor;
  Triangulation<D> Mesh;
  FeatureGrid<D> Features;
};

/** One thread's own. */
template <int D>
struct RefinementWorker
{
  explicit RefinementWorker(const RefinementContext<D>& context)
    : Kernel(context.Mesh)
  {
  }

  typename Triangulation<D>::Worker Kernel;
  PoorElementList Poor;
  RuleStatistics Statistics;
};

} // namespace voxplex

#endif
