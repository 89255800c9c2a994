// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSimplexMeshInterfaces.h"

#include "Base/Error.h"
#include "Mesh/FindInterfaces.h"
#include "Mesh/PutRight.h"
#include "Private/Execution.h"
#include "Private/LabelledMesh.h"
#include "Private/Lists.h"
#include "Private/MeshOutput.h"
#include "Private/MeshingMessages.h"

#include "vtkDataArray.h"
#include "vtkFieldData.h"
#include "vtkIdTypeArray.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

vtkStandardNewMacro(vtkSimplexMeshInterfaces);

namespace
{

/** What VTK's filters leave out. @throws voxplex::InputError */
void CheckHidden(vtkUnstructuredGrid* grid)
{
  using Attributes = vtkDataSetAttributes;
  vtkUnsignedCharArray* const cells = grid->GetCellGhostArray();
  vtkUnsignedCharArray* const points = grid->GetPointGhostArray();
  std::vector<vtkIdType> hidden;
  for (vtkIdType c = 0; (cells || points) && c < grid->GetNumberOfCells(); ++c)
  {
    vtkIdType size = 0;
    const vtkIdType* ids = nullptr;
    grid->GetCellPoints(c, size, ids);
    if ((cells &&
          (cells->GetValue(c) &
            (Attributes::DUPLICATECELL | Attributes::REFINEDCELL | Attributes::HIDDENCELL))) ||
      (points &&
        std::any_of(ids, ids + size,
          [points](vtkIdType id) { return points->GetValue(id) & Attributes::HIDDENPOINT; })))
    {
      hidden.push_back(c);
    }
  }
  if (!hidden.empty())
  {
    throw voxplex::InputError("Cells of the mesh that an array of ghost types hides: " +
      std::to_string(hidden.size()) + ", the first is cell " + std::to_string(hidden.front()) +
      ". Remove them, or the array to use them.");
  }
}

void Read(vtkUnstructuredGrid* grid, vtkAbstractArray* labels, voxplex::SimplexMesh<3>& mesh)
{
  mesh = voxplex::ReadTetrahedra(grid, labels);
}

void Read(vtkUnstructuredGrid* grid, vtkAbstractArray* labels, voxplex::SimplexMesh<4>& mesh)
{
  mesh = voxplex::ReadPentatopes(grid, labels, 1.0);
}

void MakeOutputs(
  voxplex::SimplexMesh<3>&& mesh, vtkUnstructuredGrid* grid, vtkInformationVector* outputs)
{
  voxplex::MoveToOutput(
    std::move(mesh), voxplex::ImageFrame(), grid, vtkPolyData::GetData(outputs, 1), 1);
}

/** Times are those since the first one. */
void MakeOutputs(
  voxplex::SimplexMesh<4>&& mesh, vtkUnstructuredGrid* grid, vtkInformationVector* outputs)
{
  const auto [first, last] = std::minmax_element(mesh.Points.begin(), mesh.Points.end(),
    [](const auto& p, const auto& q) { return p[3] < q[3]; });
  const auto frame = voxplex::MakeSpaceTimeFrame({}, 2, (*first)[3], (*last)[3], 1.0);
  for (voxplex::Point<4>& p : mesh.Points)
  {
    p[3] -= frame.FirstTime;
  }
  voxplex::MoveToOutput(
    std::move(mesh), frame, {}, grid, vtkUnstructuredGrid::GetData(outputs, 2), 1);
}

/** Without the points that were left out. @param points the numbers of the others */
void KeepPoints(
  const std::vector<std::uint32_t>& points, vtkUnstructuredGrid* made, vtkUnstructuredGrid* output)
{
  vtkNew<vtkPointData> before;
  before->ShallowCopy(output->GetPointData());
  output->SetPoints(made->GetPoints());
  output->GetPointData()->Initialize();
  output->GetPointData()->CopyAllOn();
  output->GetPointData()->CopyAllocate(before, static_cast<vtkIdType>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    output->GetPointData()->CopyData(before, points[i], static_cast<vtkIdType>(i));
  }
  if (vtkDataArray* const pairs = output->GetFieldData()->GetArray("PeriodicPairs"))
  {
    const auto copy = vtkSmartPointer<vtkDataArray>::Take(pairs->NewInstance());
    copy->DeepCopy(pairs);
    for (vtkIdType i = 0; i < 2 * pairs->GetNumberOfTuples(); ++i)
    {
      const double id = pairs->GetComponent(i / 2, i % 2);
      copy->SetComponent(i / 2, i % 2,
        static_cast<double>(std::lower_bound(points.begin(), points.end(), id) - points.begin()));
    }
    output->GetFieldData()->AddArray(copy);
  }
}

/** The mesh's own values, to the bit, in place of those that were made. */
void CopyPointData(vtkUnstructuredGrid* mesh, vtkDataSet* interfaces)
{
  auto* const ids = vtkIdTypeArray::SafeDownCast(interfaces->GetPointData()->GetArray("PointIds"));
  for (const char* name : { "Time", "BoundaryVelocity" })
  {
    vtkDataArray* const values = mesh->GetPointData()->GetArray(name);
    if (ids && values && interfaces->GetPointData()->HasArray(name))
    {
      const auto own = vtkSmartPointer<vtkDataArray>::Take(values->NewInstance());
      own->SetName(name);
      own->SetNumberOfComponents(values->GetNumberOfComponents());
      for (vtkIdType i = 0; i < ids->GetNumberOfValues(); ++i)
      {
        own->InsertNextTuple(ids->GetValue(i), values);
      }
      interfaces->GetPointData()->AddArray(own);
    }
  }
}

} // namespace

//----------------------------------------------------------------------------------------------------
vtkSimplexMeshInterfaces::vtkSimplexMeshInterfaces()
{
  this->SetNumberOfOutputPorts(3);
  this->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "Label");
}

int vtkSimplexMeshInterfaces::FillOutputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), port == 1 ? "vtkPolyData" : "vtkUnstructuredGrid");
  return 1;
}

int vtkSimplexMeshInterfaces::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  this->NumberOfTurnedElements = 0;
  this->Changed = false;
  vtkUnstructuredGrid* const grid = vtkUnstructuredGrid::GetData(inputVector[0]);
  this->ErrorMessage = voxplex::CatchFailure(
    [&]
    {
      CheckHidden(grid);
      voxplex::HasPentatopes(grid) ? this->Fill<4>(inputVector, outputVector)
                                   : this->Fill<3>(inputVector, outputVector);
    },
    "There is not enough memory for this mesh.", "");
  if (this->ErrorMessage.empty())
  {
    return 1;
  }
  voxplex::EmptyOutputs(outputVector);
  vtkErrorMacro(<< this->ErrorMessage);
  return 0;
}

template <int D>
void vtkSimplexMeshInterfaces::Fill(
  vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkUnstructuredGrid* const grid = vtkUnstructuredGrid::GetData(inputVector[0]);
  voxplex::SimplexMesh<D> mesh;
  Read(grid, this->GetInputAbstractArrayToProcess(0, inputVector), mesh);
  const voxplex::MeshChanges changes = voxplex::PutRight(mesh);
  this->NumberOfTurnedElements = static_cast<vtkIdType>(changes.Turned);
  this->Changed = !changes.IsNone();

  vtkUnstructuredGrid* const output = vtkUnstructuredGrid::GetData(outputVector, 0);
  output->ShallowCopy(grid);
  if (mesh.Simplices.empty())
  {
    return;
  }
  voxplex::FindInterfaces(mesh, 1);
  vtkNew<vtkUnstructuredGrid> made;
  MakeOutputs(std::move(mesh), made, outputVector);
  if (this->Changed)
  {
    output->SetCells(grid->GetCellType(0), made->GetCells());
  }
  if (!changes.Points.empty())
  {
    KeepPoints(changes.Points, made, output);
  }
  for (int port = 1; port < 3; ++port)
  {
    CopyPointData(output, vtkDataSet::GetData(outputVector, port));
    vtkDataObject::GetData(outputVector, port)->GetFieldData()->PassData(grid->GetFieldData());
  }
}

void vtkSimplexMeshInterfaces::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "NumberOfTurnedElements: " << this->NumberOfTurnedElements << "\n";
  os << indent << "Changed: " << this->Changed << "\n";
  voxplex::PrintText(os, indent, "ErrorMessage", this->ErrorMessage);
}
