// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// From masks to files of meshes, in several threads at once. Python's tests look into the files; this one is for sanitizers.

#include <vtkImageData.h>
#include <vtkImageToTetMeshFilter.h>
#include <vtkMasksToSegmentation.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkSegmentationReader.h>
#include <vtkSimplexMeshWriter.h>
#include <vtkSmartPointer.h>
#include <vtkXMLImageDataWriter.h>

#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <iterator>
#include <string>
#include <thread>
#include <vector>

#include <unistd.h>

namespace fs = std::filesystem;

namespace
{

constexpr int Size = 14;

vtkSmartPointer<vtkImageData> MakeMask(int first, int last)
{
  const auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(Size, Size, Size);
  image->AllocateScalars(VTK_UNSIGNED_CHAR, 1);
  for (int k = 0; k < Size; ++k)
  {
    for (int j = 0; j < Size; ++j)
    {
      for (int i = 0; i < Size; ++i)
      {
        const bool isInside =
          i >= first && i <= last && j > 1 && j < Size - 2 && k > 1 && k < Size - 2;
        *static_cast<unsigned char*>(image->GetScalarPointer(i, j, k)) = isInside ? 1 : 0;
      }
    }
  }
  return image;
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
  for (const char* const name :
    { "m.vtu", "m.vtk", "m.inp", "m.feb", "m.msh", "m.mfem", "m.xdmf", "m.mesh" })
  {
    vtkNew<vtkSimplexMeshWriter> writer;
    writer->SetInputConnection(0, mesher->GetOutputPort(0));
    writer->SetInputConnection(1, mesher->GetOutputPort(1));
    writer->SetFileName((folder / name).c_str());
    wrong += writer->Write() ? "" : writer->GetErrorMessage();
  }
  for (const char* const name : { "s.vtp", "s.ply", "s.stl" })
  {
    vtkNew<vtkSimplexMeshWriter> writer;
    writer->SetContent(vtkSimplexMeshWriter::CONTENT_INTERFACES);
    writer->SetInputConnection(1, mesher->GetOutputPort(1));
    writer->SetFileName((folder / name).c_str());
    wrong += writer->Write() ? "" : writer->GetErrorMessage();
  }
  const auto files = std::distance(fs::directory_iterator(folder), fs::directory_iterator());
  return wrong + (files == 13 ? "" : std::to_string(files) + " files, 13 wanted");
}

} // namespace

int TestMasksAndMeshes(int, char*[])
{
  std::string pattern = (fs::temp_directory_path() / "voxplex-meshes-XXXXXX").string();
  const fs::path root = mkdtemp(pattern.data());
  std::vector<std::string> wrong(2);
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
