// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// From masks to files of meshes, in several threads at once. Python's tests look into the files; this one is for sanitizers.

#include <vtkImageData.h>
#include <vtkImageToPentatopeMeshFilter.h>
#include <vtkImageToTetMeshFilter.h>
#include <vtkMasksToSegmentation.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkSegmentationReader.h>
#include <vtkSimplexMeshWriter.h>
#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLImageDataWriter.h>

#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <initializer_list>
#include <iostream>
#include <iterator>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <unistd.h>

namespace fs = std::filesystem;

namespace
{

constexpr int Size = 14;

/** Of several frames, one component each, in which the last voxel grows. */
vtkSmartPointer<vtkImageData> MakeMask(int first, int last, int frames = 1)
{
  const auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(Size, Size, Size);
  image->AllocateScalars(VTK_UNSIGNED_CHAR, frames);
  for (int k = 0; k < Size; ++k)
  {
    for (int j = 0; j < Size; ++j)
    {
      for (int i = 0; i < Size; ++i)
      {
        const bool isInside = i >= first && j > 1 && j < Size - 2 && k > 1 && k < Size - 2;
        auto* const voxel = static_cast<unsigned char*>(image->GetScalarPointer(i, j, k));
        for (int frame = 0; frame < frames; ++frame)
        {
          voxel[frame] = isInside && i <= last + frame ? 1 : 0;
        }
      }
    }
  }
  return image;
}

/** A mesh, or its interfaces, in files of these names; what went wrong. */
std::string WriteMesh(vtkAlgorithm* mesher, const fs::path& folder, int content,
  std::initializer_list<const char*> names)
{
  std::string wrong;
  for (const char* const name : names)
  {
    vtkNew<vtkSimplexMeshWriter> writer;
    writer->SetContent(content);
    writer->SetInputConnection(0, mesher->GetOutputPort(0));
    writer->SetInputConnection(1, mesher->GetOutputPort(1));
    writer->SetFileName((folder / name).c_str());
    wrong += writer->Write() ? "" : writer->GetErrorMessage();
  }
  return wrong;
}

std::string TrySpaceTime(const fs::path& folder)
{
  vtkNew<vtkImageToPentatopeMeshFilter> mesher;
  mesher->SetInputData(MakeMask(2, 5, 5));
  mesher->SetDelta(3.0);
  mesher->SetNumberOfThreads(2);
  mesher->Update();
  return mesher->GetErrorMessage() +
    WriteMesh(mesher, folder, vtkSimplexMeshWriter::CONTENT_MESH, { "t.vtu", "t.mesh", "t.mfem" }) +
    WriteMesh(mesher, folder, vtkSimplexMeshWriter::CONTENT_INTERFACES, { "b.vtu" });
}

/** The image as two masks, on grids that differ. */
std::string TryMaskFiles(const fs::path& folder)
{
  vtkNew<vtkSegmentationReader> reader;
  for (const int first : { 2, 7 })
  {
    const auto mask = MakeMask(first, first + 4);
    mask->SetSpacing(first == 2 ? 1.0 : 0.75, 1.0, 1.0);
    const std::string path = folder / (std::to_string(first) + ".vti");
    vtkNew<vtkXMLImageDataWriter> writer;
    writer->SetInputData(mask);
    writer->SetFileName(path.c_str());
    writer->Write();
    reader->AddFileName(path.c_str());
  }
  reader->ResampleMasksOn();
  reader->Update();
  return reader->GetErrorMessage() +
    (reader->GetOutput()->GetScalarRange()[1] == 2.0 ? "" : "the second mask is lost");
}

/** Those who have nothing to read or to write say so, and print themselves. */
std::string TryMistakes(const fs::path& folder)
{
  vtkNew<vtkSegmentationReader> reader;
  reader->SetFileName((folder / "nothing.nrrd").c_str());
  reader->Update();
  vtkNew<vtkMasksToSegmentation> masks;
  masks->AddInputDataObject(vtkNew<vtkImageData>());
  masks->Update();
  vtkNew<vtkSimplexMeshWriter> writer;
  writer->SetInputDataObject(0, vtkNew<vtkUnstructuredGrid>());
  writer->SetFileName((folder / "mesh.doc").c_str());
  const bool isWritten = writer->Write();
  vtkNew<vtkImageToPentatopeMeshFilter> refusing; // four components of bytes are colours
  refusing->SetInputData(MakeMask(3, 9, 4));
  refusing->Update();
  vtkNew<vtkSimplexMeshWriter> after;
  after->SetInputConnection(0, refusing->GetOutputPort());
  after->SetFileName((folder / "empty.vtu").c_str());
  after->Write(); // a mesh without elements
  std::ostringstream text;
  reader->Print(text);
  masks->Print(text);
  writer->Print(text);
  return isWritten || reader->GetErrorMessage().empty() || masks->GetErrorMessage().empty() ||
      text.str().find("mesh.doc") == std::string::npos
    ? "a mistake is not told"
    : "";
}

/** What went wrong; empty if nothing did. */
std::string TryAll(const fs::path& folder)
{
  vtkNew<vtkMasksToSegmentation> masks;
  masks->AddInputDataObject(MakeMask(2, 6));
  masks->AddInputDataObject(MakeMask(7, 11));
  masks->SetMaskName(0, "left");
  vtkNew<vtkXMLImageDataWriter> images;
  images->SetInputConnection(masks->GetOutputPort());
  images->SetFileName((folder / "image.vti").c_str());
  images->Write();
  vtkNew<vtkSegmentationReader> reader;
  reader->SetFileName((folder / "image.vti").c_str());
  vtkNew<vtkImageToTetMeshFilter> mesher;
  mesher->SetInputConnection(reader->GetOutputPort());
  mesher->SetDelta(2.0);
  mesher->SetNumberOfThreads(2);
  mesher->Update();
  std::string wrong =
    masks->GetErrorMessage() + reader->GetErrorMessage() + mesher->GetErrorMessage();
  wrong += WriteMesh(mesher, folder, vtkSimplexMeshWriter::CONTENT_MESH,
    { "m.vtu", "m.vtk", "m.inp", "m.feb", "m.msh", "m.mfem", "m.xdmf", "m.mesh" });
  wrong += WriteMesh(mesher, folder, vtkSimplexMeshWriter::CONTENT_INTERFACES,
    { "s.vtp", "s.ply", "s.stl", "s.vtk", "s.vtu" });
  wrong += TrySpaceTime(folder) + TryMaskFiles(folder) + TryMistakes(folder);
  const auto files = std::distance(fs::directory_iterator(folder), fs::directory_iterator());
  return wrong + (files == 22 ? "" : std::to_string(files) + " files, 22 wanted");
}

} // namespace

int TestMasksAndMeshes(int, char*[])
{
  std::string pattern = (fs::temp_directory_path() / "voxplex-meshes-XXXXXX").string();
  const fs::path root = mkdtemp(pattern.data());
  std::vector<std::string> wrong(2);
  vtkObject::GlobalWarningDisplayOff();       // TryMistakes makes some
  vtkObjectFactory::GetRegisteredFactories(); // VTK makes this list once, but without a lock
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < wrong.size(); ++i)
  {
    const fs::path folder = root / std::to_string(i);
    fs::create_directory(folder);
    threads.emplace_back([&wrong, i, folder] { wrong[i] = TryAll(folder); });
  }
  for (std::thread& thread : threads)
  {
    thread.join();
  }
  fs::remove_all(root);
  if (!wrong[0].empty() || !wrong[1].empty())
  {
    std::cerr << wrong[0] << "\n" << wrong[1] << "\n";
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}
