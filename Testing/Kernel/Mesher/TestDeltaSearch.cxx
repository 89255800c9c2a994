// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// The search for a delta with counts that are formulas.
#include "Mesher/DeltaSearch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <iomanip>
#include <sstream>

using namespace voxplex;

namespace
{

using Count = std::function<double(double delta)>;

DeltaSearch RunSearch(std::uint64_t target, double guess, const Count& count, double exponent = 2.0)
{
  DeltaSearch search(target, guess, exponent);
  while (search.Next())
  {
    EXPECT_GT(*search.Next(), 0.0);
    EXPECT_TRUE(std::isfinite(*search.Next()));
    search.Add(static_cast<std::uint64_t>(std::max(0.0, count(*search.Next()))));
  }
  EXPECT_LE(search.Runs().size(), DeltaSearch::MostRuns);
  return search;
}

double Deviation(const DeltaSearch& search, double target)
{
  return std::abs(static_cast<double>(search.Best().Elements) / target - 1.0);
}

} // namespace

TEST(DeltaSearch, FindsPowerLaws)
{
  for (const double exponent : { 1.6, 2.0, 2.4, 3.0 })
  {
    for (const double guess : { 0.2, 0.5, 0.9, 1.0, 1.2, 2.0, 5.0 })
    {
      const DeltaSearch search = RunSearch(
        500000, guess, [=](double delta) { return 500000.0 * std::pow(delta, -exponent); });
      EXPECT_TRUE(search.Found());
      EXPECT_LE(Deviation(search, 500000.0), DeltaSearch::Aim);
      EXPECT_LE(search.Runs().size(), 5u) << exponent << ' ' << guess;
      if (guess > 0.8 && guess < 1.3) // as good as the estimate of mesh sizes is
      {
        EXPECT_LE(search.Runs().size(), 3u) << exponent << ' ' << guess;
      }
    }
  }
}

TEST(DeltaSearch, OneRunIsEnoughIfItIsGood)
{
  const DeltaSearch search = RunSearch(1000, 2.0, [](double) { return 1040.0; });
  EXPECT_TRUE(search.Found());
  EXPECT_EQ(search.Runs().size(), 1u);
  EXPECT_EQ(search.Best().Delta, 2.0);
}

TEST(DeltaSearch, FindsCountsThatLevelOff)
{
  // Small components keep their elements: the knee atlas has 97 thousand with any large delta.
  const Count knee = [](double delta) { return 97000.0 + 370000.0 * std::pow(delta, -2.1); };
  for (const double target : { 110000.0, 150000.0, 450000.0, 2000000.0 })
  {
    const DeltaSearch search = RunSearch(static_cast<std::uint64_t>(target), 1.0, knee);
    EXPECT_TRUE(search.Found()) << target;
    EXPECT_LE(Deviation(search, target), DeltaSearch::Tolerance);
    EXPECT_LE(search.Runs().size(), 6u) << target;
  }
}

TEST(DeltaSearch, GivesUpWhereTheCountHasLevelledOff)
{
  const DeltaSearch search =
    RunSearch(60000, 1.0, [](double delta) { return 97000.0 + 370000.0 * std::pow(delta, -2.1); });
  EXPECT_FALSE(search.Found());
  EXPECT_LT(search.Runs().size(), DeltaSearch::MostRuns);
  EXPECT_GT(search.Best().Elements, 97000u);
  EXPECT_LT(search.Best().Elements, 100500u);
}

TEST(DeltaSearch, GivesUpAtJumps)
{
  const Count jump = [](double delta) { return delta > 1.0 ? 100.0 : 1000.0; };
  for (const double guess : { 0.9, 1.1, 50.0 })
  {
    const DeltaSearch search = RunSearch(300, guess, jump);
    EXPECT_FALSE(search.Found());
    EXPECT_EQ(search.Best().Elements, 100u);
  }
}

TEST(DeltaSearch, TriesNoDeltaAboveTheLargest)
{
  const auto last = [](double target, double guess)
  {
    DeltaSearch search(static_cast<std::uint64_t>(target), guess, 2.0, 0.0, 3.0);
    while (search.Next())
    {
      EXPECT_LE(*search.Next(), 3.0);
      search.Add(static_cast<std::uint64_t>(1e6 * std::pow(*search.Next(), -2.0)));
    }
    return search;
  };
  EXPECT_TRUE(last(150000.0, 1.0).Found());
  for (const double guess : { 0.5, 2.9, 10.0 })
  {
    const DeltaSearch search = last(20000.0, guess);
    EXPECT_FALSE(search.Found());
    EXPECT_EQ(search.Best().Delta, 3.0);
    EXPECT_LE(search.Runs().size(), 3u);
  }
}

TEST(DeltaSearch, TriesNoDeltaBelowTheSmallest)
{
  for (const double guess : { 0.01, 1.0, 30.0 })
  {
    DeltaSearch search(1000, guess, 2.0, 0.5, 10.0);
    while (search.Next())
    {
      EXPECT_GE(*search.Next(), 0.5);
      EXPECT_LE(*search.Next(), 10.0);
      search.Add(static_cast<std::uint64_t>(100.0 * std::pow(*search.Next(), -0.1)));
    }
    EXPECT_FALSE(search.Found());
    EXPECT_EQ(search.Runs().back().Delta, 0.5);
    EXPECT_LE(search.Runs().size(), 8u);
  }
  EXPECT_EQ(*DeltaSearch(1000, 2.0, 2.0, 5.0, 3.0).Next(), 3.0);
}

TEST(DeltaSearch, StepsAreNotTooLarge)
{
  const auto second = [](std::uint64_t elements)
  {
    DeltaSearch search(1000, 1.0, 2.0);
    search.Add(elements);
    return search.Next().value_or(0.0);
  };
  EXPECT_EQ(second(4000), 2.0);
  EXPECT_EQ(second(15000), 3.873);
  EXPECT_EQ(second(1000000000), 4.0); // from here on by a factor of 4
  EXPECT_EQ(second(70), 0.2646);
  EXPECT_EQ(second(1), 0.25);
  EXPECT_EQ(second(0), 0.25);
}

// Where two runs have nearly the same count, or very different ones, chance or a threshold is at work.
TEST(DeltaSearch, ExponentsAreTakenWithinReason)
{
  const auto third = [](double exponent, std::uint64_t firstCount, std::uint64_t secondCount)
  {
    DeltaSearch search(1000, 1.0, exponent);
    search.Add(firstCount);
    const double delta = search.Next().value_or(0.0);
    search.Add(secondCount);
    return search.Next().value_or(0.0) / delta;
  };
  EXPECT_NEAR(third(2.0, 1500, 1200), std::pow(1.2, std::log(1.225) / std::log(1.25)), 1e-3);
  EXPECT_NEAR(third(2.0, 1500, 1495), std::pow(1.495, 1.0 / 0.5), 1e-3); // not 0.016
  EXPECT_NEAR(
    third(2.0, 1500, 1600), std::pow(1.5, 1.0 / 0.5) / 1.225, 1e-3);    // more in a coarser one
  EXPECT_NEAR(third(20.0, 1500, 1100), std::pow(1.1, 1.0 / 6.0), 1e-3); // not 15
}

TEST(DeltaSearch, FindsWhatLiesOnASteepSlope)
{
  // Between two plateaus: lines through the runs lead nowhere, halving does.
  for (const double steepness : { 10.0, 20.0, 40.0, 80.0 })
  {
    for (const double guess : { 0.8, 1.5, 3.0 })
    {
      const DeltaSearch search = RunSearch(300, guess,
        [=](double delta) { return 100.0 + 900.0 / (1.0 + std::pow(delta, steepness)); });
      EXPECT_TRUE(search.Found()) << steepness << ' ' << guess;
    }
  }
}

TEST(DeltaSearch, FindsSteps)
{
  // Few elements come in steps; within a tenth there is one.
  const DeltaSearch search =
    RunSearch(60, 3.0, [](double delta) { return 6.0 * std::floor(40.0 * std::pow(delta, -2.0)); });
  EXPECT_TRUE(search.Found());
  EXPECT_LE(Deviation(search, 60.0), DeltaSearch::Tolerance);
}

TEST(DeltaSearch, EndsForAllCounts)
{
  // Neither monotonic nor continuous, nor above 0.
  const Count counts[] = { [](double) { return 0.0; }, [](double) { return 1e15; },
    [](double delta) { return 1000.0 * delta; },
    [](double delta) { return 1000.0 * std::pow(delta, -2.0) * (1.5 + std::sin(100.0 * delta)); },
    [](double delta) { return std::fmod(delta * 1e6, 7.0) * 1000.0; } };
  for (const Count& count : counts)
  {
    for (const double guess : { 1e-3, 1.0, 1e3 })
    {
      const DeltaSearch search = RunSearch(12345, guess, count);
      EXPECT_EQ(search.Found(), Deviation(search, 12345.0) <= DeltaSearch::Tolerance);
    }
  }
}

TEST(DeltaSearch, DeltasHaveFourDigits)
{
  for (const double guess : { 3.14159265e-3, 0.99999, 1.23456, 98765.4321 })
  {
    const DeltaSearch search =
      RunSearch(500000, guess, [=](double delta) { return 1e6 * std::pow(delta / guess, -2.3); });
    EXPECT_GT(search.Runs().size(), 1u);
    for (const MeshingRun& run : search.Runs())
    {
      std::ostringstream text;
      text << std::setprecision(4) << run.Delta;
      EXPECT_EQ(std::stod(text.str()), run.Delta);
    }
  }
}

TEST(DeltaSearch, TheNearestRunIsTheBest)
{
  DeltaSearch search(100, 1.0, 2.0);
  search.Add(150);
  search.Add(70);
  search.Add(120);
  EXPECT_EQ(search.Best().Elements, 120u);
  EXPECT_FALSE(search.Found());
  search.Add(92);
  EXPECT_EQ(search.Best().Elements, 92u);
  EXPECT_TRUE(search.Found());
  EXPECT_FALSE(search.Next().has_value()); // good enough from the fourth run on
}
