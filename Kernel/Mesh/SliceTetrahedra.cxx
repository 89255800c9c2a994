// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/SliceTetrahedra.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace voxplex
{

namespace
{

using Tetrahedron = std::array<std::uint32_t, 4>;
using Wedge = std::array<std::uint32_t, 6>;
using Pyramid = std::array<std::uint32_t, 5>;

/**
 * The wedge turned so that its smallest point comes first, and that the right-hand normal of the
 * first triangle points to the second one.
 */
Wedge Turned(const Wedge& w)
{
  // VTK's first triangle looks away from the second. The last six look like the first one.
  static constexpr std::array<std::array<std::size_t, 6>, 6> turns = { { { 0, 2, 1, 3, 5, 4 },
    { 1, 0, 2, 4, 3, 5 }, { 2, 1, 0, 5, 4, 3 }, { 3, 4, 5, 0, 1, 2 }, { 4, 5, 3, 1, 2, 0 },
    { 5, 3, 4, 2, 0, 1 } } };
  const auto& turn =
    turns[static_cast<std::size_t>(std::min_element(w.begin(), w.end()) - w.begin())];
  Wedge turned;
  std::transform(turn.begin(), turn.end(), turned.begin(), [&w](std::size_t i) { return w[i]; });
  return turned;
}

/** Both quadrilaterals at the first point are split there; the third one as its smallest point says. */
std::array<Tetrahedron, 3> Split(const Wedge& wedge)
{
  const Wedge v = Turned(wedge);
  if (std::min(v[1], v[5]) < std::min(v[2], v[4]))
  {
    return { { { v[0], v[1], v[2], v[5] }, { v[0], v[1], v[5], v[4] },
      { v[0], v[4], v[5], v[3] } } };
  }
  return { { { v[0], v[1], v[2], v[4] }, { v[0], v[4], v[2], v[5] }, { v[0], v[4], v[5], v[3] } } };
}

std::array<Tetrahedron, 2> Split(const Pyramid& v)
{
  if (std::min(v[0], v[2]) < std::min(v[1], v[3]))
  {
    return { { { v[0], v[1], v[2], v[4] }, { v[0], v[2], v[3], v[4] } } };
  }
  return { { { v[1], v[2], v[3], v[4] }, { v[1], v[3], v[0], v[4] } } };
}

template <std::size_t N>
std::array<std::uint32_t, N> Corners(const long long* ids)
{
  std::array<std::uint32_t, N> corners;
  std::transform(
    ids, ids + N, corners.begin(), [](long long id) { return static_cast<std::uint32_t>(id); });
  return corners;
}

} // namespace

//------------------------------------------------------------------------------------------------
SimplexMesh<3> SplitIntoTetrahedra(const TimeSlice& slice, std::span<const std::int64_t> labels)
{
  SimplexMesh<3> mesh;
  mesh.Points.assign(slice.Points.begin(), slice.Points.end());
  const auto add = [&](const auto& tetrahedra, std::size_t cell)
  {
    for (const Tetrahedron& tetrahedron : tetrahedra)
    {
      mesh.Simplices.push_back(tetrahedron);
      mesh.Labels.push_back(labels[static_cast<std::size_t>(slice.Sources[cell])]);
    }
  };
  for (std::size_t c = 0; c < slice.Types.size(); ++c)
  {
    const long long* const ids = slice.Connectivity.data() + slice.Offsets[c];
    switch (slice.Types[c])
    {
      case SliceCellType::Tetrahedron:
        add(std::array<Tetrahedron, 1>{ Corners<4>(ids) }, c);
        break;
      case SliceCellType::Wedge:
        add(Split(Corners<6>(ids)), c);
        break;
      case SliceCellType::Pyramid:
        add(Split(Corners<5>(ids)), c);
        break;
      case SliceCellType::Triangle:
      case SliceCellType::Quad:
        break;
    }
  }
  return mesh;
}

} // namespace voxplex
