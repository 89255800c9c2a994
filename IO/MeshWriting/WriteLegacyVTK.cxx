// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// The .vtk files: binary, version 4.2 of the format, which more programs read than 5.1.

#include "FieldTexts.h"
#include "VTKWriting.h"
#include "Writers.h"

#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkPolyDataWriter.h>
#include <vtkUnstructuredGrid.h>
#include <vtkUnstructuredGridWriter.h>

namespace voxplex::io
{
namespace
{

template <typename TWriter>
void Write(vtkDataSet* data, const char* header, const std::string& path)
{
  vtkNew<TWriter> writer;
  writer->SetInputData(data);
  writer->SetHeader(header);
  writer->SetFileTypeToBinary();
  writer->SetFileVersion(TWriter::VTK_LEGACY_READER_VERSION_4_2);
  RunWriter(writer.Get(), path);
}

} // namespace

void WriteLegacyVTKMesh(const MeshData& mesh, const std::string& path)
{
  // 3D Slicer takes the coordinate system from the header.
  const auto file = WithTextForms(mesh.Tetrahedra, TextForm::Bytes, TextForm::Bytes);
  Write<vtkUnstructuredGridWriter>(file, ("Voxplex tetrahedra, SPACE=" + mesh.Space).c_str(), path);
}

void WriteLegacyVTKInterfaces(const MeshData& mesh, const std::string& path)
{
  const auto file = WithTextForms(mesh.Interfaces, TextForm::Strings, TextForm::Strings);
  Write<vtkPolyDataWriter>(file, ("Voxplex interfaces, SPACE=" + mesh.Space).c_str(), path);
}

} // namespace voxplex::io
