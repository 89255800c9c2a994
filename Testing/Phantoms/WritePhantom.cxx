// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file WritePhantom.cxx
 * @brief voxplexPhantom: writes a label image of a known shape, of space or of space-time.
 *
 * Exit status: 0 if the file was written, 2 if the arguments are wrong, 1 if writing failed.
 */
#include "ImagePhantoms.h"
#include "SpaceTimePhantoms.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <iomanip>
#include <iostream>
#include <map>
#include <sstream>
#include <string>
#include <variant>

using namespace voxplex;
using namespace voxplex::phantoms;

namespace
{

constexpr const char* Usage = R"(usage: voxplexPhantom NAME FILE.nrrd [option]

Writes a label image.

names, with the axes x, y and z (the thesis' table 2.2, millimetres):
  ball               label 1, 416^3 voxels
  embedded-balls     a ball (1) with one in it (2) and a small one apart (3), 634 x 416 x 416 voxels
  torus              label 1, 147 x 147 x 67 voxels
                       --coarsening N  of each: N times fewer voxels along x, y and z (default 1)

names, with the axes x, y, z and time:
  four-ball          a ball in space and time, of label 1, away from the image's border
                       --radius R      of the ball, voxels (default 12)
  beating-ventricle  blood (1) within myocardium (2), one beat; cut by the first and last frame
                       --coarsening N  N times fewer voxels along x, y and z (default 1)
  merging-balls      two balls (1, 2) that meet and part
  rotating-sheet     a sheet (1), 3 voxels thick, that turns by a quarter
  opening-tube       a wall (1) whose lumen (2) opens and closes
  fast-ball          a ball (1) that moves 4 voxels a frame, there and back
                       --frames N      of each: number of frames (defaults 17, 15, 15, 17); cut by the
                                       first and last frame
)";

using Phantom = std::variant<ImagePhantom, SpaceTimePhantom>;

struct Kind
{
  std::string Option;
  double Usual, Least, Most;
  std::function<Phantom(double)> Make;
};

template <typename Function>
std::function<Phantom(double)> Whole(Function make)
{
  return [make](double n) -> Phantom { return make(static_cast<std::int64_t>(n)); };
}

const std::map<std::string, Kind> Kinds = {
  { "ball", { "--coarsening", 1, 1, 40, Whole(SingleBall) } },
  { "embedded-balls", { "--coarsening", 1, 1, 40, Whole(EmbeddedBalls) } },
  { "torus", { "--coarsening", 1, 1, 8, Whole(Torus) } },
  { "four-ball", { "--radius", 12, 1, 60, [](double radius) { return FourBall(radius); } } },
  { "beating-ventricle", { "--coarsening", 1, 1, 11, Whole(BeatingVentricle) } },
  { "merging-balls", { "--frames", 17, 2, 1000, Whole(MergingBalls) } },
  { "rotating-sheet", { "--frames", 15, 2, 1000, Whole(RotatingSheet) } },
  { "opening-tube", { "--frames", 15, 2, 1000, Whole(OpeningTube) } },
  { "fast-ball", { "--frames", 17, 2, 1000, Whole(FastBall) } },
};

template <typename PhantomType>
void Write(const PhantomType& phantom, std::ostream& file)
{
  const auto& sizes = phantom.Grid.Dimensions;
  const std::size_t dimension = sizes.size();
  file << "NRRD0004\ntype: uint8\ndimension: " << dimension << "\n"
       << (dimension == 3 ? "space: left-posterior-superior" : "space dimension: 4") << "\nsizes:";
  for (const auto size : sizes)
  {
    file << ' ' << size;
  }
  file << std::setprecision(17) << "\nspace directions:";
  for (std::size_t axis = 0; axis < dimension; ++axis)
  {
    for (std::size_t i = 0; i < dimension; ++i)
    {
      file << (i == 0 ? " (" : ",")
           << (i == axis ? phantom.Grid.Spacing(static_cast<int>(axis)) : 0.0);
    }
    file << ')';
  }
  file << "\nspace origin: " << (dimension == 3 ? "(0,0,0)" : "(0,0,0,0)") << "\nencoding: raw\n\n";
  const std::vector<std::uint8_t> scalars = phantom.Scalars();
  file.write(
    reinterpret_cast<const char*>(scalars.data()), static_cast<std::streamsize>(scalars.size()));
}

int Refuse(const std::string& why)
{
  std::fprintf(stderr, "error: %s\n\n%s", why.c_str(), Usage);
  return 2;
}

} // namespace

int main(int argc, char** argv)
{
  if (argc < 3)
  {
    return Refuse("the name of a phantom and a file are needed");
  }
  const std::string name = argv[1];
  const std::string path = argv[2];
  const auto kind = Kinds.find(name);
  if (kind == Kinds.end())
  {
    return Refuse("no such phantom: " + name);
  }
  if (path.size() < 5 || path.compare(path.size() - 5, 5, ".nrrd") != 0)
  {
    return Refuse("the name of the file must end with .nrrd: " + path);
  }
  const auto& [option, usual, least, most, make] = kind->second;
  double number = usual;
  if (argc > 3)
  {
    if (argv[3] != option || argc != 5)
    {
      return Refuse(argv[3] + (" is no option of " + name) + ", or not followed by one number");
    }
    char* end = nullptr;
    number = std::strtod(argv[4], &end);
    const bool isWhole = option != "--radius";
    if (*end != '\0' || !(number >= least && number <= most) ||
      (isWhole && number != std::floor(number)))
    {
      std::ostringstream why;
      why << option << " must be a " << (isWhole ? "whole " : "") << "number between " << least
          << " and " << most << ", not " << argv[4];
      return Refuse(why.str());
    }
  }
  std::ofstream file(path, std::ios::binary);
  std::visit([&](const auto& phantom) { Write(phantom, file); }, make(number));
  if (!file.flush())
  {
    std::fprintf(stderr, "error: cannot write %s\n", path.c_str());
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}
