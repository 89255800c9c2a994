// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Results.h"

#include "Description.h"
#include "FilterParameters.h"
#include "WholeFiles.h"

#include <vtkImageToTetMeshFilter.h>
#include <vtkMeshingStatistics.h>
#include <vtkSimplexMeshQuality.h>
#include <vtkTable.h>
#include <vtkVariant.h>

#include <algorithm>
#include <cmath>
#include <iostream>

namespace voxplex::slicer
{
namespace
{

std::string MissingLabels(vtkMeshingStatistics* statistics)
{
  std::string list;
  for (int i = 0; i < statistics->GetNumberOfLostLabels(); ++i)
  {
    list += (i == 0 ? "" : ",") + std::to_string(statistics->GetLostLabel(i));
  }
  return list;
}

} // namespace

void Warn(const std::string& warning)
{
  std::cerr << ModuleName << ": warning: " << warning << '\n';
}

Comparison CompareWithImage(vtkSimplexMeshQuality* filter)
{
  Comparison comparison{ filter->GetHausdorffDistance(), filter->GetNonManifoldEdges(), 0.0 };
  vtkTable* table = filter->GetLabelTable();
  for (vtkIdType row = 0; row < table->GetNumberOfRows(); ++row)
  {
    const double error = table->GetValueByName(row, "VolumeError").ToDouble();
    comparison.VolumeError = std::max(comparison.VolumeError, std::abs(error));
  }
  return comparison;
}

void WriteResults(vtkMeshingStatistics* statistics, const std::optional<Comparison>& comparison,
  const std::string& path, const io::WholeFiles& files)
{
  if (path.empty())
  {
    return;
  }
  files.WriteText(path,
    [&](io::TextFile& file)
    {
      file << "numberOfTetrahedra = " << statistics->GetNumberOfElements() << '\n';
      file << "usedDelta = " << statistics->GetDelta() << '\n';
      file << "missingLabels = " << MissingLabels(statistics) << '\n';
      file << "missingComponents = " << statistics->GetNumberOfLostComponents() << '\n';
      file << "smallestDihedralAngle = " << statistics->GetMinimumDihedralAngle() << '\n';
      file << "largestDihedralAngle = " << statistics->GetMaximumDihedralAngle() << '\n';
      file << "largestRadiusEdge = " << statistics->GetMaximumRadiusEdgeRatio() << '\n';
      file << "smallestFacetAngle = " << statistics->GetMinimumPlanarAngle() << '\n';
      if (comparison)
      {
        file << "hausdorffDistance = " << comparison->HausdorffDistance << '\n';
        file << "nonManifoldEdges = " << comparison->NonManifoldEdges << '\n';
        file << "volumeError = " << comparison->VolumeError << '\n';
      }
    });
}

void PrintResults(const vtkImageToTetMeshFilter* filter,
  const std::optional<Comparison>& comparison, const std::string& repair)
{
  const vtkMeshingStatistics* const statistics = filter->GetStatistics();
  std::cout << statistics->GetNumberOfElements() << " tetrahedra with "
            << statistics->GetNumberOfVertices() << " nodes, "
            << statistics->GetNumberOfInterfaceFacets() << " triangles on the interfaces; delta "
            << statistics->GetDelta() << '\n'
            << "Dihedral angles from " << statistics->GetMinimumDihedralAngle() << " to "
            << statistics->GetMaximumDihedralAngle() << " degrees, radius-edge ratio at most "
            << statistics->GetMaximumRadiusEdgeRatio() << ", angles of triangles from "
            << statistics->GetMinimumPlanarAngle() << " degrees\n";
  if (comparison)
  {
    std::cout << "Hausdorff distance " << comparison->HausdorffDistance << ", "
              << comparison->NonManifoldEdges
              << " non-manifold edges, volumes of labels off by up to "
              << 100.0 * comparison->VolumeError << " %\n";
  }
  std::cout << repair;
  for (const std::string& warning : cli::WarningsOf(filter))
  {
    Warn(warning);
  }
}

} // namespace voxplex::slicer
