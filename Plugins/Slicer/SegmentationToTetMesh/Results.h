// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Results.h
 * @brief What the application, and the user, are told about a mesh that was made.
 */
#ifndef voxplex_slicer_Results_h
#define voxplex_slicer_Results_h

#include <optional>
#include <string>

class vtkImageToTetMeshFilter;
class vtkMeshingStatistics;
class vtkSimplexMeshQuality;

namespace voxplex::io
{
class WholeFiles;
}

namespace voxplex::slicer
{

/** The mesh beside the label map that it was made from. */
struct Comparison
{
  double HausdorffDistance = 0.0; ///< symmetric, to the faces of voxels; in the unit of the image
  long long NonManifoldEdges = 0; ///< counted for each label that has them
  double VolumeError = 0.0;       ///< of the label that has the largest; relative, not negative
};

/** Of a filter that has executed with an image. */
Comparison CompareWithImage(vtkSimplexMeshQuality* filter);

/**
 * Writes the parameters that the module returns, as lines of the form name = value: those of the group
 * Results in Parameters.cxx, without those of the comparison if there is none.
 *
 * @param statistics with quality
 * @param path empty: the application wants none
 */
void WriteResults(vtkMeshingStatistics* statistics, const std::optional<Comparison>& comparison,
  const std::string& path, const io::WholeFiles& files);

/** Lines for people, on standard output, `repair` among them; warnings of the filter on standard error. */
void PrintResults(const vtkImageToTetMeshFilter* filter,
  const std::optional<Comparison>& comparison, const std::string& repair);

/** A line on standard error. */
void Warn(const std::string& warning);

} // namespace voxplex::slicer

#endif
