// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Complexes and meshes, each made from the other, and from triangulations.
#ifndef voxplex_ComplexOf_h
#define voxplex_ComplexOf_h

#include "Domain/ImageDomain.h"
#include "Mesh/MeshElements.h"
#include "Mesh/SimplexLabels.h"
#include "Optimisation/Complex.h"
#include "Optimisation/Pentatopes/PentatopeOptimiser.h"
#include "Optimisation/Tetrahedra/MeshOptimiser.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <stop_token>
#include <utility>
#include <vector>

namespace voxplex::checks
{

/** The values of label ids: those of a domain, or their own. */
template <int D>
class LabelValues
{
public:
  /** @param domain null: each label is its own value */
  LabelValues(const SimplexMesh<D>& mesh, const Domain<D>* domain)
    : Image(dynamic_cast<const ImageDomain<D>*>(domain))
  {
    for (const std::int64_t value : mesh.Labels)
    {
      LabelId id = static_cast<LabelId>(value);
      if (this->Image)
      {
        id = LabelIdOf(value, this->Image->GetImage());
      }
      else if (domain)
      {
        for (LabelId known = 1; known < 10; ++known)
        {
          id = domain->LabelValue(known) == value ? known : id;
        }
      }
      this->Ids[value] = id;
      this->Values.resize(std::max<std::size_t>(this->Values.size(), id + 1));
      this->Values[id] = value;
    }
  }

  std::map<std::int64_t, LabelId> Ids;
  std::vector<std::int64_t> Values{ 0 };

private:
  const ImageDomain<D>* Image;
};

/** Neighbours are found by the vertices of facets. @param domain see LabelValues */
template <int D>
Complex<D> ComplexOf(const SimplexMesh<D>& mesh, const Domain<D>* domain = nullptr)
{
  UninitialisedVector<Cell<D>> cells(mesh.Simplices.size());
  UninitialisedVector<LabelId> labels;
  const LabelValues<D> values(mesh, domain);
  std::map<typename Complex<D>::Facet, std::pair<std::uint32_t, unsigned>> open;
  for (std::uint32_t t = 0; t < cells.size(); ++t)
  {
    cells[t].V = mesh.Simplices[t];
    cells[t].N.fill(None);
    labels.push_back(values.Ids.at(mesh.Labels[t]));
    for (unsigned i = 0; i <= D; ++i)
    {
      const auto [other, isNew] = open.insert({ Complex<D>::SortedFacet(cells[t].V, i), { t, i } });
      if (!isNew)
      {
        cells[t].N[i] = other->second.first;
        cells[other->second.first].N[other->second.second] = t;
        open.erase(other);
      }
    }
  }
  Complex<D> complex(mesh.Points, std::move(cells), std::move(labels));
  complex.Twins.resize(mesh.Twins.empty() ? 0 : mesh.Points.size(), None);
  for (const auto& [first, last] : mesh.Twins)
  {
    complex.Twins[first] = last;
    complex.Twins[last] = first;
  }
  return complex;
}

/** The same, with scores and kinds. */
inline TetrahedralComplex ComplexOf(
  const SimplexMesh<3>& mesh, const ShapeScore& score, const Domain<3>* domain = nullptr)
{
  TetrahedralComplex complex = ComplexOf<3>(mesh, domain);
  complex.Shape = score;
  complex.FindKinds();
  complex.ScoreCells();
  return complex;
}

inline PentatopeComplex ScoredComplexOf(const SimplexMesh<4>& mesh)
{
  PentatopeComplex complex = ComplexOf<4>(mesh);
  complex.FindKinds();
  complex.ScoreCells();
  return complex;
}

/** Labels are their own values. */
template <int D>
SimplexMesh<D> Written(Complex<D> complex)
{
  std::vector<std::int64_t> values(1, 0);
  for (std::uint32_t t = 0; t < complex.Cells.size(); ++t)
  {
    while (complex.IsAlive(t) && values.size() <= complex.Labels[t])
    {
      values.push_back(static_cast<std::int64_t>(values.size()));
    }
  }
  SimplexMesh<D> mesh;
  complex.Compact(false);
  complex.Write(values, mesh);
  return mesh;
}

/** Changes a mesh as a complex. */
template <int D, typename Function>
auto ChangeMesh(SimplexMesh<D>& mesh, const Domain<D>& domain, const Function& function,
  unsigned threads, const std::stop_token& stop)
{
  const LabelValues<D> values(mesh, &domain);
  Complex<D> complex = ComplexOf<D>(mesh, &domain);
  const auto result = function(complex);
  complex.Compact(false, threads, stop);
  complex.Write(values.Values, mesh, threads, stop);
  return result;
}

inline OptimisationStatistics OptimiseMesh(SimplexMesh<3>& mesh, const Domain<3>& domain,
  const OptimisationOptions& options, unsigned threads = 1, const std::stop_token& stop = {})
{
  return ChangeMesh<3>(
    mesh, domain,
    [&](TetrahedralComplex& complex)
    { return voxplex::OptimiseMesh(complex, domain, options, threads, stop); },
    threads, stop);
}

inline PentatopeStatistics OptimisePentatopes(SimplexMesh<4>& mesh, const Domain<4>& domain,
  const LabelImage<4>& image, const PentatopeBounds& bounds, unsigned threads = 1,
  const std::stop_token& stop = {})
{
  return ChangeMesh<4>(
    mesh, domain,
    [&](PentatopeComplex& complex)
    { return voxplex::OptimisePentatopes(complex, domain, image, bounds, threads, stop); },
    threads, stop);
}

/** The values that a domain gives to the label ids that are in use. */
template <int D>
std::vector<std::int64_t> ValuesOf(const Domain<D>& domain, const SimplexLabels& labels)
{
  std::vector<std::int64_t> values(1, 0);
  const LabelId largest = labels.empty() ? 0 : *std::max_element(labels.begin(), labels.end());
  for (LabelId label = 1; label <= largest; ++label)
  {
    values.push_back(domain.LabelValue(label));
  }
  return values;
}

/** The mesh of a labelled triangulation as it is. */
template <int D>
void ExtractMesh(const Triangulation<D>& triangulation, const Domain<D>& domain,
  const SimplexLabels& labels, SimplexMesh<D>& mesh, unsigned threads = 1,
  const std::stop_token& stop = {})
{
  mesh = SimplexMesh<D>();
  UninitialisedVector<std::uint32_t> numbers;
  Complex<D> complex(triangulation, labels, {}, numbers, threads, stop);
  complex.Compact(false, threads, stop);
  complex.Write(ValuesOf(domain, labels), mesh, threads, stop);
}

template <int D>
void ExtractMesh(const Triangulation<D>& triangulation, const Domain<D>& domain,
  SimplexMesh<D>& mesh, unsigned threads = 1, const std::stop_token& stop = {})
{
  mesh = SimplexMesh<D>();
  ExtractMesh<D>(triangulation, domain, LabelSimplices(triangulation, domain, threads, stop), mesh,
    threads, stop);
}

/** A strip of tetrahedra along a helix: tetrahedron t has the vertices t to t + 3. */
inline TetrahedralComplex Strip(std::uint32_t length)
{
  SimplexMesh<3> mesh;
  for (std::uint32_t v = 0; v < length + 3; ++v)
  {
    const double angle = 2.3 * v;
    mesh.Points.push_back({ std::cos(angle), std::sin(angle), 0.3 * v });
  }
  for (std::uint32_t t = 0; t < length; ++t)
  {
    mesh.Simplices.push_back({ t, t + 1, t + 2, t + 3 });
    mesh.Labels.push_back(1);
  }
  return ComplexOf<3>(mesh);
}

} // namespace voxplex::checks

#endif
