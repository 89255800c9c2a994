// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// The .feb file: FEBio's input, format 4.0. A part and a solid domain for each label, and a surface
// for each pair of labels. FEBio reads no domain without a material: each has one of its own,
// to be replaced by the user.

#include "MeshView.h"
#include "SetNames.h"
#include "TextFile.h"
#include "Writers.h"

namespace voxplex::io
{
namespace
{

void WriteMaterials(TextFile& file, const MeshView& view, const SetNames& names)
{
  file << "\t<!-- Placeholders, to be replaced: a domain must have a material. -->\n"
       << "\t<Material>\n";
  int id = 0;
  for (const auto& [label, cells] : view.TetrahedraOfLabel)
  {
    file << "\t\t<material id=\"" << ++id << "\" name=\"" << names.OfLabel(label)
         << "\" type=\"neo-Hookean\">\n"
         << "\t\t\t<density>1</density>\n\t\t\t<E>1</E>\n\t\t\t<v>0.3</v>\n\t\t</material>\n";
  }
  file << "\t</Material>\n";
}

template <std::size_t N>
void WriteCell(
  TextFile& file, const char* tag, std::int64_t id, const std::array<vtkIdType, N>& vertices)
{
  file << "\t\t\t<" << tag << " id=\"" << id << "\">";
  for (std::size_t i = 0; i < N; ++i)
  {
    file << (i == 0 ? "" : ",") << vertices[i] + 1;
  }
  file << "</" << tag << ">\n";
}

void WriteMesh(TextFile& file, const MeshView& view, const SetNames& names)
{
  file << "\t<Mesh>\n\t\t<Nodes name=\"Voxplex\">\n";
  for (vtkIdType i = 0; i < view.NumberOfPoints(); ++i)
  {
    const auto [x, y, z] = view.Point(i);
    file << "\t\t\t<node id=\"" << i + 1 << "\">" << x << ',' << y << ',' << z << "</node>\n";
  }
  file << "\t\t</Nodes>\n";
  for (const auto& [label, cells] : view.TetrahedraOfLabel)
  {
    file << "\t\t<Elements type=\"tet4\" name=\"" << names.OfLabel(label) << "\">\n";
    for (const vtkIdType cell : cells)
    {
      WriteCell(file, "elem", cell + 1, view.Tetrahedra[static_cast<std::size_t>(cell)]);
    }
    file << "\t\t</Elements>\n";
  }
  for (const auto& [pair, cells] : view.TrianglesOfPair)
  {
    file << "\t\t<Surface name=\"" << names.OfPair(pair) << "\">\n";
    std::int64_t id = 0;
    for (const vtkIdType cell : cells)
    {
      WriteCell(file, "tri3", ++id, view.Triangles[static_cast<std::size_t>(cell)]);
    }
    file << "\t\t</Surface>\n";
  }
  file << "\t</Mesh>\n";
}

void WriteDomains(TextFile& file, const MeshView& view, const SetNames& names)
{
  file << "\t<MeshDomains>\n";
  for (const auto& [label, cells] : view.TetrahedraOfLabel)
  {
    const std::string& name = names.OfLabel(label);
    file << "\t\t<SolidDomain name=\"" << name << "\" mat=\"" << name << "\"/>\n";
  }
  file << "\t</MeshDomains>\n";
}

} // namespace

void WriteFEBio(const MeshData& mesh, const std::string& path)
{
  const MeshView view(mesh);
  const SetNames names(view, FEBioNames); // nothing in them is to be escaped
  TextFile file(path);
  file << "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
       << "<!-- Written by Voxplex. SPACE=" << mesh.Space << " -->\n"
       << "<febio_spec version=\"4.0\">\n\t<Module type=\"solid\"/>\n";
  WriteMaterials(file, view, names);
  WriteMesh(file, view, names);
  WriteDomains(file, view, names);
  file << "</febio_spec>\n";
  file.Close();
}

} // namespace voxplex::io
