// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// The command line program: label image in, mesh files out. See Documentation/Reference.md.

#include "CommandLine.h"
#include "Errors.h"
#include "Interruption.h"
#include "Measuring.h"
#include "Meshing.h"
#include "OutputFiles.h"
#include "ParameterChecks.h"
#include "ProcessMemory.h"
#include "ProgressBar.h"
#include "SpaceTimeFiles.h"
#include "StatisticsReport.h"
#include "WholeFiles.h"

#include <vtkFieldData.h>
#include <vtkImageData.h>
#include <vtkImageToSimplexMeshFilter.h>
#include <vtkLogger.h>
#include <vtkMeshingStatistics.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkOutputWindow.h>
#include <vtkSegmentationReader.h>
#include <vtkSimplexMeshWriter.h>
#include <vtkUnstructuredGrid.h>

#include <chrono>
#include <iostream>
#include <optional>

namespace voxplex::cli
{
namespace
{

/** Says nothing: what matters reaches the user as an exception's message. */
class SilentWindow : public vtkOutputWindow
{
public:
  static SilentWindow* New();
  vtkTypeMacro(SilentWindow, vtkOutputWindow);
  void DisplayText(const char*) override {}
};
vtkStandardNewMacro(SilentWindow);

void SilenceVTK()
{
  vtkNew<SilentWindow> window;
  vtkOutputWindow::SetInstance(window);
  vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
}

/** Its clock is never set back, unlike that of vtkTimerLog, which is gettimeofday(). */
class Stopwatch
{
public:
  double Seconds() const
  {
    return std::chrono::duration<double>(Clock::now() - this->Start).count();
  }

private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point Start = Clock::now();
};

/** So that nothing that is read is overwritten. */
void ProtectInputs(const io::WholeFiles& files, const Parameters& p)
{
  for (const std::string& path : { p.Input, p.SizeImage, p.Reading.LabelTable })
  {
    files.ForbidOverwriting(path);
  }
}

/** Announces all outputs but slices and slabs, so that what cannot be written is known before any work. */
void Announce(io::WholeFiles& files, const Parameters& p)
{
  AnnounceMesh(files, p.Output);
  AnnounceMesh(files, p.Interfaces);
  AnnounceFile(files, p.Statistics);
  ProtectInputs(files, p);
}

/** Slices are known only when the image has been read. */
std::optional<SliceFiles> AnnounceSlices(
  io::WholeFiles& files, const Parameters& p, vtkSegmentationReader* reader)
{
  if (p.Slices.empty())
  {
    return std::nullopt;
  }
  std::vector<double> times;
  for (int frame = 0; frame < reader->GetNumberOfFrames(); ++frame)
  {
    times.push_back(reader->GetTimeOfFrame(frame));
  }
  SliceFiles slices(p.Slices, times, p.SliceCount);
  AnnounceFile(files, slices.Collection);
  for (const std::string& path : slices.Slices)
  {
    AnnounceMesh(files, path);
  }
  ProtectInputs(files, p);
  return slices;
}

/** The number of slabs is known only when the mesh is there. */
std::optional<SlabFiles> AnnounceSlabs(io::WholeFiles& files, const Parameters& p)
{
  if (p.Slabs.empty())
  {
    return std::nullopt;
  }
  SlabFiles slabs(p.Slabs, p.Output);
  slabs.AnnounceFirst(files);
  ProtectInputs(files, p);
  return slabs;
}

void WriteSlabs(vtkImageToSimplexMeshFilter* filter, const SlabFiles& slabs, const Parameters& p,
  io::WholeFiles& files)
{
  slabs.AnnounceOthers(files, filter->GetOutput());
  ProtectInputs(files, p);
  slabs.Write(
    filter->GetOutput(), vtkUnstructuredGrid::SafeDownCast(filter->GetOutputDataObject(1)), files);
}

void Warn(const std::vector<std::string>& warnings)
{
  for (const std::string& warning : warnings)
  {
    std::cerr << "voxplex: warning: " << warning << '\n';
  }
}

/** What the user says of the place of the image. */
void SetPlace(vtkSegmentationReader* reader, const ReadingOptions& options)
{
  if (!options.Spacing.empty())
  {
    reader->SetSpacing(options.Spacing.data());
  }
  if (!options.Origin.empty())
  {
    reader->SetOrigin(options.Origin.data());
  }
  if (!options.Direction.empty())
  {
    reader->SetDirection(options.Direction.data());
  }
}

vtkSmartPointer<vtkSegmentationReader> ReadFile(
  const std::string& path, const ReadingOptions& options)
{
  const auto reader = vtkSmartPointer<vtkSegmentationReader>::New();
  reader->SetFileName(path.c_str());
  reader->SetSeriesUID(options.Series.c_str());
  reader->SetLabelTableFileName(options.LabelTable.c_str());
  for (const double time : options.FrameTimes)
  {
    reader->AddFrameTime(time);
  }
  SetPlace(reader, options);
  reader->SetDataFilesAnywhere(options.DataFilesAnywhere);
  reader->SetSpace(options.Space == io::Space::LPS ? vtkSegmentationReader::SPACE_LPS
                                                   : vtkSegmentationReader::SPACE_RAS);
  Warn(ReadImage(reader, UserInterface::CommandLine));
  return reader;
}

MeshingInput Read(const Parameters& p)
{
  MeshingInput input;
  input.Labels = ReadFile(p.Input, p.Reading);
  if (!p.SizeImage.empty())
  {
    ReadingOptions options; // where the sizes lie their own file says
    options.Space = p.Reading.Space;
    options.DataFilesAnywhere = p.Reading.DataFilesAnywhere;
    input.Sizes = ReadFile(p.SizeImage, options);
    if (input.Sizes->GetNumberOfFrames() > 1)
    {
      throw RunError("--size-image: '" + p.SizeImage +
        "' has several time frames; an image of sizes has three dimensions, and holds at all "
        "times");
    }
  }
  return input;
}

/** The result of work(progress), which is null if that was cancelled; then the program ends. */
template <typename Work>
auto CompleteOrExit(const Parameters& p, Work&& work)
{
  decltype(work(ProgressFunction())) result;
  {
    const Interruption::CancellableStep step;
    ProgressBar bar(p.Progress);
    result = work(
      [&bar](double fraction, const std::string& text)
      {
        bar.Show(fraction, text);
        return !Interruption::Requested();
      });
  }
  if (result == nullptr || Interruption::Requested())
  {
    Interruption::Exit();
  }
  return result;
}

void WriteSlices(vtkUnstructuredGrid* mesh, const SliceFiles& slices, const io::WholeFiles& files)
{
  Slicer slicer(mesh);
  for (std::size_t i = 0; i < slices.Slices.size(); ++i)
  {
    slicer.Write(slices.Times[i], slices.Slices[i], files);
  }
  WriteCollection(slices, files);
}

void Run(const Parameters& p)
{
  io::WholeFiles files;
  Announce(files, p);

  InputOutputTimes times;
  const Stopwatch reading;
  MeshingInput input = Read(p);
  times.Read = reading.Seconds();

  if (p.Has("isovalue")) // a table beside the image is about other numbers
  {
    io::SetLabelTable(input.Labels->GetOutput()->GetFieldData(), {});
  }
  const io::LabelTable names = io::GetLabelTable(input.Labels->GetOutput()->GetFieldData());
  input.Selection = SelectLabels(p, names);

  CheckDimension(p, input.Dimension());
  const std::optional<SliceFiles> slices = AnnounceSlices(files, p, input.Labels);
  const std::optional<SlabFiles> slabs = AnnounceSlabs(files, p);

  const auto filter =
    CompleteOrExit(p, [&](const ProgressFunction& progress) { return Mesh(p, input, progress); });

  const Stopwatch writing;
  WriteMeshFiles(filter, p.Output, p.Interfaces, files);
  if (slices)
  {
    WriteSlices(filter->GetOutput(), *slices, files);
  }
  if (slabs)
  {
    WriteSlabs(filter, *slabs, p, files);
  }
  times.Write = writing.Seconds();

  auto report = MakeReport(filter->GetStatistics(), p,
    LabelReport{
      input.Selection, names, p.Has("isovalue") ? "" : input.Labels->GetLabelTableSource() },
    times);
  std::string measured;
  if (p.Quality)
  {
    const auto measurement = CompleteOrExit(p,
      [&](const ProgressFunction& progress)
      { return Measure(p, input, filter->GetOutput(), progress); });
    AddMeasurement(measurement, report);
    measured = SummarizeMeasurement(report);
  }
  if (!p.Statistics.empty())
  {
    WriteReport(report, p.Statistics, files);
  }
  CommitFiles(files);
  Warn(WarningsOf(filter));
  std::cout << Summarize(report) << measured << std::flush;
}

int Main(int argc, const char* const* argv)
{
  Interruption::Install();
  SilenceVTK();
  try
  {
    const CommandLine commandLine = ParseCommandLine(argc, argv);
    if (commandLine.Run)
    {
      Run(*commandLine.Run);
    }
    else
    {
      std::cout << commandLine.Text << std::flush;
    }
    return ExitSuccess;
  }
  catch (const UsageError& error)
  {
    std::cerr << "voxplex: " << error.what() << "\nvoxplex: see voxplex --help\n";
    return ExitUsage;
  }
  catch (const std::bad_alloc&)
  {
    std::cerr << "voxplex: out of memory; try a larger --delta or --size\n";
  }
  catch (const std::exception& error)
  {
    std::cerr << "voxplex: " << error.what() << '\n';
  }
  return ExitFailure;
}

} // namespace
} // namespace voxplex::cli

int main(int argc, char* argv[])
{
  voxplex::cli::KeepFreedMemory();
  return voxplex::cli::Main(argc, argv);
}
