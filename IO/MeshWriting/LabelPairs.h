// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file LabelPairs.h
 * @brief The labels of a mesh's arrays, and numbers for the pairs that interfaces have.
 */
#ifndef voxplex_io_LabelPairs_h
#define voxplex_io_LabelPairs_h

#include <cstdint>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include <vtkType.h>

class vtkDataArray;
class vtkDataSetAttributes;
class vtkUnstructuredGrid;

namespace voxplex::io
{

using LabelPair = std::pair<std::int64_t, std::int64_t>; ///< larger label first, 0 for background

/** An array that the filters promise; a program error if it is missing. */
vtkDataArray* RequireArray(vtkDataSetAttributes* attributes, const char* name);

/** With all 64 bits. */
std::int64_t AnyLabelAt(vtkDataArray* labels, vtkIdType cell, int component = 0);

/** @throws FileError if the label does not fit into 31 bits */
std::int64_t LabelAt(vtkDataArray* labels, vtkIdType cell, int component = 0);

/**
 * A number for each pair of labels: that of the label where the other side is background; pairs of
 * two labels are numbered in increasing order from the largest label + 1 on.
 */
std::map<LabelPair, std::int64_t> NumberPairs(
  const std::set<LabelPair>& pairs, std::int64_t largestLabel);

/**
 * The side of a boundary tetrahedron, and its pair. 0 is lateral, 1 at the first time, 2 at the last, and 2 + k on
 * the time plane k, which are counted from 1; both labels are the same there.
 */
using SidedPair = std::pair<int, LabelPair>;

/** Of each cell of a boundary, by its arrays Labels and Side, which may be missing. @param labelAt of those above */
std::vector<SidedPair> SidedPairsOf(
  vtkUnstructuredGrid* boundary, std::int64_t (*labelAt)(vtkDataArray*, vtkIdType, int));

/** The keys of a map. */
template <typename TKey, typename TValue>
std::set<TKey> KeysOf(const std::map<TKey, TValue>& map)
{
  std::set<TKey> keys;
  for (const auto& [key, value] : map)
  {
    keys.insert(key);
  }
  return keys;
}

/**
 * A number for each pair of labels and side: those of NumberPairs() for lateral ones. Those at the
 * first time follow, then those at the last, and those on planes.
 */
std::map<SidedPair, std::int64_t> NumberSidedPairs(
  const std::set<SidedPair>& pairs, std::int64_t largestLabel);

} // namespace voxplex::io

#endif
