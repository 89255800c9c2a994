// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Refinement goes on for the sake of interfaces where it has to, and nowhere else.
#include "Conformity/Crumbs.h"
#include "Conformity/InterfaceCheck.h"
#include "Conformity/ManifoldRepair.h"
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
    std::max(UniformInterfaceCheck<3>::LargestDistance * delta, std::sqrt(3.0)); // voxels of 1 mm
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
    InterfaceCheck<3> check({ context.Mesh, image, domain.GetSites(), domain, context.Sizing, 1 },
      options.Rounds, local, figures, {});
    ManifoldRepairOptions<3> repairOptions;
    repairOptions.Surfaces = &domain;
    repairOptions.Sizing = &context.Sizing;
    ManifoldLabeller<3> labeller(context.Mesh, repairOptions, 1, {});
    for (bool hadPinches = false;;)
    {
      local.ForgetLowered();
      SimplexLabels labels = LabelSimplices<3>(context.Mesh, domain);
      const auto extract = [&]
      {
        SimplexMesh<3> mesh;
        ExtractMesh<3>(context.Mesh, domain, labels, mesh);
        return mesh;
      };
      const bool wasFar = HasFarFaces(image, extract(), delta);
      RelabelCrumbs(
        context.Mesh, labels, FindSmallFragments(context.Mesh, labels, 1, {}), {}, 1, {});
      const Repaired<3> repair = RepairAll<3>(context.Mesh, labels);
      const bool hasPinches = std::any_of(repair.Left.begin(), repair.Left.end(),
        [](const InterfaceEdge& edge) { return !edge.IsJunction; });
      const bool isFar = HasFarFaces(image, extract(), delta);
      std::vector<FeatureSeed<3>> seeds = check.InspectVertices().Points;
      if (seeds.empty())
      {
        seeds = check.InspectLabels(labeller.Make(figures)).Points;
      }
      EXPECT_EQ(!seeds.empty(), wasFar || hasPinches || isFar);
      afterRepair += isFar && !wasFar && !hasPinches ? 1 : 0;
      afterPinches += hadPinches && seeds.empty() ? 1 : 0;
      hadPinches = hasPinches && !wasFar;
      if (seeds.empty() || figures.Rounds == options.Rounds)
      {
        break;
      }
      context.Sizing.FollowLocalBounds();
      ASSERT_TRUE(Refiner<Rules3D>(context, {}, seeds, RefinementStart::AtSeeds).Run(nullptr));
    }
  }
  EXPECT_GT(afterPinches, 1);
  EXPECT_GT(afterRepair, 1);
}
