// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "voxplexLabelMeshing.h"

#include "Image/ImageFrame.h"
#include "Image/ScalarTypes.h"
#include "Mesher/ImageMesher.h"
#include "MeshingParameters.h"
#include "Private/MeshingMessages.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

namespace voxplex
{

namespace
{

void CheckParameters(const LabelMeshingParameters& given)
{
  CheckValue("delta", given.m_Delta);
  CheckValue("elements", static_cast<double>(given.m_NumberOfElements));
  CheckValue("radius-edge", given.m_RadiusEdgeRatio, given.m_Force);
  CheckValue("facet-angle", given.m_FacetAngle);
  CheckValue("smoothing", given.m_SmoothingSigma);
  CheckValue("min-component-volume", given.m_MinimumComponentVolume);
}

MeshingOptions<3> OptionsOf(const LabelMeshingParameters& given, unsigned threads)
{
  MeshingOptions<3> options;
  options.Sampling.Delta = given.m_Delta;
  options.Sampling.Elements = static_cast<std::uint64_t>(given.m_NumberOfElements);
  options.Shape.RadiusEdgeRatio = given.m_RadiusEdgeRatio;
  options.Shape.FacetAngle = given.m_FacetAngle;
  options.SmoothingSigma = given.m_SmoothingSigma;
  options.SmallestVolume = given.m_MinimumComponentVolume;
  options.Components.Exact = given.m_ExactComponents;
  options.Optimisation.Run = given.m_Optimise;
  options.Team.Threads = threads;
  options.Team.Reproducible = given.m_Reproducible;
  options.Limits.Force = given.m_Force;
  return options;
}

ImageFrame FrameOf(const LabelGrid& grid)
{
  if (!std::all_of(
        grid.Origin.begin(), grid.Origin.end(), [](double x) { return std::isfinite(x); }))
  {
    throw InputError("The image lies nowhere: correct its origin, which is not finite.");
  }
  return MakeImageFrame(grid.Dimensions, grid.Steps, grid.Origin, "image");
}

/** From the mesher's frame to the world; a reflection must not turn elements inside out. */
void MoveToWorld(SimplexMesh<3>& mesh, const ImageFrame& frame)
{
  for (Point<3>& point : mesh.Points)
  {
    point = frame.ToWorld(point);
  }
  for (auto& tetrahedron : mesh.Simplices)
  {
    if (frame.LeftHanded)
    {
      std::swap(tetrahedron[2], tetrahedron[3]);
    }
  }
}

} // namespace

template <typename T>
LabelledTetrahedra MeshLabels(const T* voxels, const LabelGrid& grid,
  const LabelMeshingParameters& parameters, unsigned threads,
  const std::function<bool(double)>& progress)
{
  LabelledTetrahedra result;
  const auto run = [&]
  {
    CheckParameters(parameters);
    const ImageFrame frame = FrameOf(grid);
    const auto& n = grid.Dimensions;
    const std::span<const T> scalars(voxels, static_cast<std::size_t>(n[0] * n[1] * n[2]));
    const LabelSelection chosen{ { parameters.m_Labels.begin(), parameters.m_Labels.end() }, {} };
    ImageMesher<3> mesher(OptionsOf(parameters, threads));
    mesher.Progress = progress;
    const auto mesh = std::make_shared<SimplexMesh<3>>();
    if (mesher.Run(LabelImage<3>::FromScalars(scalars, frame.Grid, chosen, threads), *mesh) ==
      MeshingOutcome::Cancelled)
    {
      return;
    }
    CheckNotEmpty(mesher.Statistics());
    MoveToWorld(*mesh, frame);
    for (const std::string& warning :
      WarningsOf(mesher.Statistics(), {}, "", parameters.m_ExactComponents))
    {
      result.Warnings.push_back(InTermsOf(UserInterface::ITK, warning));
    }
    result.Points = mesh->Points.data();
    result.NumberOfPoints = mesh->Points.size();
    result.Tetrahedra = mesh->Simplices.data();
    result.Labels = mesh->Labels.data();
    result.NumberOfTetrahedra = mesh->Simplices.size();
    result.Owner = mesh;
  };
  result.Error = InTermsOf(UserInterface::ITK, CatchFailure(run, NoMemoryForMesh, MeshingFailed));
  return result;
}

#define VOXPLEX_INSTANTIATE(T)                                                                     \
  template VOXPLEXITK_EXPORT LabelledTetrahedra MeshLabels<T>(const T*, const LabelGrid&,          \
    const LabelMeshingParameters&, unsigned, const std::function<bool(double)>&)
VOXPLEX_FOR_EACH_SCALAR_TYPE(VOXPLEX_INSTANTIATE);

} // namespace voxplex
