// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "SliceFiles.h"

#include "Errors.h"
#include "Writers/TextFile.h"
#include "Writers/Writers.h"

#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPentatopeMeshTimeSlice.h>
#include <vtkUnstructuredGrid.h>

#include <filesystem>

namespace fs = std::filesystem;

namespace voxplex::cli
{
namespace
{

std::string CollectionName(const std::string& prefix)
{
  const fs::path path(prefix);
  std::string stem = path.filename().string();
  const std::size_t last = stem.find_last_not_of("_-.");
  if (last != std::string::npos)
  {
    stem.erase(last + 1);
  }
  return (path.parent_path() / (stem + ".pvd")).string();
}

std::vector<double> SliceTimes(const ScalarImage& frames, std::optional<int> count)
{
  std::vector<double> times;
  if (!count)
  {
    for (int frame = 0; frame < frames.Frames; ++frame)
    {
      times.push_back(frames.TimeOf(frame));
    }
    return times;
  }
  const double first = frames.TimeOf(0);
  const double last = frames.TimeOf(frames.Frames - 1);
  for (int i = 0; i < *count - 1; ++i)
  {
    times.push_back(first + (last - first) * i / (*count - 1));
  }
  times.push_back(last);
  return times;
}

std::string EscapeForXML(const std::string& text)
{
  std::string escaped;
  for (const char character : text)
  {
    switch (character)
    {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      default:
        escaped += character;
    }
  }
  return escaped;
}

} // namespace

SliceFiles::SliceFiles(
  const std::string& prefix, const ScalarImage& frames, std::optional<int> count)
  : Collection(CollectionName(prefix))
  , Times(SliceTimes(frames, count))
{
  for (std::size_t i = 0; i < this->Times.size(); ++i)
  {
    this->Slices.push_back(prefix + std::to_string(i) + ".vtu");
  }
}

void CheckSlicePrefix(const std::string& prefix)
{
  const fs::path path(prefix);
  if (prefix.empty())
  {
    throw UsageError("--slices: the name is empty");
  }
  if (!path.has_filename())
  {
    throw UsageError("--slices: '" + prefix + "' names no file; give the beginning of the names, " +
      "such as heart_ for heart_0.vtu, heart_1.vtu and so on");
  }
  if (path.extension() == ".vtu" || path.extension() == ".pvd")
  {
    throw UsageError("--slices: '" + prefix +
      "' is the whole name of a file; give the beginning, " + "such as " + path.stem().string() +
      "_");
  }
}

Slicer::Slicer(vtkUnstructuredGrid* mesh)
  : Filter(vtkSmartPointer<vtkPentatopeMeshTimeSlice>::New())
{
  this->Filter->SetInputData(mesh);
}

Slicer::~Slicer() = default;

void Slicer::Write(double time, const std::string& path)
{
  this->Filter->UpdateTimeStep(time);
  if (!this->Filter->GetErrorMessage().empty())
  {
    throw RunError(this->Filter->GetErrorMessage());
  }
  vtkNew<vtkUnstructuredGrid> slice;
  slice->ShallowCopy(this->Filter->GetOutputDataObject(0));

  vtkNew<vtkDoubleArray> timeValue;
  timeValue->SetName("TimeValue");
  timeValue->InsertNextValue(time);
  slice->GetFieldData()->AddArray(timeValue);
  WriteGrid(slice, path);
}

void WriteCollection(const SliceFiles& files, const std::string& path)
{
  TextFile file(path);
  file << "<?xml version=\"1.0\"?>\n"
          "<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
          "  <Collection>\n";
  for (std::size_t i = 0; i < files.Slices.size(); ++i)
  {
    file << "    <DataSet timestep=\"" << files.Times[i] << "\" group=\"\" part=\"0\" file=\""
         << EscapeForXML(fs::path(files.Slices[i]).filename().string()) << "\"/>\n";
  }
  file << "  </Collection>\n</VTKFile>\n";
  file.Close();
}

} // namespace voxplex::cli
