// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Local feature sizes of images, and what tests ask of them.
#ifndef voxplex_FeatureSizeTesting_h
#define voxplex_FeatureSizeTesting_h

#include "Domain/ImageDomain.h"
#include "Sizing/Grading/LocalFeatureSize.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace voxplex::checks
{

template <int D>
LocalFeatureSize<D> Measure(
  const LabelImage<D>& image, const GradingParameters& parameters, unsigned threads = 1)
{
  const ImageDomain<D> domain(image, 1.0);
  return LocalFeatureSize<D>(image, domain, parameters, threads, {});
}

inline GradingParameters Parameters(double finest, double lambda)
{
  GradingParameters parameters;
  parameters.Finest = finest;
  parameters.Lambda = lambda;
  parameters.SampleSpacing = 0.75 * finest;
  parameters.Salience = std::max(1.0, parameters.SampleSpacing);
  return parameters;
}

/** What a share of the values is below. */
inline double Quantile(std::vector<double> values, double share)
{
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

/** The local feature sizes of the sample points that a test admits. */
template <int D, typename Admits>
std::vector<double> SizesWhere(const LocalFeatureSize<D>& lfs, Admits&& admits)
{
  std::vector<double> sizes;
  for (std::size_t k = 0; k < lfs.Sample().size(); ++k)
  {
    if (admits(lfs.Sample()[k]))
    {
      sizes.push_back(lfs.Sizes()[k]);
    }
  }
  return sizes;
}

} // namespace voxplex::checks

#endif
