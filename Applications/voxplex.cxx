// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// The command line program: label image or mesh in, mesh files and figures out. See Documentation/Reference.md.

#include "CommandLine.h"
#include "Errors.h"
#include "ExecutionModel.h"
#include "ImageFile.h"
#include "Interruption.h"
#include "Measuring.h"
#include "MeshReading.h"
#include "Meshing.h"
#include "OptionValues.h"
#include "OutputFiles.h"
#include "ParameterChecks.h"
#include "ProcessMemory.h"
#include "ProgressBar.h"
#include "SpaceTimeFiles.h"
#include "StatisticsReport.h"
#include "WholeFiles.h"

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkImageData.h>
#include <vtkImageToSimplexMeshFilter.h>
#include <vtkLogger.h>
#include <vtkMeshingStatistics.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkOutputWindow.h>
#include <vtkPointData.h>
#include <vtkSegmentationReader.h>
#include <vtkSegmentationRepair.h>
#include <vtkSimplexMeshWriter.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <chrono>
#include <iostream>
#include <optional>
#include <set>
#include <sstream>
#include <vector>

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

/** So that nothing that is read is overwritten. @param input nothing before it is read: then by their names */
void ProtectInputs(const io::WholeFiles& files, const Parameters& p, const MeshingInput& input)
{
  std::vector<std::string> paths = p.Inputs;
  paths.insert(
    paths.end(), { p.Text("size-image"), p.Text("label-table"), p.Mesh, p.MeshInterfaces });
  for (vtkSegmentationReader* const reader : { input.Labels.Get(), input.Sizes.Get() })
  {
    if (reader)
    {
      const std::vector<std::string> read = reader->GetFilesRead();
      paths.insert(paths.end(), read.begin(), read.end());
    }
  }
  for (const std::string& path : paths)
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
  AnnounceFile(files, p.Results);
  ProtectInputs(files, p, {});
}

/** Of the image. Without one those that the user gives, or the first and the last of a mesh. */
std::vector<double> TimesOfFrames(
  const Parameters& p, const MeshingInput& input, const MeshWithInterfaces& given)
{
  if (input.Labels)
  {
    return input.TimesOfFrames();
  }
  if (p.Has("frame-times"))
  {
    return p.Numbers("frame-times");
  }
  const double* const range = given.Mesh->GetPointData()->GetArray("Time")->GetRange();
  return { range[0], range[1] };
}

/** Slices are known only when the image or the mesh has been read. */
std::optional<SliceFiles> AnnounceSlices(io::WholeFiles& files, const Parameters& p,
  const MeshingInput& input, const MeshWithInterfaces& given)
{
  if (p.Slices.empty())
  {
    return std::nullopt;
  }
  SliceFiles slices(p.Slices, TimesOfFrames(p, input, given), p.SliceCount);
  AnnounceFile(files, slices.Collection);
  for (const std::string& path : slices.Slices)
  {
    AnnounceMesh(files, path);
  }
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
  return slabs;
}

void WriteSlabs(const MeshWithInterfaces& mesh, const SlabFiles& slabs, const Parameters& p,
  const MeshingInput& input, io::WholeFiles& files)
{
  slabs.AnnounceOthers(files, mesh.Mesh);
  ProtectInputs(files, p, input);
  slabs.Write(mesh.Mesh, mesh.Interfaces, files, p.Compress);
}

/** On standard error, to people; to programs as a line of JSON. @param doing what failed, may be empty */
void Say(UserInterface words, bool isWarning, const std::string& doing, const std::string& text)
{
  if (words == UserInterface::Python)
  {
    const nlohmann::ordered_json message = { { "kind", isWarning ? "warning" : "error" },
      { "doing", doing }, { "text", text } };
    std::cerr << message.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) << '\n';
    return;
  }
  std::cerr << "voxplex: " << (isWarning ? "warning: " : "") << (doing.empty() ? "" : doing + ": ")
            << text << '\n';
}

void Warn(UserInterface words, const std::vector<std::string>& warnings)
{
  for (const std::string& warning : warnings)
  {
    Say(words, true, "", warning);
  }
}

vtkSmartPointer<vtkSegmentationReader> ReadFile(
  const std::vector<std::string>& paths, const ParameterValues& values, UserInterface words)
{
  const auto reader = vtkSmartPointer<vtkSegmentationReader>::New();
  for (const std::string& path : paths)
  {
    reader->AddFileName(path.c_str());
  }
  Warn(words, ReadImage(reader, values, words));
  return reader;
}

MeshingInput Read(const Parameters& p)
{
  MeshingInput input;
  if (!p.Inputs.empty())
  {
    input.Labels = ReadFile(p.Inputs, p.Values, p.Words);
  }
  if (const std::string sizes = p.Text("size-image"); !sizes.empty())
  {
    ParameterValues values; // where the sizes lie their own file says
    for (const char* name : { "space", "data-files-anywhere" })
    {
      values[name] = p.Value(name).value_or(0.0);
    }
    input.Sizes = ReadFile({ sizes }, values, p.Words);
    if (input.Sizes->GetNumberOfFrames() > 1)
    {
      throw io::FileError("--size-image: '" + sizes +
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
    ProgressBar bar(p.Progress, p.Words);
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

void WriteSlices(
  vtkUnstructuredGrid* mesh, const SliceFiles& slices, bool compress, const io::WholeFiles& files)
{
  Slicer slicer(mesh, compress);
  for (std::size_t i = 0; i < slices.Slices.size(); ++i)
  {
    slicer.Write(slices.Times[i], slices.Slices[i], files);
  }
  WriteCollection(slices, files);
}

/** The mesh that is there, if there is one; it must have the dimension of the image. */
MeshWithInterfaces ReadMesh(const Parameters& p, const MeshingInput& input)
{
  if (p.Mesh.empty())
  {
    return {};
  }
  MeshWithInterfaces given = ReadMeshFiles(p.Mesh, p.MeshInterfaces);
  if (!given.Warning.empty())
  {
    Warn(p.Words, { "'" + p.Mesh + "': " + given.Warning });
  }
  if (input.Labels && input.Dimension() != given.Dimension())
  {
    throw UsageError(given.Dimension() == 4
        ? "'" + p.Mesh + "' has pentatopes, but '" + p.InputName() + "' has no time frames"
        : "'" + p.InputName() + "' has time frames, but '" + p.Mesh + "' has no pentatopes");
  }
  if (!p.Slabs.empty() && !given.Mesh->GetFieldData()->HasArray("TimePlanes"))
  {
    throw io::FileError("--slabs: '" + p.Mesh + "' has no time planes");
  }
  return given;
}

/** Of all frames; empty if one has other things. */
std::set<std::int64_t> AllLabels(vtkSegmentationReader* reader)
{
  std::set<std::int64_t> labels;
  for (int frame = 0; frame < reader->GetNumberOfFrames(); ++frame)
  {
    reader->UpdateTimeStep(reader->GetTimeOfFrame(frame));
    vtkImageData* const image = reader->GetOutput();
    std::string fault; // also if there are none
    for (const auto& [label, voxels] : vtkImageToSimplexMeshFilter::CountLabels(
           image, vtkDataObject::FIELD_ASSOCIATION_POINTS, "", fault))
    {
      labels.insert(label);
    }
    if (!fault.empty() && image->GetScalarRange()[1] > 0.0)
    {
      return {};
    }
  }
  return labels;
}

/** A label may be absent from frames, but not from all; shells have the same labels in all of them. */
void PrepareForFrames(const Parameters& p, const LabelTable& names, const MeshingInput& input)
{
  const std::set<std::int64_t> labels = AllLabels(input.Labels);
  for (const auto& [name, lengths] : input.Selection)
  {
    for (const auto& [label, length] : std::get<LabelValues>(lengths))
    {
      if (!labels.empty() && labels.count(label.first) == 0)
      {
        throw RunError("cannot repair '" + p.InputName() + "'",
          "--" + name + ": no frame of the image has label " + std::to_string(label.first));
      }
    }
  }
  const std::int64_t named = names.Entries.empty() ? 0 : names.Entries.rbegin()->first;
  const std::int64_t highest = labels.empty() ? 0 : *labels.rbegin();
  input.Repair->SetFirstShellLabel(1 + std::max(named, highest));
}

/** Puts a filter behind the reader if one is needed. */
void RepairImage(const Parameters& p, MeshingInput& input)
{
  const LabelTable names = GetLabelTable(input.Labels->GetOutput()->GetFieldData());
  input.Selection = SelectRepairs(p, names);
  input.Repair = MakeRepair(p.Values, input.Selection, p.Words);
  if (!input.Repair)
  {
    return;
  }
  if (input.Dimension() == 4)
  {
    PrepareForFrames(p, names, input);
  }
  input.Repair->SetInputConnection(input.Labels->GetOutputPort());
  CompleteOrExit(p,
    [&](const ProgressFunction& progress)
    {
      Execute(input.Repair,
        [&](double fraction, const std::string&) { return progress(fraction, "Repairing"); });
      return input.Repair;
    });
  if (!input.Repair->GetErrorMessage().empty())
  {
    throw RunError("cannot repair '" + p.InputName() + "'", input.Repair->GetErrorMessage());
  }
}

/** A shell is meshed if its label is. */
void KeepShells(const MeshingInput& input, ParameterValues& selection)
{
  const auto chosen = selection.find("labels");
  if (!input.Repair || chosen == selection.end())
  {
    return;
  }
  auto& labels = std::get<LabelValues>(chosen->second);
  for (const auto& row : nlohmann::json::parse(input.Repair->ToJSON()))
  {
    if (row.contains("new_label") &&
      labels.contains({ row["label"].get<std::int64_t>(), AnyLabel }))
    {
      labels.emplace(std::pair(row["new_label"].get<std::int64_t>(), AnyLabel), 0.0);
    }
  }
}

/** What was done to the image, what could not be done, and what is suspicious about it. */
struct RepairReport
{
  std::vector<std::string> Warnings;
  nlohmann::ordered_json Rows = nlohmann::ordered_json::array();
  std::string Text;
};

RepairReport ReportRepair(const Parameters& p, const MeshingInput& input)
{
  RepairReport report;
  const bool isSeries = input.Dimension() == 4;
  for (const double time : input.TimesOfFrames())
  {
    std::ostringstream begin;
    if (isSeries)
    {
      input.Repair->UpdateTimeStep(time);
      begin << "time " << time << ": ";
    }
    for (auto row : nlohmann::ordered_json::parse(input.Repair->ToJSON()))
    {
      if (isSeries)
      {
        row["time"] = time;
      }
      report.Rows.push_back(row);
    }
    for (const std::string& warning : WarningsOf(input.Repair.Get()))
    {
      report.Warnings.push_back(begin.str() + warning);
    }
    std::istringstream lines(input.Repair->GetReport());
    for (std::string line; std::getline(lines, line);)
    {
      report.Text += begin.str() + line + '\n';
    }
  }
  if (report.Text.empty() && p.Has("check-image"))
  {
    report.Text = "Nothing is suspicious.\n";
  }
  return report;
}

/** Names of labels of the image, and the labels that are asked for. */
LabelTable NameLabels(const Parameters& p, MeshingInput& input)
{
  if (!input.Labels)
  {
    return {};
  }
  vtkFieldData* const fields = input.Labels->GetOutput()->GetFieldData();
  if (p.Has("isovalue")) // a table beside the image is about other numbers
  {
    SetLabelTable(fields, {});
  }
  RepairImage(p, input);
  LabelTable names = GetLabelTable(input.Image()->GetFieldData());
  input.Selection.merge(SelectLabels(p, names));
  KeepShells(input, input.Selection);
  return names;
}

/** Writes the image that was read, perhaps repaired, and says what was repaired and is suspicious. */
void SaveImage(const Parameters& p)
{
  io::WholeFiles files;
  AnnounceFile(files, p.Output);
  AnnounceFile(files, p.Statistics);
  ProtectInputs(files, p, {});
  MeshingInput input = Read(p);
  ProtectInputs(files, p, input);
  RepairImage(p, input);
  if (!p.Output.empty())
  {
    WriteImage(input.Labels, input.Source(), files.TemporaryPath(p.Output));
  }
  const RepairReport report = input.Repair ? ReportRepair(p, input) : RepairReport();
  if (!p.Statistics.empty())
  {
    WriteReport({ { "repair", report.Rows } }, p.Statistics, files);
  }
  CommitFiles(files);
  Warn(p.Words, report.Warnings);
  std::cout << report.Text << std::flush;
}

/** Writes interfaces, without their mesh, in another format. */
void ConvertInterfaces(const Parameters& p)
{
  io::WholeFiles files;
  AnnounceMesh(files, p.Interfaces);
  ProtectInputs(files, p, {});
  const MeshWithInterfaces given = ReadMeshFiles("", p.MeshInterfaces);
  WriteMeshFile(nullptr, given.Interfaces, vtkSimplexMeshWriter::CONTENT_INTERFACES, p.Interfaces,
    files, -1, p.Compress);
  CommitFiles(files);
}

using Filter = vtkSmartPointer<vtkImageToSimplexMeshFilter>;

/** Gives `mesh` what the filter has made. */
Filter MakeMesh(const Parameters& p, const MeshingInput& input, MeshWithInterfaces& mesh)
{
  Filter filter =
    CompleteOrExit(p, [&](const ProgressFunction& progress) { return Mesh(p, input, progress); });
  mesh.Mesh = filter->GetOutput();
  mesh.Interfaces = filter->GetOutputDataObject(1);
  return filter;
}

/** Null if it is not asked for. */
nlohmann::ordered_json MeasureMesh(
  const Parameters& p, const MeshingInput& input, const MeshWithInterfaces& mesh)
{
  if (!p.Quality)
  {
    return nullptr;
  }
  return CompleteOrExit(
    p, [&](const ProgressFunction& progress) { return Measure(p, input, mesh.Mesh, progress); });
}

/** All files that hold the mesh or a part of it. */
void WriteFiles(const Parameters& p, const MeshingInput& input, const MeshWithInterfaces& mesh,
  const std::optional<SliceFiles>& slices, const std::optional<SlabFiles>& slabs,
  io::WholeFiles& files)
{
  using Writer = vtkSimplexMeshWriter;
  WriteMeshFile(mesh.Mesh, mesh.Interfaces, Writer::CONTENT_MESH, p.Output, files, -1, p.Compress);
  WriteMeshFile(
    mesh.Mesh, mesh.Interfaces, Writer::CONTENT_INTERFACES, p.Interfaces, files, -1, p.Compress);
  if (slices)
  {
    WriteSlices(mesh.Mesh, *slices, p.Compress, files);
  }
  if (slabs)
  {
    WriteSlabs(mesh, *slabs, p, input, files);
  }
}

/** Of the run that made the mesh, with what was measured; of a mesh that was there the latter alone. */
nlohmann::ordered_json Report(const Parameters& p, const MeshingInput& input,
  const MeshWithInterfaces& mesh, const Filter& filter, const InputOutputTimes& times,
  const LabelTable& names)
{
  nlohmann::ordered_json measurement = MeasureMesh(p, input, mesh);
  if (!filter)
  {
    return measurement;
  }
  const std::string source = p.Has("isovalue") ? "" : input.Labels->GetLabelTableSource();
  auto report =
    MakeReport(filter->GetStatistics(), p, LabelReport{ input.Selection, names, source }, times);
  if (p.Quality)
  {
    AddMeasurement(measurement, report);
  }
  return report;
}

void Run(const Parameters& p)
{
  io::WholeFiles files;
  Announce(files, p);
  if (p.WritesNothing() && !p.Quality)
  {
    Warn(p.Words, { "no mesh will be written: name one last, or with --output" });
  }

  InputOutputTimes times;
  const Stopwatch reading;
  MeshingInput input = Read(p);
  MeshWithInterfaces mesh = ReadMesh(p, input);
  times.Read = reading.Seconds();

  const LabelTable names = NameLabels(p, input);
  const int dimension = mesh.Mesh ? mesh.Dimension() : input.Dimension();
  CheckDimension(p, dimension);
  const std::optional<SliceFiles> slices = AnnounceSlices(files, p, input, mesh);
  const std::optional<SlabFiles> slabs = AnnounceSlabs(files, p);
  ProtectInputs(files, p, input);
  const Filter filter = mesh.Mesh ? Filter() : MakeMesh(p, input, mesh);

  const Stopwatch writing;
  WriteFiles(p, input, mesh, slices, slabs, files);
  times.Write = writing.Seconds();
  nlohmann::ordered_json report = Report(p, input, mesh, filter, times, names);
  RepairReport repair;
  if (input.Repair)
  {
    repair = ReportRepair(p, input);
  }
  if (input.Repair && !report.is_null())
  {
    report["repair"] = repair.Rows;
  }
  if (!p.Statistics.empty())
  {
    WriteReport(report, p.Statistics, files);
  }
  if (!p.Results.empty())
  {
    WriteResults(report, p.Results, files);
  }
  CommitFiles(files);
  Warn(p.Words, repair.Warnings);
  if (filter)
  {
    Warn(p.Words, WarningsOf(filter.Get()));
  }
  std::cout << (filter ? Summarize(report) : SummarizeMesh(mesh.Mesh, dimension, report, times))
            << (p.Quality ? SummarizeMeasurement(report) : "") << repair.Text << std::flush;
}

} // namespace
} // namespace voxplex::cli

int main(int argc, char* argv[])
{
  using namespace voxplex;
  using namespace voxplex::cli;
  KeepFreedMemory();
  Interruption::Install();
  SilenceVTK();
  const UserInterface words = WordsOf(argc, argv);
  if (words == UserInterface::Python) // the interpreter may be killed
  {
    Interruption::EndWithParent();
  }
  try
  {
    const CommandLine commandLine = ParseCommandLine(argc, argv);
    if (commandLine.Run)
    {
      const Parameters& p = *commandLine.Run;
      p.Action == Verb::Image   ? SaveImage(p)
        : p.IsAboutInterfaces() ? ConvertInterfaces(p)
                                : Run(p);
    }
    else
    {
      std::cout << commandLine.Text << std::flush;
    }
    return ExitSuccess;
  }
  catch (const UsageError& error)
  {
    Say(words, false, "", NameOptions(words, error.what()));
    std::cerr << (words == UserInterface::CommandLine ? "voxplex: see voxplex --help\n" : "");
    return ExitUsage;
  }
  catch (const io::FileError& error)
  {
    Say(words, false, "", NameOptions(words, error.what()));
    return ExitFile;
  }
  catch (const RunError& error)
  {
    Say(words, false, error.Doing, NameOptions(words, error.what()));
  }
  catch (const std::bad_alloc&)
  {
    const bool isJson = words == UserInterface::Python; // takes no memory itself
    std::cerr << (isJson ? R"({"kind":"error","doing":"","text":")" : "voxplex: ")
              << "out of memory; try larger elements (delta, size)" << (isJson ? "\"}\n" : "\n");
  }
  catch (const std::exception& error)
  {
    Say(words, false, "", NameOptions(words, error.what()));
  }
  return ExitFailure;
}
