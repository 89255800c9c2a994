// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file RidgeTable.h
 * @brief Finds which two faces of new simplices coincide.
 *
 * Vertices are named by their small numbers within the operation (VertexRecord::Local), so keys are
 * exact: no face is ever taken for another.
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
 * @brief Pairs equal sets of K vertex numbers (K at most 4); each set may be offered at most twice.
 *
 * Open addressing with stamps: starting over costs nothing. Not safe for concurrent use: one per
 * worker.
 */
template <unsigned K>
class FaceTable
{
public:
  static constexpr std::uint32_t Nothing = 0xffffffffu;
  /** Vertex numbers must be below this. */
  static constexpr std::uint32_t MostVertices = 1u << 21;
  using Face = std::array<std::uint32_t, K>;

  /** Forgets all and makes room for n distinct sets: Match() allocates only if there are more. */
  void Begin(std::size_t n)
  {
    const std::size_t wanted = std::bit_ceil(std::max<std::size_t>(64, 2 * n + 1));
    if (wanted > this->Entries.size())
    {
      this->Entries.assign(wanted, Entry{});
      this->Stamp = 0;
    }
    this->Count = 0;
    if (++this->Stamp == 0)
    {
      std::fill(this->Entries.begin(), this->Entries.end(), Entry{});
      this->Stamp = 1;
    }
  }

  /**
   * The payload under which the set was offered before, which is taken out; else remembers this one
   * and returns Nothing. A set that was taken out must not be offered again.
   */
  std::uint32_t Match(Face face, std::uint32_t payload)
  {
    if (2 * this->Count >= this->Entries.size())
    {
      this->Enlarge();
    }
    const Key key = MakeKey(face);
    Entry& e = this->Find(key);
    if (e.Stamp == this->Stamp)
    {
      const std::uint32_t other = e.Payload;
      e.Payload = Nothing;
      return other;
    }
    e = Entry{ key, this->Stamp, payload };
    ++this->Count;
    return Nothing;
  }

  /** True if the set is waiting for its partner. */
  bool IsOpen(const Face& face)
  {
    const Entry& e = this->Find(MakeKey(face));
    return e.Stamp == this->Stamp && e.Payload != Nothing;
  }

private:
  /** Up to three numbers in a word, the smallest first. */
  using Key = std::array<std::uint64_t, (K + 2) / 3>;
  struct Entry
  {
    Key Set{};
    std::uint32_t Stamp = 0;
    std::uint32_t Payload = Nothing;
  };

  static Key MakeKey(Face face)
  {
    // Insertion sort by exchanges without branches: which number is larger cannot be predicted.
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

  Entry& Find(const Key& key)
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
    std::vector<Entry> old(2 * this->Entries.size());
    old.swap(this->Entries);
    const std::uint32_t stamp = this->Stamp;
    for (const Entry& e : old)
    {
      if (e.Stamp == stamp)
      {
        this->Find(e.Set) = e;
      }
    }
  }

  std::vector<Entry> Entries;
  std::uint32_t Stamp = 0;
  std::size_t Count = 0;
};

/** Facets of a front: D vertices each. */
template <int D>
using FacetTable = FaceTable<static_cast<unsigned>(D)>;

/** Ridges of a cavity: the D-1 vertices that two of its boundary facets share. */
template <int D>
using RidgeTable = FaceTable<static_cast<unsigned>(D - 1)>;

/**
 * @brief Ridges of a cavity in 3D: directed edges in a square table, without a search or a branch.
 *
 * Two neighbouring facets of an oriented surface run through their common edge in opposite
 * directions: each facet stores its number under its three directed edges and finds its neighbours
 * under the reversed ones. On a closed surface every entry that is read was written, so nothing need
 * be cleared; the rim of a cavity at the box is the exception.
 */
class EdgeTable
{
public:
  static constexpr std::uint32_t Nothing = 0xffffffffu;
  /** Most vertices of a cavity for which the table is made; nearly all have fewer. */
  static constexpr std::size_t MostVertices = 64;

  /** @param closed whether the cavity has no rim */
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
  /** What was stored for the edge in this direction; Nothing on a rim. */
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
