// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file voxplexLabelMeshing.h
 * @brief What is compiled of itk::LabelImageToTetrahedralMeshFilter; it knows neither ITK nor VTK.
 */
#ifndef voxplexLabelMeshing_h
#define voxplexLabelMeshing_h

#include "voxplexITKExport.h" // For export macro

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace voxplex
{

/** Where the voxels of an image lie. */
struct LabelGrid
{
  std::array<std::int64_t, 3> Dimensions;     ///< voxels along each axis
  std::array<std::array<double, 3>, 3> Steps; ///< from one voxel to the next along each axis
  std::array<double, 3> Origin;               ///< the centre of the first voxel
};

/** The parameters of the filter, which documents them; its setters have these names. */
struct LabelMeshingParameters
{
  double m_Delta{ 0.0 };
  std::int64_t m_NumberOfElements{ 0 };
  double m_RadiusEdgeRatio{ 2.0 };
  double m_FacetAngle{ 30.0 };
  double m_SmoothingSigma{ 1.0 };
  double m_MinimumComponentVolume{ 0.0 };
  bool m_ExactComponents{ false };
  bool m_Optimise{ true };
  bool m_Reproducible{ false };
  bool m_Force{ false };
  std::set<std::int64_t> m_Labels;
};

/** Pointers are valid as long as the record or a copy of it. */
struct LabelledTetrahedra
{
  const std::array<double, 3>* Points{ nullptr };
  std::size_t NumberOfPoints{ 0 };
  const std::array<std::uint32_t, 4>* Tetrahedra{ nullptr }; ///< of positive volume, as in VTK
  const std::int64_t* Labels{ nullptr };                     ///< of each tetrahedron
  std::size_t NumberOfTetrahedra{ 0 };
  std::vector<std::string> Warnings;
  std::string Error; ///< why there is no mesh; also empty if the run was stopped
  std::shared_ptr<const void> Owner;
};

/**
 * Meshes a label image.
 * @param voxels the labels, x varies fastest; T is any integer or floating-point type but bool
 * @param threads their number, 1 or more
 * @param progress is called from the calling thread, at least ten times a second, with the fraction
 * done. If it returns false, the run stops within a second. It must not throw.
 */
template <typename T>
VOXPLEXITK_EXPORT LabelledTetrahedra MeshLabels(const T* voxels, const LabelGrid& grid,
  const LabelMeshingParameters& parameters, unsigned threads,
  const std::function<bool(double)>& progress);

} // namespace voxplex

#endif
