// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// The command line program: label image in, mesh files out. See Documentation/UserGuide.md.

#include "CommandLine.h"
#include "Errors.h"
#include "Interruption.h"
#include "Meshing.h"
#include "OutputFiles.h"
#include "ProgressBar.h"
#include "ReadImage.h"
#include "SliceFiles.h"
#include "StatisticsReport.h"
#include "Writers/Formats.h"

#include <vtkImageToSimplexMeshFilter.h>
#include <vtkLogger.h>
#include <vtkMeshingStatistics.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkOutputWindow.h>
#include <vtkPolyData.h>
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
void ProtectInputs(const OutputFiles& files, const Parameters& p)
{
  files.ForbidOverwriting(p.Input);
  if (!p.SizeImage.empty())
  {
    files.ForbidOverwriting(p.SizeImage);
  }
}

/** Announces all outputs but slices, so that what cannot be written is known before any work. */
void Announce(OutputFiles& files, const Parameters& p)
{
  for (const std::string& path : { p.Output, p.Interfaces, p.Statistics })
  {
    if (!path.empty())
    {
      files.Add(path);
    }
  }
  ProtectInputs(files, p);
}

/** Slices are known only when the image has been read. */
std::optional<SliceFiles> AnnounceSlices(
  OutputFiles& files, const Parameters& p, const ScalarImage& image)
{
  if (p.SpaceTime.Slices.empty())
  {
    return std::nullopt;
  }
  SliceFiles slices(p.SpaceTime.Slices, image, p.SpaceTime.SliceCount);
  files.Add(slices.Collection);
  for (const std::string& path : slices.Slices)
  {
    files.Add(path);
  }
  ProtectInputs(files, p);
  return slices;
}

void Warn(const std::vector<std::string>& warnings)
{
  for (const std::string& warning : warnings)
  {
    std::cerr << "voxplex: warning: " << warning << '\n';
  }
}

MeshingInput Read(const Parameters& p)
{
  std::vector<std::string> warnings;
  MeshingInput input{ ReadImage(p.Input, p.Series, warnings), std::nullopt };
  if (!p.SizeImage.empty())
  {
    input.Sizes = ReadImage(p.SizeImage, "", warnings);
    if (input.Sizes->Dimension() != 3)
    {
      throw RunError("--size-image: '" + p.SizeImage +
        "' has several time frames; an image of sizes has three dimensions, and holds at all "
        "times");
    }
  }
  Warn(warnings);
  return input;
}

vtkSmartPointer<vtkImageToSimplexMeshFilter> MeshOrExit(
  const Parameters& p, const MeshingInput& input)
{
  vtkSmartPointer<vtkImageToSimplexMeshFilter> filter;
  {
    const Interruption::CancellableStep step;
    ProgressBar bar(p.Progress);
    filter = Mesh(p, input,
      [&bar](double fraction, const std::string& text)
      {
        bar.Show(fraction, text);
        return !Interruption::Requested();
      });
  }
  if (!filter || Interruption::Requested())
  {
    Interruption::Exit();
  }
  return filter;
}

/** Has a file written in the place that it will be moved from. */
template <typename TWrite>
void Write(const std::string& path, const OutputFiles& files, TWrite&& write)
{
  try
  {
    write(files.TemporaryPath(path));
  }
  catch (const RunError& error)
  {
    throw RunError("cannot write '" + path + "': " + error.what());
  }
}

/** Writes both results if their names were given. */
template <typename TMesh>
void WriteMesh(const TMesh& mesh, const Parameters& p, const OutputFiles& files)
{
  const auto write = [&](const std::string& path, Content content)
  {
    if (!path.empty())
    {
      Write(path, files,
        [&](const std::string& temporary) { WriteFile(mesh, content, path, temporary); });
    }
  };
  write(p.Output, Content::Mesh);
  write(p.Interfaces, Content::Interfaces);
}

void WriteSlices(vtkUnstructuredGrid* mesh, const SliceFiles& slices, const OutputFiles& files)
{
  Slicer slicer(mesh);
  for (std::size_t i = 0; i < slices.Slices.size(); ++i)
  {
    Write(slices.Slices[i], files,
      [&](const std::string& temporary) { slicer.Write(slices.Times[i], temporary); });
  }
  Write(slices.Collection, files,
    [&](const std::string& temporary) { WriteCollection(slices, temporary); });
}

void Run(const Parameters& p)
{
  OutputFiles files;
  Announce(files, p);

  InputOutputTimes times;
  const Stopwatch reading;
  const MeshingInput input = Read(p);
  times.Read = reading.Seconds();

  CheckDimension(p, input.Labels.Dimension());
  const std::optional<SliceFiles> slices = AnnounceSlices(files, p, input.Labels);

  const auto filter = MeshOrExit(p, input);

  const Stopwatch writing;
  const std::string space = ToString(p.OutputSpace);
  vtkDataObject* interfaces = filter->GetOutputDataObject(1);
  if (input.Labels.Dimension() == 3)
  {
    WriteMesh(
      MeshData{ filter->GetOutput(), vtkPolyData::SafeDownCast(interfaces), space }, p, files);
  }
  else
  {
    auto* boundary = vtkUnstructuredGrid::SafeDownCast(interfaces);
    WriteMesh(SpaceTimeMeshData{ filter->GetOutput(), boundary, space }, p, files);
  }
  if (slices)
  {
    WriteSlices(filter->GetOutput(), *slices, files);
  }
  times.Write = writing.Seconds();

  const auto report = MakeReport(filter->GetStatistics(), p, times);
  if (!p.Statistics.empty())
  {
    WriteReport(report, files.TemporaryPath(p.Statistics));
  }
  files.Commit();
  Warn(Warnings(report));
  std::cout << Summarize(report) << std::flush;
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
  return voxplex::cli::Main(argc, argv);
}
