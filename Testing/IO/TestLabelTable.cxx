// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Names and colours of labels to field data and back, and field data that somebody else has made.

#include "LabelTable.h"

#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkStringArray.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>

using voxplex::GetLabelTable;
using voxplex::LabelTable;
using voxplex::SetLabelTable;
using voxplex::TextsOf;

namespace
{

int Failures = 0;

void Check(bool holds, const char* what)
{
  if (!holds)
  {
    ++Failures;
    std::cerr << "failed: " << what << '\n';
  }
}

bool Same(const LabelTable& a, const LabelTable& b)
{
  return a.Entries.size() == b.Entries.size() &&
    std::equal(a.Entries.begin(), a.Entries.end(), b.Entries.begin(),
      [](const auto& x, const auto& y)
      {
        return x.first == y.first && x.second.Name == y.second.Name &&
          x.second.Color == y.second.Color;
      });
}

LabelTable MakeTable()
{
  LabelTable table;
  table.Entries[7] = { "seven", std::array<double, 3>{ 0.1, 0.2, 1.0 } };
  table.Entries[3] = { "three", std::nullopt };
  return table;
}

void TestRoundTrip()
{
  vtkNew<vtkFieldData> fields;
  const LabelTable table = MakeTable();
  SetLabelTable(fields, table);
  Check(fields->GetNumberOfArrays() == 3, "three arrays");
  Check(Same(GetLabelTable(fields), table), "round trip");
  Check(
    GetLabelTable(fields).NameOf(7) == "seven" && GetLabelTable(fields).NameOf(8).empty(), "names");
  Check(std::isnan(fields->GetArray("LabelColors")->GetComponent(0, 1)), "no colour is NaN");

  LabelTable wide;
  wide.Entries[5000000000] = { "wide", std::nullopt };
  SetLabelTable(fields, wide);
  Check(fields->GetNumberOfArrays() == 2, "no colours, no array of them");
  Check(Same(GetLabelTable(fields), wide), "round trip of a label of more than 32 bits");

  SetLabelTable(fields, LabelTable());
  Check(fields->GetNumberOfArrays() == 0, "an empty table leaves no arrays");
  Check(GetLabelTable(fields).Entries.empty(), "an empty table");
}

void TestForeignArrays()
{
  vtkNew<vtkFieldData> fields;
  SetLabelTable(fields, MakeTable());
  auto* names = vtkStringArray::SafeDownCast(fields->GetAbstractArray("LabelNames"));
  auto* values = vtkIntArray::SafeDownCast(fields->GetArray("LabelValues"));
  auto* colors = vtkDoubleArray::SafeDownCast(fields->GetArray("LabelColors"));

  values->SetValue(0, -3);
  Check(GetLabelTable(fields).Entries.size() == 1, "a label that is not positive");
  values->SetValue(0, 3);
  names->SetValue(0, "");
  Check(GetLabelTable(fields).Entries.count(3) == 0, "an empty name");
  names->SetValue(0, "three");
  colors->SetNumberOfTuples(1);
  Check(GetLabelTable(fields).Entries.size() == 2 && !GetLabelTable(fields).Entries[7].Color,
    "too few colours");
  names->InsertNextValue("one more");
  Check(GetLabelTable(fields).Entries.empty(), "more names than labels");
  fields->RemoveArray("LabelNames");
  Check(GetLabelTable(fields).Entries.empty(), "no names");
}

/** As in our files: a 0 ends each text, and what has none is none. */
void TestBytes()
{
  vtkNew<vtkFieldData> fields;
  SetLabelTable(fields, MakeTable());
  vtkNew<vtkUnsignedCharArray> bytes;
  bytes->SetName("LabelNames");
  for (const char byte : { 'a', 'b', '\0', '\xC3', '\xA9', '\0' })
  {
    bytes->InsertNextValue(static_cast<unsigned char>(byte));
  }
  fields->AddArray(bytes);
  LabelTable table = GetLabelTable(fields);
  Check(table.NameOf(3) == "ab" && table.NameOf(7) == "\xC3\xA9", "names as bytes");
  Check(table.Entries[7].Color.has_value(), "colours beside bytes");
  bytes->InsertNextValue('c');
  Check(TextsOf(fields, "LabelNames").size() == 2, "bytes without an end");
  bytes->InsertNextValue(0);
  Check(GetLabelTable(fields).Entries.empty(), "more bytes than labels");
  Check(TextsOf(fields, "LabelValues").empty() && TextsOf(fields, "none").empty(), "no texts");
}

} // namespace

int TestLabelTable(int, char*[])
{
  TestRoundTrip();
  TestForeignArrays();
  TestBytes();
  return Failures == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
