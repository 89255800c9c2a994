// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Optimisation/Rooms.h"

#include <algorithm>

namespace voxplex
{

namespace
{

/** Disjoint sets. Each is known by its smallest member. */
class DisjointSets
{
public:
  static constexpr std::uint32_t None = TetrahedralComplex::None;

  /** At first, no number below `size` is in a set. */
  explicit DisjointSets(std::size_t size)
    : Smaller(size, None)
  {
  }

  bool Has(std::uint32_t v) const { return this->Smaller[v] != None; }

  std::uint32_t SetOf(std::uint32_t v)
  {
    while (this->Smaller[v] != v)
    {
      this->Smaller[v] = this->Smaller[this->Smaller[v]];
      v = this->Smaller[v];
    }
    return v;
  }

  /** Makes one set of some numbers and of the sets that they are in. */
  void Join(const TetrahedralComplex::Vertices& numbers)
  {
    std::uint32_t smallest = None;
    for (const std::uint32_t v : numbers)
    {
      if (!this->Has(v))
      {
        this->Smaller[v] = v;
      }
      smallest = std::min(smallest, this->SetOf(v));
    }
    for (const std::uint32_t v : numbers)
    {
      this->Smaller[this->SetOf(v)] = smallest;
    }
  }

private:
  std::vector<std::uint32_t> Smaller; ///< a member of the set that is not larger
};

} // namespace

//------------------------------------------------------------------------------------------------
Rooms RoomsAround(
  const TetrahedralComplex& complex, std::span<const std::uint32_t> cells, unsigned edges)
{
  DisjointSets sets(complex.Points.size());
  for (const std::uint32_t t : cells)
  {
    sets.Join(complex.Cells[t].V);
  }
  std::vector<std::uint32_t> reached;
  for (; edges > 0; --edges)
  {
    reached.clear();
    for (std::uint32_t t = 0; t < complex.Cells.size(); ++t)
    {
      const auto& v = complex.Cells[t].V;
      if (complex.IsAlive(t) &&
        (sets.Has(v[0]) || sets.Has(v[1]) || sets.Has(v[2]) || sets.Has(v[3])))
      {
        reached.push_back(t);
      }
    }
    for (const std::uint32_t t : reached)
    {
      sets.Join(complex.Cells[t].V);
    }
  }

  Rooms rooms;
  rooms.OfVertex.resize(complex.Points.size());
  for (std::uint32_t v = 0; v < rooms.OfVertex.size(); ++v)
  {
    if (sets.Has(v))
    {
      const std::uint32_t first = sets.SetOf(v);
      rooms.OfVertex[v] = first == v ? rooms.Number++ : rooms.OfVertex[first];
    }
  }
  for (std::uint32_t v = 0; v < rooms.OfVertex.size(); ++v)
  {
    if (!sets.Has(v))
    {
      rooms.OfVertex[v] = rooms.Number;
    }
  }
  return rooms;
}

} // namespace voxplex
