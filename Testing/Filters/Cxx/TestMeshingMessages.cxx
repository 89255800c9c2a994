// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Warnings of runs whose figures are made up, because images that cause them are rare.
#include "FilterTesting.h"

#include "MeshingParameters.h"
#include "Private/MeshingMessages.h"

#include <string>
#include <vector>

using namespace testing;

namespace
{

void ExpectOne(
  const voxplex::MeshingStatistics& figures, const std::string& part, bool exactComponents = false)
{
  const std::vector<std::string> warnings =
    voxplex::WarningsOf(figures, { { 8, "Rib" } }, "Local", exactComponents);
  CHECK(warnings.size() == 1, "one warning");
  const std::string text = voxplex::InTermsOf(voxplex::UserInterface::VTK, warnings.front());
  CHECK(text.find(part) != std::string::npos, text);
}

} // namespace

int TestMeshingMessages(int, char*[])
{
  CHECK(voxplex::WarningsOf({}, {}, "Local", false).empty(), "nothing to warn of");

  voxplex::MeshingStatistics closed;
  closed.Planes.Refused = 1;
  ExpectOne(closed, "Slabs asked each other for points on their time planes again and again");

  voxplex::MeshingStatistics switched;
  switched.SwitchedToLocal = true;
  switched.Threads.resize(2);
  switched.Threads[0].Rollbacks = 20;
  switched.Threads[1].Rollbacks = 3;
  ExpectOne(switched, "contention manager 'Local' (23 rollbacks)");

  voxplex::MeshingStatistics shrunk;
  shrunk.ShrunkLabels = { { .Label = 7, .Fraction = 0.25 } };
  ExpectOne(shrunk, "7 (25 %). ExactComponents or a smaller Delta keeps them.");
  shrunk.VolumeShare = 0.5; // said of the label already
  ExpectOne(shrunk, "7 (25 %). A smaller Delta keeps them.", true);
  voxplex::MeshingStatistics grains;
  grains.VolumeShare = 0.92;
  ExpectOne(grains, "has 92 % of the volume of all labels together");
  grains.VolumeShare = 0.97;
  CHECK(voxplex::WarningsOf(grains, {}, "Local", false).empty(), "little is lost");

  voxplex::MeshingStatistics lost;
  lost.LostLabels = { 7, 8 };
  ExpectOne(lost, ": 7, 8 (Rib).");

  voxplex::MeshingStatistics broken;
  broken.Components.Broken = { { { 3, 64, { 4, 4, 4 } }, 21, 0.1 } };
  ExpectOne(broken,
    "64 voxels of label 3 at (i, j, k) = (4, 4, 4) in 21. ExactComponents or a smaller Delta");
  ExpectOne(broken, "in 21. A smaller Delta, or an image with smaller voxels", true);
  return Result();
}
