// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Optimisation/TetrahedralComplex.h"

#include "Parallel/ParallelFor.h"

#include <algorithm>
#include <utility>

namespace voxplex
{

namespace
{

constexpr std::size_t Grain = 16384;

/** A facet, listed at its smallest vertex. */
struct ListedFacet
{
  std::uint64_t Others; ///< the other two vertices, the larger one in the high half
  std::uint32_t Cell;
  std::uint32_t Index; ///< of the opposite vertex
};

/** The vertices of facet i, sorted. */
std::array<std::uint32_t, 3> SortedFacet(const TetrahedralComplex::Vertices& v, unsigned i)
{
  std::array<std::uint32_t, 3> f = { v[(i + 1) & 3], v[(i + 2) & 3], v[(i + 3) & 3] };
  if (f[0] > f[1])
  {
    std::swap(f[0], f[1]);
  }
  if (f[1] > f[2])
  {
    std::swap(f[1], f[2]);
  }
  if (f[0] > f[1])
  {
    std::swap(f[0], f[1]);
  }
  return f;
}

} // namespace

//------------------------------------------------------------------------------------------------
TetrahedralComplex::TetrahedralComplex(const SimplexMesh<3>& mesh, const ShapeScore& score,
  unsigned threads, const std::stop_token& stop, std::span<const float> scores)
  : Shape(score)
  , Points(mesh.Points)
{
  this->CopyCells(mesh);
  if (scores.empty())
  {
    this->ScoreCells(threads, stop);
  }
  else
  {
    std::copy(scores.begin(), scores.end(), this->Scores.begin());
  }
  this->Connect(threads, stop);
  this->FindKinds();
}

void TetrahedralComplex::CopyCells(const SimplexMesh<3>& mesh)
{
  const std::size_t cells = mesh.Simplices.size();
  this->LabelValues.push_back(0);
  std::int64_t last = 0;
  for (const std::int64_t label : mesh.Labels)
  {
    if (label != last)
    {
      this->LabelValues.push_back(label);
      last = label;
    }
  }
  std::sort(this->LabelValues.begin() + 1, this->LabelValues.end());
  this->LabelValues.erase(
    std::unique(this->LabelValues.begin() + 1, this->LabelValues.end()), this->LabelValues.end());

  this->Cells.resize(cells);
  this->Labels.resize(cells);
  this->Scores.resize(cells);
  this->Hosts.assign(this->Points.size(), None);
  this->Degrees.assign(this->Points.size(), 0);
  this->Changes.assign(this->Points.size(), 0);
  last = 0;
  Label index = 0;
  for (std::size_t t = 0; t < cells; ++t)
  {
    this->Cells[t] = { mesh.Simplices[t], { None, None, None, None } };
    if (mesh.Labels[t] != last)
    {
      last = mesh.Labels[t];
      index = static_cast<Label>(
        std::lower_bound(this->LabelValues.begin() + 1, this->LabelValues.end(), last) -
        this->LabelValues.begin());
    }
    this->Labels[t] = index;
    for (const std::uint32_t v : mesh.Simplices[t])
    {
      this->Hosts[v] = static_cast<std::uint32_t>(t);
      ++this->Degrees[v];
    }
  }
}

void TetrahedralComplex::ScoreCells(unsigned threads, const std::stop_token& stop)
{
  ParallelFor(
    0, this->Cells.size(), Grain, threads,
    [this](std::size_t first, std::size_t end)
    {
      for (std::size_t t = first; t < end; ++t)
      {
        this->Scores[t] = static_cast<float>(this->Score(this->Cells[t].V));
      }
    },
    stop);
}

void TetrahedralComplex::AddCells(std::size_t number)
{
  const std::size_t old = this->Cells.size();
  this->Cells.resize(old + number);
  this->Labels.resize(old + number);
  this->Scores.resize(old + number);
  for (std::size_t t = old; t < this->Cells.size(); ++t)
  {
    this->Cells[t].V[0] = None;
    this->Scores[t] = 1.0f;
  }
}

void TetrahedralComplex::AddVertices(std::size_t number)
{
  const std::size_t size = this->Points.size() + number;
  this->Points.resize(size);
  this->Kinds.resize(size, VertexRole::Free);
  this->BorderFaces.resize(this->BorderFaces.empty() ? 0 : size, 0);
  this->Hosts.resize(size, None);
  this->Degrees.resize(size, 0);
  this->Changes.resize(size, 0);
}

/**
 * Facets are listed at their smallest vertex. Two facets of a list are the same if their other
 * vertices are equal.
 */
void TetrahedralComplex::Connect(unsigned threads, const std::stop_token& stop)
{
  const std::size_t points = this->Points.size();
  std::vector<std::uint32_t> begins(points + 1, 0);
  for (const Tetrahedron& cell : this->Cells)
  {
    for (unsigned i = 0; i < 4; ++i)
    {
      ++begins[SortedFacet(cell.V, i)[0] + 1];
    }
  }
  for (std::size_t v = 0; v < points; ++v)
  {
    begins[v + 1] += begins[v];
  }
  UninitialisedVector<ListedFacet> lists(4 * this->Cells.size());
  std::vector<std::uint32_t> ends(begins.begin(), begins.end() - 1);
  for (std::uint32_t t = 0; t < this->Cells.size(); ++t)
  {
    for (unsigned i = 0; i < 4; ++i)
    {
      const auto f = SortedFacet(this->Cells[t].V, i);
      lists[ends[f[0]]++] = { (std::uint64_t{ f[2] } << 32) | f[1], t, i };
    }
  }
  ParallelFor(
    0, points, Grain, threads,
    [&](std::size_t first, std::size_t last)
    {
      for (std::size_t v = first; v < last; ++v)
      {
        for (std::uint32_t i = begins[v]; i < begins[v + 1]; ++i)
        {
          for (std::uint32_t j = begins[v]; j < i; ++j)
          {
            if (lists[i].Others == lists[j].Others)
            {
              this->Cells[lists[i].Cell].N[lists[i].Index] = lists[j].Cell;
              this->Cells[lists[j].Cell].N[lists[j].Index] = lists[i].Cell;
              break;
            }
          }
        }
      }
    },
    stop);
}

/**
 * If all interface facets of a vertex separate the same two labels, it is on a surface of two
 * labels.
 */
void TetrahedralComplex::FindKinds()
{
  using Pair = std::array<Label, 2>;
  this->Kinds.assign(this->Points.size(), VertexRole::Free);
  std::vector<Pair> sides(this->Points.size());
  for (std::uint32_t t = 0; t < this->Cells.size(); ++t)
  {
    for (unsigned i = 0; i < 4; ++i)
    {
      const Pair pair = { this->Labels[t], this->LabelOf(this->Cells[t].N[i]) };
      if (pair[0] <= pair[1]) // no interface, or counted from the other side
      {
        continue;
      }
      for (unsigned k = 1; k < 4; ++k)
      {
        const std::uint32_t v = this->Cells[t].V[(i + k) & 3];
        if (this->Kinds[v] == VertexRole::Free)
        {
          this->Kinds[v] = VertexRole::Surface;
          sides[v] = pair;
        }
        else if (sides[v] != pair)
        {
          this->Kinds[v] = VertexRole::Fixed;
        }
      }
    }
  }
}

//------------------------------------------------------------------------------------------------
/**
 * A vertex is on an edge of a face if it lies on the face, but some of its triangles towards
 * background do not.
 */
void TetrahedralComplex::FindBorderFaces(const Domain<3>& domain)
{
  const ImageBorder<3>* const border = domain.Border();
  if (!border)
  {
    return;
  }
  this->BorderFaces.assign(this->Points.size(), 0);
  for (std::size_t v = 0; v < this->Points.size(); ++v)
  {
    if (this->Kinds[v] != VertexRole::Free)
    {
      this->BorderFaces[v] = static_cast<std::uint8_t>(border->FacesAt(this->Points[v]));
    }
  }
  for (const Tetrahedron& cell : this->Cells)
  {
    for (unsigned i = 0; i < 4; ++i)
    {
      if (cell.N[i] != None)
      {
        continue;
      }
      const std::array<std::uint32_t, 3> f = SortedFacet(cell.V, i);
      const unsigned common =
        this->BorderFaces[f[0]] & this->BorderFaces[f[1]] & this->BorderFaces[f[2]];
      for (const std::uint32_t v : f)
      {
        if (this->BorderFaces[v] != common && this->Kinds[v] == VertexRole::Surface)
        {
          this->Kinds[v] = VertexRole::Crease;
        }
      }
    }
  }
}

//------------------------------------------------------------------------------------------------
void TetrahedralComplex::Write(SimplexMesh<3>& mesh) const
{
  std::vector<std::uint32_t> numbers(this->Points.size(), None);
  for (const Tetrahedron& cell : this->Cells)
  {
    if (cell.V[0] != None)
    {
      for (const std::uint32_t v : cell.V)
      {
        numbers[v] = 0;
      }
    }
  }
  mesh = SimplexMesh<3>();
  for (std::size_t v = 0; v < numbers.size(); ++v)
  {
    if (numbers[v] != None)
    {
      numbers[v] = static_cast<std::uint32_t>(mesh.Points.size());
      mesh.Points.push_back(this->Points[v]);
    }
  }
  // Facet i of a positively oriented tetrahedron, its normal outwards.
  constexpr unsigned outward[4][3] = { { 1, 2, 3 }, { 2, 0, 3 }, { 0, 1, 3 }, { 1, 0, 2 } };
  for (std::uint32_t t = 0; t < this->Cells.size(); ++t)
  {
    if (!this->IsAlive(t))
    {
      continue;
    }
    const Vertices& v = this->Cells[t].V;
    const Vertices renumbered = { numbers[v[0]], numbers[v[1]], numbers[v[2]], numbers[v[3]] };
    mesh.Simplices.push_back(renumbered);
    mesh.Labels.push_back(this->LabelValues[this->Labels[t]]);
    for (unsigned i = 0; i < 4; ++i)
    {
      const Label other = this->LabelOf(this->Cells[t].N[i]);
      if (other < this->Labels[t])
      {
        mesh.Facets.push_back(
          { renumbered[outward[i][0]], renumbered[outward[i][1]], renumbered[outward[i][2]] });
        mesh.FacetLabels.push_back(
          { this->LabelValues[this->Labels[t]], this->LabelValues[other] });
      }
    }
  }
}

} // namespace voxplex
