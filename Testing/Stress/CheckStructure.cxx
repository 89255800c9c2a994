// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Arrays, orientation, conformity, the Delaunay property.
#include "Checks.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

namespace voxplex::stress
{

namespace
{

/** Number of sample points that are tested against all simplices of a mesh. */
constexpr std::size_t OverlapSamples = 24;

/** A facet of one simplex. */
template <int D>
struct Side
{
  std::array<std::uint32_t, static_cast<std::size_t>(D)> Vertices; ///< sorted
  std::uint32_t Simplex;
  std::uint32_t Opposite;
  bool IsOdd; ///< parity of Vertices relative to the outward order

  bool operator<(const Side& other) const { return this->Vertices < other.Vertices; }
};

/** Sorts vertices. @return whether the permutation is odd */
template <std::size_t N>
bool SortWithParity(std::array<std::uint32_t, N>& vertices)
{
  bool odd = false;
  for (std::size_t i = 1; i < N; ++i)
  {
    for (std::size_t j = i; j > 0 && vertices[j] < vertices[j - 1]; --j)
    {
      std::swap(vertices[j], vertices[j - 1]);
      odd = !odd;
    }
  }
  return odd;
}

template <int D>
std::vector<Side<D>> SidesOf(const SimplexMesh<D>& mesh)
{
  std::vector<Side<D>> sides;
  sides.reserve(mesh.Simplices.size() * static_cast<std::size_t>(D + 1));
  for (std::size_t s = 0; s < mesh.Simplices.size(); ++s)
  {
    for (std::size_t i = 0; i <= static_cast<std::size_t>(D); ++i)
    {
      Side<D> side;
      side.Simplex = static_cast<std::uint32_t>(s);
      side.Opposite = mesh.Simplices[s][i];
      for (std::size_t j = 0, to = 0; j <= static_cast<std::size_t>(D); ++j)
      {
        if (j != i)
        {
          side.Vertices[to++] = mesh.Simplices[s][j];
        }
      }
      side.IsOdd = SortWithParity(side.Vertices) != (i % 2 == 1);
      sides.push_back(side);
    }
  }
  std::sort(sides.begin(), sides.end());
  return sides;
}

/** A facet between labels, in a comparable form. */
template <int D>
struct Face
{
  std::array<std::uint32_t, static_cast<std::size_t>(D)> Vertices; ///< sorted
  std::array<std::int64_t, 2> Labels;
  bool IsOdd; ///< parity relative to the order that points out of the first label

  auto operator<=>(const Face&) const = default;
};

std::string Place(std::size_t simplex)
{
  return "simplex " + std::to_string(simplex);
}

} // namespace

//------------------------------------------------------------------------------------------------
template <int D>
bool CheckArrays(const Subject<D>& subject, Findings& findings)
{
  const SimplexMesh<D>& mesh = subject.Mesh;
  if (mesh.Labels.size() != mesh.Simplices.size() || mesh.FacetLabels.size() != mesh.Facets.size())
  {
    findings.Add("arrays", "as many labels as elements are needed");
    return false;
  }
  const std::vector<std::int32_t> labels = subject.Of.Image.LabelValues();
  std::vector<char> used(mesh.Points.size(), 0);
  for (std::size_t s = 0; s < mesh.Simplices.size(); ++s)
  {
    for (const std::uint32_t v : mesh.Simplices[s])
    {
      if (v >= mesh.Points.size())
      {
        findings.Add("arrays", Place(s) + " has a vertex that does not exist");
        return false;
      }
      used[v] = 1;
    }
    if (!std::binary_search(labels.begin(), labels.end(), mesh.Labels[s]))
    {
      findings.Add("label",
        Place(s) + " has label " + std::to_string(mesh.Labels[s]) + ", which the image has not");
    }
  }
  for (const auto& facet : mesh.Facets)
  {
    for (const std::uint32_t v : facet)
    {
      if (v >= mesh.Points.size())
      {
        findings.Add("arrays", "a facet has a vertex that does not exist");
        return false;
      }
    }
  }
  for (std::size_t v = 0; v < mesh.Points.size(); ++v)
  {
    const Vector<D>& p = mesh.Points[v];
    if (!std::all_of(p.begin(), p.end(), [](double x) { return std::isfinite(x); }))
    {
      findings.Add("not-finite", "point " + std::to_string(v));
      return false;
    }
    if (!used[v])
    {
      findings.Add("unused-point", "point " + std::to_string(v));
    }
  }
  std::vector<Vector<D>> points(mesh.Points.begin(), mesh.Points.end());
  std::sort(points.begin(), points.end());
  if (std::adjacent_find(points.begin(), points.end()) != points.end())
  {
    findings.Add("duplicate-point", "two points have the same coordinates");
  }
  return true;
}

//------------------------------------------------------------------------------------------------
template <int D>
void CheckOrientation(const Subject<D>& subject, Findings& findings)
{
  for (std::size_t s = 0; s < subject.Mesh.Simplices.size(); ++s)
  {
    const int sign = Orientation<D>(subject.Corners(s));
    if (sign <= 0)
    {
      findings.Add("orientation", Place(s) + (sign == 0 ? " is flat" : " is inverted"));
    }
  }
}

//------------------------------------------------------------------------------------------------
namespace
{

/** Both simplices of a facet. */
template <int D>
void CheckPair(const Subject<D>& subject, const Side<D>& a, const Side<D>& b, bool isDelaunay,
  Findings& findings)
{
  if (a.IsOdd == b.IsOdd)
  {
    findings.Add("conforming",
      "simplices " + std::to_string(a.Simplex) + " and " + std::to_string(b.Simplex) +
        " are on the same side of their facet");
  }
  if (isDelaunay && InSphere<D>(subject.Corners(a.Simplex), subject.Mesh.Points[b.Opposite]) > 0)
  {
    findings.Add("delaunay",
      "the vertex of simplex " + std::to_string(b.Simplex) + " is in the ball of simplex " +
        std::to_string(a.Simplex));
  }
}

/** The facet between labels that two sides with the same vertices make. */
template <int D>
Face<D> FaceOf(const SimplexMesh<D>& mesh, const Side<D>& a, const Side<D>* b)
{
  const std::int64_t own = mesh.Labels[a.Simplex];
  const std::int64_t other = b ? mesh.Labels[b->Simplex] : 0;
  return own > other ? Face<D>{ a.Vertices, { own, other }, a.IsOdd }
                     : Face<D>{ a.Vertices, { other, own }, b->IsOdd };
}

template <int D>
void CheckFacets(const SimplexMesh<D>& mesh, std::vector<Face<D>>& expected, Findings& findings)
{
  std::vector<Face<D>> given;
  for (std::size_t f = 0; f < mesh.Facets.size(); ++f)
  {
    Face<D> face{ mesh.Facets[f], mesh.FacetLabels[f], false };
    face.IsOdd = SortWithParity(face.Vertices);
    given.push_back(face);
  }
  std::sort(given.begin(), given.end());
  std::sort(expected.begin(), expected.end());
  if (given == expected)
  {
    return;
  }
  const auto strip = [](std::vector<Face<D>> faces, bool labels)
  {
    for (Face<D>& f : faces)
    {
      f.IsOdd = false;
      f.Labels = labels ? f.Labels : std::array<std::int64_t, 2>{};
    }
    return faces;
  };
  findings.Add("facets",
    strip(given, false) != strip(expected, false) ? std::to_string(given.size()) +
        " facets are listed, and " + std::to_string(expected.size()) + " are between labels"
      : strip(given, true) != strip(expected, true)
      ? "facets have labels that their elements have not"
      : "facets are oriented the wrong way round");
}

template <int D>
bool IsInside(
  const std::array<Vector<D>, static_cast<std::size_t>(D + 1)>& corners, const Vector<D>& p)
{
  for (std::size_t a = 0; a < p.size(); ++a)
  {
    const auto [low, high] = std::minmax_element(corners.begin(), corners.end(),
      [a](const Vector<D>& one, const Vector<D>& other) { return one[a] < other[a]; });
    if (!((*low)[a] < p[a] && p[a] < (*high)[a]))
    {
      return false;
    }
  }
  for (std::size_t i = 0; i < corners.size(); ++i)
  {
    auto replaced = corners;
    replaced[i] = p;
    if (Orientation<D>(replaced) <= 0)
    {
      return false;
    }
  }
  return true;
}

/**
 * The centroids of sample simplices lie in no other simplex. Rounding may put the centroid of a
 * flat one outside.
 */
template <int D>
void CheckOverlap(const Subject<D>& subject, Findings& findings)
{
  const SimplexMesh<D>& mesh = subject.Mesh;
  const std::size_t step = std::max<std::size_t>(1, mesh.Simplices.size() / OverlapSamples);
  for (std::size_t s = step / 2; s < mesh.Simplices.size(); s += step)
  {
    const auto own = subject.Corners(s);
    Vector<D> centroid{};
    for (const Vector<D>& corner : own)
    {
      for (std::size_t a = 0; a < centroid.size(); ++a)
      {
        centroid[a] += corner[a] / (D + 1);
      }
    }
    if (!IsInside<D>(own, centroid))
    {
      continue;
    }
    for (std::size_t t = 0; t < mesh.Simplices.size(); ++t)
    {
      if (t != s && IsInside<D>(subject.Corners(t), centroid))
      {
        findings.Add("overlap", Place(s) + " and " + Place(t));
      }
    }
  }
}

} // namespace

//------------------------------------------------------------------------------------------------
template <int D>
void CheckConformity(const Subject<D>& subject, Findings& findings)
{
  const SimplexMesh<D>& mesh = subject.Mesh;
  const MeshingOptions<D>& options = subject.Of.Options;
  const bool hasMoved = options.Optimisation.Run || subject.IsFitted();
  const bool isDelaunay = !hasMoved && subject.Stats.Interfaces.NonManifoldOpened == 0;
  // Each slab is Delaunay, their union is not.
  const std::vector<double> planes = subject.PlaneTimes();
  const std::vector<Side<D>> sides = SidesOf(mesh);
  std::vector<Face<D>> expected;
  for (std::size_t i = 0; i < sides.size();)
  {
    std::size_t end = i + 1;
    while (end < sides.size() && sides[end].Vertices == sides[i].Vertices)
    {
      ++end;
    }
    if (end - i > 2)
    {
      findings.Add("conforming", std::to_string(end - i) + " simplices have one facet");
    }
    else if (end - i == 2)
    {
      CheckPair(subject, sides[i], sides[i + 1],
        isDelaunay && OnOnePlane<D>(subject, planes, sides[i].Vertices) < D, findings);
    }
    const Side<D>* other = end - i > 1 ? &sides[i + 1] : nullptr;
    if (!other || mesh.Labels[sides[i].Simplex] != mesh.Labels[other->Simplex])
    {
      expected.push_back(FaceOf(mesh, sides[i], other));
    }
    i = end;
  }
  CheckFacets(mesh, expected, findings);
  CheckOverlap(subject, findings);
}

template bool CheckArrays<3>(const Subject<3>&, Findings&);
template bool CheckArrays<4>(const Subject<4>&, Findings&);
template void CheckOrientation<3>(const Subject<3>&, Findings&);
template void CheckOrientation<4>(const Subject<4>&, Findings&);
template void CheckConformity<3>(const Subject<3>&, Findings&);
template void CheckConformity<4>(const Subject<4>&, Findings&);

} // namespace voxplex::stress
