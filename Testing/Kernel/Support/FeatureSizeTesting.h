// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Local feature sizes of images, and what tests ask of them.
#ifndef voxplex_FeatureSizeTesting_h
#define voxplex_FeatureSizeTesting_h

#include "Base/Error.h"
#include "Domain/ImageDomain.h"
#include "Sizing/Grading/LocalFeatureSize.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <stop_token>
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

/** For any number of threads. */
template <int D>
void ExpectSameSizes(
  const LabelImage<D>& image, const GradingParameters& parameters, std::size_t leastPoles = 0)
{
  const LocalFeatureSize<D> one = Measure(image, parameters, 1);
  EXPECT_GE(one.NumberOfPoles(), leastPoles);
  for (const unsigned threads : { 2u, 5u })
  {
    const LocalFeatureSize<D> other = Measure(image, parameters, threads);
    EXPECT_EQ(one.Sample(), other.Sample());
    EXPECT_EQ(one.Sizes(), other.Sizes());
    EXPECT_EQ(one.NumberOfPoles(), other.NumberOfPoles());
    EXPECT_EQ(one.Largest(), other.Largest());
    for (const Point<D>& p : one.Sample())
    {
      ASSERT_EQ(one.Delta().At(p), other.Delta().At(p));
    }
  }
}

template <int D>
void ExpectStop(const LabelImage<D>& image)
{
  const ImageDomain<D> domain(image, 1.0);
  std::stop_source stop;
  stop.request_stop();
  EXPECT_THROW(
    LocalFeatureSize<D>(image, domain, Parameters(1.0, 10.0), 2, stop.get_token()), Cancelled);
}

} // namespace voxplex::checks

#endif
