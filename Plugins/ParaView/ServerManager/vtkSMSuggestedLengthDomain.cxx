// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSMSuggestedLengthDomain.h"

#include "vtkObjectFactory.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMUncheckedPropertyHelper.h"

#include <vector>

vtkStandardNewMacro(vtkSMSuggestedLengthDomain);

double vtkSMSuggestedLengthDomain::GetSuggestion()
{
  vtkSMProperty* const suggestion = this->GetRequiredProperty("Suggestion");
  if (suggestion == nullptr)
  {
    return 0.0;
  }
  vtkSMUncheckedPropertyHelper helper(suggestion);
  return helper.GetNumberOfElements() > 0 ? helper.GetAsDouble(0) : 0.0;
}

void vtkSMSuggestedLengthDomain::Update(vtkSMProperty*)
{
  if (const double length = this->GetSuggestion(); length > 0.0)
  {
    this->SetEntries(std::vector<vtkEntry>{ vtkEntry(0.25 * length, 4.0 * length) });
  }
}

int vtkSMSuggestedLengthDomain::IsInDomain(vtkSMProperty*)
{
  return 1;
}

int vtkSMSuggestedLengthDomain::SetDefaultValues(vtkSMProperty* property, bool useUncheckedValues)
{
  const double length = this->GetSuggestion();
  if (length > 0.0)
  {
    vtkSMPropertyHelper helper(property);
    helper.SetUseUnchecked(useUncheckedValues);
    helper.Set(0, length);
  }
  return 1;
}
