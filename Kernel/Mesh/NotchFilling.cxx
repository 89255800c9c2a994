// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/NotchFilling.h"

#include "Geometry/SimplexQuality.h"
#include "Mesh/VertexStar.h"
#include "Parallel/ChunkCounts.h"
#include "Parallel/ParallelFor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace voxplex
{

namespace
{

/** The steps of FillNotches(). */
class NotchFiller
{
public:
  NotchFiller(const Triangulation<3>& triangulation, const Domain<3>& domain,
    const NotchBounds& bounds, std::span<LabelId> labels, unsigned threads,
    const std::stop_token& stop)
    : Source(triangulation)
    , Image(domain)
    , Bounds(bounds)
    , DihedralSine(std::sin(bounds.DihedralAngle / DegreesPerRadian))
    , Labels(labels)
    , Threads(threads)
    , Stop(stop)
  {
  }

  std::vector<SimplexId> Run()
  {
    this->FindNotches();
    for (const Notch& notch : this->Notches)
    {
      this->Labels[notch.Id] = notch.Label;
    }
    this->TakeBack();
    std::vector<SimplexId> filled;
    for (const Notch& notch : this->Notches)
    {
      if (this->IsFilled(notch))
      {
        filled.push_back(notch.Id);
      }
    }
    return filled;
  }

private:
  static constexpr std::size_t Grain =
    64; ///< tetrahedra in notches that a thread looks at in a row

  /** How things are at the vertices and edges of a tetrahedron. */
  struct Surroundings
  {
    std::array<bool, 4> IsJunction{}; ///< whether three labels or more meet at the vertex
    std::array<unsigned, 6>
      Bad{}; ///< labels with other than two boundary facets, or none, at the edge
  };
  struct Notch
  {
    SimplexId Id;
    LabelId Label;
    Surroundings Before;
  };
  using Positions = std::array<const Point<3>*, 4>;

  bool IsFilled(const Notch& notch) const { return this->Labels[notch.Id] != 0; }

  void FindNotches()
  {
    const std::size_t ids = this->Labels.size();
    std::vector<std::vector<Notch>> found((ids + ChunkCounts::Grain - 1) / ChunkCounts::Grain);
    ParallelFor(
      0, ids, ChunkCounts::Grain, this->Threads,
      [&](std::size_t first, std::size_t last)
      {
        for (auto s = static_cast<SimplexId>(first); s < last; ++s)
        {
          const LabelId label =
            this->Labels[s] == 0 && this->Source.IsAlive(s) ? this->LabelInNotch(s) : LabelId{ 0 };
          if (label != 0)
          {
            found[first / ChunkCounts::Grain].push_back({ s, label, this->LookAround(s) });
          }
        }
      },
      this->Stop);
    for (const std::vector<Notch>& some : found)
    {
      this->Notches.insert(this->Notches.end(), some.begin(), some.end());
    }
  }

  /** 0 if it is in none, or its shape is not good enough. */
  LabelId LabelInNotch(SimplexId s) const
  {
    const Circumball<3> ball = this->Source.GetCircumball(s);
    if (!this->Image.IsBeyondCutFaces(ball.Center))
    {
      return 0;
    }
    Positions points;
    Point<3> centroid{};
    for (unsigned i = 0; i < 4; ++i)
    {
      points[i] = &this->Source.Position(this->Source.GetSimplex(s).V[i]);
      if (!this->Image.IsWithinCutFaces(*points[i]))
      {
        return 0;
      }
      for (std::size_t a = 0; a < 3; ++a)
      {
        centroid[a] += 0.25 * (*points[i])[a];
      }
    }
    const LabelId label = this->Image.Label(centroid);
    return label != 0 && this->HasGoodShape(points, ball, label) ? label : LabelId{ 0 };
  }

  bool HasGoodShape(const Positions& points, const Circumball<3>& ball, LabelId label) const
  {
    if (!(SmallestDihedralSine(points.data()) >= this->DihedralSine &&
          RadiusEdgeRatio<3>(points.data()) < this->Bounds.RadiusEdgeRatio))
    {
      return false;
    }
    const double size = this->Bounds.Size
      ? this->Bounds.Size->Evaluate(ball.Center, this->Image.LabelValue(label))
      : 0.0;
    return !(size > 0.0) || ball.Radius2 < size * size;
  }

  /** All threads look for what breaks a rule; then one at a time goes, if it still does. */
  void TakeBack()
  {
    std::vector<std::uint8_t> isSuspect(this->Notches.size());
    for (bool again = true; again;)
    {
      ParallelFor(
        0, this->Notches.size(), Grain, this->Threads,
        [&](std::size_t first, std::size_t last)
        {
          for (std::size_t k = first; k < last; ++k)
          {
            const Notch& notch = this->Notches[k];
            isSuspect[k] = this->IsFilled(notch) && !this->IsAllowed(notch) ? 1 : 0;
          }
        },
        this->Stop);
      again = false;
      for (std::size_t k = 0; k < this->Notches.size(); ++k)
      {
        if (isSuspect[k] != 0 && !this->IsAllowed(this->Notches[k]))
        {
          this->Labels[this->Notches[k].Id] = 0;
          again = true;
        }
      }
    }
  }

  bool IsAllowed(const Notch& notch) const
  {
    const Surroundings now = this->LookAround(notch.Id);
    for (std::size_t e = 0; e < now.Bad.size(); ++e)
    {
      if (now.Bad[e] > notch.Before.Bad[e])
      {
        return false;
      }
    }
    const auto& simplex = this->Source.GetSimplex(notch.Id);
    for (unsigned i = 0; i < 4; ++i)
    {
      const bool isInterface = this->LabelOrBackground(simplex.N[i]) != notch.Label;
      if ((isInterface && !this->IsGoodInterface(simplex.V, i, now)) ||
        (notch.Before.IsJunction[i] && !now.IsJunction[i] &&
          this->HasSharpFacets(simplex.V[i], notch.Id)))
      {
        return false;
      }
    }
    return true;
  }

  bool IsGoodInterface(
    const std::array<VertexId, 4>& v, unsigned facet, const Surroundings& around) const
  {
    bool isAtJunction = false;
    for (unsigned i = 0; i < 4; ++i)
    {
      if (i != facet && this->Source.GetVertex(v[i]).Kind != VertexKind::Feature)
      {
        return false;
      }
      isAtJunction = isAtJunction || (i != facet && around.IsJunction[i]);
    }
    return this->SmallestAngle(v, facet) >=
      (isAtJunction ? this->Bounds.JunctionFacetAngle : this->Bounds.FacetAngle);
  }

  double SmallestAngle(const std::array<VertexId, 4>& v, unsigned facet) const
  {
    const auto corner = [&](unsigned k) -> const Point<3>&
    { return this->Source.Position(v[(facet + k) % 4]); };
    const std::array<double, 3> angles = PlanarAngles(corner(1), corner(2), corner(3));
    return *std::min_element(angles.begin(), angles.end());
  }

  /** Whether a vertex of s has interfaces whose angles only a junction excuses. */
  bool HasSharpFacets(VertexId v, SimplexId s) const
  {
    for (const SimplexId t : StarOf(this->Source, v, s))
    {
      const auto& simplex = this->Source.GetSimplex(t);
      for (unsigned i = 0; i < 4; ++i)
      {
        if (simplex.V[i] != v && this->LabelOrBackground(simplex.N[i]) < this->Labels[t] &&
          this->SmallestAngle(simplex.V, i) < this->Bounds.FacetAngle)
        {
          return true;
        }
      }
    }
    return false;
  }

  Surroundings LookAround(SimplexId s) const
  {
    Surroundings around;
    const auto& v = this->Source.GetSimplex(s).V;
    std::vector<LabelId> labels;
    std::size_t edge = 0;
    for (unsigned i = 0; i < 4; ++i)
    {
      const std::vector<SimplexId> star = StarOf(this->Source, v[i], s);
      labels.clear();
      for (const SimplexId t : star)
      {
        if (std::find(labels.begin(), labels.end(), this->Labels[t]) == labels.end())
        {
          labels.push_back(this->Labels[t]);
        }
      }
      around.IsJunction[i] = labels.size() > 2;
      for (unsigned j = i + 1; j < 4; ++j)
      {
        around.Bad[edge++] = this->CountBad(v[i], v[j], star, labels);
      }
    }
    return around;
  }

  /** Of the labels of the star of a, background left out. */
  unsigned CountBad(
    VertexId a, VertexId b, std::span<const SimplexId> star, std::span<const LabelId> labels) const
  {
    unsigned bad = 0;
    for (const LabelId label : labels)
    {
      unsigned facets = 0;
      for (const SimplexId t : star)
      {
        const auto& simplex = this->Source.GetSimplex(t);
        if (label == 0 || this->Labels[t] != label ||
          std::find(simplex.V.begin(), simplex.V.end(), b) == simplex.V.end())
        {
          continue;
        }
        for (unsigned i = 0; i < 4; ++i)
        {
          facets +=
            simplex.V[i] != a && simplex.V[i] != b && this->LabelOrBackground(simplex.N[i]) != label
            ? 1u
            : 0u;
        }
      }
      bad += facets != 0 && facets != 2 ? 1u : 0u;
    }
    return bad;
  }

  LabelId LabelOrBackground(SimplexId s) const
  {
    return s == None ? LabelId{ 0 } : this->Labels[s];
  }

  const Triangulation<3>& Source;
  const Domain<3>& Image;
  const NotchBounds& Bounds;
  const double DihedralSine;
  const std::span<LabelId> Labels; ///< of each simplex id
  const unsigned Threads;
  const std::stop_token& Stop;
  std::vector<Notch> Notches; ///< ascending
};

} // namespace

//------------------------------------------------------------------------------------------------
std::vector<SimplexId> FillNotches(const Triangulation<3>& triangulation, const Domain<3>& domain,
  const NotchBounds& bounds, std::span<LabelId> labels, unsigned threads,
  const std::stop_token& stop)
{
  return NotchFiller(triangulation, domain, bounds, labels, threads, stop).Run();
}

} // namespace voxplex
