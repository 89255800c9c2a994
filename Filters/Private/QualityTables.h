// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file QualityTables.h
 * @brief What vtkSimplexMeshQuality puts into its outputs.
 */
#ifndef voxplex_QualityTables_h
#define voxplex_QualityTables_h

#include "Mesh/SimplexMesh.h"
#include "Quality/MeshMeasurement.h"

class vtkCellData;
class vtkTable;

namespace voxplex
{

/** Adds the arrays MinimumDihedralAngle, MaximumDihedralAngle, RadiusEdgeRatio and Volume. */
void AddElementMeasures(const SimplexMesh<3>& mesh, unsigned threads, vtkCellData* cells);

/** A row for each label of the mesh or the image. */
void FillLabelTable(const MeshMeasurement& measurement, vtkTable* table);

/** Bins of angles and of radius-edge ratios. */
void FillHistograms(const MeshQuality& quality, vtkTable* table);

} // namespace voxplex

#endif
