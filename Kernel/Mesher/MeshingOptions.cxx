// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Mesher/MeshingOptions.h"

#include "Base/Error.h"
#include "Base/NumberText.h"
#include "Geometry/Predicates.h"
#include "Image/Series/FrameInterpolation.h"

#include <cmath>
#include <string>

namespace voxplex
{

namespace
{

void CheckSliverOptions(const SliverOptions& slivers, bool force)
{
  if (!(slivers.PickingRadius > 0.0 && slivers.PickingRadius < 1.0))
  {
    throw InputError("the radius of picking regions must be between 0 and 1; it is " +
      NumberText(slivers.PickingRadius));
  }
  if (!(slivers.RadiusFactor > 0.0) || std::isinf(slivers.RadiusFactor))
  {
    throw InputError("the factor that identifies small slivers must be positive; it is " +
      NumberText(slivers.RadiusFactor));
  }
  if (slivers.Picks == 0)
  {
    throw InputError("there must be at least one pick in a picking region");
  }
  if (!(slivers.VolumeBound >= 0.0 && slivers.VolumeBound < 1.0))
  {
    throw InputError("the normalized volume of slivers must be at least 0 and below 1; it is " +
      NumberText(slivers.VolumeBound));
  }
  if (slivers.VolumeBound > LargestSliverBound && !force)
  {
    throw InputError("a sliver bound of " + NumberText(slivers.VolumeBound) + " is above " +
      NumberText(LargestSliverBound) +
      ", where meshes can become very large; ask for less, or force it");
  }
}

void CheckTetSliverOptions(const TetSliverOptions& slivers, bool force)
{
  if (!(slivers.Angle >= 0.0 && slivers.Angle < 60.0))
  {
    throw InputError(
      "the dihedral angle of slivers must be at least 0 and below 60 degrees; it is " +
      NumberText(slivers.Angle));
  }
  if (slivers.Angle > LargestSliverAngle && !force)
  {
    throw InputError("a dihedral angle of " + NumberText(slivers.Angle) + " degrees is above " +
      NumberText(LargestSliverAngle) +
      ", where meshes can become very large; ask for less, or force it");
  }
  if (!(slivers.PickingRadius > 0.0 && slivers.PickingRadius < 1.0) || slivers.Picks == 0)
  {
    throw InputError("slivers need at least one pick, and a picking radius between 0 and 1");
  }
}

void CheckGradingOptions(const GradingOptions& grading)
{
  if (!(grading.Ratio > 0.0) || std::isinf(grading.Ratio))
  {
    throw InputError(
      "the ratio of the sampling distance to the local feature size must be positive; it is " +
      NumberText(grading.Ratio));
  }
  if (!(grading.Lambda > 0.0) || std::isinf(grading.Lambda))
  {
    throw InputError("the largest local feature size must be a positive number of voxels; it is " +
      NumberText(grading.Lambda));
  }
}

} // namespace

//------------------------------------------------------------------------------------------------
template <int D>
double DefaultDelta(double voxelVolume)
{
  return 2.0 * std::pow(voxelVolume, 1.0 / D);
}

//------------------------------------------------------------------------------------------------
template <int D>
void CheckOptions(const MeshingOptions<D>& options)
{
  if (!(options.Sampling.Delta >= 0.0) || std::isinf(options.Sampling.Delta))
  {
    throw InputError("delta must be a positive length, or 0 to derive it from the spacing; it is " +
      NumberText(options.Sampling.Delta));
  }
  if (options.Sampling.Delta > 0.0 && options.Sampling.Elements > 0)
  {
    throw InputError("give either delta or a number of elements, not both");
  }
  if (!(options.Sampling.Gradation >= 0.0) || std::isinf(options.Sampling.Gradation))
  {
    throw InputError("the gradation must be positive, or 0 for no limit; it is " +
      NumberText(options.Sampling.Gradation));
  }
  if (!(options.Shape.RadiusEdgeRatio > 0.0) || std::isinf(options.Shape.RadiusEdgeRatio))
  {
    throw InputError(
      "the radius-edge ratio must be positive; it is " + NumberText(options.Shape.RadiusEdgeRatio));
  }
  if (options.Shape.RadiusEdgeRatio < SmallestRadiusEdgeRatio && !options.Limits.Force)
  {
    throw InputError("a radius-edge ratio of " + NumberText(options.Shape.RadiusEdgeRatio) +
      " is below 1.93, where meshes can become very large; ask for 1.93 or more, or force it");
  }
  if (!(options.Shape.FacetAngle >= 0.0 && options.Shape.FacetAngle <= 30.0))
  {
    throw InputError("the facet angle must be between 0 and 30 degrees; it is " +
      NumberText(options.Shape.FacetAngle));
  }
  if (options.FrameSteps > MaximumFrameSteps)
  {
    throw InputError("there are at most " + std::to_string(MaximumFrameSteps) +
      " steps between two frames; " + std::to_string(options.FrameSteps) + " were asked for");
  }
  CheckTetSliverOptions(options.Shape.Slivers, options.Limits.Force);
  CheckSliverOptions(options.SpaceTime.Slivers, options.Limits.Force);
  CheckGradingOptions(options.Sampling.Grading);
  if (!FloatingPointIsStrict())
  {
    throw Error("this build of Voxplex fuses or extends floating-point operations, which makes its "
                "predicates unreliable; compile it with -ffp-contract=off and without -ffast-math");
  }
}

template double DefaultDelta<3>(double);
template double DefaultDelta<4>(double);
template void CheckOptions<3>(const MeshingOptions<3>&);
template void CheckOptions<4>(const MeshingOptions<4>&);

} // namespace voxplex
