// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/** @file TestTerms.cxx @brief Messages in the terms of each interface, and what is wrong with a value. */
#include "MeshingParameters.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace voxplex;

namespace
{

std::string In(UserInterface interface, const std::string& message)
{
  return InTermsOf(interface, message);
}

std::string Fault(const char* name, double value, bool force = false)
{
  return InTermsOf(UserInterface::VTK, FaultOf(FindParameter(name), value, force));
}

} // namespace

TEST(Parameters, NamesOfParameters)
{
  const std::string message = "{facet-angle}, {label-size}, {force}, {frame-times}";
  EXPECT_EQ(In(UserInterface::VTK, message), "FacetAngle, SetLabelSize(), Force, AddFrameTime()");
  EXPECT_EQ(
    In(UserInterface::CommandLine, message), "--facet-angle, --label-size, --force, --frame-times");
  EXPECT_EQ(In(UserInterface::Slicer, message),
    "Facet angle, Largest element of labels, Force, AddFrameTime()");
  EXPECT_EQ(
    In(UserInterface::Python, message), "facet_angle, label_sizes, force=True, AddFrameTime()");
  EXPECT_EQ(In(UserInterface::ParaView, message),
    "'Facet Angle', 'Label Table', 'Force', 'Times of Frames'");
  EXPECT_EQ(In(UserInterface::ITK, "{facet-angle}, {labels}, {threads}, {isosurface}"),
    "FacetAngle, AddLabel(), NumberOfWorkUnits, vtkImageToTetMeshFilter");
}

TEST(Parameters, WhatOnlySomeUsersHave)
{
  const std::string message = "Segment it{array:, or choose another array}, or {isosurface}.";
  EXPECT_EQ(In(UserInterface::VTK, message),
    "Segment it, or choose another array, or SetInputModeToIsosurface().");
  EXPECT_EQ(In(UserInterface::CommandLine, message), "Segment it, or --isovalue.");
  EXPECT_EQ(In(UserInterface::Python, "a{contention: manager}{delta: length}"), "a length");
}

/** Names of files and labels may have braces. */
TEST(Parameters, OtherBracesStay)
{
  for (const char* text : { "{", "}", "{}", "{x", "'{a}.nrrd'", "{ {nothing: here} }" })
  {
    EXPECT_EQ(In(UserInterface::CommandLine, text), text);
  }
  EXPECT_EQ(In(UserInterface::CommandLine, "{ {delta}"), "{ --delta");
}

TEST(Parameters, MethodsOfReaders)
{
  const std::string list =
    "\n  SetSeriesUID(\"1.2\")  (3 files)\n  SetSeriesUID(\"1.3\")  (4 files)";
  EXPECT_EQ(In(UserInterface::VTK, list), list);
  EXPECT_EQ(
    In(UserInterface::CommandLine, list), "\n  --series 1.2  (3 files)\n  --series 1.3  (4 files)");
  EXPECT_EQ(In(UserInterface::Python, list),
    "\n  series_uid=\"1.2\"  (3 files)\n  series_uid=\"1.3\"  (4 files)");
  const std::string places = "SetSpacing() and SetSpacing(); SetOrigin()";
  EXPECT_EQ(In(UserInterface::CommandLine, places), "--spacing and --spacing; --origin");
  EXPECT_EQ(In(UserInterface::Slicer, places),
    "3D Slicer's module Volumes and 3D Slicer's module Volumes; SetOrigin()");
}

TEST(Parameters, OutOfRange)
{
  EXPECT_EQ(Fault("delta", -1.0),
    "Delta is -1; it must be positive and finite, or 0 (derived from the spacing).");
  EXPECT_EQ(
    Fault("gradation", NAN), "Gradation is nan; it must be positive and finite, or 0 (no limit).");
  EXPECT_EQ(Fault("feature-ratio", 0.0), "FeatureRatio is 0; it must be positive and finite.");
  EXPECT_EQ(Fault("facet-angle", 31.0), "FacetAngle is 31; it must be between 0 and 30.");
  for (const MeshingParameter& parameter : MeshingParameters())
  {
    if (parameter.IsNumber()) // 0 is no value
    {
      const double usual = parameter.IsOptional() ? 0.0 : std::stod(parameter.Default);
      EXPECT_EQ(Fault(parameter.Name.c_str(), usual), "");
    }
  }
}

TEST(Parameters, BeyondWhatForceLifts)
{
  EXPECT_EQ(Fault("radius-edge", 1.5),
    "RadiusEdgeRatio is 1.5; it must be at least 1.93, because below it meshes can become very "
    "large; "
    "Force goes down to 1.");
  EXPECT_EQ(Fault("sliver-angle", 16.0),
    "SliverAngle is 16; it must be between 0 and 15, because above it meshes can become very "
    "large; "
    "Force goes up to 59.");
  EXPECT_EQ(Fault("radius-edge", 1.5, true), "");
  EXPECT_EQ(Fault("radius-edge", 0.9, true), "RadiusEdgeRatio is 0.9; it must be at least 1.");
}
