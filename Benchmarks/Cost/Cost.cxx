// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Does one fixed piece of work with one thread, so that a tool can count its instructions
// (Benchmarks/measure-cost). Without an argument it lists the pieces.
#include "Domain/ImageDomain.h"
#include "Domain/LabelField.h"
#include "Image/FeatureTransform.h"
#include "Mesher/ImageMesher.h"
#include "PointTriangulation.h"

#include "ImagePhantoms.h"
#include "SpaceTimePhantoms.h"

#include <cstdint>
#include <cstdio>
#include <functional>
#include <map>
#include <random>
#include <stdexcept>
#include <string>

namespace
{

using namespace voxplex;
using namespace voxplex::benchmarks;

void Check(bool done)
{
  if (!done)
  {
    throw std::runtime_error("the work could not be done");
  }
}

/** Inserts points along a Hilbert curve, then removes some of them in random order. */
template <int D>
void Triangulate(std::size_t points, Input input, std::size_t removed = 0)
{
  const double side = SideFor<D>(points, input);
  Instance<D> instance(Cube<D>(side));
  Check(instance.Insert(MakePoints<D>(points, input, side)));
  std::vector<VertexId> vertices;
  std::sample(instance.Vertices.begin(), instance.Vertices.end(), std::back_inserter(vertices),
    removed, std::mt19937_64(1));
  Check(instance.Remove(vertices));
}

template <typename Phantom>
auto ImageOf(const Phantom& phantom)
{
  constexpr int D = std::is_same_v<Phantom, phantoms::ImagePhantom> ? 3 : 4;
  return LabelImage<D>::template FromScalars<std::uint8_t>(phantom.Scalars(), phantom.Grid);
}

/** Two nested balls and one apart, 158 x 104 x 104 voxels of 0.16 mm. */
LabelImage<3> Balls()
{
  return ImageOf(phantoms::EmbeddedBalls(4));
}

template <int D>
void Mesh(const LabelImage<D>& image, MeshingOptions<D> options)
{
  options.Team.Threads = 1;
  SimplexMesh<D> mesh;
  ImageMesher<D>(options).Run(image, mesh);
  Check(!mesh.Simplices.empty());
}

MeshingOptions<3> Plain(double delta)
{
  MeshingOptions<3> options;
  options.Sampling.Delta = delta;
  options.Shape.Slivers.Angle = 0.0;
  options.Components.Smallest = 0;
  options.Interfaces.SampleJunctions = false;
  options.Interfaces.Rounds = 0;
  options.Interfaces.Manifold = false;
  options.Optimisation.Run = false;
  return options;
}

template <int D>
MeshingOptions<D> Default(double delta)
{
  MeshingOptions<D> options;
  options.Sampling.Delta = delta;
  return options;
}

MeshingOptions<3> Graded(double delta)
{
  MeshingOptions<3> options = Default<3>(delta);
  options.Sampling.Grading.Mode = GradingMode::LocalFeatureSize;
  return options;
}

const std::map<std::string, std::function<void()>>& Pieces()
{
  static const std::map<std::string, std::function<void()>> pieces{
    { "insertion-3d", [] { Triangulate<3>(30'000, Input::Random); } },
    { "insertion-3d-lattice", [] { Triangulate<3>(15'000, Input::Lattice); } },
    { "insertion-4d", [] { Triangulate<4>(3'000, Input::Random); } },
    { "removal-3d", [] { Triangulate<3>(10'000, Input::Random, 5'000); } },
    { "removal-4d", [] { Triangulate<4>(800, Input::Random, 400); } },
    { "label-field", [] { LabelField<3>(Balls(), 2.0); } },
    { "balls-plain", [] { Mesh(Balls(), Plain(0.2)); } },
    { "balls", [] { Mesh(Balls(), Default<3>(0.25)); } },
    { "balls-graded", [] { Mesh(Balls(), Graded(0.36)); } },
    { "four-ball", [] { Mesh(ImageOf(phantoms::FourBall(9.0)), Default<4>(2.0)); } },
    { "merging-balls", [] { Mesh(ImageOf(phantoms::MergingBalls(17)), Default<4>(3.0)); } },
  };
  return pieces;
}

} // namespace

int main(int argc, char* argv[])
{
  try
  {
    const auto piece = Pieces().find(argc == 2 ? argv[1] : "");
    if (piece == Pieces().end())
    {
      for (const auto& [name, work] : Pieces())
      {
        std::puts(name.c_str());
      }
      return argc == 1 ? 0 : 2;
    }
    piece->second();
    return 0;
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "voxplexCost: %s\n", error.what());
    return 1;
  }
}
