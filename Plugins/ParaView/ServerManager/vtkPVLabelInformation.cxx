// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVLabelInformation.h"

#include "LabelTable.h"

#include "vtkAlgorithm.h"
#include "vtkAlgorithmOutput.h"
#include "vtkClientServerStream.h"
#include "vtkDataArray.h"
#include "vtkDataObject.h"
#include "vtkDataSetAttributes.h"
#include "vtkFieldData.h"
#include "vtkImageData.h"
#include "vtkImageToSimplexMeshFilter.h"
#include "vtkMultiProcessStream.h"
#include "vtkObjectFactory.h"

#include <algorithm>

vtkStandardNewMacro(vtkPVLabelInformation);

void vtkPVLabelInformation::CopyFromObject(vtkObject* object)
{
  this->Labels.clear();
  this->ErrorMessage.clear();
  vtkDataObject* data = nullptr;
  if (auto* const port = vtkAlgorithmOutput::SafeDownCast(object))
  {
    data = port->GetProducer()->GetOutputDataObject(port->GetIndex());
  }
  else if (auto* const algorithm = vtkAlgorithm::SafeDownCast(object))
  {
    if (this->PortNumber < algorithm->GetNumberOfOutputPorts())
    {
      data = algorithm->GetOutputDataObject(this->PortNumber);
    }
  }
  if (data)
  {
    this->ReadCells(data);
    this->ReadTable(data->GetFieldData());
    auto* const image = vtkImageData::SafeDownCast(data);
    if (image && image->GetNumberOfPoints() > 0 && this->Association >= 0)
    {
      this->ReadVoxels(image);
    }
  }
}

void vtkPVLabelInformation::ReadVoxels(vtkImageData* image)
{
  using Filter = vtkImageToSimplexMeshFilter;
  for (const auto& [value, voxels] :
    Filter::CountLabels(image, this->Association, this->ArrayName, this->ErrorMessage))
  {
    this->Labels[value].Voxels = voxels;
  }
  this->ErrorMessage = Filter::InTermsOf(Filter::VOCABULARY_PARAVIEW, this->ErrorMessage);
}

void vtkPVLabelInformation::ReadCells(vtkDataObject* data)
{
  vtkFieldData* const cells = data->GetAttributesAsFieldData(vtkDataObject::CELL);
  vtkDataArray* const labels = cells ? cells->GetArray("Label") : nullptr;
  if (labels == nullptr || labels->GetNumberOfComponents() != 1)
  {
    return;
  }
  double last = 0.0; // neighbours in the list mostly have the same label
  for (vtkIdType cell = 0; cell < labels->GetNumberOfTuples(); ++cell)
  {
    const double label = labels->GetTuple1(cell);
    if (label != last && label > 0.0)
    {
      this->Labels[static_cast<vtkTypeInt64>(label)];
    }
    last = label;
  }
}

void vtkPVLabelInformation::ReadTable(vtkFieldData* fields)
{
  for (const auto& [value, entry] : voxplex::GetLabelTable(fields).Entries)
  {
    LabelEntry& label = this->Labels[value];
    label.Name = entry.Name;
    label.HasColor = entry.Color.has_value();
    label.Color = entry.Color.value_or(label.Color);
  }
}

void vtkPVLabelInformation::AddInformation(vtkPVInformation* other)
{
  if (auto* const labels = vtkPVLabelInformation::SafeDownCast(other))
  {
    for (const auto& [value, label] : labels->Labels)
    {
      LabelEntry& own = this->Labels[value];
      own = own == LabelEntry() ? label : own;
      own.Voxels = std::max(own.Voxels, label.Voxels); // each process has the whole image
    }
    this->ErrorMessage = this->Labels.empty() ? labels->ErrorMessage : "";
  }
}

void vtkPVLabelInformation::CopyToStream(vtkClientServerStream* stream)
{
  stream->Reset();
  *stream << vtkClientServerStream::Reply << this->ErrorMessage.c_str()
          << static_cast<int>(this->Labels.size());
  for (const auto& [value, label] : this->Labels)
  {
    *stream << value << label.Name.c_str() << static_cast<int>(label.HasColor) << label.Color[0]
            << label.Color[1] << label.Color[2] << label.Voxels;
  }
  *stream << vtkClientServerStream::End;
}

void vtkPVLabelInformation::CopyFromStream(const vtkClientServerStream* stream)
{
  this->Labels.clear();
  int count = 0;
  int argument = 0;
  stream->GetArgument(0, argument++, &this->ErrorMessage);
  stream->GetArgument(0, argument++, &count);
  for (int i = 0; i < count; ++i)
  {
    vtkTypeInt64 value = 0;
    LabelEntry label;
    int hasColor = 0;
    stream->GetArgument(0, argument++, &value);
    stream->GetArgument(0, argument++, &label.Name);
    stream->GetArgument(0, argument++, &hasColor);
    for (double& component : label.Color)
    {
      stream->GetArgument(0, argument++, &component);
    }
    stream->GetArgument(0, argument++, &label.Voxels);
    label.HasColor = hasColor != 0;
    this->Labels.emplace(value, label);
  }
}

void vtkPVLabelInformation::CopyParametersToStream(vtkMultiProcessStream& stream)
{
  stream << this->PortNumber << this->Association << this->ArrayName;
}

void vtkPVLabelInformation::CopyParametersFromStream(vtkMultiProcessStream& stream)
{
  stream >> this->PortNumber >> this->Association >> this->ArrayName;
}

void vtkPVLabelInformation::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "PortNumber: " << this->PortNumber << "\n";
  os << indent << "Labels: " << this->Labels.size() << "\n";
  for (const auto& [value, label] : this->Labels)
  {
    os << indent.GetNextIndent() << value << ": " << label.Name << "\n";
  }
}
