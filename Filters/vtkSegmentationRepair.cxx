// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSegmentationRepair.h"

#include "Base/Error.h"
#include "Base/NumberText.h"
#include "LabelTable.h"
#include "MeshingParameters.h"
#include "Private/ChosenArray.h"
#include "Private/Execution.h"
#include "Private/Lists.h"
#include "Private/MeshingMessages.h"
#include "SegmentationRepair.h"

#include "vtkCellData.h"
#include "vtkDataSetAttributes.h"
#include "vtkImageData.h"
#include "vtkLongLongArray.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkStringArray.h"
#include "vtkTable.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <string_view>
#include <vector>

vtkStandardNewMacro(vtkSegmentationRepair);

using voxplex::InputError;
using voxplex::RepairRow;

class vtkSegmentationRepair::Internals
{
public:
  std::map<std::int64_t, double> MinimumThicknesses;
  std::map<std::int64_t, double> Shells;
  std::vector<RepairRow> Rows;
  std::map<std::int64_t, std::string> Names;
  std::vector<std::string> Warnings;
  ///@{
  /** Of the progress: operations on one label or all, those done, and what was said. */
  std::size_t Steps = 0;
  std::size_t Step = 0;
  double Fraction = 0.0;
  ///@}

  std::string NameOf(std::int64_t label) const
  {
    const auto name = this->Names.find(label);
    return name == this->Names.end() ? "" : name->second;
  }
};

namespace
{

using Pipeline = vtkStreamingDemandDrivenPipeline;
using Names = std::map<std::int64_t, std::string>;

/** Checks the lengths of a parameter. */
void CheckLengths(
  const char* parameter, const std::map<std::int64_t, double>& lengths, bool isSigned)
{
  for (const auto& [label, length] : lengths)
  {
    if (label <= 0)
    {
      throw InputError(std::string("{") + parameter + "}: " + std::to_string(label) +
        " is not a label; labels are positive.");
    }
    if (!std::isfinite(length) || length == 0.0 || (length < 0.0 && !isSigned))
    {
      throw InputError(std::string("{") + parameter + "} of label " + std::to_string(label) +
        " is " + voxplex::NumberText(length) + "; it must be " +
        (isSigned ? "finite, and not 0." : "positive and finite."));
    }
  }
}

void RequireLabels(const char* parameter, const std::map<std::int64_t, double>& lengths,
  std::span<const std::int64_t> labels)
{
  for (const auto& [label, length] : lengths)
  {
    if (std::find(labels.begin(), labels.end(), label) == labels.end())
    {
      throw InputError(std::string("{") + parameter + "}: the image has no label " +
        std::to_string(label) + "; it has " + voxplex::ListLabels(labels.subspan(1)) + ".");
    }
  }
}

/** A type that has all whole numbers up to a label: that before the repair, or another one. */
int TypeFor(int before, std::int64_t highest)
{
  for (const int type :
    { before == VTK_BIT ? VTK_UNSIGNED_CHAR : before, VTK_UNSIGNED_SHORT, VTK_INT })
  {
    constexpr std::int64_t one = 1;
    if (type == VTK_FLOAT    ? highest <= one << 24
        : type == VTK_DOUBLE ? highest <= one << 53
                             : static_cast<double>(highest) <= vtkDataArray::GetDataTypeMax(type))
    {
      return type;
    }
  }
  return VTK_LONG_LONG;
}

vtkSmartPointer<vtkDataArray> MakeArray(
  const voxplex::SegmentationRepair& image, vtkDataArray* before)
{
  const std::vector<std::int64_t>& labels = image.Labels();
  auto array = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(
    TypeFor(before->GetDataType(), *std::max_element(labels.begin(), labels.end()))));
  array->SetName(before->GetName());
  array->SetNumberOfTuples(static_cast<vtkIdType>(image.Voxels().size()));
  switch (array->GetDataType())
  {
    vtkTemplateMacro(std::transform(image.Voxels().begin(), image.Voxels().end(),
      static_cast<VTK_TT*>(array->GetVoidPointer(0)),
      [&labels](voxplex::LabelId id) { return static_cast<VTK_TT>(labels[id]); }));
  }
  return array;
}

/** Whether announced scalars are the array to process, by its name or as the active one. */
bool AreChosen(vtkInformation* scalars, vtkInformation* chosen)
{
  if (!scalars || !scalars->Has(vtkDataObject::FIELD_ARRAY_TYPE()))
  {
    return false;
  }
  const char* const own = scalars->Get(vtkDataObject::FIELD_NAME());
  const char* const name = chosen->Get(vtkDataObject::FIELD_NAME());
  return !name || (own && std::string_view(name) == own);
}

bool HasForeground(vtkDataArray* array)
{
  double range[2];
  array->GetRange(range);
  return range[0] != 0.0 || range[1] != 0.0;
}

/** Puts an array in the place of the one that has its name. */
void Replace(const char* name, vtkDataArray* array, vtkDataSetAttributes* data)
{
  const bool isActive = data->GetScalars() == data->GetAbstractArray(name);
  data->RemoveArray(name);
  isActive ? data->SetScalars(array) : data->AddArray(array);
}

/** Appends the names that were not there before: of labels that are higher than all others. */
void AddNames(vtkFieldData* fields, const Names& before, const Names& after)
{
  Names added;
  std::set_difference(
    after.begin(), after.end(), before.begin(), before.end(), std::inserter(added, added.end()));
  if (added.empty())
  {
    return;
  }
  voxplex::LabelTable table = voxplex::GetLabelTable(fields);
  for (const auto& [label, name] : added)
  {
    table.Entries[label].Name = name;
  }
  voxplex::SetLabelTable(fields, table);
}

void FillTable(const std::vector<RepairRow>& rows, const Names& names, vtkTable* table)
{
  const auto numbers = [&](const char* name, int components)
  {
    const auto array = vtkSmartPointer<vtkLongLongArray>::New();
    array->SetName(name);
    array->SetNumberOfComponents(components);
    table->AddColumn(array);
    return array;
  };
  const auto texts = [&](const char* name)
  {
    const auto array = vtkSmartPointer<vtkStringArray>::New();
    array->SetName(name);
    table->AddColumn(array);
    return array;
  };
  const auto what = texts("What");
  const auto label = numbers("Label", 1);
  const auto name = texts("Name");
  const auto voxels = numbers("Voxels", 1);
  const auto places = numbers("Places", 1);
  const auto largest = numbers("Largest", 1);
  const auto first = numbers("First", 3);
  const auto last = numbers("Last", 3);
  const auto leftOut = numbers("LeftOut", 1);
  const auto touching = numbers("TouchingFaces", 1);
  for (const RepairRow& row : rows)
  {
    what->InsertNextValue(row.What);
    label->InsertNextValue(row.Label);
    const auto found = names.find(row.Label);
    name->InsertNextValue(found == names.end() ? "" : found->second);
    voxels->InsertNextValue(row.Voxels);
    places->InsertNextValue(row.Places);
    largest->InsertNextValue(row.Largest);
    leftOut->InsertNextValue(row.LeftOut);
    touching->InsertNextValue(row.TouchingFaces);
    for (std::size_t a = 0; a < 3; ++a)
    {
      first->InsertNextValue(row.First[a]);
      last->InsertNextValue(row.Last[a]);
    }
  }
}

/** Of one kind, in a report to read. The table has all of them. */
constexpr std::ptrdiff_t MostLines = 20;

std::string Named(std::int64_t label, const std::string& name)
{
  return "label " + std::to_string(label) + (name.empty() ? "" : " (" + name + ")");
}

/** What could not be done; empty if there is nothing. @param length of the shell or thickness */
std::string WarningOf(const RepairRow& row, const std::string& name, double length)
{
  if (row.What == "min-thickness" && row.LeftOut > 0)
  {
    return "{min-thickness}: " + Named(row.Label, name) + " stays thinner than " +
      voxplex::NumberText(length) + ", because labels that have to stay keep " +
      std::to_string(row.LeftOut) + (row.LeftOut == 1 ? " voxel." : " voxels.");
  }
  if (row.TouchingFaces == 0)
  {
    return "";
  }
  return "{shell}: " + Named(row.Label, name) + " still touches what its shell keeps away, at " +
    std::to_string(row.TouchingFaces) + " faces of voxels, because " +
    (std::abs(length) < row.ClosedFrom
        ? "the shell is thinner than half a voxel. From " + voxplex::NumberText(row.ClosedFrom) +
          " on it is closed."
        : "a gap of one voxel cannot hold two shells. Smaller voxels can.");
}

std::string PlaceOf(const RepairRow& row)
{
  std::string text;
  if (row.Places > 1 && row.Places != row.Voxels)
  {
    text += " in " + std::to_string(row.Places) + " places";
  }
  text += row.Places == 1      ? ", at ("
    : row.Places == row.Voxels ? ", one at ("
                               : ", the largest (" + std::to_string(row.Largest) + ") at (";
  for (std::size_t a = 0; a < 3; ++a)
  {
    text += (a == 0 ? "" : ", ") + std::to_string(row.First[a]) +
      (row.First[a] == row.Last[a] ? "" : "-" + std::to_string(row.Last[a]));
  }
  return text + ")";
}

std::string Line(const RepairRow& row, const std::string& name)
{
  return row.What + ": " + Named(row.Label, name) + ": " + std::to_string(row.Voxels) +
    (row.Voxels == 1 ? " voxel" : " voxels") +
    (row.NewLabel == 0 ? "" : " became label " + std::to_string(row.NewLabel)) +
    (row.IsAll ? ", all that it had" : "") + (row.IsCut ? ", cut at the border of the image" : "") +
    (row.Places == 0 ? "" : PlaceOf(row)) +
    (row.LeftOut == 0 ? ""
                      : ", " + std::to_string(row.LeftOut) +
          (row.What == "shell" ? " more have other labels"
                               : " more would cross labels that have to stay"));
}

} // namespace

//----------------------------------------------------------------------------------------------------
vtkSegmentationRepair::vtkSegmentationRepair()
  : Private(std::make_unique<Internals>())
{
  this->SetNumberOfOutputPorts(2);
  voxplex::SetArray(this, 0, 0);
}

vtkSegmentationRepair::~vtkSegmentationRepair() = default;

void vtkSegmentationRepair::SetInputArrayToProcess(
  int index, int port, int connection, int association, const char* name)
{
  voxplex::SetArray(this, index, port, connection, association, name);
}

VOXPLEX_SIZES_OF_LABELS(
  vtkSegmentationRepair, MinimumThickness, MinimumThicknesses, ThickenedLabel, MinimumThicknesses)
VOXPLEX_SIZES_OF_LABELS(vtkSegmentationRepair, Shell, Shells, ShelledLabel, Shells)

vtkTable* vtkSegmentationRepair::GetReportTable()
{
  return vtkTable::SafeDownCast(this->GetOutputDataObject(1));
}

std::string vtkSegmentationRepair::GetReport()
{
  std::string text;
  const std::vector<RepairRow>& rows = this->Private->Rows;
  for (auto first = rows.begin(); first != rows.end();)
  {
    const auto last = std::find_if(
      first, rows.end(), [first](const RepairRow& row) { return row.What != first->What; });
    const auto shown = first + std::min(last - first, MostLines);
    for (auto row = first; row != shown; ++row)
    {
      text += Line(*row, this->Private->NameOf(row->Label)) + "\n";
    }
    if (shown != last)
    {
      text += first->What + ": " + std::to_string(last - shown) + " more labels\n";
    }
    first = last;
  }
  return text;
}

std::string vtkSegmentationRepair::ToJSON()
{
  auto rows = nlohmann::ordered_json::array();
  for (const RepairRow& row : this->Private->Rows)
  {
    rows.push_back({ { "what", row.What }, { "label", row.Label }, { "voxels", row.Voxels },
      { "places", row.Places }, { "largest", row.Largest }, { "first", row.First },
      { "last", row.Last } });
    if (row.NewLabel != 0)
    {
      rows.back()["new_label"] = row.NewLabel;
    }
    if (row.LeftOut != 0)
    {
      rows.back()["left_out"] = row.LeftOut;
    }
    if (row.TouchingFaces != 0)
    {
      rows.back()["touching_faces"] = row.TouchingFaces;
    }
  }
  return rows.dump();
}

int vtkSegmentationRepair::GetNumberOfWarnings() const
{
  return static_cast<int>(this->Private->Warnings.size());
}

const std::string& vtkSegmentationRepair::GetWarning(int i) const
{
  return voxplex::TextAt(this->Private->Warnings, i);
}

int vtkSegmentationRepair::FillOutputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), port == 0 ? "vtkImageData" : "vtkTable");
  return 1;
}

vtkTypeBool vtkSegmentationRepair::ProcessRequest(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  VOXPLEX_FORGET_ABORT(request);
  return this->Superclass::ProcessRequest(request, inputVector, outputVector);
}

int vtkSegmentationRepair::RequestInformation(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputVector)
{
  // The executive has copied what is announced of the input.
  vtkInformation* const output = outputVector->GetInformationObject(0);
  vtkInformation* const chosen = this->GetInputArrayInformation(0);
  for (const int association :
    { vtkDataObject::FIELD_ASSOCIATION_POINTS, vtkDataObject::FIELD_ASSOCIATION_CELLS })
  {
    vtkInformation* const scalars =
      vtkDataObject::GetActiveFieldInformation(output, association, vtkDataSetAttributes::SCALARS);
    if (this->IsIdle() || !AreChosen(scalars, chosen))
    {
      continue;
    }
    const auto shells = static_cast<std::int64_t>(this->Private->Shells.size());
    if (shells > 0 && this->FirstShellLabel == 0) // after the highest label, which only data tell
    {
      scalars->Remove(vtkDataObject::FIELD_ARRAY_TYPE());
    }
    else
    {
      scalars->Set(vtkDataObject::FIELD_ARRAY_TYPE(),
        TypeFor(scalars->Get(vtkDataObject::FIELD_ARRAY_TYPE()),
          shells > 0 ? this->FirstShellLabel + shells - 1 : 0));
    }
    break;
  }
  return 1;
}

int vtkSegmentationRepair::RequestUpdateExtent(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector*)
{
  voxplex::RequestWholeInputs(inputVector, 1);
  return 1;
}

int vtkSegmentationRepair::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  this->ErrorMessage.clear();
  this->Private->Rows.clear();
  this->Private->Warnings.clear();
  bool isAborted = false;
  this->ErrorMessage = voxplex::CatchFailure([&] { this->Repair(inputVector, outputVector); },
    "There is not enough memory to repair this image.",
    "The image cannot be repaired: ", &isAborted);
  const auto words = static_cast<voxplex::UserInterface>(this->Vocabulary);
  if (this->ErrorMessage.empty() && !isAborted)
  {
    for (const RepairRow& row : this->Private->Rows)
    {
      const auto& lengths =
        row.What == "shell" ? this->Private->Shells : this->Private->MinimumThicknesses;
      const std::string warning =
        WarningOf(row, this->Private->NameOf(row.Label), voxplex::SizeOf(lengths, row.Label));
      if (!warning.empty())
      {
        this->Private->Warnings.push_back(voxplex::InTermsOf(words, warning));
        vtkWarningMacro(<< this->Private->Warnings.back());
      }
    }
    return 1;
  }
  this->Private->Rows.clear();
  voxplex::EmptyOutputs(outputVector);
  if (isAborted)
  {
    return 1;
  }
  this->ErrorMessage = voxplex::InTermsOf(words, this->ErrorMessage);
  vtkErrorMacro(<< this->ErrorMessage);
  return 0;
}

//----------------------------------------------------------------------------------------------------
void vtkSegmentationRepair::CheckParameters() const
{
  voxplex::CheckValue("fill-holes", this->FillHoles);
  CheckLengths("min-thickness", this->Private->MinimumThicknesses, false);
  CheckLengths("shell", this->Private->Shells, true);
  if (this->FirstShellLabel < 0 || this->NumberOfThreads < 0)
  {
    throw InputError("FirstShellLabel and NumberOfThreads must not be negative.");
  }
}

bool vtkSegmentationRepair::IsIdle() const
{
  return this->FillHoles == 0 && !this->RemoveSpikes && !this->CheckImage &&
    this->Private->MinimumThicknesses.empty() && this->Private->Shells.empty();
}

void vtkSegmentationRepair::Change(voxplex::SegmentationRepair& image)
{
  Internals& own = *this->Private;
  own.Steps = own.MinimumThicknesses.size() + own.Shells.size() + (this->FillHoles > 0 ? 1 : 0) +
    (this->RemoveSpikes ? 1 : 0) + (this->CheckImage ? 1 : 0);
  own.Step = 0;
  own.Fraction = 0.0;
  const auto take = [&](const std::vector<RepairRow>& rows, std::size_t steps)
  {
    own.Rows.insert(own.Rows.end(), rows.begin(), rows.end());
    own.Step += steps;
    this->Proceed(0.0);
  };
  if (this->FillHoles > 0)
  {
    take(image.FillHoles(this->FillHoles), 1);
  }
  if (this->RemoveSpikes)
  {
    take(image.RemoveSpikes(), 1);
  }
  take(image.Thicken(own.MinimumThicknesses), own.MinimumThicknesses.size());
  const std::int64_t named = own.Names.empty() ? 0 : own.Names.rbegin()->first;
  const std::int64_t highest = std::max(image.Labels().back(), named);
  const std::int64_t first = this->FirstShellLabel > 0 ? this->FirstShellLabel - 1 : highest;
  if (first > std::numeric_limits<std::int64_t>::max() - std::ssize(own.Shells))
  {
    throw InputError("{shell}: there is no label above " + std::to_string(first) + " for a shell.");
  }
  take(image.MakeShells(own.Shells, first + 1), own.Shells.size());
  for (const RepairRow& row : std::vector(own.Rows))
  {
    if (row.NewLabel != 0 && own.Names.count(row.Label))
    {
      own.Names[row.NewLabel] = own.Names[row.Label] + " shell";
    }
  }
  if (this->CheckImage)
  {
    take(image.FindSuspicious(own.Names), 1);
  }
}

void vtkSegmentationRepair::Proceed(double fraction)
{
  Internals& own = *this->Private;
  const double done = (static_cast<double>(own.Step) + fraction) /
    static_cast<double>(std::max<std::size_t>(own.Steps, 1));
  own.Fraction = std::max(own.Fraction, std::min(done, 1.0)); // a step begins again for each label
  this->UpdateProgress(own.Fraction);
  if (voxplex::IsStopRequested(this))
  {
    throw voxplex::Cancelled();
  }
}

void vtkSegmentationRepair::Repair(
  vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  this->CheckParameters();
  vtkImageData* const input = vtkImageData::GetData(inputVector[0]);
  vtkImageData* const output = vtkImageData::GetData(outputVector);
  output->ShallowCopy(input);
  if (!this->IsIdle())
  {
    int association = 0;
    vtkAbstractArray* const chosen =
      this->GetInputAbstractArrayToProcess(0, inputVector, association);
    const voxplex::ChosenArray array =
      voxplex::ChooseScalars(input, chosen, association, voxplex::ImageContent::Labels, "input",
        " Frames that are components cannot be repaired; give them as steps of time.");
    const Names before = voxplex::GetLabelTable(input->GetFieldData()).Names();
    const bool isSeries =
      inputVector[0]->GetInformationObject(0)->Length(Pipeline::TIME_STEPS()) > 1;
    const unsigned threads = voxplex::ThreadsFor(this->NumberOfThreads);
    voxplex::SegmentationRepair image(
      array.Frame.Grid, threads, [this](double fraction) { this->Proceed(fraction); });
    if (!isSeries || HasForeground(array.Array))
    {
      image.SetImage(voxplex::ReadLabels(array, {}, threads));
    }
    if (!isSeries)
    {
      RequireLabels("min-thickness", this->Private->MinimumThicknesses, image.Labels());
      RequireLabels("shell", this->Private->Shells, image.Labels());
    }
    this->Private->Names = before;
    this->Change(image);
    const bool isOfCells = association == vtkDataObject::FIELD_ASSOCIATION_CELLS;
    Replace(chosen->GetName(), MakeArray(image, array.Array),
      isOfCells ? static_cast<vtkDataSetAttributes*>(output->GetCellData())
                : output->GetPointData());
    AddNames(output->GetFieldData(), before, this->Private->Names);
  }
  FillTable(this->Private->Rows, this->Private->Names, vtkTable::GetData(outputVector, 1));
}

void vtkSegmentationRepair::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  const auto print = [](ostream& to, const auto& item) { to << item.first << '=' << item.second; };
  os << indent << "FillHoles: " << this->FillHoles << "\n";
  os << indent << "RemoveSpikes: " << this->RemoveSpikes << "\n";
  voxplex::PrintList(
    os, indent, "MinimumThickness", this->Private->MinimumThicknesses, " none", print);
  voxplex::PrintList(os, indent, "Shell", this->Private->Shells, " none", print);
  os << indent << "FirstShellLabel: " << this->FirstShellLabel << "\n";
  os << indent << "CheckImage: " << this->CheckImage << "\n";
  os << indent << "NumberOfThreads: " << this->NumberOfThreads << "\n";
  os << indent << "Vocabulary: " << this->Vocabulary << "\n";
  voxplex::PrintText(os, indent, "ErrorMessage", this->ErrorMessage);
  os << indent << "Report: " << (this->Private->Rows.empty() ? "(none)" : "") << "\n"
     << this->GetReport();
}
