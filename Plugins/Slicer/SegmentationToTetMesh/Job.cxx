// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Job.h"

#include "Arguments.h"
#include "Description.h"
#include "Errors.h"
#include "FilterParameters.h"
#include "OutputFiles.h"
#include "ProgressReport.h"
#include "Results.h"
#include "WholeFiles.h"

#include <vtkCallbackCommand.h>
#include <vtkExecutive.h>
#include <vtkImageData.h>
#include <vtkImageToTetMeshFilter.h>
#include <vtkMeshingStatistics.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkSegmentationReader.h>
#include <vtkSegmentationRepair.h>
#include <vtkSimplexMeshQuality.h>
#include <vtkSimplexMeshWriter.h>
#include <vtkUnstructuredGrid.h>

#include <optional>

namespace voxplex::slicer
{
namespace
{

constexpr ProgressReport::Stage Reading{ "vtkSegmentationReader", "Reading the label map", 0.0,
  0.05 };
constexpr ProgressReport::Stage Repairing{ "vtkSegmentationRepair", "Repairing the label map", 0.05,
  0.1 };
constexpr ProgressReport::Stage Meshing{ "vtkImageToTetMeshFilter", "Meshing", 0.1, 0.95 };
constexpr ProgressReport::Stage Measuring{ "vtkSimplexMeshQuality", "Comparing with the label map",
  0.95, 0.98 };
constexpr ProgressReport::Stage Writing{ "vtkSimplexMeshWriter", "Writing the mesh", 0.98, 1.0 };

/** An object with an observer of its errors and warnings does not print them. */
void Silence(vtkObject* object)
{
  vtkNew<vtkCallbackCommand> nothing;
  nothing->SetCallback([](vtkObject*, unsigned long, void*, void*) {});
  object->AddObserver(vtkCommand::ErrorEvent, nothing);
  object->AddObserver(vtkCommand::WarningEvent, nothing);
}

void Silence(vtkAlgorithm* algorithm)
{
  Silence(static_cast<vtkObject*>(algorithm));
  Silence(algorithm->GetExecutive());
}

vtkSmartPointer<vtkSegmentationReader> Read(const Arguments& arguments)
{
  const std::string& path = arguments.Text("inputLabels");
  const auto reader = vtkSmartPointer<vtkSegmentationReader>::New();
  Silence(reader.Get());
  reader->SetFileName(path.c_str());
  reader->SetLabelTableFileName(arguments.Text("colorTable").c_str());
  reader->SetSpace(arguments.Text("space") == "RAS" ? vtkSegmentationReader::SPACE_RAS
                                                    : vtkSegmentationReader::SPACE_LPS);
  for (const std::string& warning : cli::ReadImage(reader, UserInterface::SlicerCommand))
  {
    Warn(warning);
  }
  if (reader->GetNumberOfFrames() != 1)
  {
    throw cli::RunError("cannot mesh '" + path +
      "': it has several time frames; this module meshes one, the program voxplex all of them");
  }
  return reader;
}

void Configure(vtkImageToTetMeshFilter* filter, const Arguments& arguments)
{
  cli::SetParameters(filter, arguments.MeshingValues());
  filter->SetInputMode(arguments.IsSet("isosurface") ? vtkImageToTetMeshFilter::INPUT_ISOSURFACE
                                                     : vtkImageToTetMeshFilter::INPUT_LABELS);
  cli::SetLabels(filter, arguments.Selection());
  filter->ComputeQualityOn();
  filter->SetVocabulary(vtkImageToTetMeshFilter::VOCABULARY_SLICER);
}

/** Executes with progress, as long as the application does not want it to stop. */
void Execute(vtkAlgorithm* filter, ProgressReport& report)
{
  Silence(filter);
  cli::Execute(
    filter, [&report](double fraction, const std::string&) { return report.Show(fraction); });
}

/** Null if nothing is to be repaired or checked. */
vtkSmartPointer<vtkSegmentationRepair> Repair(
  const Arguments& arguments, vtkAlgorithmOutput* labels, ProgressReport& report)
{
  const auto filter =
    cli::MakeRepair(arguments.MeshingValues(), arguments.Selection(), UserInterface::SlicerCommand);
  if (!filter)
  {
    return nullptr;
  }
  if (arguments.IsSet("isosurface"))
  {
    throw cli::UsageError("grey-value images have no labels to repair or check; leave the "
                          "parameters of Repair of segmentations out, or --isosurface");
  }
  report.Start(Repairing);
  filter->SetInputConnection(labels);
  Execute(filter, report);
  if (!filter->GetErrorMessage().empty())
  {
    throw cli::RunError(
      "cannot repair '" + arguments.Text("inputLabels") + "': " + filter->GetErrorMessage());
  }
  for (const std::string& warning : cli::WarningsOf(filter.Get()))
  {
    Warn(warning);
  }
  return filter;
}

vtkSmartPointer<vtkImageToTetMeshFilter> Mesh(
  const Arguments& arguments, vtkAlgorithmOutput* labels, ProgressReport& report)
{
  const auto filter = vtkSmartPointer<vtkImageToTetMeshFilter>::New();
  filter->SetInputConnection(labels);
  Configure(filter, arguments);
  Execute(filter, report);
  if (!filter->GetErrorMessage().empty())
  {
    throw cli::RunError(
      "cannot mesh '" + arguments.Text("inputLabels") + "': " + filter->GetErrorMessage());
  }
  return filter;
}

/** Nothing if the user does not want it, or if the image has grey values and so no labels. */
std::optional<Comparison> Compare(const Arguments& arguments, vtkAlgorithmOutput* labels,
  vtkUnstructuredGrid* mesh, ProgressReport& report)
{
  if (!arguments.IsSet("quality"))
  {
    return std::nullopt;
  }
  if (arguments.IsSet("isosurface"))
  {
    Warn("--quality compares with a label map, and the input has grey values: leave it out");
    return std::nullopt;
  }
  report.Start(Measuring);
  vtkNew<vtkSimplexMeshQuality> filter;
  filter->SetInputData(mesh);
  filter->SetImageConnection(labels);
  for (const std::int64_t label : arguments.Selection().Labels)
  {
    filter->AddLabel(label);
  }
  filter->SetSmoothDistances(false);
  filter->SetNumberOfThreads(static_cast<int>(arguments.MeshingValues().at("threads")));
  Execute(filter, report);
  if (!filter->GetErrorMessage().empty())
  {
    throw cli::RunError("cannot measure the mesh: " + filter->GetErrorMessage());
  }
  // Stopped: the next stage ends the run before anything is written.
  return filter->GetAborted() ? std::nullopt : std::optional(CompareWithImage(filter));
}

/** Announces all outputs, so that what cannot be written is known before any work. */
void Announce(io::WholeFiles& files, const Arguments& arguments)
{
  cli::AnnounceMesh(files, arguments.Text("outputMesh"));
  cli::AnnounceMesh(files, arguments.Text("outputSurfaces"));
  cli::AnnounceFile(files, arguments.ReturnFile);
  files.ForbidOverwriting(arguments.Text("inputLabels"));
}

/** Before any work. */
void RequireFormat(const std::string& path, int content)
{
  if (!path.empty() && !vtkSimplexMeshWriter::HasFormat(path, content, 3))
  {
    throw cli::UsageError("'" + path + "': its extension is not that of a format known here; use " +
      vtkSimplexMeshWriter::ListExtensions(content, 3));
  }
}

} // namespace

void RunJob(const Arguments& arguments)
{
  const std::string& meshPath = arguments.Text("outputMesh");
  const std::string& surfacesPath = arguments.Text("outputSurfaces");
  RequireFormat(meshPath, vtkSimplexMeshWriter::CONTENT_MESH);
  RequireFormat(surfacesPath, vtkSimplexMeshWriter::CONTENT_INTERFACES);
  io::WholeFiles files;
  Announce(files, arguments);

  ProgressReport report(arguments.Host);
  report.Start(Reading);
  const auto reader = Read(arguments);

  const auto repair = Repair(arguments, reader->GetOutputPort(), report);
  vtkAlgorithmOutput* const labels = repair ? repair->GetOutputPort() : reader->GetOutputPort();

  report.Start(Meshing);
  const auto filter = Mesh(arguments, labels, report);

  const auto comparison = Compare(arguments, labels, filter->GetOutput(), report);

  report.Start(Writing);
  cli::WriteMeshFiles(filter, meshPath, surfacesPath, files);
  WriteResults(filter->GetStatistics(), comparison, arguments.ReturnFile, files);
  report.Finish();
  cli::CommitFiles(files);
  PrintResults(filter, comparison, repair ? repair->GetReport() : "");
}

} // namespace voxplex::slicer
