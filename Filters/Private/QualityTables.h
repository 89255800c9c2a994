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
#include "Quality/SpaceTimeMeasurement.h"

#include <cstdint>
#include <map>
#include <string>

class vtkCellData;
class vtkTable;

namespace voxplex
{

/** All that there is to say of a label. */
struct LabelFigures
{
  LabelComparison Comparison;
  LabelTopology Topology;
  std::uint64_t Fragments = 0;
};

/** By the value of the label. */
std::map<std::int64_t, LabelFigures> CollectLabels(const MeshMeasurement& measurement);

/** Adds the arrays MinimumDihedralAngle, MaximumDihedralAngle, RadiusEdgeRatio and Volume. */
void AddElementMeasures(const SimplexMesh<3>& mesh, unsigned threads, vtkCellData* cells);

/** A row for each label of the mesh or the image. */
void FillLabelTable(const MeshMeasurement& measurement, vtkTable* table);

/** Bins of angles and of radius-edge ratios. */
void FillHistograms(const MeshQuality& quality, vtkTable* table);

///@{
/** The same of pentatopes; the arrays are NormalizedVolume, RadiusEdgeRatio, Volume, WorstElement. */
void AddElementMeasures(const SpaceTimeMeasurement& figures, vtkCellData* cells);
void FillLabelTable(const SpaceTimeMeasurement& figures, vtkTable* table);
void FillHistograms(const SpaceTimeMeasurement& figures, vtkTable* table);
///@}

/** A row for each frame and each label in its cut or its image. */
void FillFrameTable(const SpaceTimeMeasurement& figures, vtkTable* table);

/** Counts, objects "labels", "quality", "topology", and if there was an image "image" and "hausdorff"; all in JSON. */
std::string ToJson(const MeshMeasurement& measurement);

/** Counts, objects "labels", "quality", a list "worst_elements", if there was an image an object "image", and a list
 * "frames"; all in JSON. */
std::string ToJson(const SpaceTimeMeasurement& figures);

} // namespace voxplex

#endif
