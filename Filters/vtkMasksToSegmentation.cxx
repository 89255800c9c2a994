// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkMasksToSegmentation.h"

#include "LabelTable.h"
#include "MasksOnGrid.h"
#include "Private/Execution.h"
#include "Private/Lists.h"
#include "Private/MeshingMessages.h"
#include "Refuse.h"
#include "ShownText.h"
#include "VTKImage.h"

#include "vtkAbstractArray.h"
#include "vtkCellData.h"
#include "vtkCompositeDataSet.h"
#include "vtkDataArray.h"
#include "vtkDataObject.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMatrix3x3.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkObjectFactory.h"
#include "vtkPartitionedDataSet.h"
#include "vtkPartitionedDataSetCollection.h"
#include "vtkPointData.h"

#include <cstddef>

using namespace voxplex;
using Pipeline = vtkStreamingDemandDrivenPipeline;

namespace
{

constexpr const char* NoMemory = "the masks do not fit into memory";

struct Mask
{
  vtkImageData* Image;
  LabelTable::Entry Entry; ///< its name is empty if there is none
};

/** Of a block; empty if it has none. */
template <typename TComposite>
std::string NameOfBlock(TComposite* blocks, unsigned i)
{
  vtkInformation* const about = blocks->HasMetaData(i) ? blocks->GetMetaData(i) : nullptr;
  const char* name = about ? about->Get(vtkCompositeDataSet::NAME()) : nullptr;
  return name ? name : "";
}

/** The images of a data object, in their order. */
void Gather(vtkDataObject* data, const std::string& name, std::vector<Mask>& masks)
{
  if (auto* image = vtkImageData::SafeDownCast(data))
  {
    masks.push_back({ image, { name, std::nullopt } });
  }
  else if (auto* blocks = vtkMultiBlockDataSet::SafeDownCast(data))
  {
    for (unsigned i = 0; i < blocks->GetNumberOfBlocks(); ++i)
    {
      Gather(blocks->GetBlock(i), NameOfBlock(blocks, i), masks);
    }
  }
  else if (auto* collection = vtkPartitionedDataSetCollection::SafeDownCast(data))
  {
    for (unsigned i = 0; i < collection->GetNumberOfPartitionedDataSets(); ++i)
    {
      Gather(collection->GetPartitionedDataSet(i), NameOfBlock(collection, i), masks);
    }
  }
  else if (auto* parts = vtkPartitionedDataSet::SafeDownCast(data))
  {
    for (unsigned i = 0; i < parts->GetNumberOfPartitions(); ++i)
    {
      Gather(parts->GetPartition(i), name, masks);
    }
  }
  else
  {
    RefuseIf(data != nullptr, "block '", Excerpt(name), "' is a ", data ? data->GetClassName() : "",
      "; masks are vtkImageData");
  }
}

/** Of the array that is most likely the mask; empty if there is none. */
std::string NameOfArray(vtkImageData* image)
{
  vtkDataSetAttributes* data = image->GetPointData();
  if (data->GetNumberOfArrays() == 0)
  {
    data = image->GetCellData();
  }
  vtkAbstractArray* array = data->GetScalars();
  array = array ? array : data->GetAbstractArray(0);
  return array && array->GetName() ? array->GetName() : "";
}

/** Where neither the user nor a block gives one. */
void FindNames(std::vector<Mask>& masks)
{
  std::map<std::string, int> uses;
  for (const Mask& mask : masks)
  {
    ++uses[NameOfArray(mask.Image)];
  }
  for (Mask& mask : masks)
  {
    const LabelTable table = GetLabelTable(mask.Image->GetFieldData());
    const std::string array = NameOfArray(mask.Image);
    if (table.Entries.size() == 1)
    {
      const LabelTable::Entry& only = table.Entries.begin()->second;
      mask.Entry.Color = only.Color;
      mask.Entry.Name = mask.Entry.Name.empty() ? only.Name : mask.Entry.Name;
    }
    else if (mask.Entry.Name.empty() && uses[array] == 1)
    {
      mask.Entry.Name = array;
    }
  }
}

std::vector<Mask> MasksOf(vtkInformationVector* inputs, const std::map<int, std::string>& names)
{
  std::vector<Mask> masks;
  for (int i = 0; i < inputs->GetNumberOfInformationObjects(); ++i)
  {
    Gather(vtkDataObject::GetData(inputs, i), "", masks);
  }
  RefuseIf(masks.empty(), "there is no mask in the input");
  for (const auto& [number, name] : names)
  {
    RefuseIf(number < 0 || static_cast<std::size_t>(number) >= masks.size(), "SetMaskName(", number,
      ", '", Excerpt(name), "') names none of the ", masks.size(), " masks");
    masks[static_cast<std::size_t>(number)].Entry.Name = name;
  }
  FindNames(masks);
  return masks;
}

/** As messages name it. */
std::string Shown(const std::vector<Mask>& masks, const Mask& mask)
{
  return "mask " +
    (mask.Entry.Name.empty() ? std::to_string(&mask - masks.data() + 1)
                             : "'" + Excerpt(mask.Entry.Name) + "'");
}

/** Calls take(); what it says of the image is said of the mask. */
template <typename TFunction>
ScalarImage Take(const std::string& shown, TFunction&& take)
{
  try
  {
    return take();
  }
  catch (const InputError& error)
  {
    Refuse(shown, ": ", error.what());
  }
}

void OfferGrids(MasksOnGrid& joined, const std::vector<Mask>& masks)
{
  for (const Mask& mask : masks)
  {
    const std::string shown = Shown(masks, mask);
    joined.OfferGrid(Take(shown, [&mask] { return PlaceOfVTKImage(mask.Image); }), shown);
  }
}

} // namespace

vtkStandardNewMacro(vtkMasksToSegmentation);

vtkMasksToSegmentation::vtkMasksToSegmentation() = default;
vtkMasksToSegmentation::~vtkMasksToSegmentation() = default;

void vtkMasksToSegmentation::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "MaskNames:";
  for (const auto& [mask, name] : this->MaskNames)
  {
    os << " " << mask << " " << name;
  }
  os << "\n"
     << indent << "Overlap: " << (this->Overlap == OVERLAP_SMALLEST ? "smallest" : "order") << "\n"
     << indent << "MaskThreshold: " << this->MaskThreshold << "\n"
     << indent << "ResampleMasks: " << (this->ResampleMasks ? "on" : "off") << "\n";
  PrintText(os, indent, "ErrorMessage", this->ErrorMessage);
}

void vtkMasksToSegmentation::SetMaskName(int mask, const char* name)
{
  this->MaskNames[mask] = name ? name : "";
  this->Modified();
}

void vtkMasksToSegmentation::ClearMaskNames()
{
  this->MaskNames.clear();
  this->Modified();
}

const std::string& vtkMasksToSegmentation::GetWarning(int i) const
{
  return TextAt(this->Warnings, i);
}

int vtkMasksToSegmentation::FillInputPortInformation(int, vtkInformation* information)
{
  information->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkImageData");
  information->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkDataObjectTree");
  information->Set(vtkAlgorithm::INPUT_IS_REPEATABLE(), 1);
  return 1;
}

vtkTypeBool vtkMasksToSegmentation::ProcessRequest(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  VOXPLEX_FORGET_ABORT(request);
  return this->Superclass::ProcessRequest(request, inputVector, outputVector);
}

int vtkMasksToSegmentation::Fail(vtkInformationVector* outputVector)
{
  this->Warnings.clear();
  EmptyOutputs(outputVector);
  if (this->ErrorMessage.empty()) // it was stopped
  {
    return 1;
  }
  vtkErrorMacro(<< this->ErrorMessage);
  return 0;
}

void vtkMasksToSegmentation::Announce(vtkInformationVector* inputs, vtkInformation* output)
{
  const std::vector<Mask> masks = MasksOf(inputs, this->MaskNames);
  MasksOnGrid joined(this->ResampleMasks);
  OfferGrids(joined, masks);
  const auto grid = ToVTKImage(joined.FindGrid(), GetSpace(masks.front().Image->GetFieldData()));
  output->Set(Pipeline::WHOLE_EXTENT(), grid->GetExtent(), 6);
  output->Set(vtkDataObject::ORIGIN(), grid->GetOrigin(), 3);
  output->Set(vtkDataObject::SPACING(), grid->GetSpacing(), 3);
  output->Set(vtkDataObject::DIRECTION(), grid->GetDirectionMatrix()->GetData(), 9);
  vtkDataObject::SetPointDataActiveScalarInfo(output, VTK_UNSIGNED_SHORT, 1);
}

int vtkMasksToSegmentation::RequestInformation(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  for (int i = 0; i < this->GetNumberOfInputConnections(0); ++i)
  {
    int port = 0;
    vtkAlgorithm* const source = this->GetInputAlgorithm(0, i, port);
    source->Update(port);
  }
  this->ErrorMessage = CatchFailure(
    [&] { this->Announce(inputVector[0], outputVector->GetInformationObject(0)); }, NoMemory, "");
  return this->ErrorMessage.empty() ? 1 : this->Fail(outputVector);
}

int vtkMasksToSegmentation::RequestUpdateExtent(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector*)
{
  RequestWholeInputs(inputVector, 1);
  return 1;
}

void vtkMasksToSegmentation::Join(vtkInformationVector* inputs, vtkImageData* output)
{
  const std::vector<Mask> masks = MasksOf(inputs, this->MaskNames);
  MasksOnGrid joined(this->ResampleMasks, this->MaskThreshold);
  OfferGrids(joined, masks);
  for (const Mask& mask : masks)
  {
    this->UpdateProgress(
      static_cast<double>(&mask - masks.data()) / static_cast<double>(masks.size()));
    if (IsStopRequested(this))
    {
      throw Cancelled();
    }
    const std::string shown = Shown(masks, mask);
    std::vector<std::string> warnings;
    LabelTable ignored; // FindNames() has taken what is wanted of it
    joined.Add(mask.Entry,
      Take(shown, [&] { return TakeVTKImage(mask.Image, AllocateVoxels, ignored, warnings); }),
      shown);
    for (const std::string& warning : warnings)
    {
      this->Warnings.push_back(shown + ": " + warning);
    }
  }
  const ScalarImage image =
    joined.Finish(static_cast<voxplex::Overlap>(this->Overlap), this->Warnings);
  LabelTable labels = joined.GetLabels();
  KeepLabelsOf(image, labels);
  FillVTKImage(output, image, GetSpace(masks.front().Image->GetFieldData()), labels);
  this->UpdateProgress(1.0);
}

int vtkMasksToSegmentation::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  this->Warnings.clear();
  bool isAborted = false;
  this->ErrorMessage =
    CatchFailure([&] { this->Join(inputVector[0], vtkImageData::GetData(outputVector)); }, NoMemory,
      "", &isAborted);
  if (isAborted || !this->ErrorMessage.empty())
  {
    return this->Fail(outputVector);
  }
  for (const std::string& warning : this->Warnings)
  {
    vtkWarningMacro(<< warning);
  }
  return 1;
}
