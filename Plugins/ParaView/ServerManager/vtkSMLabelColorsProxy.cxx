// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSMLabelColorsProxy.h"

#include "vtkDataObject.h"
#include "vtkMath.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPVDataInformation.h"
#include "vtkPVSession.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkSMSourceProxy.h"
#include "vtkSMStringVectorProperty.h"
#include "vtkSMTransferFunctionManager.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

vtkStandardNewMacro(vtkSMLabelColorsProxy);

namespace
{

using Color = std::array<double, 3>;

/** VTK looks for a cell's category among all of them, one after the other: with more, drawing takes minutes. */
constexpr std::size_t MostCategories = 1000;

/** Two strings a category, and its colour. */
class Categories
{
public:
  void Add(vtkTypeInt64 value, const std::string& name, const Color& color)
  {
    const std::string number = std::to_string(value);
    this->Annotations.push_back(number);
    this->Annotations.push_back(name.empty() ? number : name);
    this->Colors.insert(this->Colors.end(), color.begin(), color.end());
  }

  /** Each property at once: windows draw again at each change. */
  void SetTo(vtkSMProxy* colorMap) const
  {
    vtkSMPropertyHelper(colorMap, "IndexedColors")
      .Set(this->Colors.data(), static_cast<unsigned int>(this->Colors.size()));
    if (auto* const annotations =
          vtkSMStringVectorProperty::SafeDownCast(colorMap->GetProperty("Annotations")))
    {
      annotations->SetElements(this->Annotations);
    }
  }

private:
  std::vector<std::string> Annotations;
  std::vector<double> Colors;
};

} // namespace

void vtkSMLabelColorsProxy::UpdateVTKObjects()
{
  vtkSMPropertyHelper input(this, "Input");
  auto* const source = vtkSMSourceProxy::SafeDownCast(input.GetAsProxy());
  if (source == nullptr)
  {
    vtkErrorMacro(<< "Input is not a source.");
    return;
  }
  vtkNew<vtkPVLabelInformation> labels;
  Gather(source, input.GetOutputPort(), labels);
  Apply(labels, this->GetSessionProxyManager());
}

bool vtkSMLabelColorsProxy::HasLabels(vtkSMSourceProxy* source, unsigned int port)
{
  vtkPVDataInformation* const data = source->GetDataInformation(port);
  return data && data->GetArrayInformation("LabelValues", vtkDataObject::FIELD) &&
    (data->GetArrayInformation("LabelNames", vtkDataObject::FIELD) ||
      data->GetArrayInformation("LabelColors", vtkDataObject::FIELD));
}

void vtkSMLabelColorsProxy::Gather(
  vtkSMSourceProxy* source, unsigned int port, vtkPVLabelInformation* labels)
{
  labels->SetPortNumber(static_cast<int>(port));
  source->GatherInformation(labels, vtkPVSession::DATA_SERVER);
}

/** Without a colour, neighbouring labels get hues far from each other: steps of the golden ratio. */
Color vtkSMLabelColorsProxy::ColorOf(
  vtkTypeInt64 value, const vtkPVLabelInformation::LabelEntry& label)
{
  if (label.HasColor)
  {
    return label.Color;
  }
  const double hue = std::fmod(static_cast<double>(value) * 0.6180339887498949, 1.0);
  const bool odd = value % 2 != 0;
  Color color;
  vtkMath::HSVToRGB(
    hue, odd ? 0.45 : 0.62, odd ? 0.95 : 0.82, color.data(), color.data() + 1, color.data() + 2);
  return color;
}

void vtkSMLabelColorsProxy::Apply(vtkPVLabelInformation* labels, vtkSMSessionProxyManager* manager)
{
  if (labels->GetLabels().empty())
  {
    return;
  }
  const bool hasCategories = labels->GetLabels().size() <= MostCategories;
  vtkNew<vtkSMTransferFunctionManager> maps;
  for (const std::string array : { "Label", "Labels" })
  {
    vtkSMProxy* const map = maps->GetColorTransferFunction(array.c_str(), manager);
    Categories categories;
    if (array == "Labels") // both sides of an interface; 0 is background
    {
      vtkSMPropertyHelper(map, "VectorMode").Set("Component");
      vtkSMPropertyHelper(map, "VectorComponent").Set(0);
      categories.Add(0, "background", { 0.85, 0.85, 0.85 });
    }
    for (const auto& [value, label] : labels->GetLabels())
    {
      categories.Add(value, label.Name, ColorOf(value, label));
    }
    (hasCategories ? categories : Categories()).SetTo(map);
    // Otherwise ParaView's colour map editor looks for the array's values and asks the user what it did.
    vtkSMPropertyHelper(map, "AnnotationsInitialized").Set(1);
    vtkSMPropertyHelper(map, "IndexedLookup").Set(hasCategories ? 1 : 0);
    map->UpdateVTKObjects();
  }
}
