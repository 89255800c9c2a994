// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/FindInterfaces.h"

#include "Mesh/InterfaceFacets.h"
#include "Parallel/ParallelFor.h"
#include "Parallel/ParallelSort.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

namespace voxplex
{
namespace
{

constexpr std::size_t Grain = 4096;

/** A face of a simplex: its points in increasing order, and where it comes from. */
template <int D>
struct Face
{
  std::array<std::uint32_t, static_cast<std::size_t>(D)> Points;
  std::uint32_t Source; ///< (D + 1) * simplex + number of the face

  bool operator<(const Face& other) const
  {
    return std::tie(this->Points, this->Source) < std::tie(other.Points, other.Source);
  }
};

template <int D>
std::vector<Face<D>> ListFaces(
  const SimplexMesh<D>& mesh, unsigned threads, const std::stop_token& stop)
{
  std::vector<Face<D>> faces((D + 1) * mesh.Simplices.size());
  ParallelFor(
    0, mesh.Simplices.size(), Grain, threads,
    [&](std::size_t first, std::size_t last)
    {
      for (std::size_t s = first; s < last; ++s)
      {
        for (std::size_t i = 0; i <= D; ++i)
        {
          Face<D>& face = faces[(D + 1) * s + i];
          face.Points = OutwardFacet(mesh.Simplices[s], static_cast<unsigned>(i));
          std::sort(face.Points.begin(), face.Points.end());
          face.Source = static_cast<std::uint32_t>((D + 1) * s + i);
        }
      }
    },
    stop);
  return faces;
}

/**
 * Sorts faces by their points: first by the smallest point, then, if it is the same, by the others.
 */
template <int D>
void SortFaces(
  std::vector<Face<D>>& faces, std::size_t points, unsigned threads, const std::stop_token& stop)
{
  std::vector<Face<D>> scratch(faces.size());
  const std::span<Face<D>> sorted = ParallelRadixSort(
    std::span<Face<D>>(faces), std::span<Face<D>>(scratch),
    static_cast<unsigned>(std::bit_width(points)),
    [](const Face<D>& face) { return face.Points[0]; }, threads, stop);
  if (sorted.data() != faces.data())
  {
    faces.swap(scratch);
  }
  ParallelFor(
    0, faces.size(), Grain, threads,
    [&](std::size_t first, std::size_t last)
    {
      // The thread sorts the groups that begin in this chunk, even if they end beyond it.
      const auto sameGroup = [&](std::size_t f)
      { return f > 0 && f < faces.size() && faces[f].Points[0] == faces[f - 1].Points[0]; };
      while (first < last && sameGroup(first))
      {
        ++first;
      }
      while (first < last)
      {
        std::size_t end = first + 1;
        while (sameGroup(end))
        {
          ++end;
        }
        std::sort(faces.begin() + static_cast<std::ptrdiff_t>(first),
          faces.begin() + static_cast<std::ptrdiff_t>(end));
        first = end;
      }
    },
    stop);
}

} // namespace

template <int D>
std::uint64_t FindInterfaces(SimplexMesh<D>& mesh, unsigned threads, const std::stop_token& stop)
{
  std::vector<Face<D>> faces = ListFaces<D>(mesh, threads, stop);
  SortFaces(faces, mesh.Points.size(), threads, stop);

  mesh.Facets.clear();
  mesh.FacetLabels.clear();
  const auto add = [&mesh](std::uint32_t source, std::int64_t other)
  {
    mesh.Facets.push_back(OutwardFacet(mesh.Simplices[source / (D + 1)], source % (D + 1)));
    mesh.FacetLabels.push_back({ mesh.Labels[source / (D + 1)], other });
  };
  std::uint64_t shared = 0;
  for (std::size_t f = 0; f < faces.size();)
  {
    std::size_t end = f + 1;
    while (end < faces.size() && faces[end].Points == faces[f].Points)
    {
      ++end;
    }
    const std::uint32_t one = faces[f].Source;
    if (end - f == 1)
    {
      add(one, 0);
    }
    else if (end - f == 2)
    {
      const std::uint32_t two = faces[f + 1].Source;
      const std::int64_t labels[2] = { mesh.Labels[one / (D + 1)], mesh.Labels[two / (D + 1)] };
      if (labels[0] != labels[1])
      {
        add(labels[0] > labels[1] ? one : two, std::min(labels[0], labels[1]));
      }
    }
    else
    {
      ++shared;
    }
    f = end;
  }
  return shared;
}

template std::uint64_t FindInterfaces<3>(SimplexMesh<3>&, unsigned, const std::stop_token&);
template std::uint64_t FindInterfaces<4>(SimplexMesh<4>&, unsigned, const std::stop_token&);

} // namespace voxplex
