// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "SpaceTimeFiles.h"

#include "Errors.h"
#include "FileError.h"
#include "OutputFiles.h"
#include "Text.h"
#include "WholeFiles.h"

#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPentatopeMeshTimeSlice.h>
#include <vtkSimplexMeshWriter.h>
#include <vtkUnstructuredGrid.h>

#include <filesystem>
#include <utility>

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

std::vector<double> SliceTimes(const std::vector<double>& frameTimes, std::optional<int> count)
{
  if (!count)
  {
    return frameTimes;
  }
  std::vector<double> times;
  const double first = frameTimes.front();
  const double last = frameTimes.back();
  for (int i = 0; i < *count - 1; ++i)
  {
    times.push_back(first + (last - first) * i / (*count - 1));
  }
  times.push_back(last);
  return times;
}

/** Planes at the ends of the series are none, so there may be no plane. */
int NumberOfPlanes(vtkUnstructuredGrid* mesh)
{
  vtkDataArray* const planes = mesh->GetFieldData()->GetArray("TimePlanes");
  return planes ? static_cast<int>(planes->GetNumberOfTuples()) : 0;
}

} // namespace

SliceFiles::SliceFiles(
  const std::string& prefix, const std::vector<double>& frameTimes, std::optional<int> count)
  : Collection(CollectionName(prefix))
  , Times(SliceTimes(frameTimes, count))
{
  for (std::size_t i = 0; i < this->Times.size(); ++i)
  {
    this->Slices.push_back(prefix + std::to_string(i) + ".vtu");
  }
}

void CheckFilePrefix(
  const std::string& option, const std::string& prefix, const std::string& example)
{
  const fs::path path(prefix);
  if (prefix.empty())
  {
    throw UsageError("--" + option + ": the name is empty");
  }
  if (!path.has_filename())
  {
    throw UsageError("--" + option + ": '" + prefix +
      "' names no file; give the beginning of the names, such as " + example + " for " + example +
      "0.vtu, " + example + "1.vtu and so on");
  }
  if (path.extension() == ".vtu" || path.extension() == ".pvd")
  {
    throw UsageError("--" + option + ": '" + prefix +
      "' is the whole name of a file; give the beginning, " + "such as " + path.stem().string() +
      "_");
  }
}

Slicer::Slicer(vtkUnstructuredGrid* mesh, bool compress)
  : Filter(vtkSmartPointer<vtkPentatopeMeshTimeSlice>::New())
  , Compress(compress)
{
  this->Filter->SetInputData(mesh);
}

Slicer::~Slicer() = default;

void Slicer::Write(double time, const std::string& path, const io::WholeFiles& files)
{
  this->Filter->UpdateTimeStep(time);
  if (!this->Filter->GetErrorMessage().empty())
  {
    throw io::FileError(this->Filter->GetErrorMessage());
  }
  vtkNew<vtkUnstructuredGrid> slice;
  slice->ShallowCopy(this->Filter->GetOutputDataObject(0));

  vtkNew<vtkDoubleArray> timeValue;
  timeValue->SetName("TimeValue");
  timeValue->InsertNextValue(time);
  slice->GetFieldData()->AddArray(timeValue);
  WriteMeshFile(
    slice, nullptr, vtkSimplexMeshWriter::CONTENT_MESH, path, files, -1, this->Compress);
}

void WriteCollection(const SliceFiles& slices, const io::WholeFiles& files)
{
  files.WriteText(slices.Collection,
    [&slices](io::TextFile& file)
    {
      file << "<?xml version=\"1.0\"?>\n"
              "<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
              "  <Collection>\n";
      for (std::size_t i = 0; i < slices.Slices.size(); ++i)
      {
        file << "    <DataSet timestep=\"" << slices.Times[i] << "\" group=\"\" part=\"0\" file=\""
             << io::EscapeForXML(fs::path(slices.Slices[i]).filename().string()) << "\"/>\n";
      }
      file << "  </Collection>\n</VTKFile>\n";
    });
}

//----------------------------------------------------------------------------------------------------
SlabFiles::SlabFiles(std::string prefix, const std::string& output)
  : Prefix(std::move(prefix))
  , Extension(output.empty() ? ".vtu" : std::filesystem::path(output).extension().string())
{
}

std::string SlabFiles::NameOf(int slab) const
{
  return this->Prefix + std::to_string(slab) + this->Extension;
}

void SlabFiles::AnnounceFirst(io::WholeFiles& files) const
{
  AnnounceMesh(files, this->NameOf(0));
}

void SlabFiles::AnnounceOthers(io::WholeFiles& files, vtkUnstructuredGrid* mesh) const
{
  for (int slab = 1; slab <= NumberOfPlanes(mesh); ++slab)
  {
    AnnounceMesh(files, this->NameOf(slab));
  }
}

void SlabFiles::Write(vtkUnstructuredGrid* mesh, vtkDataObject* boundary,
  const io::WholeFiles& files, bool compress) const
{
  const int planes = NumberOfPlanes(mesh);
  for (int slab = 0; slab <= planes; ++slab)
  {
    WriteMeshFile(mesh, boundary, vtkSimplexMeshWriter::CONTENT_MESH, this->NameOf(slab), files,
      planes > 0 ? slab : -1, compress);
  }
}

} // namespace voxplex::cli
