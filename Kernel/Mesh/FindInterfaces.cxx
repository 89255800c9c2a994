// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/FindInterfaces.h"

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

/** The vertices of the face opposite to vertex i, counter-clockwise as seen from outside. */
constexpr std::array<std::array<std::size_t, 3>, 4> FaceVertices{ { { 1, 2, 3 }, { 0, 3, 2 },
  { 0, 1, 3 }, { 0, 2, 1 } } };

/** A face of a tetrahedron: its points in increasing order, and where it comes from. */
struct Face
{
  std::array<std::uint32_t, 3> Points;
  std::uint32_t Source; ///< 4 * tetrahedron + number of the face

  bool operator<(const Face& other) const
  {
    return std::tie(this->Points, this->Source) < std::tie(other.Points, other.Source);
  }
};

std::vector<Face> ListFaces(
  const SimplexMesh<3>& mesh, unsigned threads, const std::stop_token& stop)
{
  std::vector<Face> faces(4 * mesh.Simplices.size());
  ParallelFor(
    0, mesh.Simplices.size(), Grain, threads,
    [&](std::size_t first, std::size_t last)
    {
      for (std::size_t s = first; s < last; ++s)
      {
        for (std::size_t i = 0; i < 4; ++i)
        {
          Face& face = faces[4 * s + i];
          for (std::size_t k = 0; k < 3; ++k)
          {
            face.Points[k] = mesh.Simplices[s][FaceVertices[i][k]];
          }
          std::sort(face.Points.begin(), face.Points.end());
          face.Source = static_cast<std::uint32_t>(4 * s + i);
        }
      }
    },
    stop);
  return faces;
}

/**
 * Sorts faces by their points: first by the smallest point, then, if it is the same, by the others.
 */
void SortFaces(
  std::vector<Face>& faces, std::size_t points, unsigned threads, const std::stop_token& stop)
{
  std::vector<Face> scratch(faces.size());
  const std::span<Face> sorted = ParallelRadixSort(
    std::span<Face>(faces), std::span<Face>(scratch), static_cast<unsigned>(std::bit_width(points)),
    [](const Face& face) { return face.Points[0]; }, threads, stop);
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

std::uint64_t FindInterfaces(SimplexMesh<3>& mesh, unsigned threads, const std::stop_token& stop)
{
  std::vector<Face> faces = ListFaces(mesh, threads, stop);
  SortFaces(faces, mesh.Points.size(), threads, stop);

  mesh.Facets.clear();
  mesh.FacetLabels.clear();
  const auto add = [&mesh](std::uint32_t source, std::int64_t other)
  {
    const std::array<std::uint32_t, 4>& simplex = mesh.Simplices[source / 4];
    const std::array<std::size_t, 3>& face = FaceVertices[source % 4];
    mesh.Facets.push_back({ simplex[face[0]], simplex[face[1]], simplex[face[2]] });
    mesh.FacetLabels.push_back({ mesh.Labels[source / 4], other });
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
      const std::int64_t labels[2] = { mesh.Labels[one / 4], mesh.Labels[two / 4] };
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

} // namespace voxplex
