// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "SpaceTimeSurfaces.h"

#include "LabelPairs.h"
#include "LabelTable.h"
#include "SetNames.h"

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkStringArray.h>
#include <vtkTypeInt64Array.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace voxplex::io
{
namespace
{

/** By pair and side. */
std::map<SidedPair, std::string> NamesOf(const std::set<SidedPair>& sided, const LabelTable& table)
{
  std::set<LabelPair> pairs;
  for (const auto& [side, pair] : sided)
  {
    pairs.insert(pair);
  }
  SetNames sets({}, pairs, table, QuotedNames);
  constexpr std::array<const char*, 3> ends{ "", "__initial", "__final" };
  std::map<SidedPair, std::string> names;
  for (const SidedPair& one : sided)
  {
    const auto& [side, pair] = one;
    const std::string end = ends.at(static_cast<std::size_t>(side));
    names[one] = side == 0
      ? sets.OfPair(pair)
      : sets.MakeUnique(sets.OfPair(pair) + end,
          "_" + std::to_string(pair.first) + "_" + std::to_string(pair.second) + end);
  }
  return names;
}

} // namespace

vtkSmartPointer<vtkUnstructuredGrid> WithSurfaces(vtkUnstructuredGrid* boundary)
{
  vtkDataArray* const labels = boundary->GetCellData()->GetArray("Labels");
  vtkDataArray* const sides = boundary->GetCellData()->GetArray("Side");
  const vtkIdType cells = boundary->GetNumberOfCells();
  const bool isOurs = labels && labels->GetNumberOfComponents() == 2 &&
    labels->GetNumberOfTuples() == cells && (!sides || sides->GetNumberOfValues() == cells);
  if (!isOurs)
  {
    return boundary;
  }
  const std::vector<SidedPair> pairs = SidedPairsOf(boundary, AnyLabelAt);
  const std::set<SidedPair> all(pairs.begin(), pairs.end());
  std::int64_t largest = 0; // every label has a boundary
  for (const auto& [side, pair] : all)
  {
    largest = std::max(largest, pair.first);
  }
  const std::map<SidedPair, std::int64_t> numbers = NumberSidedPairs(all, largest);
  const std::map<SidedPair, std::string> names =
    NamesOf(all, GetLabelTable(boundary->GetFieldData()));

  vtkNew<vtkTypeInt64Array> surfaces;
  surfaces->SetName("Surface");
  for (const SidedPair& pair : pairs)
  {
    surfaces->InsertNextValue(numbers.at(pair));
  }
  std::map<std::int64_t, std::string> nameOfNumber;
  for (const auto& [pair, number] : numbers)
  {
    nameOfNumber[number] = names.at(pair);
  }
  vtkNew<vtkTypeInt64Array> listed;
  listed->SetName("SurfaceNumbers");
  vtkNew<vtkStringArray> texts;
  texts->SetName("SurfaceNames");
  for (const auto& [number, name] : nameOfNumber)
  {
    listed->InsertNextValue(number);
    texts->InsertNextValue(name);
  }
  auto result = vtkSmartPointer<vtkUnstructuredGrid>::New();
  result->ShallowCopy(boundary);
  result->GetCellData()->AddArray(surfaces);
  vtkNew<vtkFieldData> fields;
  fields->ShallowCopy(boundary->GetFieldData());
  fields->AddArray(listed);
  fields->AddArray(texts);
  result->SetFieldData(fields);
  return result;
}

} // namespace voxplex::io
