// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "FieldTexts.h"

#include "LabelTable.h"

#include <vtkStringArray.h>
#include <vtkUnsignedCharArray.h>

namespace voxplex::io
{
namespace
{

vtkSmartPointer<vtkAbstractArray> MakeStrings(const std::vector<std::string>& texts)
{
  const auto strings = vtkSmartPointer<vtkStringArray>::New();
  for (const std::string& text : texts)
  {
    strings->InsertNextValue(text);
  }
  return strings;
}

vtkSmartPointer<vtkAbstractArray> MakeBytes(const std::vector<std::string>& texts)
{
  const auto bytes = vtkSmartPointer<vtkUnsignedCharArray>::New();
  for (const std::string& text : texts)
  {
    for (const char* byte = text.c_str(); *byte != '\0'; ++byte) // a 0 inside would be an end
    {
      bytes->InsertNextValue(static_cast<unsigned char>(*byte));
    }
    bytes->InsertNextValue(0);
  }
  return bytes;
}

void SetTextForm(vtkFieldData* fields, const char* name, TextForm form)
{
  const std::vector<std::string> texts = TextsOf(fields, name);
  if (!texts.empty())
  {
    const auto array = form == TextForm::Bytes ? MakeBytes(texts) : MakeStrings(texts);
    array->SetName(name);
    fields->AddArray(array);
  }
}

} // namespace

void SetTextForms(vtkFieldData* fields, TextForm names, TextForm space)
{
  SetTextForm(fields, "LabelNames", names);
  SetTextForm(fields, "SurfaceNames", names);
  SetTextForm(fields, "SPACE", space);
}

} // namespace voxplex::io
