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

#include <itkImage.h>
#include <itkImageFileWriter.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <functional>
#include <map>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <variant>

using namespace voxplex;
using namespace voxplex::phantoms;

namespace
{

constexpr const char* Usage = R"(usage: voxplexPhantom NAME FILE [options]

Writes a label image in the format that FILE's name asks for (.nrrd, .nhdr).

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

struct Arguments
{
  std::string Name;
  std::string File;
  std::map<std::string, double> Options;
};

/** A number, all of the text. */
double ParseNumber(const std::string& option, const std::string& text)
{
  std::istringstream stream(text);
  double number = 0.0;
  if (!(stream >> number) || !stream.eof() || !std::isfinite(number))
  {
    throw std::invalid_argument(option + " needs a number, not \"" + text + "\"");
  }
  return number;
}

Arguments ParseArguments(int argc, char** argv)
{
  const std::set<std::string> known = { "--radius", "--coarsening", "--frames" };
  Arguments arguments;
  for (int i = 1; i < argc; ++i)
  {
    const std::string argument = argv[i];
    if (argument.rfind("--", 0) == 0)
    {
      if (known.count(argument) == 0)
      {
        throw std::invalid_argument("unknown option " + argument);
      }
      if (++i == argc)
      {
        throw std::invalid_argument(argument + " needs a value");
      }
      arguments.Options[argument] = ParseNumber(argument, argv[i]);
    }
    else if (arguments.Name.empty())
    {
      arguments.Name = argument;
    }
    else if (arguments.File.empty())
    {
      arguments.File = argument;
    }
    else
    {
      throw std::invalid_argument(
        "one name and one file are needed; what is \"" + argument + "\"?");
    }
  }
  if (arguments.File.empty())
  {
    throw std::invalid_argument("the name of a phantom and a file are needed");
  }
  return arguments;
}

/** Takes an option out of the list; the default if it is not there. */
double Take(Arguments& arguments, const std::string& option, double defaultValue, double smallest,
  double largest)
{
  const auto found = arguments.Options.find(option);
  const double value = found == arguments.Options.end() ? defaultValue : found->second;
  arguments.Options.erase(option);
  if (!(value >= smallest && value <= largest))
  {
    std::ostringstream message;
    message << option << " must be between " << smallest << " and " << largest;
    throw std::invalid_argument(message.str());
  }
  return value;
}

std::int64_t TakeCount(Arguments& arguments, const std::string& option, std::int64_t defaultValue,
  std::int64_t smallest, std::int64_t largest)
{
  const double value = Take(arguments, option, static_cast<double>(defaultValue),
    static_cast<double>(smallest), static_cast<double>(largest));
  if (value != std::floor(value))
  {
    throw std::invalid_argument(option + " must be a whole number");
  }
  return static_cast<std::int64_t>(value);
}

using Phantom = std::variant<ImagePhantom, SpaceTimePhantom>;

Phantom MakePhantom(Arguments arguments)
{
  const auto coarsening = [&](std::int64_t largest)
  { return TakeCount(arguments, "--coarsening", 1, 1, largest); };
  const auto frames = [&](std::int64_t usual)
  { return TakeCount(arguments, "--frames", usual, 2, 1000); };
  const std::map<std::string, std::function<Phantom()>> phantoms = {
    { "ball", [&] { return SingleBall(coarsening(40)); } },
    { "embedded-balls", [&] { return EmbeddedBalls(coarsening(40)); } },
    { "torus", [&] { return Torus(coarsening(8)); } },
    { "four-ball", [&] { return FourBall(Take(arguments, "--radius", 12.0, 1.0, 60.0)); } },
    { "beating-ventricle", [&] { return BeatingVentricle(coarsening(11)); } },
    { "merging-balls", [&] { return MergingBalls(frames(17)); } },
    { "rotating-sheet", [&] { return RotatingSheet(frames(15)); } },
    { "opening-tube", [&] { return OpeningTube(frames(15)); } },
    { "fast-ball", [&] { return FastBall(frames(17)); } },
  };
  const auto found = phantoms.find(arguments.Name);
  if (found == phantoms.end())
  {
    throw std::invalid_argument("no such phantom: " + arguments.Name);
  }
  Phantom phantom = found->second();
  if (!arguments.Options.empty())
  {
    throw std::invalid_argument(
      arguments.Options.begin()->first + " is no option of " + arguments.Name);
  }
  return phantom;
}

template <typename PhantomType>
void Write(const PhantomType& phantom, const std::string& fileName)
{
  constexpr auto Dimension = static_cast<unsigned>(decltype(phantom.Grid.Dimensions)().size());
  using Image = itk::Image<std::uint8_t, Dimension>;
  const std::vector<std::uint8_t> scalars = phantom.Scalars();
  typename Image::SizeType size;
  typename Image::SpacingType spacing;
  for (unsigned axis = 0; axis < Dimension; ++axis)
  {
    size[axis] = static_cast<itk::SizeValueType>(phantom.Grid.Dimensions[axis]);
    spacing[axis] = phantom.Grid.Spacing(static_cast<int>(axis));
  }
  const typename Image::Pointer image = Image::New();
  image->SetRegions(size);
  image->SetSpacing(spacing);
  image->Allocate();
  std::copy(scalars.begin(), scalars.end(), image->GetBufferPointer());

  const auto writer = itk::ImageFileWriter<Image>::New();
  writer->SetFileName(fileName);
  writer->SetInput(image);
  writer->UseCompressionOn();
  writer->Update();
}

} // namespace

int main(int argc, char** argv)
{
  std::string file;
  Phantom phantom;
  try
  {
    Arguments arguments = ParseArguments(argc, argv);
    file = arguments.File;
    phantom = MakePhantom(std::move(arguments));
  }
  catch (const std::invalid_argument& error)
  {
    std::fprintf(stderr, "error: %s\n\n%s", error.what(), Usage);
    return 2;
  }
  try
  {
    std::visit([&](const auto& shape) { Write(shape, file); }, phantom);
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "error: cannot write %s: %s\n", file.c_str(), error.what());
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}
