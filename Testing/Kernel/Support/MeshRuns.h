// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Runs of the mesher, and what they say.
#ifndef voxplex_MeshRuns_h
#define voxplex_MeshRuns_h

#include "Base/Error.h"
#include "Mesher/ImageMesher.h"

#include <gtest/gtest.h>

#include <functional>
#include <string>

namespace voxplex::checks
{

template <int D>
MeshingOptions<D> WithDelta(double delta)
{
  MeshingOptions<D> options;
  options.Sampling.Delta = delta;
  return options;
}

/** The mesh of a label image or of an isosurface. */
template <template <int> class Image, int D>
SimplexMesh<D> MeshOf(
  const Image<D>& image, const MeshingOptions<D>& options, MeshingStatistics* statistics = nullptr)
{
  ImageMesher<D> mesher(options);
  SimplexMesh<D> mesh;
  EXPECT_EQ(mesher.Run(image, mesh), MeshingOutcome::Done);
  if (statistics)
  {
    *statistics = mesher.Statistics();
  }
  return mesh;
}

/** What a call says is wrong, "" if nothing. */
template <typename Exception = InputError>
std::string MessageOf(const std::function<void()>& call)
{
  try
  {
    call();
  }
  catch (const Exception& error)
  {
    return error.what();
  }
  return "";
}

} // namespace voxplex::checks

#endif
