// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// The .vtu and .vtp files: appended raw data, compressed with zlib, 64-bit block headers.

#include "FieldTexts.h"
#include "LabelTable.h"
#include "SpaceTimeSurfaces.h"
#include "TimeSlabs.h"
#include "VTKWriting.h"
#include "Writers.h"

#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLPolyDataWriter.h>
#include <vtkXMLUnstructuredGridWriter.h>

namespace voxplex::io
{
namespace
{

template <typename TWriter>
void Write(vtkDataSet* data, const std::string& path)
{
  vtkNew<TWriter> writer;
  writer->SetInputData(data);
  writer->SetDataModeToAppended();
  writer->EncodeAppendedDataOff();
  writer->SetCompressorTypeToZLib();
  writer->SetHeaderTypeToUInt64();
  RunWriter(writer.Get(), path);
}

} // namespace

void WriteGrid(vtkUnstructuredGrid* grid, const std::string& path)
{
  // 3D Slicer takes RAS from a string only, and LPS where there is none.
  const bool isLPS = TextsOf(grid->GetFieldData(), "SPACE") == std::vector<std::string>{ "LPS" };
  const auto file =
    WithTextForms(grid, TextForm::Bytes, isLPS ? TextForm::Bytes : TextForm::Strings);
  Write<vtkXMLUnstructuredGridWriter>(file, path);
}

void WriteVTU(const MeshData& mesh, const std::string& path)
{
  WriteGrid(mesh.Tetrahedra, path);
}

void WriteVTP(const MeshData& mesh, const std::string& path)
{
  Write<vtkXMLPolyDataWriter>(
    WithTextForms(mesh.Interfaces, TextForm::Strings, TextForm::Strings), path);
}

void WriteSpaceTimeVTU(const SpaceTimeMeshData& mesh, const std::string& path)
{
  WriteGrid(mesh.Slab < 0 ? mesh.Pentatopes : SlabOf(mesh.Pentatopes, mesh.Slab).Get(), path);
}

void WriteSpaceTimeBoundaryVTU(const SpaceTimeMeshData& mesh, const std::string& path)
{
  WriteGrid(WithSurfaces(mesh.Boundary), path);
}

} // namespace voxplex::io
