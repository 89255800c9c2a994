// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "ChildProcess.h"
#include "PointsRun.h"
#include "CpuStopwatch.h"

#include <CGAL/Delaunay_triangulation.h>
#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Epick_d.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Spatial_sort_traits_adapter_3.h>
#include <CGAL/Spatial_sort_traits_adapter_d.h>
#include <CGAL/hilbert_sort.h>
#include <CGAL/property_map.h>
#include <CGAL/spatial_sort.h>

#include <cstddef>
#include <numeric>

namespace voxplex::benchmarks
{
namespace
{

template <int D>
struct CgalTypes;

template <>
struct CgalTypes<3>
{
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  using Point = Kernel::Point_3;
  using Triangulation = CGAL::Delaunay_triangulation_3<Kernel>;
  template <typename Map>
  using SortTraits = CGAL::Spatial_sort_traits_adapter_3<Kernel, Map>;

  static Point Convert(const voxplex::Point<3>& p) { return { p[0], p[1], p[2] }; }
  static std::uint64_t FiniteCells(const Triangulation& t) { return t.number_of_finite_cells(); }
};

template <>
struct CgalTypes<4>
{
  using Kernel = CGAL::Epick_d<CGAL::Dimension_tag<4>>;
  using Point = Kernel::Point_d;
  using Triangulation = CGAL::Delaunay_triangulation<Kernel>;
  template <typename Map>
  using SortTraits = CGAL::Spatial_sort_traits_adapter_d<Kernel, Map>;

  static Point Convert(const voxplex::Point<4>& p) { return Point(p.begin(), p.end()); }
  static std::uint64_t FiniteCells(const Triangulation& t)
  {
    return t.number_of_finite_full_cells();
  }
};

template <int D>
auto MakeTriangulation()
{
  if constexpr (D == 3)
  {
    return CgalTypes<3>::Triangulation();
  }
  else
  {
    return CgalTypes<4>::Triangulation(D);
  }
}

template <int D>
auto ConvertAll(const std::vector<Point<D>>& points)
{
  std::vector<typename CgalTypes<D>::Point> converted;
  converted.reserve(points.size());
  for (const Point<D>& p : points)
  {
    converted.push_back(CgalTypes<D>::Convert(p));
  }
  return converted;
}

} // namespace

template <int D>
void SortSpatially(std::vector<Point<D>>& points, bool rounds)
{
  const auto converted = ConvertAll<D>(points);
  const auto map = CGAL::make_property_map(converted);
  const typename CgalTypes<D>::template SortTraits<std::remove_const_t<decltype(map)>> traits(map);
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{ 0 });
  if (rounds)
  {
    CGAL::spatial_sort(order.begin(), order.end(), traits);
  }
  else
  {
    CGAL::hilbert_sort(order.begin(), order.end(), traits);
  }
  std::vector<Point<D>> sorted;
  sorted.reserve(points.size());
  for (const std::size_t i : order)
  {
    sorted.push_back(points[i]);
  }
  points.swap(sorted);
}

template <int D>
PointsRun TriangulateWithCgal(const std::vector<Point<D>>& points)
{
  const auto corners = ConvertAll<D>(UnitCubeCorners<D>());
  const auto converted = ConvertAll<D>(points);
  PointsRun run;
  const CpuStopwatch stopwatch;
  auto triangulation = MakeTriangulation<D>();
  triangulation.insert(corners.begin(), corners.end());
  auto hint = triangulation.infinite_vertex();
  for (const auto& p : converted)
  {
    hint = triangulation.insert(p, hint);
  }
  run.Seconds = stopwatch.Seconds();
  run.CpuSeconds = stopwatch.CpuSeconds();
  run.PeakBytes = PeakResidentBytes();
  run.Simplices = CgalTypes<D>::FiniteCells(triangulation);
  return run;
}

template void SortSpatially<3>(std::vector<Point<3>>&, bool);
template void SortSpatially<4>(std::vector<Point<4>>&, bool);
template PointsRun TriangulateWithCgal<3>(const std::vector<Point<3>>&);
template PointsRun TriangulateWithCgal<4>(const std::vector<Point<4>>&);

} // namespace voxplex::benchmarks
