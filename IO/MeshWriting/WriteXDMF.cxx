// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// The .xdmf file and the .h5 file beside it: XDMF 3.0 with the numbers in HDF5, as FEniCS reads and
// writes them. Two grids over the same points: "mesh", tetrahedra with their labels, and "facets",
// triangles with the numbers of their pairs of labels.

#include "FileError.h"
#include "HDF5File.h"
#include "MeshView.h"
#include "SetNames.h"
#include "Text.h"
#include "TextFile.h"
#include "Writers.h"

#include <filesystem>

namespace voxplex::io
{
namespace
{

std::vector<double> Coordinates(const MeshView& view)
{
  std::vector<double> coordinates;
  coordinates.reserve(3 * static_cast<std::size_t>(view.NumberOfPoints()));
  for (vtkIdType i = 0; i < view.NumberOfPoints(); ++i)
  {
    const auto x = view.Point(i);
    coordinates.insert(coordinates.end(), x.begin(), x.end());
  }
  return coordinates;
}

template <std::size_t N>
std::vector<std::int64_t> Flat(const std::vector<std::array<vtkIdType, N>>& cells)
{
  std::vector<std::int64_t> flat;
  flat.reserve(N * cells.size());
  for (const auto& vertices : cells)
  {
    flat.insert(flat.end(), vertices.begin(), vertices.end());
  }
  return flat;
}

void WriteNumbers(const MeshView& view, const std::string& path)
{
  HDF5File file;
  file.Write("mesh/geometry", Coordinates(view), 3);
  file.Write("mesh/topology", Flat(view.Tetrahedra), 4);
  file.Write("mesh/labels",
    std::vector<std::int32_t>(view.LabelOfTetrahedron.begin(), view.LabelOfTetrahedron.end()), 1);

  std::vector<std::int32_t> numbers;
  std::vector<std::int32_t> pairs;
  for (const MeshView::LabelPair& pair : view.PairOfTriangle)
  {
    numbers.push_back(static_cast<std::int32_t>(view.PairNumber.at(pair)));
    pairs.push_back(static_cast<std::int32_t>(pair.first));
    pairs.push_back(static_cast<std::int32_t>(pair.second));
  }
  file.Write("facets/topology", Flat(view.Triangles), 3);
  file.Write("facets/numbers", numbers, 1);
  file.Write("facets/labels", pairs, 2);
  file.Close(path);
}

/** The XML of the grids, in which an item is a dataset of the .h5 file. */
class Description
{
public:
  Description(TextFile& file, const std::string& heavyName)
    : File(file)
    , HeavyName(EscapeForXML(heavyName))
  {
  }

  void BeginGrid(const char* name) const
  {
    this->File << "    <Grid Name=\"" << name << "\" GridType=\"Uniform\">\n";
  }
  void EndGrid() const { this->File << "    </Grid>\n"; }

  void WriteTopology(
    const char* type, const char* dataset, std::size_t cells, std::size_t vertices) const
  {
    this->File << "      <Topology TopologyType=\"" << type << "\" NumberOfElements=\"" << cells
               << "\" NodesPerElement=\"" << vertices << "\">\n";
    this->WriteItem(dataset, "Int", 8, cells, vertices);
    this->File << "      </Topology>\n";
  }
  void WriteGeometry(std::size_t points) const
  {
    this->File << "      <Geometry GeometryType=\"XYZ\">\n";
    this->WriteItem("mesh/geometry", "Float", 8, points, 3);
    this->File << "      </Geometry>\n";
  }
  void WriteAttribute(
    const char* name, const char* dataset, std::size_t cells, std::size_t components) const
  {
    this->File << "      <Attribute Name=\"" << name << "\" AttributeType=\""
               << (components == 1 ? "Scalar" : "Matrix") << "\" Center=\"Cell\">\n";
    this->WriteItem(dataset, "Int", 4, cells, components);
    this->File << "      </Attribute>\n";
  }

private:
  void WriteItem(const char* dataset, const char* type, int precision, std::size_t rows,
    std::size_t columns) const
  {
    this->File << "        <DataItem Dimensions=\"" << rows;
    if (columns > 1)
    {
      this->File << ' ' << columns;
    }
    this->File << "\" NumberType=\"" << type << "\" Precision=\"" << precision
               << "\" Format=\"HDF\">" << this->HeavyName << ":/" << dataset << "</DataItem>\n";
  }

  TextFile& File;
  std::string HeavyName;
};

/** Names and numbers as an object in JSON; names have no quotation marks and backslashes. */
template <typename TNumbers, typename TNameOf>
std::string ToJSON(const TNumbers& numbers, const TNameOf& nameOf)
{
  std::string json;
  for (const auto& [key, number] : numbers)
  {
    json += (json.empty() ? "{\"" : ", \"") + nameOf(key) + "\": " + std::to_string(number);
  }
  return json.empty() ? "{}" : json + "}";
}

void WriteInformation(TextFile& file, const char* name, const std::string& value)
{
  file << "    <Information Name=\"" << name << "\" Value=\"" << EscapeForXML(value) << "\"/>\n";
}

void WriteNames(TextFile& file, const MeshView& view)
{
  const SetNames names(view, QuotedNames);
  std::map<std::int64_t, std::int64_t> labels;
  for (const auto& [label, cells] : view.TetrahedraOfLabel)
  {
    labels[label] = label;
  }
  WriteInformation(
    file, "CellTags", ToJSON(labels, [&](std::int64_t label) { return names.OfLabel(label); }));
  WriteInformation(file, "FacetTags",
    ToJSON(view.PairNumber, [&](const LabelPair& pair) { return names.OfPair(pair); }));
}

} // namespace

void WriteXDMF(const MeshData& mesh, const std::string& path, const std::string& heavyName,
  const std::string& heavyPath)
{
  const std::string heavyFile = std::filesystem::path(heavyName).filename().string();
  RefuseIf(heavyFile.find(':') != std::string::npos,
    "XDMF has no way to refer to a file with ':' in its name; choose another name");
  const MeshView view(mesh);
  WriteNumbers(view, heavyPath);

  const auto points = static_cast<std::size_t>(view.NumberOfPoints());
  const std::size_t cells = view.Tetrahedra.size();
  const std::size_t triangles = view.Triangles.size();
  TextFile file(path);
  file << "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<Xdmf Version=\"3.0\">\n  <Domain>\n";
  WriteInformation(file, "Writer", "Voxplex");
  WriteInformation(file, "SPACE", mesh.Space);
  WriteNames(file, view);

  const Description description(file, heavyFile);
  description.BeginGrid("mesh");
  description.WriteTopology("Tetrahedron", "mesh/topology", cells, 4);
  description.WriteGeometry(points);
  description.WriteAttribute("Label", "mesh/labels", cells, 1);
  description.EndGrid();
  description.BeginGrid("facets");
  description.WriteTopology("Triangle", "facets/topology", triangles, 3);
  description.WriteGeometry(points);
  description.WriteAttribute("Number", "facets/numbers", triangles, 1);
  description.WriteAttribute("Labels", "facets/labels", triangles, 2);
  description.EndGrid();
  file << "  </Domain>\n</Xdmf>\n";
  file.Close();
}

} // namespace voxplex::io
