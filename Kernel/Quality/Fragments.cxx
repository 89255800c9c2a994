// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Quality/Fragments.h"

#include "Base/DisjointSets.h"
#include "Parallel/ParallelFor.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace voxplex
{

namespace
{

/** A face of a tetrahedron, without its smallest vertex. */
struct Face
{
  std::uint32_t Middle;
  std::uint32_t Largest;
  std::uint32_t Element;

  auto operator<=>(const Face&) const = default; // NOLINT(modernize-use-nullptr): not a null
};

/** Calls f(smallest vertex, face) for each face of each tetrahedron. */
template <typename Function>
void ForEachFace(const SimplexMesh<3>& mesh, Function f)
{
  for (std::uint32_t s = 0; s < mesh.Simplices.size(); ++s)
  {
    std::array<std::uint32_t, 4> v = mesh.Simplices[s];
    std::sort(v.begin(), v.end());
    f(v[0], Face{ v[1], v[2], s });
    f(v[0], Face{ v[1], v[3], s });
    f(v[0], Face{ v[2], v[3], s });
    f(v[1], Face{ v[2], v[3], s });
  }
}

} // namespace

//------------------------------------------------------------------------------------------------
std::map<std::int64_t, std::uint64_t> CountFragments(
  const SimplexMesh<3>& mesh, const std::stop_token& stop)
{
  std::vector<std::size_t> ends(mesh.Points.size() + 1); // of the faces of each smallest vertex
  ForEachFace(mesh, [&](std::uint32_t v, const Face&) { ++ends[v + 1]; });
  for (std::size_t v = 1; v < ends.size(); ++v)
  {
    ends[v] += ends[v - 1];
  }
  ThrowIfStopped(stop);
  std::vector<Face> faces(ends.back());
  ForEachFace(mesh, [&](std::uint32_t v, const Face& face) { faces[ends[v]++] = face; });
  ThrowIfStopped(stop);

  DisjointSets fragments(mesh.Simplices.size());
  std::size_t first = 0;
  for (std::size_t v = 0; v < mesh.Points.size(); ++v)
  {
    std::sort(faces.begin() + static_cast<std::ptrdiff_t>(first),
      faces.begin() + static_cast<std::ptrdiff_t>(ends[v]));
    for (std::size_t k = first + 1; k < ends[v]; ++k)
    {
      const Face& a = faces[k - 1];
      const Face& b = faces[k];
      if (a.Middle == b.Middle && a.Largest == b.Largest &&
        mesh.Labels[a.Element] == mesh.Labels[b.Element])
      {
        fragments.Join(a.Element, b.Element);
      }
    }
    first = ends[v];
  }
  ThrowIfStopped(stop);
  std::map<std::int64_t, std::uint64_t> numbers;
  for (std::uint32_t s = 0; s < mesh.Simplices.size(); ++s)
  {
    numbers[mesh.Labels[s]] += fragments.Find(s) == s ? 1 : 0;
  }
  return numbers;
}

} // namespace voxplex
