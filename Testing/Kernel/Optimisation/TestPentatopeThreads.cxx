// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Several threads optimise pentatopes, with the result of one.
#include "MeshChecks.h"
#include "Optimisation/Pentatopes/PentatopeOptimiser.h"
#include "PentatopeCases.h"

#include <gtest/gtest.h>

using namespace voxplex;
using namespace voxplex::checks;

TEST(PentatopeOptimiser, DoesNotDependOnThreads)
{
  const LabelImage<4> image = ImageOf(PulsatingBalls(9, 2.0));
  MeshingOptions<4> options = UsualOptions(2.5);
  options.Team.Reproducible = true;
  const Result first = Mesh(image, options, true);
  EXPECT_GT(first.Statistics.Optimisation.PoorBefore, first.Statistics.Optimisation.PoorAfter);
  for (const unsigned threads : { 2u, 3u, 8u })
  {
    options.Team.Threads = threads;
    ExpectSame(Mesh(image, options, true).Mesh, first.Mesh);
  }
}

// Threads find insertions side by side, also where cavities overlap.
TEST(PentatopeInsertion, DoesNotDependOnThreads)
{
  const LabelImage<4> image = ImageOf(phantoms::WithTimeScale(phantoms::OpeningTube(), 2.0));
  const ImageDomain<4> domain(image, 1.0);
  const SimplexMesh<4> before = Mesh(image, UsualOptions(4.0), false).Mesh;
  PentatopeBounds bounds;
  bounds.Target = 0.14; // so that there are many
  SimplexMesh<4> first = before;
  const PentatopeStatistics done = checks::OptimisePentatopes(first, domain, image, bounds, 1, {});
  EXPECT_GT(done.Insertions, 20u);
  SimplexMesh<4> mesh = before;
  EXPECT_EQ(
    checks::OptimisePentatopes(mesh, domain, image, bounds, 3, {}).Insertions, done.Insertions);
  ExpectSame(mesh, first);
}
