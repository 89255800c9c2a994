// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MeshingFigures.h
 * @brief What vtkMeshingStatistics holds; for the filters that fill it.
 */
#ifndef voxplex_MeshingFigures_h
#define voxplex_MeshingFigures_h

#include "Mesher/MeshingStatistics.h"
#include "Quality/MeshQuality.h"
#include "Quality/ShrunkLabels.h"

#include "vtkMeshingStatistics.h"

#include <array>
#include <cstdint>
#include <vector>

/** What was meshed, if not labels. */
struct IsosurfaceFigures
{
  bool Meshed = false;
  double Value = 0.0;
  bool InsideIsAbove = true;
  std::array<double, 2> Range{}; ///< of the image's values
};

struct vtkMeshingStatistics::Figures
{
  int Dimension = 3;
  std::int64_t Elements = 0;
  std::int64_t Vertices = 0;
  std::int64_t InterfaceFacets = 0;
  int Threads = 0;
  IsosurfaceFigures Isosurface;
  std::vector<std::int64_t> LostLabels;                    ///< in the image, not in the mesh
  std::vector<voxplex::ShrunkLabel> ShrunkLabels;          ///< in 3D
  std::vector<voxplex::ComponentReport> DroppedComponents; ///< left out on request
  voxplex::MeshingStatistics Run; ///< its Times include what the filter itself does

  bool HasQuality = false;      ///< whether Quality was measured
  voxplex::MeshQuality Quality; ///< its Labels, too
};

#endif
