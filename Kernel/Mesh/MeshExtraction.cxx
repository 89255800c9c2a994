// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/MeshExtraction.h"

#include "Mesh/HilbertOrder.h"

#include <algorithm>
#include <utility>

namespace voxplex
{

namespace
{

/** The three steps of an extraction and what they hand on. */
template <int D>
class Extraction
{
public:
  Extraction(const Triangulation<D>& triangulation, const Domain<D>& image, SimplexMesh<D>& mesh)
    : Source(triangulation)
    , Image(image)
    , Mesh(mesh)
  {
  }

  void Run()
  {
    this->Mesh = SimplexMesh<D>();
    this->LabelSimplices();
    this->NumberPoints();
    this->CollectSimplices();
    this->CollectFacets();
  }

private:
  static constexpr unsigned N = D + 1;
  using Facet = std::array<std::uint32_t, static_cast<std::size_t>(D)>;

  /** Labels of all simplices, those of the object in Inside. */
  void LabelSimplices()
  {
    const SimplexId end = this->Source.SimplexIdEnd();
    this->Labels.assign(end, 0);
    for (SimplexId s = 0; s < end; ++s)
    {
      if (!this->Source.IsAlive(s))
      {
        continue;
      }
      const SimplexState& state = this->Source.State(s);
      this->Labels[s] =
        state.Labelled ? state.Label : this->Image.Label(this->Source.GetCircumball(s).Center);
      if (this->Labels[s] != 0)
      {
        this->Inside.push_back(s);
      }
    }
  }

  void NumberPoints()
  {
    this->Numbers.assign(this->Source.VertexIdEnd(), None);
    std::vector<std::pair<std::uint64_t, VertexId>> order;
    for (const SimplexId s : this->Inside)
    {
      for (const VertexId v : this->Source.GetSimplex(s).V)
      {
        if (this->Numbers[v] == None)
        {
          this->Numbers[v] = 0;
          order.push_back({ HilbertIndex<D>(this->Source.Position(v), this->Source.GetBox()), v });
        }
      }
    }
    std::sort(order.begin(), order.end());
    this->Mesh.Points.reserve(order.size());
    for (const auto& [index, v] : order)
    {
      this->Numbers[v] = static_cast<std::uint32_t>(this->Mesh.Points.size());
      this->Mesh.Points.push_back(this->Source.Position(v));
    }
  }

  /** Simplices in the order of their smallest point: a counting sort. */
  void CollectSimplices()
  {
    std::vector<std::uint32_t> first(this->Mesh.Points.size() + 1, 0);
    for (const SimplexId s : this->Inside)
    {
      ++first[this->SmallestPoint(s) + 1];
    }
    for (std::size_t i = 1; i < first.size(); ++i)
    {
      first[i] += first[i - 1];
    }
    std::vector<SimplexId> sorted(this->Inside.size());
    for (const SimplexId s : this->Inside)
    {
      sorted[first[this->SmallestPoint(s)]++] = s;
    }
    this->Inside.swap(sorted);

    this->Mesh.Simplices.resize(this->Inside.size());
    this->Mesh.Labels.resize(this->Inside.size());
    for (std::size_t k = 0; k < this->Inside.size(); ++k)
    {
      const SimplexId s = this->Inside[k];
      for (unsigned i = 0; i < N; ++i)
      {
        this->Mesh.Simplices[k][i] = this->Numbers[this->Source.GetSimplex(s).V[i]];
      }
      this->Mesh.Labels[k] = this->Image.LabelValue(this->Labels[s]);
    }
  }

  /** Each facet between two labels once, from the side of the larger one. */
  void CollectFacets()
  {
    for (std::size_t k = 0; k < this->Inside.size(); ++k)
    {
      const SimplexId s = this->Inside[k];
      for (unsigned i = 0; i < N; ++i)
      {
        const SimplexId n = this->Source.GetSimplex(s).N[i];
        const LabelId other = n == None ? LabelId(0) : this->Labels[n];
        if (other >= this->Labels[s])
        {
          continue; // ids ascend with the image's values
        }
        this->Mesh.Facets.push_back(OutwardFacet(this->Mesh.Simplices[k], i));
        this->Mesh.FacetLabels.push_back({ this->Mesh.Labels[k], this->Image.LabelValue(other) });
      }
    }
  }

  std::uint32_t SmallestPoint(SimplexId s) const
  {
    std::uint32_t smallest = None;
    for (const VertexId v : this->Source.GetSimplex(s).V)
    {
      smallest = std::min(smallest, this->Numbers[v]);
    }
    return smallest;
  }

  /** Facet i of a positively oriented simplex; in 3D its right-hand normal points outwards. */
  static Facet OutwardFacet(const std::array<std::uint32_t, N>& simplex, unsigned i)
  {
    Facet facet;
    unsigned m = 0;
    for (unsigned j = 0; j < N; ++j)
    {
      if (j != i)
      {
        facet[m++] = simplex[j];
      }
    }
    if (i % 2 == 1)
    {
      std::swap(facet[0], facet[1]);
    }
    return facet;
  }

  const Triangulation<D>& Source;
  const Domain<D>& Image;
  SimplexMesh<D>& Mesh;
  std::vector<LabelId> Labels;
  std::vector<SimplexId> Inside;
  std::vector<std::uint32_t> Numbers;
};

} // namespace

//------------------------------------------------------------------------------------------------
template <int D>
void ExtractMesh(
  const Triangulation<D>& triangulation, const Domain<D>& image, SimplexMesh<D>& mesh)
{
  Extraction<D>(triangulation, image, mesh).Run();
}

template void ExtractMesh<3>(const Triangulation<3>&, const Domain<3>&, SimplexMesh<3>&);
template void ExtractMesh<4>(const Triangulation<4>&, const Domain<4>&, SimplexMesh<4>&);

} // namespace voxplex
