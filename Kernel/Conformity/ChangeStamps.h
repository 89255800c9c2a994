// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ChangeStamps.h
 * @brief Internal to ManifoldLabels: when labels around a vertex have changed.
 */
#ifndef voxplex_ChangeStamps_h
#define voxplex_ChangeStamps_h

#include "Delaunay/Triangulation.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace voxplex::repair
{

/** @brief When something around each vertex has changed last. */
class ChangeStamps
{
public:
  explicit ChangeStamps(std::size_t vertices)
    : Last(vertices, 0)
  {
  }

  /** @param time not before any other */
  template <typename Vertices>
  void Set(const Vertices& vertices, std::uint32_t time)
  {
    for (const VertexId v : vertices)
    {
      this->Last[v] = time;
    }
  }

  /** Whether something around one of these vertices has changed after a time. */
  bool AnyAfter(const std::vector<VertexId>& vertices, std::uint32_t time) const
  {
    return std::any_of(
      vertices.begin(), vertices.end(), [&](VertexId v) { return this->Last[v] > time; });
  }

private:
  std::vector<std::uint32_t> Last;
};

} // namespace voxplex::repair

#endif
