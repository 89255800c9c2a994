// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Space.h"

#include "LabelTable.h"

#include "vtkFieldData.h"
#include "vtkNew.h"
#include "vtkStringArray.h"

#include <vector>

namespace voxplex
{

Space GetSpace(vtkFieldData* fields, std::optional<std::string>* unknown)
{
  const std::vector<std::string> texts = TextsOf(fields, "SPACE");
  const std::string text = texts.size() == 1 ? texts.front() : "LPS";
  if (unknown && text != "LPS" && text != "RAS")
  {
    *unknown = text;
  }
  return text == "RAS" ? Space::RAS : Space::LPS;
}

void SetSpace(vtkFieldData* fields, Space space)
{
  vtkNew<vtkStringArray> array;
  array->SetName("SPACE");
  array->InsertNextValue(ToString(space));
  fields->AddArray(array);
}

} // namespace voxplex
