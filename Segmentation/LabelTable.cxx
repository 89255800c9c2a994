// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "LabelTable.h"

#include "ShownText.h"

#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkIntArray.h>
#include <vtkLongLongArray.h>
#include <vtkNew.h>
#include <vtkSmartPointer.h>
#include <vtkStringArray.h>
#include <vtkUnsignedCharArray.h>
#include <vtkVariant.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace voxplex
{
namespace
{

constexpr const char* ValuesName = "LabelValues";
constexpr const char* NamesName = "LabelNames";
constexpr const char* ColorsName = "LabelColors";

template <typename TArray>
vtkSmartPointer<vtkDataArray> MakeValues(const LabelTable& table)
{
  const auto values = vtkSmartPointer<TArray>::New();
  for (const auto& [label, entry] : table.Entries)
  {
    values->InsertNextValue(static_cast<typename TArray::ValueType>(label));
  }
  return values;
}

bool IsColored(const std::pair<const std::int64_t, LabelTable::Entry>& row)
{
  return row.second.Color.has_value();
}

} // namespace

const std::string& LabelTable::NameOf(std::int64_t label) const
{
  static const std::string none;
  const auto row = this->Entries.find(label);
  return row == this->Entries.end() ? none : row->second.Name;
}

std::map<std::int64_t, std::string> LabelTable::Names() const
{
  std::map<std::int64_t, std::string> names;
  for (const auto& [label, entry] : this->Entries)
  {
    names[label] = entry.Name;
  }
  return names;
}

std::vector<std::string> TextsOf(vtkFieldData* fields, const char* name)
{
  std::vector<std::string> texts;
  vtkAbstractArray* array = fields->GetAbstractArray(name);
  if (auto* strings = vtkStringArray::SafeDownCast(array))
  {
    for (vtkIdType i = 0; i < strings->GetNumberOfValues(); ++i)
    {
      texts.push_back(strings->GetValue(i));
    }
  }
  else if (auto* bytes = vtkUnsignedCharArray::SafeDownCast(array))
  {
    const unsigned char* begin = bytes->GetPointer(0);
    const unsigned char* const end = begin + bytes->GetNumberOfValues();
    for (const auto* zero = std::find(begin, end, 0); zero != end; zero = std::find(begin, end, 0))
    {
      texts.emplace_back(begin, zero);
      begin = zero + 1;
    }
  }
  return texts;
}

LabelTable GetLabelTable(vtkFieldData* fields)
{
  vtkDataArray* values = fields->GetArray(ValuesName);
  const std::vector<std::string> names = TextsOf(fields, NamesName);
  vtkDataArray* colors = fields->GetArray(ColorsName);
  LabelTable table;
  if (!values || static_cast<vtkIdType>(names.size()) != values->GetNumberOfValues())
  {
    return table;
  }
  const bool hasColors = colors && colors->GetNumberOfComponents() == 3 &&
    colors->GetNumberOfTuples() == values->GetNumberOfValues();
  for (vtkIdType i = 0; i < values->GetNumberOfValues(); ++i)
  {
    // vtkVariant keeps all 64 bits of a label.
    const auto label = static_cast<std::int64_t>(values->GetVariantValue(i).ToTypeInt64());
    const std::string& name = names[static_cast<std::size_t>(i)];
    if (label <= 0 || name.empty())
    {
      continue;
    }
    LabelTable::Entry& entry = table.Entries[label];
    entry.Name = name;
    if (hasColors)
    {
      std::array<double, 3> color;
      colors->GetTuple(i, color.data());
      if (std::isfinite(color[0] + color[1] + color[2]))
      {
        entry.Color = color;
      }
    }
  }
  return table;
}

void SetLabelTable(vtkFieldData* fields, const LabelTable& table)
{
  for (const char* name : { ValuesName, NamesName, ColorsName })
  {
    fields->RemoveArray(name);
  }
  if (table.Entries.empty())
  {
    return;
  }
  const bool isWide = table.Entries.rbegin()->first > std::numeric_limits<int>::max();
  const auto values = isWide ? MakeValues<vtkLongLongArray>(table) : MakeValues<vtkIntArray>(table);
  values->SetName(ValuesName);
  vtkNew<vtkStringArray> names;
  names->SetName(NamesName);
  vtkNew<vtkDoubleArray> colors;
  colors->SetName(ColorsName);
  colors->SetNumberOfComponents(3);
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  for (const auto& [label, entry] : table.Entries)
  {
    names->InsertNextValue(entry.Name);
    colors->InsertNextTuple(entry.Color.value_or(std::array<double, 3>{ nan, nan, nan }).data());
  }
  fields->AddArray(values);
  fields->AddArray(names);
  if (std::any_of(table.Entries.begin(), table.Entries.end(), IsColored))
  {
    fields->AddArray(colors);
  }
}

void LeaveOutOtherTexts(LabelTable& table, std::vector<std::string>& warnings)
{
  std::erase_if(table.Entries,
    [&warnings](const auto& row)
    {
      constexpr char escape = '\x1b'; // ISO 2022 changes the character set with it
      const bool isText =
        IsUTF8(row.second.Name) && row.second.Name.find(escape) == std::string::npos;
      if (!isText)
      {
        warnings.push_back(
          "the name of label " + std::to_string(row.first) + " is not in UTF-8, and is not used");
      }
      return !isText;
    });
}

} // namespace voxplex
