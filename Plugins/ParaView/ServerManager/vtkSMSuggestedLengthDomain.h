// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSMSuggestedLengthDomain
 * @brief   lengths around one that the filter suggests for its input
 *
 * The default is the suggested length, the slider goes from a quarter of it to four times it; other
 * values are allowed. The suggestion comes from the required property with the function
 * `Suggestion`, an information-only property with one element; as long as it is 0 (unknown) the
 * property keeps its value.
 *
 * As a bounds domain it has the buttons of those in ParaView's panel: one that scales the value, and one that
 * resets it to the suggestion.
 *
 * In the server manager's XML:
 * @code
 * <SuggestedLengthDomain name="range">
 *   <RequiredProperties>
 *     <Property name="DefaultDelta" function="Suggestion"/>
 *   </RequiredProperties>
 * </SuggestedLengthDomain>
 * @endcode
 */
#ifndef vtkSMSuggestedLengthDomain_h
#define vtkSMSuggestedLengthDomain_h

#include "vtkSMBoundsDomain.h"
#include "vtkVoxplexServerManagerModule.h" // For export macro

class VTKVOXPLEXSERVERMANAGER_EXPORT vtkSMSuggestedLengthDomain : public vtkSMBoundsDomain
{
public:
  static vtkSMSuggestedLengthDomain* New();
  vtkTypeMacro(vtkSMSuggestedLengthDomain, vtkSMBoundsDomain);

  void Update(vtkSMProperty* property) override;
  int IsInDomain(vtkSMProperty* property) override;
  int SetDefaultValues(vtkSMProperty* property, bool useUncheckedValues) override;

protected:
  vtkSMSuggestedLengthDomain() = default;
  ~vtkSMSuggestedLengthDomain() override = default;

private:
  vtkSMSuggestedLengthDomain(const vtkSMSuggestedLengthDomain&) = delete;
  void operator=(const vtkSMSuggestedLengthDomain&) = delete;

  /** 0 if there is none. */
  double GetSuggestion();
};

#endif
