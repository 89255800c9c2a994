// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file LocalFeatureSize.h
 * @brief The sampling distance of interfaces by their local feature size.
 */
#ifndef voxplex_LocalFeatureSize_h
#define voxplex_LocalFeatureSize_h

#include "Domain/Domain.h"
#include "Image/LabelImage.h"
#include "Sizing/GradedDelta.h"

#include <array>
#include <limits>
#include <memory>
#include <stop_token>
#include <vector>

namespace voxplex
{

/** Lengths are in units of the frame. */
struct GradingParameters
{
  double Finest = 1.0;  ///< smallest Delta(z)
  double Ratio = 1.0;   ///< Delta(z) over lfs(z): delta of the thesis
  double Lambda = 12.0; ///< upper bound of the local feature size
  double Coarsest = std::numeric_limits<double>::infinity(); ///< upper bound of Delta(z)
  double Salience = 1.0;      ///< edges and bumps that are lower do not count (MedialBalls)
  double SampleSpacing = 0.5; ///< spacing of the interface points whose Voronoi diagram is computed
  /**
   * Largest distance of triangles from an interface that bends. Infinite: Delta(z) does not depend
   * on the bend.
   */
  double Tolerance = std::numeric_limits<double>::infinity();
};

/**
 * @brief Delta(z) = min(Ratio x min(lambda, lfs(z)), sqrt(1.2 Tolerance / curvature(z)), Coarsest),
 * and at least Finest (thesis, sections 2.2 and 2.6.1; the thesis has the first term alone).
 *
 * lfs(z), the local feature size, is the distance from a point z of the interfaces to their medial
 * axis. It is computed before refinement:
 * 1. SampleLabelChanges: points on all interfaces;
 * 2. FindPoles: points of the medial axis, from the Delaunay triangulation of the sample;
 * 3. the distance of each sample point to the nearest pole, by the feature transform of a grid;
 * 4. SampleCurvature: how strongly the interface bends there, measured at the scale of Delta;
 * 5. GradedDelta: Delta at the sample points, spread so that it is Lipschitz.
 *
 * The thesis adds feature points to the second triangulation during refinement. So a point's lfs is
 * too large at first, and the thesis calls this triangulation its bottleneck (section 2.7). Here
 * the sample is dense from the start, and all threads make the triangulation once.
 */
template <int D>
class LocalFeatureSize
{
public:
  /**
   * @param threads 0 means all cores; the result does not depend on it
   * @throws Cancelled if a stop was requested before the end; std::bad_alloc
   */
  LocalFeatureSize(const LabelImage<D>& image, const Domain<D>& domain,
    const GradingParameters& parameters, unsigned threads, const std::stop_token& stop);

  /** Between Finest and Largest(). */
  const GradedDelta<D>& Delta() const { return *this->Graded; }

  /** The largest Delta at any sample point. */
  double Largest() const { return this->LargestDelta; }

  /** The uniform delta that gives interfaces of the same (hyper)area as many vertices. */
  double Equivalent() const { return this->EquivalentDelta; }

  /** The sample points of the interfaces, and the local feature size at each, at most lambda. */
  const std::vector<Point<D>>& Sample() const { return this->Points; }
  const std::vector<double>& Sizes() const { return this->SizeOfPoint; }

  std::size_t NumberOfPoles() const { return this->Poles; }

private:
  std::vector<double> DeltaOfPoints(const std::vector<std::array<LabelId, 2>>& labels,
    double spacing, double roughness, const GradingParameters& parameters, unsigned threads,
    const std::stop_token& stop) const;

  std::vector<Point<D>> Points;
  std::vector<double> SizeOfPoint;
  std::size_t Poles = 0;
  std::unique_ptr<GradedDelta<D>> Graded;
  double LargestDelta;
  double EquivalentDelta;
};

extern template class LocalFeatureSize<3>;
extern template class LocalFeatureSize<4>;

} // namespace voxplex

#endif
