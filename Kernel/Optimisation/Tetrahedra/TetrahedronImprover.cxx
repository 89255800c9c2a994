// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Optimisation/Tetrahedra/TetrahedronImprover.h"

namespace voxplex
{

bool TetrahedronImprover::Improve(std::uint32_t t)
{
  if (this->Topology.Improve(t))
  {
    return true;
  }
  bool better = false;
  const auto vertices = this->Mesh.Cells[t].V; // smoothing only moves them
  for (const std::uint32_t v : vertices)
  {
    better = this->Geometry.Improve(v) || better;
    if (!this->Mesh.IsPoor(t))
    {
      return true;
    }
  }
  return better || (this->Most != Effort::Plain && this->ImproveAsLastResort(t));
}

bool TetrahedronImprover::ImproveAsLastResort(std::uint32_t t)
{
  for (unsigned i = 0; i < 4; ++i)
  {
    for (unsigned j = 0; j < i; ++j)
    {
      if (this->Geometry.Insert(t, j, i))
      {
        return true;
      }
    }
  }
  if (this->Geometry.InsertInside(t))
  {
    return true;
  }
  bool better = false;
  if (this->Most == Effort::MovesOffInterfaces)
  {
    const auto vertices = this->Mesh.Cells[t].V;
    for (const std::uint32_t v : vertices)
    {
      better = this->Geometry.MoveOffInterface(v) || better;
      if (!this->Mesh.IsPoor(t))
      {
        break;
      }
    }
  }
  return better;
}

} // namespace voxplex
