// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/** @file TestKernel.cxx @brief Defaults and ranges of the kernel's options against the table of parameters. */
#include "Base/Error.h"
#include "Mesher/MeshingOptions.h"
#include "MeshingParameters.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <type_traits>

using namespace voxplex;

namespace
{

/** One option in D dimensions, by the name of its parameter. */
template <int D>
struct Option
{
  /** member gives it by reference. */
  template <class Member>
  Option(const char* name, Member member)
    : Name(name)
    , Get([member](MeshingOptions<D> options) { return static_cast<double>(member(options)); })
    , Set(
        [member](MeshingOptions<D>& options, double value)
        {
          auto& option = member(options);
          option = static_cast<std::remove_reference_t<decltype(option)>>(value);
        })
  {
  }

  const char* Name;
  std::function<double(MeshingOptions<D>)> Get;
  std::function<void(MeshingOptions<D>&, double)> Set;
};

const std::vector<Option<3>> Options3{
  { "delta", [](auto& o) -> decltype(auto) { return (o.Sampling.Delta); } },
  { "elements", [](auto& o) -> decltype(auto) { return (o.Sampling.Elements); } },
  { "feature-ratio", [](auto& o) -> decltype(auto) { return (o.Sampling.Grading.Ratio); } },
  { "largest-feature", [](auto& o) -> decltype(auto) { return (o.Sampling.Grading.Lambda); } },
  { "gradation", [](auto& o) -> decltype(auto) { return (o.Sampling.Gradation); } },
  { "radius-edge", [](auto& o) -> decltype(auto) { return (o.Shape.RadiusEdgeRatio); } },
  { "facet-angle", [](auto& o) -> decltype(auto) { return (o.Shape.FacetAngle); } },
  { "smoothing", [](auto& o) -> decltype(auto) { return (o.SmoothingSigma); } },
  { "sliver-angle", [](auto& o) -> decltype(auto) { return (o.Shape.Slivers.Angle); } },
  { "smallest-component", [](auto& o) -> decltype(auto) { return (o.Components.Smallest); } },
  { "optimise-seconds", [](auto& o) -> decltype(auto) { return (o.Optimisation.Seconds); } },
  { "interface-rounds", [](auto& o) -> decltype(auto) { return (o.Interfaces.Rounds); } },
  { "memory-limit", [](auto& o) -> decltype(auto) { return (o.Limits.Memory); } },
};

const std::vector<Option<4>> Options4{
  { "picks", [](auto& o) -> decltype(auto) { return (o.SpaceTime.Slivers.Picks); } },
  { "sliver-bound", [](auto& o) -> decltype(auto) { return (o.SpaceTime.Slivers.VolumeBound); } },
  { "seed", [](auto& o) -> decltype(auto) { return (o.SpaceTime.Slivers.Seed); } },
};

template <int D>
bool IsAccepted(const Option<D>& option, double value, bool force)
{
  MeshingOptions<D> options;
  options.Limits.Force = force;
  option.Set(options, value);
  try
  {
    CheckOptions(options);
    return true;
  }
  catch (const InputError&)
  {
    return false;
  }
}

template <int D>
void ExpectDefault(const Option<D>& option)
{
  const std::string& text = FindParameter(option.Name).Default;
  EXPECT_EQ(option.Get(MeshingOptions<D>()), text.empty() ? 0.0 : std::stod(text)) << option.Name;
}

/** The kernel takes what the table allows. */
template <int D>
void ExpectRange(const Option<D>& option)
{
  const MeshingParameter& parameter = FindParameter(option.Name);
  const ParameterRange& range = parameter.Range;
  EXPECT_EQ(IsAccepted(option, range.Low, true), !range.LowIsOutside || parameter.IsOptional())
    << option.Name;
  EXPECT_TRUE(IsAccepted(option, std::min(range.High, 1e9), true)) << option.Name;
}

template <int D>
void ExpectForced(const Option<D>& option, double limit, double beyond)
{
  EXPECT_TRUE(IsAccepted(option, limit, false)) << option.Name;
  EXPECT_FALSE(IsAccepted(option, beyond, false)) << option.Name;
  EXPECT_TRUE(IsAccepted(option, beyond, true)) << option.Name;
}

template <int D>
void ExpectForced(const Option<D>& option)
{
  const MeshingParameter& parameter = FindParameter(option.Name);
  if (const auto limit = parameter.ForceBelow)
  {
    ExpectForced(option, *limit, std::nextafter(*limit, 0.0));
  }
  if (const auto limit = parameter.ForceAbove)
  {
    ExpectForced(option, *limit, std::nextafter(*limit, 100.0));
  }
}

template <int D>
void ExpectAgreement(const std::vector<Option<D>>& options)
{
  for (const Option<D>& option : options)
  {
    ExpectDefault(option);
    ExpectRange(option);
    ExpectForced(option);
  }
}

} // namespace

TEST(Parameters, KernelAgreesIn3D)
{
  ExpectAgreement(Options3);
}

TEST(Parameters, KernelAgreesIn4D)
{
  ExpectAgreement(Options4);
}
