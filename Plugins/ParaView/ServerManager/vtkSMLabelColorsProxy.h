// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSMLabelColorsProxy
 * @brief   gives the colour maps of labels the names and colours that a source's data carries
 *
 * Set the property `Input` to a source and call UpdateVTKObjects(): the colour maps of the arrays
 * `Label` and `Labels` show categories, each label's name is its annotation (its value if it has no name)
 * and its colour that category's colour; labels without a colour get one that their value decides on, so that it is the same in
 * every mesh. Colour maps belong to the names of arrays in ParaView, so this holds for all that is made from the source as well.
 * `Labels` (two components: both sides of an interface) is coloured by its first. With more than 1000 labels the colour maps
 * are continuous.
 *
 * The proxy has no object on the server. Labels come from vtkPVLabelInformation.
 */
#ifndef vtkSMLabelColorsProxy_h
#define vtkSMLabelColorsProxy_h

#include "vtkPVLabelInformation.h" // For LabelEntry
#include "vtkSMProxy.h"
#include "vtkVoxplexServerManagerModule.h" // For export macro

class vtkSMOutputPort;
class vtkSMSourceProxy;

class VTKVOXPLEXSERVERMANAGER_EXPORT vtkSMLabelColorsProxy : public vtkSMProxy
{
public:
  static vtkSMLabelColorsProxy* New();
  vtkTypeMacro(vtkSMLabelColorsProxy, vtkSMProxy);

  /** Applies what the Input carries; it must be up to date. */
  void UpdateVTKObjects() override;

  /** Whether the data information of an output lists arrays with names or colours of labels. */
  static bool HasLabels(vtkSMSourceProxy* source, unsigned int port);

  /** Fills the information from one output of a source. */
  static void Gather(vtkSMSourceProxy* source, unsigned int port, vtkPVLabelInformation* labels);

#ifndef __VTK_WRAP__
  /** The colour that a label has in these colour maps. */
  static std::array<double, 3> ColorOf(
    vtkTypeInt64 value, const vtkPVLabelInformation::LabelEntry& label);
#endif

  /** Sets the colour maps of the session's `Label` and `Labels`. Does nothing without labels. */
  static void Apply(vtkPVLabelInformation* labels, vtkSMSessionProxyManager* manager);

protected:
  vtkSMLabelColorsProxy() = default;
  ~vtkSMLabelColorsProxy() override = default;

private:
  vtkSMLabelColorsProxy(const vtkSMLabelColorsProxy&) = delete;
  void operator=(const vtkSMLabelColorsProxy&) = delete;
};

#endif
