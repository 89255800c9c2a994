// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "MeshingParameters.h"

namespace voxplex
{
namespace
{

using Kind = ParameterKind;
using Group = ParameterGroup;
using Parameters = std::vector<MeshingParameter>;

constexpr const char* None = MeshingParameter::None;
constexpr double Infinity = std::numeric_limits<double>::infinity();
constexpr double LargestWhole = std::numeric_limits<int>::max();
constexpr ParameterRange Positive{ 0.0, Infinity, true };
constexpr ParameterRange NotNegative{ 0.0, Infinity };
constexpr ParameterRange Sigmas{ 0.0, 5.0 };

Parameters GreyValues()
{
  return {
    { .Name = "isovalue",
      .Kind = Kind::Real,
      .Dimension = 3,
      .Usual = ParameterRange{ -1e9, 1e9 },
      .Step = 0.1,
      .Unit = "VALUE",
      .Help = "mesh what the isosurface of a grey-value image at this value bounds, as one label" },
    { .Name = "inside",
      .Kind = Kind::Word,
      .Dimension = 3,
      .Default = "above",
      .Words = { "above", "below" },
      .Help = "on which side of the isosurface the object lies; above: where values are greater" },
    { .Name = "inside-label",
      .Kind = Kind::Whole,
      .Label = "Label of the inside",
      .Dimension = 3,
      .Default = "1",
      .Range = { 1.0, LargestWhole },
      .Usual = ParameterRange{ 1.0, 65535.0 },
      .Step = 1.0,
      .Unit = "LABEL",
      .Help = "the label of the elements inside of the isosurface" },
    { .Name = "grey-smoothing",
      .Kind = Kind::Real,
      .Property = "IsosurfaceSmoothingSigma",
      .Label = "Smoothing of grey values",
      .Dimension = 3,
      .Default = "0",
      .Range = Sigmas,
      .Step = 0.1,
      .Unit = "VOXELS",
      .Help = "standard deviation of the smoothing of noise in grey values, in voxels",
      .Zero = "off",
      .Option = None, // --smoothing is both
      .Python = None },
  };
}

Parameters Density()
{
  return {
    { .Name = "delta",
      .Kind = Kind::Real,
      .Range = Positive,
      .Unit = "LENGTH",
      .Help = "sampling density of the interfaces: the edges of their triangles are about one to "
              "two times as long; the number of elements grows with the square of 1/delta",
      .Zero = "derived from the spacing" },
    { .Name = "elements",
      .Kind = Kind::Whole,
      .Property = "NumberOfElements",
      .Label = "Number of elements",
      .Range = { 1.0, LargestWhole },
      .Unit = "NUMBER",
      .Help = "solve for the delta that makes so many elements, to within a tenth, in place of "
              "{delta}; it takes two or three times as long",
      .Zero = "as delta has it" },
    { .Name = "grading",
      .Kind = Kind::Word,
      .Dimension = 3,
      .Default = "uniform",
      .Words = { "uniform", "lfs" },
      .Help = "sample interfaces with delta everywhere (uniform), or more coarsely where their "
              "shape allows it, by the local feature size (lfs): the distance to the medial axis, "
              "about half the thickness of what is thin" },
    { .Name = "size",
      .Kind = Kind::Real,
      .Property = "ElementSize",
      .Label = "Largest element",
      .Range = Positive,
      .Unit = "LENGTH",
      .Help = "upper bound of the elements' circumradii, everywhere",
      .Zero = "no bound" },
    { .Name = "label-size",
      .Kind = Kind::LabelSizes,
      .Label = "Largest element of labels",
      .Unit = "LABEL=LENGTH",
      .Help = "the same in single labels",
      .Slicer = "labelSizes",
      .Python = "label_sizes" },
    { .Name = "size-image",
      .Kind = Kind::Image,
      .Property = "ElementSizeData",
      .Label = "Image of sizes",
      .Unit = "FILE",
      .Help = "the same from an image whose values are lengths, 0 where there is no bound",
      .Slicer = None },
  };
}

Parameters Labels()
{
  return {
    { .Name = "labels",
      .Kind = Kind::Labels,
      .Property = "Label",
      .Unit = "LIST",
      .Help = "mesh these labels only; the others become background" },
  };
}

Parameters Shapes()
{
  return {
    { .Name = "optimise",
      .Kind = Kind::Flag,
      .Dimension = 3,
      .Default = "on",
      .Help = "improve shapes after refinement: dihedral angles of 15 to 155 degrees but for a "
              "few, radius-edge ratios up to 2.5",
      .Zero = "they stay as refinement makes them: Delaunay, radius-edge ratios below 2" },
    { .Name = "smallest-component",
      .Kind = Kind::Whole,
      .Dimension = 3,
      .Default = "8",
      .Range = { 0.0, LargestWhole },
      .Unit = "VOXELS",
      .Help = "connected components of at least so many voxels, and the largest of each label, get "
              "tetrahedra whatever delta",
      .Zero = "as it comes" },
    { .Name = "exact-components",
      .Kind = Kind::Flag,
      .Dimension = 3,
      .Default = "off",
      .Help = "sample these components as finely as they are thin, whatever delta; otherwise those "
              "that are thin beside delta have a few tetrahedra" },
    { .Name = "min-component-volume",
      .Kind = Kind::Real,
      .Property = "MinimumComponentVolume",
      .Label = "Smallest volume",
      .Dimension = 3,
      .Range = Positive,
      .Unit = "VOLUME",
      .Help = "leave out connected components that are smaller, such as specks: they become what "
              "is around them",
      .Zero = "none is left out",
      .Slicer = "minimumVolume" },
  };
}

Parameters Interfaces()
{
  return {
    { .Name = "interface-size",
      .Kind = Kind::InterfaceSizes,
      .Label = "Interface sizes",
      .Unit = "LABELS=LENGTH",
      .Help = "sampling density of all interfaces of a label, or of the interface between two "
              "labels, 0 being background, in place of delta, smaller or larger",
      .Slicer = "interfaceSizes",
      .Python = "interface_sizes" },
    { .Name = "feature-ratio",
      .Kind = Kind::Real,
      .Dimension = 3,
      .Default = "1",
      .Range = Positive,
      .Usual = ParameterRange{ 0.1, 4.0 },
      .Step = 0.1,
      .Unit = "RATIO",
      .Help = "with {grading} lfs: sampling density over local feature size where that gives more "
              "than delta" },
    { .Name = "largest-feature",
      .Kind = Kind::Real,
      .Dimension = 3,
      .Default = "12",
      .Range = Positive,
      .Usual = ParameterRange{ 1.0, 100.0 },
      .Step = 1.0,
      .Unit = "VOXELS",
      .Help = "with {grading} lfs: larger local feature sizes count as this (lambda), in voxels" },
    { .Name = "gradation",
      .Kind = Kind::Real,
      .Default = "0.3",
      .Range = NotNegative,
      .Usual = ParameterRange{ 0.0, 1.0 },
      .Unit = "SLOPE",
      .Help = "how much sizes and interface sizes may change over a unit of length",
      .Zero = "no limit" },
  };
}

Parameters Quality()
{
  return {
    { .Name = "radius-edge",
      .Kind = Kind::Real,
      .Property = "RadiusEdgeRatio",
      .Label = "Radius-edge ratio",
      .Default = "2",
      .Range = { 1.0, Infinity },
      .Usual = ParameterRange{ 1.0, 10.0 },
      .Step = 0.1,
      .Unit = "RATIO",
      .Help = "upper bound of circumradius over shortest edge, of every element",
      .ForceBelow = 1.93,
      .ForceWhy = "it is not proved that refinement ends" },
    { .Name = "facet-angle",
      .Kind = Kind::Real,
      .Dimension = 3,
      .Default = "30",
      .Range = { 0.0, 30.0 },
      .Step = 1.0,
      .Unit = "DEGREES",
      .Help = "lower bound of the angles of triangles on the interfaces, in degrees" },
    { .Name = "smoothing",
      .Kind = Kind::Real,
      .Property = "SmoothingSigma",
      .Default = "1",
      .Range = Sigmas,
      .Step = 0.1,
      .Unit = "VOXELS",
      .Help = "standard deviation of the smoothing of voxel stairs, in voxels; every voxel centre "
              "keeps its label",
      .Zero = "off",
      .StandsFor = "grey-smoothing" },
    { .Name = "sliver-angle",
      .Kind = Kind::Real,
      .Dimension = 3,
      .Default = "9",
      .Range = { 0.0, 59.0 },
      .Step = 1.0,
      .Unit = "DEGREES",
      .Help = "dihedral angle below which, or above 180 degrees less which, a tetrahedron is a "
              "sliver and split; most above 3 degrees are left to optimisation",
      .Zero = "leave slivers",
      .ForceAbove = 15.0,
      .ForceWhy = "meshes can become very large" },
    { .Name = "optimise-seconds",
      .Kind = Kind::Real,
      .Property = "OptimisationTimeLimit",
      .Label = "Time for optimising",
      .Dimension = 3,
      .Range = Positive,
      .Unit = "SECONDS",
      .Help = "stop improving shapes after so long, wherever that is",
      .Zero = "no limit" },
    { .Name = "junctions",
      .Kind = Kind::Flag,
      .Property = "SampleJunctions",
      .Dimension = 3,
      .Default = "on",
      .Help = "sample the curves where three labels or more meet before all else, so that edges "
              "follow them",
      .Zero = "the curves zigzag",
      .Python = "sample_junctions" },
    { .Name = "interface-rounds",
      .Kind = Kind::Whole,
      .Dimension = 3,
      .Default = "8",
      .Range = { 0.0, 100.0 },
      .Step = 1.0,
      .Unit = "NUMBER",
      .Help = "how often, at most, to refine again where an interface of the image is farther than "
              "1.5 delta from the mesh's, or a label's boundary is not manifold",
      .Zero = "never" },
    { .Name = "manifold",
      .Kind = Kind::Flag,
      .Dimension = 3,
      .Default = "on",
      .Help =
        "mend edges where more than two triangles of a label's boundary meet, if need be with "
        "pieces of tetrahedra that are not Delaunay",
      .Zero = "such edges stay",
      .Slicer = None },
  };
}

Parameters SpaceTime()
{
  return {
    { .Name = "time-scale",
      .Kind = Kind::Real,
      .Dimension = 4,
      .Default = "1",
      .Range = Positive,
      .Unit = "LENGTH",
      .Help = "the length that one unit of time counts as much as" },
    { .Name = "rule-order",
      .Kind = Kind::Word,
      .Dimension = 4,
      .Default = "radius-edge",
      .Words = { "radius-edge", "surface" },
      .Help = "which rules come first: those that bound the radius-edge ratio, or those that "
              "sample the interfaces",
      .Python = None },
    { .Name = "picking",
      .Kind = Kind::Flag,
      .Property = "PickingRegions",
      .Label = "Fight slivers",
      .Dimension = 4,
      .Default = "on",
      .Help = "fight slivers with picking regions",
      .Zero = "faster, with flat elements",
      .Python = "pick_slivers" },
    { .Name = "picks",
      .Kind = Kind::Whole,
      .Property = "NumberOfPicks",
      .Label = "Number of picks",
      .Dimension = 4,
      .Default = "10",
      .Range = { 1.0, LargestWhole },
      .Unit = "NUMBER",
      .Help = "random points to try in a picking region",
      .Python = None },
    { .Name = "sliver-bound",
      .Kind = Kind::Real,
      .Dimension = 4,
      .Default = "0.01",
      .Range = { 0.0, 0.999 },
      .Usual = ParameterRange{ 0.0, 0.03 },
      .Unit = "RATIO",
      .Help = "normalized volume below which an element is a sliver",
      .ForceAbove = 0.03,
      .ForceWhy = "meshes can become very large",
      .Python = None },
    { .Name = "seed",
      .Kind = Kind::Whole,
      .Property = "RandomSeed",
      .Label = "Random seed",
      .Dimension = 4,
      .Default = "0",
      .Range = { 0.0, LargestWhole },
      .Unit = "NUMBER",
      .Help = "seed of the random points" },
    { .Name = "fine-grained",
      .Kind = Kind::Flag,
      .Label = "Fine-grained",
      .Dimension = 4,
      .Default = "on",
      .Help = "let waiting threads help others to expand cavities",
      .Python = None },
  };
}

Parameters Running()
{
  return {
    { .Name = "threads",
      .Kind = Kind::Whole,
      .Property = "NumberOfThreads",
      .Default = "0",
      .Range = { 0.0, 4096.0 },
      .Step = 1.0,
      .Unit = "NUMBER",
      .Help = "threads to use in every stage, refinement included; with 1 the mesh is the same, "
              "bit for bit, in every run",
      .Zero = "all cores" },
    { .Name = "contention",
      .Kind = Kind::Word,
      .Property = "ContentionManager",
      .Label = "Contention manager",
      .Default = "local",
      .Words = { "aggressive", "random", "global", "local" },
      .Unit = "MANAGER",
      .Help = "what a thread does when another holds what it needs: aggressive (try again at "
              "once), random (sleep now and then), global or local (wait until another thread "
              "makes progress)",
      .Slicer = None,
      .Python = None },
    { .Name = "balance",
      .Kind = Kind::Word,
      .Property = "LoadBalancer",
      .Label = "Load balancer",
      .Default = "hws",
      .Words = { "rws", "hws" },
      .Help = "from whom a thread without work gets some: whichever thread looks first (rws) or "
              "the nearest (hws)",
      .Slicer = None,
      .Python = None },
    { .Name = "pin",
      .Kind = Kind::Flag,
      .Property = "PinThreads",
      .Label = "Pin threads",
      .Default = "off",
      .Help = "keep each thread on a core of its own; not while other programs use the cores",
      .Slicer = None,
      .Python = None },
    { .Name = "memory-limit",
      .Kind = Kind::Bytes,
      .Range = { 1.0, 1e18 },
      .Unit = "BYTES",
      .Help = "refuse meshes estimated to need more",
      .Zero = "the machine's memory",
      .Slicer = None },
    { .Name = "force",
      .Kind = Kind::Flag,
      .Default = "off",
      .Help = "go on although the mesh is estimated not to fit into memory, the labels look like "
              "grey values, or the value of another parameter needs it" },
  };
}

struct GroupOfParameters
{
  Group Name;
  Parameters Members;
};

Parameters Join(const std::vector<GroupOfParameters>& groups)
{
  Parameters all;
  for (const GroupOfParameters& group : groups)
  {
    for (const MeshingParameter& member : group.Members)
    {
      all.push_back(member);
      all.back().Group = group.Name;
    }
  }
  return all;
}

} // namespace

const std::vector<MeshingParameter>& MeshingParameters()
{
  static const Parameters all = Join({
    { Group::GreyValues, GreyValues() },
    { Group::Density, Density() },
    { Group::Labels, Labels() },
    { Group::Shapes, Shapes() },
    { Group::Interfaces, Interfaces() },
    { Group::Quality, Quality() },
    { Group::SpaceTime, SpaceTime() },
    { Group::Running, Running() },
  });
  return all;
}

} // namespace voxplex
