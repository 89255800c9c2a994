// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkMeshingStatistics.h"

#include "Mesher/MeshingStatistics.h"
#include "Private/FiguresJson.h"
#include "Private/Lists.h"

#include "vtkObjectFactory.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <limits>

using nlohmann::ordered_json;
using voxplex::ItemAt;

vtkStandardNewMacro(vtkMeshingStatistics);

vtkMeshingStatistics::vtkMeshingStatistics()
  : Values(std::make_unique<voxplex::MeshingStatistics>())
{
}

vtkMeshingStatistics::~vtkMeshingStatistics() = default;

void vtkMeshingStatistics::Initialize()
{
  *this->Values = voxplex::MeshingStatistics();
  this->Modified();
}

voxplex::MeshingStatistics& vtkMeshingStatistics::Edit()
{
  this->Modified();
  return *this->Values;
}

// Getters whose figure has another name or type behind it.
#define VOXPLEX_FIGURE(type, getter, figure)                                                       \
  type vtkMeshingStatistics::Get##getter() const                                                   \
  {                                                                                                \
    return static_cast<type>(this->Values->figure);                                                \
  }

VOXPLEX_FIGURE(int, Dimension, Dimension)
VOXPLEX_FIGURE(vtkTypeInt64, NumberOfElements, Elements)
VOXPLEX_FIGURE(vtkTypeInt64, NumberOfVertices, Vertices)
VOXPLEX_FIGURE(vtkTypeInt64, NumberOfInterfaceFacets, InterfaceFacets)
VOXPLEX_FIGURE(double, Delta, Delta)
VOXPLEX_FIGURE(int, NumberOfThreads, NumberOfThreads)
VOXPLEX_FIGURE(int, NumberOfLostLabels, LostLabels.size())
VOXPLEX_FIGURE(int, NumberOfShrunkLabels, ShrunkLabels.size())
VOXPLEX_FIGURE(vtkTypeInt64, NumberOfComponents, Components.Found)
VOXPLEX_FIGURE(int, NumberOfLostComponents, Components.Lost.size())
VOXPLEX_FIGURE(int, NumberOfDroppedComponents, DroppedComponents.size())
VOXPLEX_FIGURE(bool, HasQuality, HasQuality)
VOXPLEX_FIGURE(int, NumberOfLabels, Quality.Labels.size())
VOXPLEX_FIGURE(double, MaximumRadiusEdgeRatio, Quality.MaximumRadiusEdgeRatio)
VOXPLEX_FIGURE(double, MinimumDihedralAngle, Quality.MinimumDihedralAngle)
VOXPLEX_FIGURE(double, MaximumDihedralAngle, Quality.MaximumDihedralAngle)
VOXPLEX_FIGURE(double, MinimumPlanarAngle, Quality.MinimumFacetAngle)
VOXPLEX_FIGURE(vtkTypeInt64, RadiusEdgeViolations, Quality.RadiusEdgeViolations)
VOXPLEX_FIGURE(vtkTypeInt64, FacetAngleViolations, Quality.FacetAngleViolations)
VOXPLEX_FIGURE(vtkTypeInt64, InvertedElements, Quality.InvertedSimplices)
VOXPLEX_FIGURE(double, LabelFieldTime, Times.LabelField)
VOXPLEX_FIGURE(double, DistanceTransformTime, Times.DistanceTransform)
VOXPLEX_FIGURE(double, GradingTime, Times.Grading)
VOXPLEX_FIGURE(double, ComponentsTime, Times.Components)
VOXPLEX_FIGURE(double, InterfacesTime, Times.Interfaces)
VOXPLEX_FIGURE(double, RefinementTime, Times.Refinement)
VOXPLEX_FIGURE(double, ExtractionTime, Times.Extraction)
VOXPLEX_FIGURE(double, OptimisationTime, Times.Optimisation)
VOXPLEX_FIGURE(bool, Optimised, Optimisation.Ran)
VOXPLEX_FIGURE(double, TotalTime, Times.Total())
VOXPLEX_FIGURE(bool, SwitchedToLocal, SwitchedToLocal)
VOXPLEX_FIGURE(int, NumberOfRuns, Runs.size())
#undef VOXPLEX_FIGURE

vtkTypeInt64 vtkMeshingStatistics::GetLostLabel(int index) const
{
  return ItemAt(this->Values->LostLabels, index, 0);
}

vtkTypeInt64 vtkMeshingStatistics::GetShrunkLabel(int index) const
{
  return ItemAt(this->Values->ShrunkLabels, index, {}).Label;
}

double vtkMeshingStatistics::GetShrunkLabelFraction(int index) const
{
  return ItemAt(this->Values->ShrunkLabels, index, {}).Fraction;
}

vtkTypeInt64 vtkMeshingStatistics::GetLabel(int index) const
{
  return ItemAt(this->Values->Quality.Labels, index, {}).Label;
}

vtkTypeInt64 vtkMeshingStatistics::GetLabelElements(int index) const
{
  return static_cast<vtkTypeInt64>(ItemAt(this->Values->Quality.Labels, index, {}).Elements);
}

double vtkMeshingStatistics::GetLabelVolume(int index) const
{
  return ItemAt(this->Values->Quality.Labels, index, {}).Volume;
}

int vtkMeshingStatistics::GetNumberOfYieldingRegions() const
{
  const auto& steps = this->Values->RelaxedRegions;
  return static_cast<int>(std::count_if(steps.begin(), steps.end(),
    [](const voxplex::RelaxationReport& region) { return region.Step == 1; }));
}

//----------------------------------------------------------------------------------------------------
std::string vtkMeshingStatistics::ToJSON() const
{
  return voxplex::FiguresToJson(*this->Values).dump();
}

//----------------------------------------------------------------------------------------------------
double vtkMeshingStatistics::GetFigure(const char* path) const
{
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  try
  {
    const ordered_json json = voxplex::FiguresToJson(*this->Values);
    const ordered_json& figure = json.at(ordered_json::json_pointer(path ? path : ""));
    if (figure.is_boolean())
    {
      return figure.get<bool>() ? 1.0 : 0.0;
    }
    if (figure.is_structured())
    {
      return static_cast<double>(figure.size());
    }
    return figure.is_number() ? figure.get<double>() : none;
  }
  catch (const ordered_json::exception&) // there is no such figure
  {
    return none;
  }
}

//----------------------------------------------------------------------------------------------------
void vtkMeshingStatistics::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Dimension: " << this->GetDimension() << "\n";
  os << indent << "NumberOfElements: " << this->GetNumberOfElements() << "\n";
  os << indent << "NumberOfVertices: " << this->GetNumberOfVertices() << "\n";
  os << indent << "NumberOfInterfaceFacets: " << this->GetNumberOfInterfaceFacets() << "\n";
  os << indent << "Delta: " << this->GetDelta() << "\n";
  os << indent << "NumberOfRuns: " << this->GetNumberOfRuns() << "\n";
  os << indent << "NumberOfThreads: " << this->GetNumberOfThreads() << "\n";
  os << indent << "NumberOfLostLabels: " << this->GetNumberOfLostLabels() << "\n";
  os << indent << "NumberOfShrunkLabels: " << this->GetNumberOfShrunkLabels() << "\n";
  os << indent << "HasQuality: " << this->GetHasQuality() << "\n";
  os << indent << "NumberOfLabels: " << this->GetNumberOfLabels() << "\n";
  os << indent << "TotalTime: " << this->GetTotalTime() << "\n";
  os << indent << "SwitchedToLocal: " << this->GetSwitchedToLocal() << "\n";
  os << indent << "All figures: " << this->ToJSON() << "\n";
}
