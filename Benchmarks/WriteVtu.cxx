// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "WriteVtu.h"

#include <bit>
#include <cstdint>
#include <fstream>
#include <stdexcept>
#include <vector>

namespace voxplex::benchmarks
{
namespace
{

static_assert(std::endian::native == std::endian::little);

/** The elements of the XML part, and the bytes that they refer to, in the same order. */
class AppendedArrays
{
public:
  template <typename Values>
  std::string Add(const char* type, const char* name, int components, const Values& values)
  {
    const std::uint64_t bytes = values.size() * sizeof(values[0]);
    const std::uint64_t offset = this->Data.size();
    this->Append(&bytes, sizeof(bytes));
    this->Append(values.data(), bytes);
    return std::string("<DataArray type=\"") + type + "\" Name=\"" + name +
      "\" NumberOfComponents=\"" + std::to_string(components) + "\" format=\"appended\" offset=\"" +
      std::to_string(offset) + "\"/>\n";
  }

  const std::vector<char>& Bytes() const { return this->Data; }

private:
  void Append(const void* data, std::size_t bytes)
  {
    const char* const first = static_cast<const char*>(data);
    this->Data.insert(this->Data.end(), first, first + bytes);
  }

  std::vector<char> Data;
};

} // namespace

void WriteVtu(const SimplexMesh<3>& mesh, const std::string& fileName)
{
  constexpr std::uint8_t tetrahedron = 10; // VTK_TETRA
  const std::size_t cells = mesh.Simplices.size();
  std::vector<std::int64_t> offsets(cells);
  for (std::size_t c = 0; c < cells; ++c)
  {
    offsets[c] = static_cast<std::int64_t>(4 * (c + 1));
  }
  AppendedArrays arrays;
  std::ofstream file(fileName, std::ios::binary);
  file << "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" "
          "byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<UnstructuredGrid>\n"
          "<Piece NumberOfPoints=\""
       << mesh.Points.size() << "\" NumberOfCells=\"" << cells << "\">\n<Points>\n"
       << arrays.Add("Float64", "Points", 3, mesh.Points) << "</Points>\n<Cells>\n"
       << arrays.Add("UInt32", "connectivity", 1, mesh.Simplices)
       << arrays.Add("Int64", "offsets", 1, offsets)
       << arrays.Add("UInt8", "types", 1, std::vector<std::uint8_t>(cells, tetrahedron))
       << "</Cells>\n<CellData>\n"
       << arrays.Add("Int64", "Label", 1, mesh.Labels)
       << "</CellData>\n</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_";
  file.write(arrays.Bytes().data(), static_cast<std::streamsize>(arrays.Bytes().size()));
  file << "\n</AppendedData>\n</VTKFile>\n";
  if (!file.flush())
  {
    throw std::runtime_error("cannot write " + fileName);
  }
}

} // namespace voxplex::benchmarks
