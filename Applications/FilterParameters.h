// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/** @file FilterParameters.h @brief How programs set and execute readers and filters. */
#ifndef voxplex_cli_FilterParameters_h
#define voxplex_cli_FilterParameters_h

#include "MeshingParameters.h"

#include <vtkSmartPointer.h>

#include <functional>
#include <string>
#include <vector>

class vtkAlgorithm;
class vtkImageToSimplexMeshFilter;
class vtkSegmentationReader;
class vtkSegmentationRepair;

namespace voxplex::cli
{

/**
 * What the values say of the image before it is meshed; null if they say nothing.
 * @param ofLabels those of SelectRepairs()
 */
vtkSmartPointer<vtkSegmentationRepair> MakeRepair(
  const ParameterValues& values, const ParameterValues& ofLabels, UserInterface words);

/** Sets what the values say of meshing, which are for images of the filter's dimension. */
void SetParameters(vtkImageToSimplexMeshFilter* filter, const ParameterValues& values);

/** Called now and then with the fraction done and the name of the step; returning false cancels. */
using ProgressFunction = std::function<bool(double fraction, const std::string& step)>;

/**
 * Has a reader read its file, as the values say.
 * @return warnings in the terms of the interface
 * @throws io::FileError
 */
std::vector<std::string> ReadImage(
  vtkSegmentationReader* reader, const ParameterValues& values, UserInterface interface);

/** How what a filter has made differs from what was asked for. */
template <typename Filter>
std::vector<std::string> WarningsOf(const Filter* filter)
{
  std::vector<std::string> warnings;
  for (int i = 0; i < filter->GetNumberOfWarnings(); ++i)
  {
    warnings.push_back(filter->GetWarning(i));
  }
  return warnings;
}

/** Executes a filter. If `progress` cancels, its GetAborted() is true afterwards. */
void Execute(vtkAlgorithm* filter, const ProgressFunction& progress);

} // namespace voxplex::cli

#endif
