// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// VTK's writers: .vtu and .vtp files (appended raw data, compressed with zlib, 64-bit block headers), .vtk files (binary,
// version 4.2 of the format, which more programs read than 5.1), and .stl files (binary, all interfaces in one solid).
//
// Names of labels and surfaces and the coordinate system are string arrays in memory. meshio reads no file that has
// one. So files of meshes have the bytes of the texts in their place, see TextsOf() in LabelTable.h. Interfaces of 3D
// meshes keep strings: meshio does not read their formats at all.

#include "FileError.h"
#include "LabelTable.h"
#include "SpaceTimeSurfaces.h"
#include "TimeSlabs.h"
#include "Writers.h"

#include <vtkErrorCode.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkPolyDataWriter.h>
#include <vtkSTLWriter.h>
#include <vtkStringArray.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkUnstructuredGridWriter.h>
#include <vtkXMLPolyDataWriter.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <cerrno>
#include <cstring>

namespace voxplex::io
{
namespace
{

enum class TextForm
{
  Strings, ///< vtkStringArray
  Bytes    ///< vtkUnsignedCharArray
};

/** Gives a text of field data this form, whichever it had. Others' arrays stay as they are. */
void SetTextForm(vtkFieldData* fields, const char* name, TextForm form)
{
  vtkNew<vtkStringArray> strings;
  vtkNew<vtkUnsignedCharArray> bytes;
  for (const std::string& text : TextsOf(fields, name))
  {
    strings->InsertNextValue(text);
    for (const char* byte = text.c_str(); *byte != '\0'; ++byte) // a 0 inside would be an end
    {
      bytes->InsertNextValue(static_cast<unsigned char>(*byte));
    }
    bytes->InsertNextValue(0);
  }
  vtkAbstractArray* array = bytes;
  if (form == TextForm::Strings)
  {
    array = strings;
  }
  array->SetName(name);
  if (array->GetNumberOfValues() > 0)
  {
    fields->AddArray(array);
  }
}

/** A shallow copy with our texts in these forms. */
template <typename TData>
vtkSmartPointer<TData> WithTextForms(TData* data, TextForm names, TextForm space)
{
  auto copy = vtkSmartPointer<TData>::New();
  copy->ShallowCopy(data);
  vtkNew<vtkFieldData> fields;
  fields->ShallowCopy(data->GetFieldData());
  SetTextForm(fields, "LabelNames", names);
  SetTextForm(fields, "SurfaceNames", names);
  SetTextForm(fields, "SPACE", space);
  copy->SetFieldData(fields);
  return copy;
}

/** @throws FileError if the writer reports an error, such as a full disk */
template <typename TWriter>
void Run(TWriter* writer, vtkDataSet* data, const std::string& path)
{
  writer->SetInputData(data);
  writer->SetFileName(path.c_str());
  errno = 0;
  const int done = writer->Write();
  const unsigned long code = writer->GetErrorCode();
  if (!done || code != vtkErrorCode::NoError)
  {
    Refuse(errno != 0 ? std::strerror(errno) : vtkErrorCode::GetStringFromErrorCode(code));
  }
}

template <typename TWriter>
void WriteXML(vtkDataSet* data, const std::string& path)
{
  vtkNew<TWriter> writer;
  writer->SetDataModeToAppended();
  writer->EncodeAppendedDataOff();
  writer->SetCompressorTypeToZLib();
  writer->SetHeaderTypeToUInt64();
  Run(writer.Get(), data, path);
}

template <typename TWriter>
void WriteLegacy(vtkDataSet* data, const std::string& header, const std::string& path)
{
  vtkNew<TWriter> writer;
  writer->SetHeader(header.c_str());
  writer->SetFileTypeToBinary();
  writer->SetFileVersion(TWriter::VTK_LEGACY_READER_VERSION_4_2);
  Run(writer.Get(), data, path);
}

} // namespace

void WriteGrid(vtkUnstructuredGrid* grid, const std::string& path)
{
  // 3D Slicer takes RAS from a string only, and LPS where there is none.
  const bool isLPS = TextsOf(grid->GetFieldData(), "SPACE") == std::vector<std::string>{ "LPS" };
  WriteXML<vtkXMLUnstructuredGridWriter>(
    WithTextForms(grid, TextForm::Bytes, isLPS ? TextForm::Bytes : TextForm::Strings), path);
}

void WriteVTU(const MeshData& mesh, const std::string& path)
{
  WriteGrid(mesh.Tetrahedra, path);
}

void WriteVTP(const MeshData& mesh, const std::string& path)
{
  WriteXML<vtkXMLPolyDataWriter>(
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

void WriteLegacyVTKMesh(const MeshData& mesh, const std::string& path)
{
  // 3D Slicer takes the coordinate system from the header.
  WriteLegacy<vtkUnstructuredGridWriter>(
    WithTextForms(mesh.Tetrahedra, TextForm::Bytes, TextForm::Bytes),
    "Voxplex tetrahedra, SPACE=" + mesh.Space, path);
}

void WriteLegacyVTKInterfaces(const MeshData& mesh, const std::string& path)
{
  WriteLegacy<vtkPolyDataWriter>(
    WithTextForms(mesh.Interfaces, TextForm::Strings, TextForm::Strings),
    "Voxplex interfaces, SPACE=" + mesh.Space, path);
}

void WriteSTL(const MeshData& mesh, const std::string& path)
{
  // 3D Slicer takes the coordinate system from the header, here, too.
  vtkNew<vtkSTLWriter> writer;
  writer->SetFileTypeToBinary();
  writer->SetHeader(("Voxplex interfaces. SPACE=" + mesh.Space).c_str());
  Run(writer.Get(), mesh.Interfaces, path);
}

} // namespace voxplex::io
