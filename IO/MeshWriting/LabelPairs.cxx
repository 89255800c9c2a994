// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "LabelPairs.h"

#include "FileError.h"

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDataSetAttributes.h>
#include <vtkUnstructuredGrid.h>
#include <vtkVariant.h>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

namespace voxplex::io
{

vtkDataArray* RequireArray(vtkDataSetAttributes* attributes, const char* name)
{
  vtkDataArray* array = attributes->GetArray(name);
  if (!array)
  {
    throw std::logic_error(std::string("the mesh has no array '") + name + "'");
  }
  return array;
}

/** vtkVariant keeps all 64 bits of a label, GetTuple() only 53. */
std::int64_t AnyLabelAt(vtkDataArray* labels, vtkIdType cell, int component)
{
  return labels->GetVariantValue(cell * labels->GetNumberOfComponents() + component).ToTypeInt64();
}

std::int64_t LabelAt(vtkDataArray* labels, vtkIdType cell, int component)
{
  const std::int64_t label = AnyLabelAt(labels, cell, component);
  RefuseIf(!std::in_range<std::int32_t>(label), "label ", label,
    " does not fit into this format, which has 32 bits for it; write a .vtu file");
  return label;
}

std::vector<SidedPair> SidedPairsOf(
  vtkUnstructuredGrid* boundary, std::int64_t (*labelAt)(vtkDataArray*, vtkIdType, int))
{
  vtkDataArray* const labels = RequireArray(boundary->GetCellData(), "Labels");
  vtkDataArray* const sides = boundary->GetCellData()->GetArray("Side");
  std::vector<SidedPair> pairs;
  for (vtkIdType cell = 0; cell < boundary->GetNumberOfCells(); ++cell)
  {
    const double side = sides ? sides->GetComponent(cell, 0) : 0.0;
    pairs.push_back({ side == 1.0 || side == 2.0 ? static_cast<int>(side) : 0,
      { labelAt(labels, cell, 0), labelAt(labels, cell, 1) } });
  }
  return pairs;
}

std::map<LabelPair, std::int64_t> NumberPairs(
  const std::set<LabelPair>& pairs, std::int64_t largestLabel)
{
  std::map<LabelPair, std::int64_t> numbers;
  std::int64_t next = largestLabel + 1;
  for (const LabelPair& pair : pairs)
  {
    numbers[pair] = pair.second == 0 ? pair.first : next++;
  }
  return numbers;
}

std::map<SidedPair, std::int64_t> NumberSidedPairs(
  const std::set<SidedPair>& pairs, std::int64_t largestLabel)
{
  std::set<LabelPair> lateral;
  for (const auto& [side, pair] : pairs)
  {
    if (side == 0)
    {
      lateral.insert(pair);
    }
  }
  std::map<SidedPair, std::int64_t> numbers;
  std::int64_t next = largestLabel + 1;
  for (const auto& [pair, number] : NumberPairs(lateral, largestLabel))
  {
    numbers[{ 0, pair }] = number;
    next = std::max(next, number + 1);
  }
  for (const SidedPair& pair : pairs)
  {
    if (pair.first != 0)
    {
      numbers[pair] = next++;
    }
  }
  return numbers;
}

} // namespace voxplex::io
