// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file RidgeRepair.h
 * @brief Internal to ManifoldRepair: the best change of labels around a bad interface ridge.
 */
#ifndef voxplex_RidgeRepair_h
#define voxplex_RidgeRepair_h

#include "Conformity/ChangeRules.h"
#include "Conformity/OrderedChanges.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <numbers>
#include <optional>
#include <set>
#include <span>
#include <utility>
#include <vector>

namespace voxplex::repair
{

/** A ridge, and a simplex that has it. */
template <int D>
struct CellRidge
{
  Ridge<D> Vertices;
  SimplexId Cell;
};

/** @brief Finds changes that leave fewer bad ridges. Each thread needs its own. */
template <int D>
class RidgeRepair
{
public:
  /** @param labels by simplex id; they may change between calls */
  RidgeRepair(const Triangulation<D>& triangulation, std::span<const LabelId> labels,
    const ManifoldRepairOptions<D>& options)
    : Labels(labels)
    , Near(triangulation, labels)
    , Rules(this->Near, labels, options)
  {
  }

  RidgeRepair(const RidgeRepair&) = delete; // Rules refer to Near
  RidgeRepair& operator=(const RidgeRepair&) = delete;

  /** The best change around a ridge. */
  Proposal Propose(const Ridge<D>& ridge) const
  {
    this->Near.ForgetSeen();
    const std::vector<SimplexId> star = this->Near.StarOf(ridge);
    Proposal proposal;
    if (this->Near.RingOf(ridge, star.front()).Now.Bad != 0)
    {
      proposal.Best = this->BestOf(this->ChangesAt(star));
    }
    proposal.Seen = this->Near.Seen();
    for (const SimplexId t : star)
    {
      const auto& v = this->Near.VerticesOf(t);
      proposal.Seen.insert(proposal.Seen.end(), v.begin(), v.end());
    }
    return proposal;
  }

  /**
   * The bad ridges now, in the order of their vertices. Only ridges that were bad before, and ridges
   * of changed simplices, need to be checked.
   * @param before the bad ridges before any change
   * @param relabelled the changed simplices
   */
  std::vector<InterfaceRidge<D>> FindLeft(
    const std::vector<InterfaceRidge<D>>& before, const std::vector<SimplexId>& relabelled) const
  {
    std::vector<InterfaceRidge<D>> left;
    const std::vector<CellRidge<D>> changed = this->RidgesOf(relabelled);
    for (const InterfaceRidge<D>& ridge : before)
    {
      const auto at = std::lower_bound(changed.begin(), changed.end(), ridge.Vertices,
        [](const CellRidge<D>& r, const Ridge<D>& vertices) { return r.Vertices < vertices; });
      if (at == changed.end() || at->Vertices != ridge.Vertices)
      {
        left.push_back(ridge);
      }
    }
    for (const CellRidge<D>& ridge : changed)
    {
      const auto state = this->Near.RingOf(ridge.Vertices, ridge.Cell).Now;
      if (state.Bad > 0)
      {
        left.push_back({ ridge.Vertices, state.IsJunction });
      }
    }
    std::sort(left.begin(), left.end(),
      [](const auto& a, const auto& b) { return a.Vertices < b.Vertices; });
    return left;
  }

private:
  using Rings = std::vector<typename Neighbourhood<D>::Ring>;
  static constexpr std::size_t UsualRings = 32; ///< around a ridge, in 3D

  std::optional<Change> BestOf(std::vector<Change> changes) const
  {
    Rings rings;
    rings.reserve(UsualRings);
    std::optional<Change> best;
    bool bestDents = true;
    int bestGain = 0;
    double bestVolume = 0.0;
    for (Change& change : changes)
    {
      const int gain = this->GainOf(change, rings);
      const double volume = this->Near.VolumeOf(change.Cells);
      const bool dents = this->Rules.Dents(change);
      const bool isBetter = dents != bestDents ? bestDents
        : gain != bestGain                     ? gain > bestGain
                                               : volume < bestVolume;
      if (gain > 0 && isBetter && this->Rules.IsAllowed(change))
      {
        bestDents = dents;
        bestGain = gain;
        bestVolume = volume;
        best = std::move(change);
      }
    }
    return best;
  }

  /**
   * All candidate changes: each simplex around a ridge, and each run of a label, gets a label
   * beside it.
   * @param star the simplices around it, ascending
   */
  std::vector<Change> ChangesAt(const std::vector<SimplexId>& star) const
  {
    std::vector<std::vector<SimplexId>> groups;
    std::set<SimplexId> grouped;
    for (const SimplexId t : star)
    {
      if (this->Labels[t] == 0) // is not in the mesh
      {
        continue;
      }
      groups.push_back({ t });
      if (!grouped.insert(t).second)
      {
        continue;
      }
      std::vector<SimplexId> run{ t };
      for (std::size_t k = 0; k < run.size(); ++k)
      {
        for (unsigned i = 0; i <= D; ++i)
        {
          const SimplexId other = this->Near.Beside(run[k], i);
          if (std::binary_search(star.begin(), star.end(), other) &&
            this->Labels[other] == this->Labels[t] && grouped.insert(other).second)
          {
            run.push_back(other);
          }
        }
      }
      if (run.size() > 1)
      {
        groups.push_back(std::move(run));
      }
    }
    std::vector<Change> changes;
    for (const std::vector<SimplexId>& group : groups)
    {
      std::set<LabelId> labels;
      for (const SimplexId t : group)
      {
        for (unsigned i = 0; i <= D; ++i)
        {
          labels.insert(this->Near.LabelBeside(t, i));
        }
      }
      labels.erase(this->Labels[group.front()]);
      for (const LabelId label : labels)
      {
        changes.push_back({ group, label });
      }
    }
    return changes;
  }

  /** The ridges of some simplices, ascending. */
  template <typename Cells>
  std::vector<CellRidge<D>> RidgesOf(const Cells& cells) const
  {
    std::vector<CellRidge<D>> ridges;
    for (const SimplexId t : cells)
    {
      auto v = this->Near.VerticesOf(t);
      std::sort(v.begin(), v.end());
      for (unsigned i = 0; i <= D; ++i)
      {
        for (unsigned j = 0; j < i; ++j)
        {
          CellRidge<D>& ridge = ridges.emplace_back();
          ridge.Cell = t;
          std::size_t n = 0;
          for (unsigned k = 0; k <= D; ++k)
          {
            if (k != i && k != j)
            {
              ridge.Vertices[n++] = v[k];
            }
          }
        }
      }
    }
    std::sort(ridges.begin(), ridges.end(),
      [](const CellRidge<D>& a, const CellRidge<D>& b) { return a.Vertices < b.Vertices; });
    ridges.erase(
      std::unique(ridges.begin(), ridges.end(),
        [](const CellRidge<D>& a, const CellRidge<D>& b) { return a.Vertices == b.Vertices; }),
      ridges.end());
    return ridges;
  }

  /**
   * Neighbourhood::GainAt(), summed over all ridges.
   * @param rings those that are known; more are added
   */
  int GainOf(const Change& change, Rings& rings) const
  {
    int gain = 0;
    for (const CellRidge<D>& ridge : this->RidgesOf(change.Cells))
    {
      auto ring = rings.begin();
      while (ring != rings.end() && !IsSame(ring->Vertices, ridge.Vertices))
      {
        ++ring;
      }
      if (ring == rings.end())
      {
        ring = rings.insert(ring, this->Near.RingOf(ridge.Vertices, ridge.Cell));
      }
      gain += Neighbourhood<D>::GainAt(*ring, change);
    }
    return gain;
  }

  /** The operator of std::array compiles to a call of memcmp(), which is slower for two or three ids. */
  static bool IsSame(const Ridge<D>& a, const Ridge<D>& b)
  {
    bool isSame = true;
    for (std::size_t k = 0; k < a.size(); ++k)
    {
      isSame = isSame && a[k] == b[k];
    }
    return isSame;
  }

  const std::span<const LabelId> Labels; ///< by simplex id
  const Neighbourhood<D> Near;
  const ChangeRules<D> Rules;
};

} // namespace voxplex::repair

#endif
