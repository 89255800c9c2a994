// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// The .ply file: binary little-endian, all interfaces, the labels on both sides as properties of
// the faces; SPACE in a comment as 3D Slicer writes it. Not with vtkPLYWriter, which does not
// notice a full disk.

#include "LabelPairs.h"
#include "TextFile.h"
#include "Writers.h"

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkPolyData.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace voxplex::io
{
namespace
{

template <typename T>
void Append(TextFile& file, T value)
{
  std::array<char, sizeof(T)> bytes;
  std::memcpy(bytes.data(), &value, sizeof(T));
  if constexpr (std::endian::native == std::endian::big)
  {
    std::reverse(bytes.begin(), bytes.end());
  }
  file << std::string_view(bytes.data(), bytes.size());
}

} // namespace

void WritePLY(const MeshData& mesh, const std::string& path)
{
  vtkPolyData* surface = mesh.Interfaces;
  vtkDataArray* const pairs = RequireArray(surface->GetCellData(), "Labels");
  TextFile file(path);
  file << "ply\nformat binary_little_endian 1.0\n"
       << "comment Voxplex interfaces. SPACE=" << mesh.Space << "\nelement vertex "
       << surface->GetNumberOfPoints()
       << "\nproperty float x\nproperty float y\nproperty float z\nelement face "
       << surface->GetNumberOfCells()
       << "\nproperty list uchar int vertex_indices\nproperty int label\n"
          "property int other_label\nend_header\n";
  for (vtkIdType i = 0; i < surface->GetNumberOfPoints(); ++i)
  {
    std::array<double, 3> x;
    surface->GetPoint(i, x.data());
    for (const double coordinate : x)
    {
      Append(file, static_cast<float>(coordinate));
    }
  }
  vtkIdType size;
  const vtkIdType* ids;
  for (vtkIdType cell = 0; cell < surface->GetNumberOfCells(); ++cell)
  {
    surface->GetCellPoints(cell, size, ids);
    Append(file, static_cast<std::uint8_t>(3));
    for (vtkIdType k = 0; k < 3; ++k)
    {
      Append(file, static_cast<std::int32_t>(ids[k]));
    }
    Append(file, static_cast<std::int32_t>(LabelAt(pairs, cell, 0)));
    Append(file, static_cast<std::int32_t>(LabelAt(pairs, cell, 1)));
  }
  file.Close();
}

} // namespace voxplex::io
