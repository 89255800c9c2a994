// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Parameters.h"

namespace voxplex::slicer
{
namespace
{

ParameterGroup Files()
{
  return { .Label = "Input and output",
    .Description = "The label map, and the mesh that is made of it",
    .Parameters = {
      { .Type = Kind::Image,
        .Name = "inputLabels",
        .Label = "Label map or volume",
        .Description =
          "The segmentation: one whole number a voxel, 0 is background; or, if Isosurface "
          "is on, a volume of grey values. Origin, spacing and axes are honoured.",
        .Index = 0,
        .Direction = Channel::Input,
        .NodeType = "any",
        .FileExtensions = ".nrrd" },
      { .Type = Kind::Table,
        .Name = "colorTable",
        .Label = "Colour table",
        .Description =
          "Names and colours of the labels, for the mesh. Optional: the names in a .seg.nrrd "
          "file are used without.",
        .LongFlag = "colortable",
        .Direction = Channel::Input,
        .NodeType = "color",
        .FileExtensions = ".ctbl" },
      { .Type = Kind::Geometry,
        .Name = "outputMesh",
        .Label = "Mesh",
        .Description = "The tetrahedra, with the label of each in the cell array Label.",
        .Index = 1,
        .Direction = Channel::Output,
        .NodeType = "model",
        .FileExtensions = ".vtu" },
      { .Type = Kind::Geometry,
        .Name = "outputSurfaces",
        .Label = "Interfaces",
        .Description = "The triangles between labels, and between labels and background, with both "
                       "labels of each in the cell array Labels. Optional.",
        .LongFlag = "surfaces",
        .Direction = Channel::Output,
        .NodeType = "model",
        .FileExtensions = ".vtp" },
    } };
}

ParameterGroup GreyValues()
{
  return { .Label = "Isosurface",
    .Description = "Mesh what an isosurface of a volume of grey values bounds, as one label.",
    .Parameters = {
      { .Type = Kind::Boolean,
        .Name = "isosurface",
        .Label = "Isosurface",
        .Description = "The input has grey values, not labels.",
        .LongFlag = "isosurface",
        .Default = "false" },
      { .Type = Kind::Double,
        .Name = "isovalue",
        .Label = "Isovalue",
        .Description = "The value of the isosurface.",
        .LongFlag = "isovalue",
        .Default = "0",
        .Limits = Constraints{ -1e9, 1e9, 0.1 } },
      { .Type = Kind::StringEnumeration,
        .Name = "inside",
        .Label = "Inside",
        .Description = "On which side of the isosurface the object lies.",
        .LongFlag = "inside",
        .Default = "above",
        .Elements = { "above", "below" } },
      { .Type = Kind::Integer,
        .Name = "insideLabel",
        .Label = "Label of the inside",
        .Description = "The label of its elements.",
        .LongFlag = "insidelabel",
        .Default = "1",
        .Limits = Constraints{ 1.0, 65535.0, 1.0 } },
      { .Type = Kind::Double,
        .Name = "greySmoothing",
        .Label = "Smoothing of grey values",
        .Description =
          "How far grey values are smoothed against noise: the standard deviation of a "
          "Gaussian, in voxels. 0 switches it off.",
        .LongFlag = "greysmoothing",
        .Default = "0",
        .Limits = Constraints{ 0.0, 5.0, 0.1 } },
    } };
}

ParameterGroup Density()
{
  return { .Label = "Density",
    .Description = "How fine the mesh is. Lengths are in the unit of the image, usually "
                   "millimetres.",
    .Parameters = {
      { .Type = Kind::Double,
        .Name = "delta",
        .Label = "Delta",
        .Description = "Sampling density of the interfaces: the edges of their triangles are about "
                       "one to two times as long. 0 derives it from the spacing of the voxels.",
        .LongFlag = "delta",
        .Flag = 'd',
        .Default = "0" },
      { .Type = Kind::Integer,
        .Name = "elements",
        .Label = "Number of elements",
        .Description =
          "Solve for the delta that makes so many tetrahedra, to within a tenth; delta must "
          "be 0 then. It takes two or three times as long. 0 leaves it to delta.",
        .LongFlag = "elements",
        .Default = "0" },
      { .Type = Kind::StringEnumeration,
        .Name = "grading",
        .Label = "Grading",
        .Description = "uniform samples interfaces with delta everywhere; lfs more coarsely where "
                       "their shape allows it, by the local feature size: the distance to the "
                       "medial axis, about half the thickness of what is thin.",
        .LongFlag = "grading",
        .Default = "uniform",
        .Elements = { "uniform", "lfs" } },
      { .Type = Kind::Double,
        .Name = "size",
        .Label = "Largest element",
        .Description = "Upper bound of the circumradii of all elements. 0 sets none.",
        .LongFlag = "size",
        .Default = "0" },
      { .Type = Kind::StringVector,
        .Name = "labelSizes",
        .Label = "Largest element of labels",
        .Description = "The same for single labels: LABEL=LENGTH, separated by commas, such as "
                       "3=1.5,7=2.",
        .LongFlag = "labelsizes" },
      { .Type = Kind::IntegerVector,
        .Name = "labels",
        .Label = "Labels",
        .Description = "Mesh these labels only, such as 1,2,5; the others become background. Left "
                       "empty, all are meshed.",
        .LongFlag = "labels" },
    } };
}

ParameterGroup Shapes()
{
  return { .Label = "Shapes and small objects",
    .Description = "What is looked after besides.",
    .Parameters = {
      { .Type = Kind::StringEnumeration,
        .Name = "optimise",
        .Label = "Optimise",
        .Description = "Improve shapes after refinement: dihedral angles of 15 to 155 degrees but "
                       "for a few, at the "
                       "price of radius-edge ratios up to 2.5.",
        .LongFlag = "optimise",
        .Default = "on",
        .Elements = { "on", "off" } },
      { .Type = Kind::Integer,
        .Name = "smallestComponent",
        .Label = "Smallest component",
        .Description =
          "Connected components of a label with at least so many voxels, and its largest one, get "
          "tetrahedra, however small they are beside delta. 1 keeps all single voxels, 0 leaves it "
          "to chance.",
        .LongFlag = "smallestcomponent",
        .Default = "8" },
      { .Type = Kind::Boolean,
        .Name = "exactComponents",
        .Label = "Exact components",
        .Description = "Sample these components as finely as they are thin, whatever delta. "
                       "Otherwise those that "
                       "are thin beside delta have a few tetrahedra.",
        .LongFlag = "exactcomponents",
        .Default = "false" },
      { .Type = Kind::Double,
        .Name = "minimumVolume",
        .Label = "Smallest volume",
        .Description =
          "Leave out connected components with less volume, such as specks: they become "
          "what is around them. 0 leaves out none.",
        .LongFlag = "minimumvolume",
        .Default = "0" },
      { .Type = Kind::Boolean,
        .Name = "quality",
        .Label = "Compare with the label map",
        .Description =
          "Measure the finished mesh: the Hausdorff distance of its interfaces from those of the "
          "label map, errors of volumes, non-manifold edges. Not of isosurfaces.",
        .LongFlag = "quality",
        .Default = "false" },
    } };
}

ParameterGroup Sizes()
{
  return { .Label = "Sizes of interfaces",
    .Description = "How density changes from place to place.",
    .Advanced = true,
    .Parameters = {
      { .Type = Kind::StringVector,
        .Name = "interfaceSizes",
        .Label = "Interface sizes",
        .Description =
          "In place of delta: LABEL=LENGTH for all interfaces of a label, LABEL:LABEL=LENGTH for "
          "the one between two, 0 being background; separated by commas, such as 3=0.5,3:7=0.4.",
        .LongFlag = "interfacesizes" },
      { .Type = Kind::Double,
        .Name = "featureRatio",
        .Label = "Feature ratio",
        .Description =
          "With grading lfs: sampling density over local feature size where that gives "
          "more than delta.",
        .LongFlag = "featureratio",
        .Default = "1",
        .Limits = Constraints{ 0.1, 4.0, 0.1 } },
      { .Type = Kind::Double,
        .Name = "largestFeature",
        .Label = "Largest feature",
        .Description = "With grading lfs: local feature sizes above this count as this, in voxels.",
        .LongFlag = "largestfeature",
        .Default = "12",
        .Limits = Constraints{ 1.0, 100.0, 1.0 } },
      { .Type = Kind::Double,
        .Name = "gradation",
        .Label = "Gradation",
        .Description =
          "How much sizes, and interface sizes, may change over a unit of length. 0 sets "
          "no limit.",
        .LongFlag = "gradation",
        .Default = "0.3" },
    } };
}

ParameterGroup Quality()
{
  return { .Label = "Quality",
    .Description = "The defaults suit finite elements.",
    .Advanced = true,
    .Parameters = {
      { .Type = Kind::Double,
        .Name = "radiusEdge",
        .Label = "Radius-edge ratio",
        .Description = "Upper bound of circumradius over shortest edge of every element. Below "
                       "1.932 it is not proved that meshing ends, and Force is needed.",
        .LongFlag = "radiusedge",
        .Default = "2",
        .Limits = Constraints{ 1.0, 10.0, 0.1 } },
      { .Type = Kind::Double,
        .Name = "facetAngle",
        .Label = "Facet angle",
        .Description = "Lower bound of the angles of triangles on the interfaces, in degrees.",
        .LongFlag = "facetangle",
        .Default = "30",
        .Limits = Constraints{ 0.0, 30.0, 1.0 } },
      { .Type = Kind::Double,
        .Name = "smoothing",
        .Label = "Smoothing",
        .Description =
          "How far voxel stairs are smoothed: the standard deviation of a Gaussian, in "
          "voxels. Every voxel centre keeps its label. 0 switches it off.",
        .LongFlag = "smoothing",
        .Flag = 's',
        .Default = "1",
        .Limits = Constraints{ 0.0, 10.0, 0.1 } },
      { .Type = Kind::Double,
        .Name = "sliverAngle",
        .Label = "Sliver angle",
        .Description =
          "Tetrahedra with a dihedral angle below this, or above 180 degrees less this, "
          "are split. 0 leaves them alone; above 15 Force is needed.",
        .LongFlag = "sliverangle",
        .Default = "9",
        .Limits = Constraints{ 0.0, 59.0, 1.0 } },
      { .Type = Kind::Double,
        .Name = "optimiseSeconds",
        .Label = "Time for optimising",
        .Description =
          "Stop improving shapes after so many seconds, wherever that is. 0 sets no limit.",
        .LongFlag = "optimiseseconds",
        .Default = "0" },
      { .Type = Kind::StringEnumeration,
        .Name = "junctions",
        .Label = "Junctions",
        .Description = "Sample the curves where three labels or more meet before all else, so that "
                       "edges follow them; otherwise they zigzag.",
        .LongFlag = "junctions",
        .Default = "on",
        .Elements = { "on", "off" } },
      { .Type = Kind::Integer,
        .Name = "interfaceRounds",
        .Label = "Interface rounds",
        .Description =
          "How often, at most, to refine again where an interface of the image is farther than 1.5 "
          "delta from those of the mesh, or where the boundary of a label is not manifold. 0: "
          "never.",
        .LongFlag = "interfacerounds",
        .Default = "8",
        .Limits = Constraints{ 0.0, 100.0, 1.0 } },
    } };
}

ParameterGroup Running()
{
  return { .Label = "Running",
    .Description = "How the module works.",
    .Advanced = true,
    .Parameters = {
      { .Type = Kind::Integer,
        .Name = "threads",
        .Label = "Threads",
        .Description = "How many threads work; 0 means all cores. With 1 the mesh is the same in "
                       "every run.",
        .LongFlag = "threads",
        .Flag = 't',
        .Default = "0",
        .Limits = Constraints{ 0.0, 1024.0, 1.0 } },
      { .Type = Kind::Boolean,
        .Name = "force",
        .Label = "Force",
        .Description = "Go on although the mesh is estimated not to fit into memory, the labels "
                       "look like grey values, or the radius-edge ratio is too low.",
        .LongFlag = "force",
        .Default = "false" },
      { .Type = Kind::StringEnumeration,
        .Name = "space",
        .Label = "Coordinates",
        .Description = "Coordinates in the files: LPS is that of DICOM and of Slicer's files, RAS "
                       "that of Slicer's scene. The files say which; Slicer reads both.",
        .LongFlag = "space",
        .Default = "LPS",
        .Elements = { "LPS", "RAS" } },
    } };
}

ParameterGroup Results()
{
  return { .Label = "Results",
    .Description = "What is known about the mesh afterwards.",
    .Parameters = {
      { .Type = Kind::Integer,
        .Name = "numberOfTetrahedra",
        .Label = "Tetrahedra",
        .Description = "How many there are.",
        .Direction = Channel::Output,
        .Default = "0" },
      { .Type = Kind::Double,
        .Name = "usedDelta",
        .Label = "Delta used",
        .Description = "The sampling density that was used.",
        .Direction = Channel::Output,
        .Default = "0" },
      { .Type = Kind::String,
        .Name = "missingLabels",
        .Label = "Labels without elements",
        .Description = "Labels of the image that the mesh lacks, because they are too small for "
                       "delta.",
        .Direction = Channel::Output },
      { .Type = Kind::Integer,
        .Name = "missingComponents",
        .Label = "Components without elements",
        .Description =
          "How many connected components the mesh lacks although they were looked after.",
        .Direction = Channel::Output,
        .Default = "0" },
      { .Type = Kind::Double,
        .Name = "smallestDihedralAngle",
        .Label = "Smallest dihedral angle",
        .Description = "Of all tetrahedra, in degrees.",
        .Direction = Channel::Output,
        .Default = "0" },
      { .Type = Kind::Double,
        .Name = "largestDihedralAngle",
        .Label = "Largest dihedral angle",
        .Description = "Of all tetrahedra, in degrees.",
        .Direction = Channel::Output,
        .Default = "0" },
      { .Type = Kind::Double,
        .Name = "largestRadiusEdge",
        .Label = "Largest radius-edge ratio",
        .Description = "Circumradius over shortest edge, of all tetrahedra.",
        .Direction = Channel::Output,
        .Default = "0" },
      { .Type = Kind::Double,
        .Name = "smallestFacetAngle",
        .Label = "Smallest angle of triangles",
        .Description = "Of those on the interfaces, in degrees.",
        .Direction = Channel::Output,
        .Default = "0" },
      { .Type = Kind::Double,
        .Name = "hausdorffDistance",
        .Label = "Hausdorff distance",
        .Description = "From the faces between voxels of different labels to the interfaces and "
                       "back, if the mesh was compared with the label map.",
        .Direction = Channel::Output,
        .Default = "0" },
      { .Type = Kind::Integer,
        .Name = "nonManifoldEdges",
        .Label = "Non-manifold edges",
        .Description = "Edges of the boundary of a label that not exactly two of its triangles "
                       "share, if the mesh was compared.",
        .Direction = Channel::Output,
        .Default = "0" },
      { .Type = Kind::Double,
        .Name = "volumeError",
        .Label = "Error of volumes",
        .Description = "Of the label that has the largest, as a fraction of its volume, if the "
                       "mesh was compared.",
        .Direction = Channel::Output,
        .Default = "0" },
    } };
}

} // namespace

const std::vector<ParameterGroup>& ParameterGroups()
{
  static const std::vector<ParameterGroup> groups{ Files(), GreyValues(), Density(), Shapes(),
    Sizes(), Quality(), Running(), Results() };
  return groups;
}

} // namespace voxplex::slicer
