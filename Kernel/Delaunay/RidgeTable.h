// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file RidgeTable.h
 * @brief Finds the pairs of faces of new simplices that coincide.
 *
 * Vertices are identified by their small numbers within the operation (VertexRecord::Local). So
 * keys are exact: two different faces never have the same key.
 */
#ifndef voxplex_RidgeTable_h
#define voxplex_RidgeTable_h

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace voxplex
{

/**
 * @brief Pairs equal sets of K vertex numbers (K at most 4). Each set may be given at most twice.
 *
 * A hash table with open addressing. Entries have stamps, so clearing the table costs nothing. Not
 * thread-safe: each worker has its own table.
 */
template <unsigned K>
class FaceTable
{
public:
  static constexpr std::uint32_t Nothing = 0xffffffffu;
  /** Vertex numbers must be below this. */
  static constexpr std::uint32_t MostVertices = 1u << 21;
  using Face = std::array<std::uint32_t, K>;

  /**
   * Clears the table, and makes room for n distinct sets. If more come, Match() allocates memory.
   */
  void Begin(std::size_t n)
  {
    const std::size_t wanted = std::bit_ceil(std::max<std::size_t>(64, 2 * n + 1));
    if (wanted > this->Entries.size())
    {
      this->Entries.assign(wanted, RidgeEntry{});
      this->Stamp = 0;
    }
    this->Count = 0;
    if (++this->Stamp == 0)
    {
      std::fill(this->Entries.begin(), this->Entries.end(), RidgeEntry{});
      this->Stamp = 1;
    }
  }

  /**
   * If the set was given before, takes it out and returns its payload. Otherwise stores the set
   * with this payload and returns Nothing. A set that was taken out must not be given again.
   */
  std::uint32_t Match(Face face, std::uint32_t payload)
  {
    if (2 * this->Count >= this->Entries.size())
    {
      this->Enlarge();
    }
    const Key key = MakeKey(face);
    RidgeEntry& e = this->Find(key);
    if (e.Stamp == this->Stamp)
    {
      const std::uint32_t other = e.Payload;
      e.Payload = Nothing;
      return other;
    }
    e = RidgeEntry{ key, this->Stamp, payload };
    ++this->Count;
    return Nothing;
  }

private:
  /** Up to three vertex numbers per word, the smallest first. */
  using Key = std::array<std::uint64_t, (K + 2) / 3>;
  struct RidgeEntry
  {
    Key Set{};
    std::uint32_t Stamp = 0;
    std::uint32_t Payload = Nothing;
  };

  static Key MakeKey(Face face)
  {
    // Insertion sort by exchanges without branches, since the comparisons are unpredictable.
    for (unsigned i = 1; i < K; ++i)
    {
      for (unsigned j = i; j > 0; --j)
      {
        const std::uint32_t low = std::min(face[j - 1], face[j]);
        face[j] = std::max(face[j - 1], face[j]);
        face[j - 1] = low;
      }
    }
    Key key{};
    for (unsigned i = 0; i < K; ++i)
    {
      key[i / 3] |= std::uint64_t{ face[i] } << (21 * (i % 3));
    }
    return key;
  }

  RidgeEntry& Find(const Key& key)
  {
    const std::size_t mask = this->Entries.size() - 1;
    std::uint64_t h = key[0] * 0x9e3779b97f4a7c15ull;
    if constexpr (K > 3)
    {
      h += key[1] * 0xc2b2ae3d27d4eb4full;
    }
    std::size_t i = (h ^ (h >> 32)) & mask;
    while (this->Entries[i].Stamp == this->Stamp && this->Entries[i].Set != key)
    {
      i = (i + 1) & mask;
    }
    return this->Entries[i];
  }

  void Enlarge()
  {
    std::vector<RidgeEntry> old(2 * this->Entries.size());
    old.swap(this->Entries);
    const std::uint32_t stamp = this->Stamp;
    for (const RidgeEntry& e : old)
    {
      if (e.Stamp == stamp)
      {
        this->Find(e.Set) = e;
      }
    }
  }

  std::vector<RidgeEntry> Entries;
  std::uint32_t Stamp = 0;
  std::size_t Count = 0;
};

/** Facets of a front, with D vertices each. */
template <int D>
using FacetTable = FaceTable<static_cast<unsigned>(D)>;

/** Ridges of a cavity: sets of D-1 vertices that two boundary facets share. */
template <int D>
using RidgeTable = FaceTable<static_cast<unsigned>(D - 1)>;

/**
 * @brief Ridges of a cavity in 3D: a square table of directed edges, without a search or a branch.
 *
 * Two neighbouring facets of an oriented surface have opposite directions along their common edge.
 * Each facet stores its simplex under its three directed edges, and finds its neighbours under the
 * reversed edges. On a closed surface, every entry that is read has been written. So the table is
 * cleared only if the cavity has a rim at the box.
 */
class EdgeTable
{
public:
  static constexpr std::uint32_t Nothing = 0xffffffffu;
  /** The table is for cavities with at most this number of vertices. Nearly all have fewer. */
  static constexpr std::size_t MostVertices = 64;

  /** @param closed true if the cavity has no rim */
  void Begin(std::size_t vertices, bool closed)
  {
    this->Side = vertices;
    if (!closed)
    {
      std::fill_n(this->Cells.begin(), vertices * vertices, Nothing);
    }
  }
  void Store(std::uint32_t from, std::uint32_t to, std::uint32_t payload)
  {
    this->Cells[from * this->Side + to] = payload;
  }
  /** The payload of the edge in this direction; Nothing on a rim. */
  std::uint32_t Find(std::uint32_t from, std::uint32_t to) const
  {
    return this->Cells[from * this->Side + to];
  }

private:
  std::size_t Side = 0;
  std::array<std::uint32_t, MostVertices * MostVertices> Cells{};
};

} // namespace voxplex

#endif
