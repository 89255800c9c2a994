// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Compares who touches whom in a mesh and in its image, and asks that the statistics tell each difference.
#include "Checks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace voxplex::stress
{

namespace
{

template <int D>
using Index = typename Volume<D>::Index;

constexpr double VoxelsBeyond = 3.0;

/** Numbers, each in a set of its own at first. */
class Sets
{
public:
  explicit Sets(std::size_t size)
    : Parent(size)
  {
    std::iota(this->Parent.begin(), this->Parent.end(), std::size_t{ 0 });
  }

  std::size_t Find(std::size_t i)
  {
    while (this->Parent[i] != i)
    {
      i = this->Parent[i] = this->Parent[this->Parent[i]];
    }
    return i;
  }

  void Join(std::size_t i, std::size_t j) { this->Parent[this->Find(i)] = this->Find(j); }

private:
  std::vector<std::size_t> Parent;
};

/** Calls visit(index, number of differing axes) for all voxels that share a corner with one, and may lie outside. */
template <int D, typename Visit>
void ForEachAround(const Index<D>& voxel, const Visit& visit)
{
  constexpr int All = D == 3 ? 27 : 81;
  for (int k = 0; k < All; ++k)
  {
    Index<D> other = voxel;
    int axes = 0;
    for (int rest = k, a = 0; a < D; ++a, rest /= 3)
    {
      other[static_cast<std::size_t>(a)] += rest % 3 - 1;
      axes += rest % 3 != 1;
    }
    if (axes > 0)
    {
      visit(other, axes);
    }
  }
}

/** Sets of voxels of one label that are connected through faces, or also through edges and corners. */
template <int D>
Sets ComponentsOf(const Volume<D>& image, bool throughCorners)
{
  Sets components(image.Size());
  image.ForEach(
    [&](const Index<D>& voxel, std::size_t i)
    {
      ForEachAround<D>(voxel,
        [&](const Index<D>& other, int axes)
        {
          if ((axes == 1 || throughCorners) && image.Contains(other) &&
            image.LabelAt(other) == image.Labels[i])
          {
            components.Join(i, image.At(other));
          }
        });
    });
  return components;
}

/** Sets of simplices of one label that are connected through facets. */
template <int D>
Sets PiecesOf(const SimplexMesh<D>& mesh)
{
  using Facet = std::array<std::uint32_t, static_cast<std::size_t>(D)>;
  Sets pieces(mesh.Simplices.size());
  std::map<Facet, std::size_t> first;
  for (std::size_t s = 0; s < mesh.Simplices.size(); ++s)
  {
    for (std::size_t without = 0; without <= D; ++without)
    {
      Facet facet{};
      for (std::size_t k = 0, n = 0; k <= D; ++k)
      {
        if (k != without)
        {
          facet[n++] = mesh.Simplices[s][k];
        }
      }
      std::sort(facet.begin(), facet.end());
      const auto [entry, isNew] = first.emplace(facet, s);
      if (!isNew && mesh.Labels[entry->second] == mesh.Labels[s])
      {
        pieces.Join(s, entry->second);
      }
    }
  }
  return pieces;
}

template <int D>
Index<D> NearestVoxel(const Volume<D>& image, const Vector<D>& p)
{
  const Vector<D> at = image.ToIndex(p);
  Index<D> voxel;
  for (std::size_t a = 0; a < voxel.size(); ++a)
  {
    voxel[a] = std::lround(at[a]);
  }
  return voxel;
}

/** Components in several pieces are listed, and so are pieces with the bulk of two that do not even share a corner. */
template <int D>
void CheckPieces(const Subject<D>& subject, Findings& findings)
{
  const Volume<D>& image = subject.Of.Image;
  const ComponentStatistics& stats = subject.Stats.Components;
  const auto smallest = static_cast<double>(subject.Of.Options.Components.Smallest);
  Sets components = ComponentsOf(image, false);
  Sets wider = ComponentsOf(image, true);
  std::map<std::size_t, double> voxels;
  for (std::size_t i = 0; i < image.Size(); ++i)
  {
    voxels[components.Find(i)] += 1.0;
  }
  Sets pieces = PiecesOf(subject.Mesh);
  std::map<std::size_t, std::map<std::size_t, double>> shares; // by piece and component, in voxels
  for (std::size_t s = 0; s < subject.Mesh.Simplices.size(); ++s)
  {
    Vector<D> centroid{};
    for (const Vector<D>& corner : subject.Corners(s))
    {
      for (std::size_t a = 0; a < centroid.size(); ++a)
      {
        centroid[a] += corner[a] / (D + 1);
      }
    }
    const Index<D> voxel = NearestVoxel(image, centroid);
    if (image.Contains(voxel) && image.LabelAt(voxel) == subject.Mesh.Labels[s])
    {
      shares[pieces.Find(s)][components.Find(image.At(voxel))] +=
        static_cast<double>(VolumeOf<D>(subject.Corners(s))) / image.VoxelVolume();
    }
  }
  std::map<std::size_t, int> numbers; // of pieces, by component
  for (const auto& [piece, parts] : shares)
  {
    const auto largest = std::max_element(
      parts.begin(), parts.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
    ++numbers[largest->first];
    std::set<std::size_t> held;
    for (const auto& [component, volume] : parts)
    {
      const double size = voxels[component];
      if (size >= smallest && volume > 0.51 * std::min(size, 64.0))
      {
        held.insert(wider.Find(component));
      }
    }
    const auto label = subject.Mesh.Labels[piece];
    const bool isTold = std::any_of(stats.United.begin(), stats.United.end(),
      [&](const UnitedComponents& united) { return united.Component.Label == label; });
    if (held.size() > 1 && !isTold)
    {
      findings.Add(
        "united", "a piece unites components of label " + std::to_string(label) + ", silently");
    }
  }
  std::set<std::size_t> told;
  for (const BrokenComponent& broken : stats.Broken)
  {
    Index<D> voxel{};
    std::copy_n(broken.Component.Voxel.begin(), voxel.size(), voxel.begin());
    told.insert(components.Find(image.At(voxel)));
  }
  for (const auto& [component, number] : numbers)
  {
    if (number > 1 && voxels[component] >= smallest && !told.contains(component))
    {
      findings.Add("broken",
        "a component of " + std::to_string(voxels[component]) + " voxels of label " +
          std::to_string(image.Labels[component]) + " is in " + std::to_string(number) +
          " pieces, silently");
    }
  }
}

/**
 * Interfaces between labels that share no corner near them are listed. Near is farther than for the kernel: as far from
 * the centroid of a facet as its vertices, and three voxels more.
 */
template <int D>
void CheckContacts(const Subject<D>& subject, Findings& findings)
{
  const Volume<D>& image = subject.Of.Image;
  using Pair = std::pair<std::int64_t, std::int64_t>; // the larger first
  std::map<Pair, std::vector<Index<D>>> places;
  image.ForEach(
    [&](const Index<D>& voxel, std::size_t i)
    {
      std::set<std::int64_t> beside;
      ForEachAround<D>(
        voxel, [&](const Index<D>& other, int) { beside.insert(image.LabelAt(other)); });
      for (const std::int64_t other : beside)
      {
        if (image.Labels[i] != other)
        {
          places[std::minmax<std::int64_t>(image.Labels[i], other)].push_back(voxel);
        }
      }
    });
  std::set<Pair> told;
  for (const FalseContact& contact : subject.Stats.Components.Contacts)
  {
    told.insert(std::minmax(contact.Labels[0], contact.Labels[1]));
  }
  for (std::size_t f = 0; f < subject.Mesh.Facets.size(); ++f)
  {
    const auto& labels = subject.Mesh.FacetLabels[f];
    const Pair pair = std::minmax(labels[0], labels[1]);
    Vector<D> centroid{};
    for (const std::uint32_t v : subject.Mesh.Facets[f])
    {
      for (std::size_t a = 0; a < centroid.size(); ++a)
      {
        centroid[a] += subject.Mesh.Points[v][a] / D;
      }
    }
    double reach = 0.0;
    for (const std::uint32_t v : subject.Mesh.Facets[f])
    {
      double square = 0.0;
      for (std::size_t a = 0; a < centroid.size(); ++a)
      {
        square +=
          (subject.Mesh.Points[v][a] - centroid[a]) * (subject.Mesh.Points[v][a] - centroid[a]);
      }
      reach = std::max(reach, std::sqrt(square));
    }
    reach += VoxelsBeyond * image.LargestSpacing();
    const Vector<D> at = image.ToIndex(centroid);
    const auto isNear = [&](const Index<D>& voxel)
    {
      bool near = true;
      for (std::size_t a = 0; a < voxel.size(); ++a)
      {
        near =
          near && std::abs(static_cast<double>(voxel[a]) - at[a]) < reach / image.LayerDistance(a);
      }
      return near;
    };
    const auto& of = places[pair];
    if (!told.contains(pair) && std::none_of(of.begin(), of.end(), isNear))
    {
      told.insert(pair);
      findings.Add("contact",
        "labels " + std::to_string(pair.first) + " and " + std::to_string(pair.second) +
          " touch where they do not in the image, silently");
    }
  }
}

} // namespace

//------------------------------------------------------------------------------------------------
template <int D>
void CheckTopology(const Subject<D>& subject, Findings& findings)
{
  const Volume<D>& image = subject.Of.Image;
  const bool knowsLabels = !image.Surface || image.Surface->SmoothingSigma == 0.0;
  if (subject.Of.Options.Components.Smallest > 0 && knowsLabels)
  {
    CheckPieces(subject, findings);
    CheckContacts(subject, findings);
  }
}

template void CheckTopology<3>(const Subject<3>&, Findings&);
template void CheckTopology<4>(const Subject<4>&, Findings&);

} // namespace voxplex::stress
