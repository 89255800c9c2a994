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
#include "StatisticsReport.h"
#include "Writers/Formats.h"

#include <vtkImageToTetMeshFilter.h>
#include <vtkLogger.h>
#include <vtkMeshingStatistics.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkOutputWindow.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

#include <chrono>
#include <iostream>

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

/** Announces all outputs, so that what cannot be written is known before any work. */
void Announce(OutputFiles& files, const Parameters& p)
{
  for (const std::string& path : { p.Output, p.Interfaces, p.Statistics })
  {
    if (!path.empty())
    {
      files.Add(path);
    }
  }
  files.ForbidOverwriting(p.Input);
  if (!p.SizeImage.empty())
  {
    files.ForbidOverwriting(p.SizeImage);
  }
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
  }
  Warn(warnings);
  return input;
}

vtkSmartPointer<vtkImageToTetMeshFilter> MeshOrExit(const Parameters& p, const MeshingInput& input)
{
  vtkSmartPointer<vtkImageToTetMeshFilter> filter;
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

/** Writes one of the two results if its name was given. */
void Write(const MeshData& mesh, const std::string& path, Content content, const OutputFiles& files)
{
  if (path.empty())
  {
    return;
  }
  try
  {
    FindWriter(path, content)(mesh, files.TemporaryPath(path));
  }
  catch (const RunError& error)
  {
    throw RunError("cannot write '" + path + "': " + error.what());
  }
}

void Run(const Parameters& p)
{
  OutputFiles files;
  Announce(files, p);

  InputOutputTimes times;
  const Stopwatch reading;
  const MeshingInput input = Read(p);
  times.Read = reading.Seconds();

  const auto filter = MeshOrExit(p, input);

  const MeshData mesh{ filter->GetOutput(), filter->GetInterfaces(), ToString(p.OutputSpace) };
  const Stopwatch writing;
  Write(mesh, p.Output, Content::Mesh, files);
  Write(mesh, p.Interfaces, Content::Interfaces, files);
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
