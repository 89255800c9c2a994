// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ChangeRules.h
 * @brief Internal to ManifoldLabels: which simplices may get another label.
 */
#ifndef voxplex_ChangeRules_h
#define voxplex_ChangeRules_h

#include "Conformity/ManifoldRepair.h"
#include "Conformity/RepairNeighbourhood.h"
#include "Geometry/SimplexQuality.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <span>
#include <vector>

namespace voxplex::repair
{

template <int D>
using Facet = std::array<VertexId, static_cast<std::size_t>(D)>;

/** The vertices of a simplex but vertex i, in cyclic order. */
template <int D>
Facet<D> FacetOf(const std::array<VertexId, static_cast<std::size_t>(D + 1)>& v, unsigned i)
{
  Facet<D> facet;
  for (unsigned k = 0; k < facet.size(); ++k)
  {
    facet[k] = v[(i + k + 1) % v.size()];
  }
  return facet;
}

/** How far a change may go. */
enum class Leeway
{
  Usual,
  WholePiece,    ///< nothing of the label need be left beside it: there is more elsewhere
  OffInterfaces, ///< vertices may come onto interfaces
};

/** @brief The rules for changes of labels, whatever they are made for. See RepairManifold(). */
template <int D>
class ChangeRules
{
public:
  /**
   * @param near, labels must outlive this object; labels, by simplex id, may change between calls
   * @param options Surfaces and Sizing must outlive this object
   */
  ChangeRules(const Neighbourhood<D>& near, std::span<const LabelId> labels,
    const ManifoldRepairOptions<D>& options)
    : Labels(labels)
    , Near(near)
    , LargestRatio(options.Shape.RadiusEdgeRatio)
    , SliverSine(std::sin(options.SliverAngle * std::numbers::pi / 180.0))
    , FacetCosine(std::cos(options.Shape.FacetAngle * std::numbers::pi / 180.0))
    , JunctionCosine(std::cos(options.Shape.JunctionFacetAngle * std::numbers::pi / 180.0))
    , Surfaces(options.Surfaces)
    , Sizing(options.Sizing)
    , Contacts(options.Contacts)
    , Keeps(options.Keeps)
  {
  }

  /**
   * Whether a change keeps the bounds of shapes and sizes, leaves some of the label beside it, and does
   * not part from the topology of the image.
   */
  bool IsAllowed(const Change& change, Leeway leeway = Leeway::Usual) const
  {
    const bool mayAddVertices = leeway == Leeway::OffInterfaces;
    bool leavesSome = leeway == Leeway::WholePiece;
    for (const SimplexId t : change.Cells)
    {
      if (this->IsTooLarge(t, change.Label) || this->IsPoor(t, change.Label) ||
        (this->Keeps && this->Keeps(t)))
      {
        return false;
      }
      const LabelId own = this->Labels[t];
      for (const VertexId v : this->Near.VerticesOf(t))
      {
        if (!mayAddVertices && !this->Near.IsOnInterface(v))
        {
          return false;
        }
        if (!leavesSome)
        {
          const std::vector<SimplexId>& star = this->Near.StarOf(v);
          leavesSome = std::any_of(star.begin(), star.end(),
            [&](SimplexId other) { return this->Labels[other] == own && !change.Touches(other); });
        }
      }
      for (unsigned i = 0; i <= D; ++i)
      {
        if (change.Label == 0 && this->Near.Beside(t, i) == None)
        {
          return false;
        }
        const bool isNew = this->Near.LabelBeside(t, i) == own &&
          !change.Touches(this->Near.Beside(t, i)); // the facet becomes an interface facet
        if (isNew && !this->HasGoodAngles(t, i, change))
        {
          return false;
        }
      }
    }
    return leavesSome && !this->UncoversSharpFacet(change) && this->KeepsTopology(change);
  }

  /**
   * Whether a change drops a tetrahedron with a facet on a flat face where the image cuts the
   * object.
   */
  bool Dents(const Change& change) const
  {
    const ImageBorder<D>* const border = this->Surfaces ? this->Surfaces->Border() : nullptr;
    if (!border || change.Label != 0)
    {
      return false;
    }
    for (const SimplexId t : change.Cells)
    {
      for (unsigned i = 0; i <= D; ++i)
      {
        unsigned faces = ~0u;
        for (const VertexId v : this->FacetOf(t, i))
        {
          faces &= border->FacesAt(this->Near.Position(v));
        }
        if (faces != 0)
        {
          return true;
        }
      }
    }
    return false;
  }

  /** Whether facet i of a simplex may be of an interface after a change; in 4D all may. */
  bool HasGoodAngles(SimplexId t, unsigned i, const Change& change) const
  {
    const Sharpness sharpness = this->SharpnessOf(t, i);
    return sharpness == Sharpness::Anywhere ||
      (sharpness == Sharpness::AtJunctionsOnly && this->HasJunction(t, i, change));
  }

private:
  Facet<D> FacetOf(SimplexId t, unsigned i) const
  {
    return repair::FacetOf<D>(this->Near.VerticesOf(t), i);
  }

  /**
   * Whether a change takes a junction away from an interface facet whose angles are allowed at
   * junctions only.
   */
  bool UncoversSharpFacet(const Change& change) const
  {
    if constexpr (D != 3)
    {
      return false;
    }
    for (const SimplexId t : change.Cells)
    {
      for (const VertexId v : this->Near.VerticesOf(t))
      {
        if (!this->IsAtJunction(v, nullptr) || this->IsAtJunction(v, &change))
        {
          continue;
        }
        for (const SimplexId s : this->Near.StarOf(v))
        {
          for (unsigned i = 0; i <= D; ++i)
          {
            const SimplexId beside = this->Near.Beside(s, i);
            const LabelId other =
              beside == None ? LabelId{ 0 } : this->Near.LabelOf(beside, &change);
            if (this->Near.VerticesOf(s)[i] != v && other < this->Near.LabelOf(s, &change) &&
              this->SharpnessOf(s, i) == Sharpness::AtJunctionsOnly &&
              !this->HasJunction(s, i, change))
            {
              return true;
            }
          }
        }
      }
    }
    return false;
  }

  /**
   * Whether a facet separates labels that do not touch near it in the image.
   * @param label of the simplex t; `beside` is that of the one beside facet i
   */
  bool IsFalseContact(SimplexId t, unsigned i, LabelId label, LabelId beside) const
  {
    return label != beside &&
      !this->Contacts->TouchNear(this->Near.Points(this->FacetOf(t, i)), label, beside);
  }

  /**
   * Whether a change neither makes a contact that the image does not have, nor cuts what it connects,
   * nor joins what it does not connect (the last two in 3D). Only the stars of the changed simplices are looked at.
   */
  bool KeepsTopology(const Change& change) const
  {
    if (!this->Contacts)
    {
      return true;
    }
    // The simplices beside the change that have its label, or one that it takes away.
    std::map<LabelId, std::vector<SimplexId>> beside;
    for (const SimplexId t : change.Cells)
    {
      const LabelId own = this->Labels[t];
      for (unsigned i = 0; i <= D; ++i)
      {
        const SimplexId n = this->Near.Beside(t, i);
        if (change.Touches(n))
        {
          continue;
        }
        const LabelId other = this->Near.LabelBeside(t, i);
        if (this->IsFalseContact(t, i, change.Label, other) &&
          !this->IsFalseContact(t, i, own, other))
        {
          return false;
        }
        if (n != None && (other == change.Label || other == own))
        {
          beside[other].push_back(n);
        }
      }
    }
    // In 4D this would leave more triangles to be opened, whose pieces have worse shapes.
    return D == 4 ||
      std::all_of(beside.begin(), beside.end(),
        [&](const auto& some) { return this->AgreesWithImage(change, some.second); });
  }

  /**
   * Whether the image connects some simplices of one label beside a change, if the change connects
   * them, and otherwise does not connect those that the change separates.
   */
  bool AgreesWithImage(const Change& change, const std::vector<SimplexId>& some) const
  {
    if (some.size() < 2)
    {
      return true;
    }
    std::vector<VertexId> vertices;
    for (const SimplexId t : change.Cells)
    {
      const auto& v = this->Near.VerticesOf(t);
      vertices.insert(vertices.end(), v.begin(), v.end());
    }
    const LabelId label = this->Labels[some.front()];
    const auto isAround = [&](SimplexId s)
    {
      const auto& v = this->Near.VerticesOf(s);
      return this->Labels[s] == label && !change.Touches(s) &&
        std::find_first_of(v.begin(), v.end(), vertices.begin(), vertices.end()) != v.end();
    };
    std::vector<SimplexId> apart = some; // one may be beside two cells
    std::vector<SimplexId> reached{ some.front() };
    std::erase(apart, some.front());
    for (std::size_t k = 0; k < reached.size() && !apart.empty(); ++k)
    {
      for (unsigned i = 0; i <= D; ++i)
      {
        const SimplexId next = this->Near.Beside(reached[k], i);
        if (next != None && isAround(next) &&
          std::find(reached.begin(), reached.end(), next) == reached.end())
        {
          reached.push_back(next);
          std::erase(apart, next);
        }
      }
    }
    this->Near.See(vertices);
    return std::all_of(apart.begin(), apart.end(),
      [&](SimplexId s)
      {
        return this->Contacts->AreConnected(this->CentroidOf(some.front()), this->CentroidOf(s),
                 label) == (label == change.Label);
      });
  }

  Point<D> CentroidOf(SimplexId t) const
  {
    return Centroid(this->Near.Points(this->Near.VerticesOf(t)));
  }

  /** Whether a tetrahedron is larger than the elements of a label may be. */
  bool IsTooLarge(SimplexId t, LabelId label) const
  {
    return this->Sizing && label != 0 &&
      !this->Sizing->IsSmallEnough(this->Near.Circumball(t), label);
  }

  /** Whether a simplex would become an element of a bad shape. Those of a label have good ones. */
  bool IsPoor(SimplexId t, LabelId label) const
  {
    if (label == 0 || this->Labels[t] != 0)
    {
      return false;
    }
    const auto points = this->Near.Points(this->Near.VerticesOf(t));
    if constexpr (D == 3)
    {
      if (SmallestDihedralSine(points.data()) < this->SliverSine)
      {
        return true;
      }
    }
    return RadiusEdgeRatio<D>(points.data(), this->Near.Circumball(t).Radius2) > this->LargestRatio;
  }

  /** Where a facet with these angles may be; anywhere in 4D. */
  enum class Sharpness
  {
    Anywhere,
    AtJunctionsOnly,
    Nowhere
  };
  Sharpness SharpnessOf(SimplexId t, unsigned i) const
  {
    if constexpr (D != 3)
    {
      return Sharpness::Anywhere;
    }
    const Facet<D> facet = this->FacetOf(t, i);
    Sharpness sharpness = Sharpness::Anywhere;
    for (unsigned k = 0; k < 3; ++k)
    {
      const Point<D>& p = this->Near.Position(facet[k]);
      const Point<D> a = Subtract(this->Near.Position(facet[(k + 1) % 3]), p);
      const Point<D> b = Subtract(this->Near.Position(facet[(k + 2) % 3]), p);
      const double lengths = std::sqrt(Dot(a, a) * Dot(b, b));
      if (Dot(a, b) > this->JunctionCosine * lengths)
      {
        return Sharpness::Nowhere;
      }
      sharpness = Dot(a, b) > this->FacetCosine * lengths ? Sharpness::AtJunctionsOnly : sharpness;
    }
    return sharpness;
  }

  /** Whether a vertex of a facet is at a junction after a change. */
  bool HasJunction(SimplexId t, unsigned i, const Change& change) const
  {
    const Facet<D> facet = this->FacetOf(t, i);
    return std::any_of(
      facet.begin(), facet.end(), [&](VertexId v) { return this->IsAtJunction(v, &change); });
  }

  /** Whether three or more labels, including background, meet at a vertex. */
  bool IsAtJunction(VertexId v, const Change* change) const
  {
    std::array<LabelId, 2> known{};
    unsigned count = 0;
    for (const SimplexId t : this->Near.StarOf(v))
    {
      const LabelId label = this->Near.LabelOf(t, change);
      if (std::find(known.begin(), known.begin() + count, label) == known.begin() + count)
      {
        if (count == known.size())
        {
          return true;
        }
        known[count++] = label;
      }
    }
    return false;
  }

  const std::span<const LabelId> Labels;
  const Neighbourhood<D>& Near;
  const double LargestRatio;
  const double SliverSine;
  const double FacetCosine;
  const double JunctionCosine; ///< at least FacetCosine
  const Domain<D>* const Surfaces;
  const SizingField<D>* const Sizing;
  const LabelContacts<D>* const Contacts; ///< null: topology is not looked at
  const std::function<bool(SimplexId)> Keeps;
};

} // namespace voxplex::repair

#endif
