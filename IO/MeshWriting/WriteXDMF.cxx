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

/** The shape and type of a dataset of the .h5 file. */
struct Dataset
{
  const char* Name;
  std::size_t Rows;
  std::size_t Columns;
  const char* Type;
  int Precision;
};

/** @param element with its attributes, which has the dataset inside */
void WriteElement(
  TextFile& file, const std::string& element, const std::string& heavyName, const Dataset& dataset)
{
  file << "      <" << element << ">\n        <DataItem Dimensions=\"" << dataset.Rows;
  if (dataset.Columns > 1)
  {
    file << ' ' << dataset.Columns;
  }
  file << "\" NumberType=\"" << dataset.Type << "\" Precision=\"" << dataset.Precision
       << "\" Format=\"HDF\">" << EscapeForXML(heavyName) << ":/" << dataset.Name
       << "</DataItem>\n      </" << element.substr(0, element.find(' ')) << ">\n";
}

std::string Topology(const char* type, std::size_t cells, std::size_t vertices)
{
  return std::string("Topology TopologyType=\"") + type + "\" NumberOfElements=\"" +
    std::to_string(cells) + "\" NodesPerElement=\"" + std::to_string(vertices) + "\"";
}

std::string Attribute(const char* name, const char* type)
{
  return std::string("Attribute Name=\"") + name + "\" AttributeType=\"" + type +
    "\" Center=\"Cell\"";
}

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

  const auto write = [&](const std::string& element, const Dataset& dataset)
  { WriteElement(file, element, heavyFile, dataset); };
  const std::string geometry = "Geometry GeometryType=\"XYZ\"";
  const Dataset coordinates{ "mesh/geometry", points, 3, "Float", 8 };
  file << "    <Grid Name=\"mesh\" GridType=\"Uniform\">\n";
  write(Topology("Tetrahedron", cells, 4), { "mesh/topology", cells, 4, "Int", 8 });
  write(geometry, coordinates);
  write(Attribute("Label", "Scalar"), { "mesh/labels", cells, 1, "Int", 4 });
  file << "    </Grid>\n    <Grid Name=\"facets\" GridType=\"Uniform\">\n";
  write(Topology("Triangle", triangles, 3), { "facets/topology", triangles, 3, "Int", 8 });
  write(geometry, coordinates);
  write(Attribute("Number", "Scalar"), { "facets/numbers", triangles, 1, "Int", 4 });
  write(Attribute("Labels", "Matrix"), { "facets/labels", triangles, 2, "Int", 4 });
  file << "    </Grid>\n";
  file << "  </Domain>\n</Xdmf>\n";
  file.Close();
}

} // namespace voxplex::io
