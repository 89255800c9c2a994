// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// All operations at once, with one thread and with several. Python's tests try each; this one is for sanitizers.
#include "FilterTesting.h"

#include "vtkImageData.h"
#include "vtkNew.h"
#include "vtkSegmentationRepair.h"
#include "vtkTable.h"

using namespace testing;

namespace
{

/** A cube of 15 voxels with a cavity of 3 and a string of 4, and a sheet of one voxel beside it. */
double LabelAt(const Vector& x)
{
  const auto isIn = [&](double low, double high)
  { return x[0] >= low && x[0] <= high && x[1] >= low && x[1] <= high; };
  if (isIn(8, 22) && x[2] == 27)
  {
    return 2;
  }
  const bool isCavity = isIn(14, 16) && x[2] >= 14 && x[2] <= 16;
  const bool isString = x[0] > 22 && x[0] < 27 && x[1] == 15 && x[2] == 15;
  return (isIn(8, 22) && x[2] >= 8 && x[2] <= 22 && !isCavity) || isString ? 1 : 0;
}

void TryRepair(int threads)
{
  vtkNew<vtkSegmentationRepair> repair;
  repair->SetInputData(MakeImage({}, LabelAt));
  repair->SetNumberOfThreads(threads);
  repair->SetFillHoles(100);
  repair->SetRemoveSpikes(true);
  repair->SetMinimumThickness(2, 3.0);
  repair->SetShell(1, 2.0);
  repair->SetCheckImage(true);
  repair->Update();
  vtkImageData* const image = repair->GetOutput();
  const auto labelAt = [image](int i, int j, int k)
  { return static_cast<int>(image->GetScalarComponentAsDouble(i, j, k, 0)); };
  int cube = 0;
  for (int k = 0; k < 32; ++k)
  {
    for (int j = 0; j < 32; ++j)
    {
      for (int i = 0; i < 32; ++i)
      {
        cube += labelAt(i, j, k) == 1 ? 1 : 0;
      }
    }
  }
  CHECK(cube == 15 * 15 * 15, threads, cube);
  CHECK(labelAt(25, 15, 15) == 0, threads, labelAt(25, 15, 15));
  for (int k = 25; k <= 29; ++k)
  {
    CHECK((labelAt(15, 15, k) == 2) == (k >= 26 && k <= 28), threads, k);
  }
  for (int i = 4; i < 8; ++i)
  {
    CHECK(labelAt(i, 15, 15) == (i < 6 ? 0 : 3), threads, i, labelAt(i, 15, 15));
  }
  CHECK(repair->GetReportTable()->GetNumberOfRows() >= 4, threads, repair->GetReport());
}

} // namespace

int TestSegmentationRepair(int, char*[])
{
  TryRepair(1);
  TryRepair(4);
  return Result();
}
