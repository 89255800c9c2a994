// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Several readers at once: each gets its own image or error, and standard error stays in its place.

#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkObject.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkSegmentationReader.h>

#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <string>
#include <thread>
#include <vector>

#include <sys/stat.h>
#include <unistd.h>

namespace fs = std::filesystem;

namespace
{

constexpr int Size = 12;
constexpr int Readings = 25;

/** A cube of one label, uncompressed; a truncated one lacks most of its voxels. */
void WriteMetaImage(const fs::path& path, char label, bool truncated = false)
{
  std::ofstream file(path, std::ios::binary);
  file << "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\n"
       << "ElementSpacing = 1 1 1\nDimSize = " << Size << ' ' << Size << ' ' << Size
       << "\nElementType = MET_UCHAR\nElementDataFile = LOCAL\n"
       << std::string(truncated ? 40 : Size * Size * Size, label);
}

void WriteNames(const fs::path& path, int label)
{
  std::ofstream(path) << label << " name of " << label << "\n";
}

/** Where standard error goes. */
struct stat StandardError()
{
  struct stat status
  {
  };
  fstat(STDERR_FILENO, &status);
  return status;
}

bool ReadsWhole(const fs::path& path, double label)
{
  vtkNew<vtkSegmentationReader> reader;
  reader->SetFileName(path.c_str());
  reader->Update();
  vtkDataArray* labels = reader->GetOutput()->GetPointData()->GetScalars();
  if (!reader->GetErrorMessage().empty() || !labels ||
    labels->GetNumberOfValues() != Size * Size * Size)
  {
    return false;
  }
  double range[2];
  labels->GetRange(range);
  return range[0] == label && range[1] == label && reader->GetNumberOfWarnings() == 0 &&
    reader->GetLabelTableSource() == path.string() + ".txt";
}

bool SeesDamage(const fs::path& path)
{
  vtkNew<vtkSegmentationReader> reader;
  reader->SetFileName(path.c_str());
  reader->Update();
  return reader->GetErrorMessage().find("truncated") != std::string::npos &&
    reader->GetOutput()->GetNumberOfPoints() == 0;
}

} // namespace

int TestReaderThreads(int, char*[])
{
  vtkObject::GlobalWarningDisplayOff();
  std::string pattern = (fs::temp_directory_path() / "voxplex-threads-XXXXXX").string();
  const fs::path folder = mkdtemp(pattern.data());
  constexpr int threads = 4;
  for (int t = 0; t < threads; ++t)
  {
    const fs::path path = folder / ("image" + std::to_string(t) + ".mha");
    WriteMetaImage(path, static_cast<char>(t + 1));
    WriteNames(path.string() + ".txt", t + 1);
  }
  WriteMetaImage(folder / "damaged.mha", 1, true);

  const struct stat before = StandardError();
  std::atomic<int> wrong = 0;
  vtkObjectFactory::GetRegisteredFactories(); // VTK makes this list once, but without a lock
  {
    std::vector<std::jthread> team;
    for (int t = 0; t < threads; ++t)
    {
      team.emplace_back(
        [&wrong, t, path = folder / ("image" + std::to_string(t) + ".mha")]
        {
          for (int i = 0; i < Readings; ++i)
          {
            wrong += !ReadsWhole(path, t + 1);
          }
        });
    }
    team.emplace_back(
      [&wrong, path = folder / "damaged.mha"]
      {
        for (int i = 0; i < Readings; ++i)
        {
          wrong += !SeesDamage(path);
        }
      });
  }
  const struct stat after = StandardError();
  fs::remove_all(folder);

  if (wrong != 0)
  {
    std::cerr << wrong << " of " << (threads + 1) * Readings << " readings are wrong\n";
  }
  const bool isBack = before.st_dev == after.st_dev && before.st_ino == after.st_ino;
  if (!isBack)
  {
    std::cout << "standard error goes elsewhere after reading\n";
  }
  return wrong == 0 && isBack ? EXIT_SUCCESS : EXIT_FAILURE;
}
