// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// VTK's writers: .vtu and .vtp files (appended raw data, 64-bit headers, compressed with zlib or as they are), .vtk files
// (binary, version 4.2 of the format, which more programs read than 5.1), and .stl files (binary, all interfaces in one
// solid).
//
// Names of labels and surfaces and the coordinate system are string arrays in memory. meshio reads no file that has
// one. So files of meshes have the bytes of the texts in their place, see TextsOf() in LabelTable.h. Interfaces of 3D
// meshes keep strings: meshio does not read their formats at all.

#include "FileError.h"
#include "LabelPairs.h"
#include "LabelTable.h"
#include "SetNames.h"
#include "TimeSlabs.h"
#include "Writers.h"

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkErrorCode.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkPolyDataWriter.h>
#include <vtkSTLWriter.h>
#include <vtkStringArray.h>
#include <vtkTypeInt64Array.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkUnstructuredGridWriter.h>
#include <vtkXMLPolyDataWriter.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <map>
#include <set>
#include <vector>

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
void WriteXML(vtkDataSet* data, bool compress, const std::string& path)
{
  vtkNew<TWriter> writer;
  writer->SetDataModeToAppended();
  writer->EncodeAppendedDataOff();
  writer->SetCompressorType(compress ? TWriter::ZLIB : TWriter::NONE);
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

/** By pair and side. */
std::map<SidedPair, std::string> NamesOf(const std::set<SidedPair>& sided, const LabelTable& table)
{
  std::set<LabelPair> pairs;
  for (const auto& [side, pair] : sided)
  {
    pairs.insert(pair);
  }
  SetNames sets({}, pairs, table, QuotedNames);
  constexpr std::array<const char*, 3> ends{ "", "__initial", "__final" };
  std::map<SidedPair, std::string> names;
  for (const SidedPair& one : sided)
  {
    const auto& [side, pair] = one;
    const std::string end = ends.at(static_cast<std::size_t>(side));
    names[one] = side == 0
      ? sets.OfPair(pair)
      : sets.MakeUnique(sets.OfPair(pair) + end,
          "_" + std::to_string(pair.first) + "_" + std::to_string(pair.second) + end);
  }
  return names;
}

/**
 * A copy of a boundary grid that shares its arrays, with
 * - a cell array `Surface` (vtkTypeInt64Array): a number for the pair of labels and the side. The
 *   numbers are those of NumberSidedPairs(), which .mfem and .mesh files have;
 * - in the field data `SurfaceNumbers` (vtkTypeInt64Array), increasing, and `SurfaceNames`
 *   (vtkStringArray): names as SetNames makes them, `Blood__Muscle`; those of flat ends are
 *   `Blood__background__initial` and `Blood__background__final`.
 *
 * A grid without the cell array `Labels` is returned as it is. Labels may have 64 bits.
 */
vtkSmartPointer<vtkUnstructuredGrid> WithSurfaces(vtkUnstructuredGrid* boundary)
{
  vtkDataArray* const labels = boundary->GetCellData()->GetArray("Labels");
  vtkDataArray* const sides = boundary->GetCellData()->GetArray("Side");
  const vtkIdType cells = boundary->GetNumberOfCells();
  const bool isOurs = labels && labels->GetNumberOfComponents() == 2 &&
    labels->GetNumberOfTuples() == cells && (!sides || sides->GetNumberOfValues() == cells);
  if (!isOurs)
  {
    return boundary;
  }
  const std::vector<SidedPair> pairs = SidedPairsOf(boundary, AnyLabelAt);
  const std::set<SidedPair> all(pairs.begin(), pairs.end());
  std::int64_t largest = 0; // every label has a boundary
  for (const auto& [side, pair] : all)
  {
    largest = std::max(largest, pair.first);
  }
  const std::map<SidedPair, std::int64_t> numbers = NumberSidedPairs(all, largest);
  const std::map<SidedPair, std::string> names =
    NamesOf(all, GetLabelTable(boundary->GetFieldData()));

  vtkNew<vtkTypeInt64Array> surfaces;
  surfaces->SetName("Surface");
  for (const SidedPair& pair : pairs)
  {
    surfaces->InsertNextValue(numbers.at(pair));
  }
  std::map<std::int64_t, std::string> nameOfNumber;
  for (const auto& [pair, number] : numbers)
  {
    nameOfNumber[number] = names.at(pair);
  }
  vtkNew<vtkTypeInt64Array> listed;
  listed->SetName("SurfaceNumbers");
  vtkNew<vtkStringArray> texts;
  texts->SetName("SurfaceNames");
  for (const auto& [number, name] : nameOfNumber)
  {
    listed->InsertNextValue(number);
    texts->InsertNextValue(name);
  }
  auto result = vtkSmartPointer<vtkUnstructuredGrid>::New();
  result->ShallowCopy(boundary);
  result->GetCellData()->AddArray(surfaces);
  vtkNew<vtkFieldData> fields;
  fields->ShallowCopy(boundary->GetFieldData());
  fields->AddArray(listed);
  fields->AddArray(texts);
  result->SetFieldData(fields);
  return result;
}

} // namespace

void WriteGrid(vtkUnstructuredGrid* grid, bool compress, const std::string& path)
{
  // 3D Slicer takes RAS from a string only, and LPS where there is none.
  const bool isLPS = TextsOf(grid->GetFieldData(), "SPACE") == std::vector<std::string>{ "LPS" };
  WriteXML<vtkXMLUnstructuredGridWriter>(
    WithTextForms(grid, TextForm::Bytes, isLPS ? TextForm::Bytes : TextForm::Strings), compress,
    path);
}

void WriteVTU(const MeshData& mesh, const std::string& path)
{
  WriteGrid(mesh.Tetrahedra, mesh.Compress, path);
}

void WriteVTP(const MeshData& mesh, const std::string& path)
{
  WriteXML<vtkXMLPolyDataWriter>(
    WithTextForms(mesh.Interfaces, TextForm::Strings, TextForm::Strings), mesh.Compress, path);
}

void WriteInterfacesVTU(const MeshData& mesh, const std::string& path)
{
  vtkNew<vtkUnstructuredGrid> triangles;
  triangles->SetPoints(mesh.Interfaces->GetPoints());
  triangles->SetCells(VTK_TRIANGLE, mesh.Interfaces->GetPolys());
  triangles->GetPointData()->ShallowCopy(mesh.Interfaces->GetPointData());
  triangles->GetCellData()->ShallowCopy(mesh.Interfaces->GetCellData());
  triangles->SetFieldData(mesh.Interfaces->GetFieldData());
  WriteGrid(triangles, mesh.Compress, path);
}

void WriteSpaceTimeVTU(const SpaceTimeMeshData& mesh, const std::string& path)
{
  WriteGrid(mesh.Slab < 0 ? mesh.Pentatopes : ExtractSlab(mesh.Pentatopes, mesh.Slab).Get(),
    mesh.Compress, path);
}

void WriteSpaceTimeBoundaryVTU(const SpaceTimeMeshData& mesh, const std::string& path)
{
  WriteGrid(WithSurfaces(mesh.Boundary), mesh.Compress, path);
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
