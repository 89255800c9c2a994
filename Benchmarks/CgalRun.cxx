// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "MesherRun.h"

#include "ChildProcess.h"
#include "CpuStopwatch.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Image_3.h>
#include <CGAL/Labeled_mesh_domain_3.h>
#include <CGAL/Mesh_complex_3_in_triangulation_3.h>
#include <CGAL/Mesh_criteria_3.h>
#include <CGAL/Mesh_triangulation_3.h>
#include <CGAL/make_mesh_3.h> // also has perturbation and exudation

#ifdef CGAL_LINKED_WITH_TBB
#include <tbb/global_control.h>
#endif

#include <stdexcept>
#include <unordered_map>

namespace voxplex::benchmarks
{
namespace
{

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using MeshDomain = CGAL::Labeled_mesh_domain_3<Kernel>;

/** A view of the volume. CGAL reads the same voxels and does not own them. */
CGAL::Image_3 MakeImage(const LabelVolume& volume)
{
  using namespace CGAL; // which has ImageIO's names since 6.2
  _image* const image = _initImage();
  image->xdim = static_cast<std::size_t>(volume.Dimensions[0]);
  image->ydim = static_cast<std::size_t>(volume.Dimensions[1]);
  image->zdim = static_cast<std::size_t>(volume.Dimensions[2]);
  image->vdim = 1;
  image->vx = volume.Spacing[0];
  image->vy = volume.Spacing[1];
  image->vz = volume.Spacing[2];
  image->wdim = sizeof(volume.Labels[0]);
  image->wordKind = WK_FIXED;
  image->sign = SGN_UNSIGNED;
  image->data = const_cast<std::uint16_t*>(volume.Labels.data());
  return CGAL::Image_3(image, CGAL::Image_3::DO_NOT_OWN_THE_DATA);
}

/** The tetrahedra of the complex as plain arrays. */
template <typename Complex>
SimplexMesh<3> ToArrays(const Complex& complex)
{
  SimplexMesh<3> mesh;
  std::unordered_map<typename Complex::Vertex_handle, std::uint32_t> ids;
  for (auto cell = complex.cells_in_complex_begin(); cell != complex.cells_in_complex_end(); ++cell)
  {
    std::array<std::uint32_t, 4>& simplex = mesh.Simplices.emplace_back();
    for (int i = 0; i < 4; ++i)
    {
      const auto vertex = cell->vertex(i);
      const auto [id, isNew] =
        ids.try_emplace(vertex, static_cast<std::uint32_t>(mesh.Points.size()));
      if (isNew)
      {
        const auto& p = vertex->point();
        mesh.Points.push_back({ p.x(), p.y(), p.z() });
      }
      simplex[static_cast<std::size_t>(i)] = id->second;
    }
    mesh.Labels.push_back(complex.subdomain_index(cell));
  }
  return mesh;
}

/** @param optimisation null: no optimisation */
template <typename ConcurrencyTag>
MesherRun Run(const LabelVolume& volume, double size, Optimisation* optimisation = nullptr)
{
  namespace parameters = CGAL::parameters;
  using Triangulation =
    typename CGAL::Mesh_triangulation_3<MeshDomain, CGAL::Default, ConcurrencyTag>::type;
  using Complex = CGAL::Mesh_complex_3_in_triangulation_3<Triangulation>;
  using Criteria = CGAL::Mesh_criteria_3<Triangulation>;

  MesherRun run;
  const CpuStopwatch total;
  const CGAL::Image_3 image = MakeImage(volume);
  const MeshDomain domain = MeshDomain::create_labeled_image_mesh_domain(image);
  const Criteria criteria(parameters::facet_angle = 30.0, parameters::facet_size = size,
    parameters::cell_radius_edge_ratio = 2.0);

  const CpuStopwatch refinement;
  Complex complex = CGAL::make_mesh_3<Complex>(domain, criteria, parameters::no_perturb(),
    parameters::no_exude(), parameters::no_lloyd(), parameters::no_odt());
  run.RefinementSeconds = refinement.Seconds();
  run.TotalSeconds = total.Seconds();
  run.CpuSeconds = total.CpuSeconds();
  run.PeakBytes = PeakResidentBytes();
  run.Mesh = ToArrays(complex);
  if (optimisation)
  {
    const CpuStopwatch perturbation;
    CGAL::perturb_mesh_3(complex, domain);
    optimisation->PerturbSeconds = perturbation.Seconds();
    const CpuStopwatch exudation;
    CGAL::exude_mesh_3(complex);
    optimisation->ExudeSeconds = exudation.Seconds();
    optimisation->Mesh = ToArrays(complex);
  }
  return run;
}

} // namespace

MesherRun RunCgal(const LabelVolume& image, double size, unsigned threads, bool parallel)
{
  if (threads == 1 && !parallel)
  {
    return Run<CGAL::Sequential_tag>(image, size);
  }
#ifdef CGAL_LINKED_WITH_TBB
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
  return Run<CGAL::Parallel_tag>(image, size);
#else
  throw std::runtime_error("CGAL's Parallel_tag needs TBB, which was not found");
#endif
}

MesherRun RunCgalAndOptimise(const LabelVolume& image, double size, Optimisation& optimisation)
{
  return Run<CGAL::Sequential_tag>(image, size, &optimisation);
}

} // namespace voxplex::benchmarks
