// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/PutRight.h"

#include "Base/Error.h"
#include "Geometry/SimplexQuality.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <string>
#include <utility>

namespace voxplex
{

namespace
{

/** Whether its volume is nothing but roundings, beside that of a box with its edges at one vertex. */
template <int D>
bool IsFlat(const std::array<const Point<D>*, static_cast<std::size_t>(D + 1)>& v)
{
  constexpr double Rounding = 1e-14;
  double box = 1.0;
  for (std::size_t k = 1; k <= D; ++k)
  {
    box *= Distance(*v[k], *v[0]) / static_cast<double>(k);
  }
  return !(std::abs(SignedVolume<D>(v.data())) > Rounding * box);
}

/** @param cells ascending */
void RefuseIfAny(
  const std::vector<std::size_t>& cells, const std::string& what, const std::string& advice)
{
  if (cells.empty())
  {
    return;
  }
  throw InputError("Cells of the mesh " + what + ": " + std::to_string(cells.size()) +
    ", the first is cell " + std::to_string(cells.front()) + ". " + advice);
}

template <int D>
std::vector<std::size_t> FindFlat(const SimplexMesh<D>& mesh)
{
  std::vector<std::size_t> flat;
  for (std::size_t s = 0; s < mesh.Simplices.size(); ++s)
  {
    if (IsFlat<D>(mesh.PointsOf(s)))
    {
      flat.push_back(s);
    }
  }
  return flat;
}

/** Those with the points of another before them. */
template <int D>
std::vector<std::size_t> FindRepeated(const SimplexMesh<D>& mesh)
{
  auto simplices = mesh.Simplices;
  for (auto& simplex : simplices)
  {
    std::sort(simplex.begin(), simplex.end());
  }
  std::vector<std::size_t> order(simplices.size());
  std::iota(order.begin(), order.end(), std::size_t{ 0 });
  std::stable_sort(order.begin(), order.end(),
    [&simplices](std::size_t a, std::size_t b) { return simplices[a] < simplices[b]; });
  std::vector<std::size_t> repeated;
  for (std::size_t i = 1; i < order.size(); ++i)
  {
    if (simplices[order[i]] == simplices[order[i - 1]])
    {
      repeated.push_back(order[i]);
    }
  }
  std::sort(repeated.begin(), repeated.end());
  return repeated;
}

/** Returns the former numbers of the points that are left; empty if all are used. */
template <int D>
std::vector<std::uint32_t> DropUnusedPoints(SimplexMesh<D>& mesh)
{
  std::vector<std::uint32_t> numbers(mesh.Points.size(), 0);
  for (const auto& simplex : mesh.Simplices)
  {
    for (const std::uint32_t id : simplex)
    {
      numbers[id] = 1;
    }
  }
  std::vector<std::uint32_t> left;
  for (std::uint32_t id = 0; id < numbers.size(); ++id)
  {
    if (numbers[id] != 0)
    {
      numbers[id] = static_cast<std::uint32_t>(left.size());
      mesh.Points[left.size()] = mesh.Points[id];
      left.push_back(id);
    }
  }
  if (left.size() == numbers.size())
  {
    return {};
  }
  mesh.Points.resize(left.size());
  for (auto& simplex : mesh.Simplices)
  {
    std::transform(simplex.begin(), simplex.end(), simplex.begin(),
      [&numbers](std::uint32_t id) { return numbers[id]; });
  }
  return left;
}

} // namespace

//------------------------------------------------------------------------------------------------
template <int D>
MeshChanges PutRight(SimplexMesh<D>& mesh)
{
  RefuseIfAny(FindFlat(mesh), "without volume",
    "Solvers take no flat elements; make the mesh anew without them.");
  RefuseIfAny(
    FindRepeated(mesh), "with the points of another one", "Leave each element out but once.");
  MeshChanges changes;
  for (std::size_t s = 0; s < mesh.Simplices.size(); ++s)
  {
    if (SignedVolume<D>(mesh.PointsOf(s).data()) < 0.0)
    {
      std::swap(mesh.Simplices[s][D - 1], mesh.Simplices[s][D]);
      ++changes.Turned;
    }
  }
  changes.Points = DropUnusedPoints(mesh);
  return changes;
}

template MeshChanges PutRight<3>(SimplexMesh<3>&);
template MeshChanges PutRight<4>(SimplexMesh<4>&);

} // namespace voxplex
