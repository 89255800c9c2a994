// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Refinement goes on for the sake of interfaces where it has to, and nowhere else.
#include "Conformity/InterfaceCheck.h"
#include "Conformity/ManifoldLabels.h"
#include "Domain/ImageDomain.h"
#include "InterfaceChecks.h"
#include "RefinementChecks.h"
#include "RepairTesting.h"

#include <algorithm>
#include <cmath>

using namespace voxplex;
using namespace voxplex::checks;

namespace
{

/** Whether a face between voxels of different labels has no vertex of the mesh's interfaces nearby. */
bool HasFarFaces(const LabelImage<3>& image, const SimplexMesh<3>& mesh, double delta)
{
  const double limit =
    std::max(DistanceCheck<3>::LargestDistance * delta, std::sqrt(3.0)); // voxels of 1 mm
  FeatureGrid<3> vertices({ 0.0, 0.0, 0.0 }, limit, mesh.Points.size());
  for (const auto& facet : mesh.Facets)
  {
    for (const std::uint32_t v : facet)
    {
      vertices.Add(mesh.Points[v]);
    }
  }
  bool isFar = false;
  ForEachFace(image,
    [&](const GridGeometry<3>::Index& voxel, const GridGeometry<3>::Index& next)
    {
      isFar |=
        !vertices.AnyWithin(Interpolate(image.CentreOf(voxel), image.CentreOf(next), 0.5), limit);
    });
  return isFar;
}

} // namespace

TEST(InterfaceCheck, GoesOnWhereItHasTo)
{
  int afterPinches = 0;
  int afterRepair = 0;
  struct Case
  {
    double Delta;
    unsigned Seed;
  };
  for (const auto& [delta, seed] : { Case{ 1.0, 27 }, Case{ 1.3, 28 }, Case{ 1.3, 37 },
         Case{ 2.5, 22 }, Case{ 3.0, 36 }, Case{ 4.0, 25 }, Case{ 4.0, 32 } })
  {
    SCOPED_TRACE(testing::Message() << "seed " << seed << ", delta " << delta);
    const LabelImage<3> image = Blobs(seed);
    const ImageDomain<3> domain(image, 1.0);
    LocalDelta<3> local(image);
    RefinementSettings<3> settings;
    settings.Sizing.Base = { delta };
    settings.Sizing.Local = &local;
    RefinementContext<3> context(domain, settings, Around(domain, delta), 1000);
    ASSERT_TRUE(Refiner<Rules3D>(context).Run(nullptr));
    const InterfaceOptions options;
    InterfaceStatistics figures;
    LocalSampling<3> sampling(image, image, domain.GetSites(), domain, context.Sizing, local, {});
    InterfaceCheck<3> check({ context.Mesh, image, domain.GetSites(), domain, context.Sizing, 1 },
      options.Rounds, sampling, figures, {});
    ManifoldRepairOptions<3> repairOptions;
    repairOptions.Surfaces = &domain;
    repairOptions.Sizing = &context.Sizing;
    ManifoldLabeller<3> labeller(context.Mesh, repairOptions, 1, {});
    for (bool hadPinches = false;;)
    {
      const auto extract = [&](const SimplexLabels& labels)
      {
        SimplexMesh<3> mesh;
        ExtractMesh<3>(context.Mesh, domain, labels, mesh);
        return mesh;
      };
      labeller.Take();
      const bool wasFar = HasFarFaces(image, extract(labeller.GetLabels()), delta);
      const checks::RepairedLabels<3> made = checks::LabelsOf(labeller, figures);
      const bool hasPinches = !made.NonManifold.empty();
      const bool isFar = HasFarFaces(image, extract(made.Labels), delta);
      bool isNeeded = false;
      for (const auto inspect : { &InterfaceCheck<3>::InspectSampled,
             &InterfaceCheck<3>::InspectRidges, &InterfaceCheck<3>::InspectAll })
      {
        isNeeded = isNeeded || (check.*inspect)(made);
      }
      EXPECT_EQ(isNeeded, hasPinches || isFar);
      afterRepair += isFar && !wasFar && !hasPinches ? 1 : 0;
      afterPinches += hadPinches && !isNeeded ? 1 : 0;
      hadPinches = hasPinches;
      if (!isNeeded || figures.Rounds == options.Rounds)
      {
        break;
      }
      const std::vector<FeatureSeed<3>> seeds = sampling.TakeSeeds();
      EXPECT_FALSE(seeds.empty());
      ASSERT_TRUE(Refiner<Rules3D>(context, {}, seeds, RefinementStart::AtSeeds).Run(nullptr));
    }
  }
  EXPECT_GT(afterPinches, 1);
  EXPECT_GT(afterRepair, 0);
}
