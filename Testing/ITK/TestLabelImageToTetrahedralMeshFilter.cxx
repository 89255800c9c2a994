// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// The filter for ITK: where its mesh lies, what of it arrives in ITK's pipeline, and that its mesh is that of the filter
// for VTK.
#include "itkLabelImageToTetrahedralMeshFilter.h"

#include "MeshingParameters.h"

#include "itkCastImageFilter.h"
#include "itkCommand.h"
#include "itkDefaultStaticMeshTraits.h"
#include "itkImage.h"
#include "itkImageRegionIteratorWithIndex.h"
#include "itkMesh.h"
#include "itkOutputWindow.h"

#include "vtkCellArray.h"
#include "vtkImageData.h"
#include "vtkImageToTetMeshFilter.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkUnstructuredGrid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <tuple>
#include <vector>

namespace
{

using Image = itk::Image<unsigned short, 3>;
template <typename Label>
using MeshOf = itk::Mesh<Label, 3, itk::DefaultStaticMeshTraits<Label, 3, 3, double, double>>;
using Mesh = MeshOf<int>;
using Filter = itk::LabelImageToTetrahedralMeshFilter<Image, Mesh>;
using Vector = itk::Vector<double, 3>;

constexpr unsigned short Inner = 7;
constexpr unsigned short Outer = 300;
const itk::Point<double, 3> Centre(std::array<double, 3>{ -31.0, 12.0, 205.0 });

/** Columns of rotations and reflections. */
Image::DirectionType Direction(const std::string& kind)
{
  constexpr double oblique[3][3] = { { 0.8, -0.6, 0.0 }, { 0.48, 0.64, -0.6 },
    { 0.36, 0.48, 0.8 } };
  Image::DirectionType direction;
  direction.SetIdentity();
  for (unsigned r = 0; r < 3 && kind != "plain"; ++r)
  {
    for (unsigned c = 0; c < 3; ++c)
    {
      direction[r][c] = oblique[r][c] * (kind == "left-handed" && c == 1 ? -1.0 : 1.0);
    }
  }
  return direction;
}

/** A ball of the label Outer with a ball of Inner in it, around Centre; no index of a voxel is 0. */
template <typename Pixel = unsigned short>
typename itk::Image<Pixel, 3>::Pointer MakeImage(
  const std::string& kind = "plain", double radius = 10.0, double inner = 6.0)
{
  using ImageType = itk::Image<Pixel, 3>;
  const auto image = ImageType::New();
  image->SetRegions(typename ImageType::RegionType({ { -9, 4, 11 } }, { { 25, 31, 20 } }));
  const double spacing[3] = { 1.0, 0.8, 1.25 };
  image->SetSpacing(spacing);
  image->SetDirection(Direction(kind));
  image->Allocate();
  itk::Point<double, 3> middle; // of the voxels, with the origin at 0
  constexpr double index[3] = { 3.0, 19.0, 20.5 };
  image->TransformContinuousIndexToPhysicalPoint(itk::ContinuousIndex<double, 3>(index), middle);
  image->SetOrigin((Centre - middle).GetDataPointer());
  for (itk::ImageRegionIteratorWithIndex<ImageType> voxel(image, image->GetBufferedRegion());
       !voxel.IsAtEnd(); ++voxel)
  {
    itk::Point<double, 3> x;
    image->TransformIndexToPhysicalPoint(voxel.GetIndex(), x);
    const double r = x.EuclideanDistanceTo(Centre);
    voxel.Set(static_cast<Pixel>(r < inner ? Inner
        : r < radius                       ? (sizeof(Pixel) == 1 ? 100 : Outer)
                                           : 0));
  }
  return image;
}

Filter::Pointer MakeFilter(const Image* image, double delta = 2.0)
{
  const auto filter = Filter::New();
  filter->SetInput(image);
  filter->SetDelta(delta);
  filter->SetNumberOfWorkUnits(1);
  return filter;
}

std::vector<std::uint64_t> CornersOf(const Mesh* mesh, std::size_t cell)
{
  Mesh::CellAutoPointer pointer;
  EXPECT_TRUE(mesh->GetCell(cell, pointer));
  EXPECT_EQ(pointer->GetType(), itk::CommonEnums::CellGeometry::TETRAHEDRON_CELL);
  return { pointer->PointIdsBegin(), pointer->PointIdsEnd() };
}

struct Measured
{
  std::map<int, double> Volumes;
  Vector Centroid{ 0.0 };
};

/** Checks that tetrahedra are positive, and that all points are used. */
Measured Measure(const Mesh* mesh)
{
  Measured result;
  std::set<std::uint64_t> used;
  double all = 0.0;
  for (std::size_t cell = 0; cell < mesh->GetNumberOfCells(); ++cell)
  {
    const auto corners = CornersOf(mesh, cell);
    const auto p = mesh->GetPoint(corners[0]);
    Vector edges[3];
    Vector middle(0.0);
    for (unsigned i = 0; i < 4; ++i)
    {
      used.insert(corners[i]);
      middle += mesh->GetPoint(corners[i]).GetVectorFromOrigin() / 4.0;
      edges[i ? i - 1 : 0] = mesh->GetPoint(corners[i]) - p;
    }
    const double volume = itk::CrossProduct(edges[0], edges[1]) * edges[2] / 6.0;
    EXPECT_GT(volume, 0.0);
    int label = 0;
    EXPECT_TRUE(mesh->GetCellData(cell, &label));
    result.Volumes[label] += volume;
    result.Centroid += middle * volume;
    all += volume;
  }
  EXPECT_EQ(used.size(), mesh->GetNumberOfPoints());
  result.Centroid /= all;
  return result;
}

/** What Update() says; empty if it succeeds. After an error the output is empty. */
template <typename AnyFilter>
std::string ErrorOf(AnyFilter* filter)
{
  try
  {
    filter->Update();
  }
  catch (const itk::ExceptionObject& error)
  {
    EXPECT_EQ(filter->GetOutput()->GetNumberOfCells(), 0u);
    return error.GetDescription();
  }
  return "";
}

void Observe(itk::Object* object, const itk::EventObject& event, std::function<void()> call)
{
  const auto command = itk::FunctionCommand::New();
  command->SetCallback([call](const itk::EventObject&) { call(); });
  object->AddObserver(event, command);
}

bool Has(const std::string& text, const std::string& part)
{
  return text.find(part) != std::string::npos;
}

/** ITK's warnings, which are otherwise on the screen. */
class Warnings : public itk::OutputWindow
{
public:
  using Self = Warnings;
  using Pointer = itk::SmartPointer<Self>;
  itkFactorylessNewMacro(Self);
  void DisplayText(const char* text) override { this->Text += text; }
  std::string Text;
};

} // namespace

TEST(LabelImageToTetrahedralMeshFilter, MeshLiesWhereTheImageLies)
{
  for (const char* const kind : { "plain", "oblique", "left-handed" })
  {
    SCOPED_TRACE(kind);
    const auto filter = MakeFilter(MakeImage(kind));
    filter->Update();
    const Measured mesh = Measure(filter->GetOutput());
    const auto ball = [](double r) { return 4.0 / 3.0 * std::numbers::pi * r * r * r; };
    ASSERT_EQ(mesh.Volumes.size(), 2u);
    EXPECT_NEAR(mesh.Volumes.at(Inner) / ball(6.0), 1.0, 0.02);
    EXPECT_NEAR(mesh.Volumes.at(Outer) / (ball(10.0) - ball(6.0)), 1.0, 0.02);
    EXPECT_LT((mesh.Centroid - Centre.GetVectorFromOrigin()).GetNorm(), 0.1);
  }
}

TEST(LabelImageToTetrahedralMeshFilter, MeshIsThatOfTheFilterForVTK)
{
  const auto image = MakeImage("left-handed");
  const auto itkFilter = MakeFilter(image);
  itkFilter->Update();
  const Mesh* const ours = itkFilter->GetOutput();

  vtkNew<vtkImageData> copy;
  const auto region = image->GetBufferedRegion();
  const auto first = region.GetIndex();
  const auto last = region.GetUpperIndex();
  copy->SetExtent(static_cast<int>(first[0]), static_cast<int>(last[0]), static_cast<int>(first[1]),
    static_cast<int>(last[1]), static_cast<int>(first[2]), static_cast<int>(last[2]));
  copy->SetSpacing(image->GetSpacing().GetDataPointer());
  copy->SetOrigin(image->GetOrigin().GetDataPointer());
  copy->SetDirectionMatrix(image->GetDirection().GetVnlMatrix().data_block());
  copy->AllocateScalars(VTK_UNSIGNED_SHORT, 1);
  std::copy_n(image->GetBufferPointer(), region.GetNumberOfPixels(),
    static_cast<unsigned short*>(copy->GetScalarPointer()));
  vtkNew<vtkImageToTetMeshFilter> vtkFilter;
  vtkFilter->SetInputData(copy);
  vtkFilter->SetDelta(2.0);
  vtkFilter->SetNumberOfThreads(1);
  vtkFilter->Update();
  vtkUnstructuredGrid* const theirs = vtkFilter->GetOutput();

  ASSERT_EQ(ours->GetNumberOfPoints(), static_cast<std::size_t>(theirs->GetNumberOfPoints()));
  ASSERT_EQ(ours->GetNumberOfCells(), static_cast<std::size_t>(theirs->GetNumberOfCells()));
  for (std::size_t i = 0; i < ours->GetNumberOfPoints(); ++i)
  {
    const itk::Point<double, 3> theirPoint(theirs->GetPoint(static_cast<vtkIdType>(i)));
    ASSERT_LT(ours->GetPoint(i).EuclideanDistanceTo(theirPoint), 1e-10);
  }
  for (std::size_t i = 0; i < ours->GetNumberOfCells(); ++i)
  {
    vtkIdType size = 0;
    const vtkIdType* ids = nullptr;
    theirs->GetCells()->GetCellAtId(static_cast<vtkIdType>(i), size, ids);
    ASSERT_EQ(CornersOf(ours, i), std::vector<std::uint64_t>(ids, ids + size));
  }
}

template <typename Pixel>
void CheckPixels(std::set<std::size_t>& numbers)
{
  using TypedImage = itk::Image<Pixel, 3>;
  const auto filter = itk::LabelImageToTetrahedralMeshFilter<TypedImage, Mesh>::New();
  filter->SetInput(MakeImage<Pixel>());
  filter->SetDelta(4.0);
  filter->SetNumberOfWorkUnits(1);
  filter->Update();
  numbers.insert(filter->GetOutput()->GetNumberOfCells());
}

TEST(LabelImageToTetrahedralMeshFilter, PixelsAreNumbersOfAnyType)
{
  std::set<std::size_t> numbers;
  const auto check = [&numbers]<typename... Pixels>(std::tuple<Pixels...>)
  { (CheckPixels<Pixels>(numbers), ...); };
  check(std::tuple<char, signed char, unsigned char, short, unsigned short, int, unsigned, long,
    unsigned long, long long, unsigned long long, float, double>());
  EXPECT_EQ(numbers.size(), 1u);
}

TEST(LabelImageToTetrahedralMeshFilter, RunsWhenSomethingChanged)
{
  const auto cast = itk::CastImageFilter<itk::Image<int, 3>, Image>::New();
  cast->SetInput(MakeImage<int>());
  cast->UpdateOutputInformation();
  auto corner = cast->GetOutput()->GetLargestPossibleRegion();
  corner.SetSize({ { 3, 3, 3 } });
  cast->GetOutput()->SetRequestedRegion(corner);
  const auto filter = MakeFilter(cast->GetOutput());
  int runs = 0;
  Observe(filter, itk::StartEvent(), [&runs] { ++runs; });
  filter->Update();
  filter->Update();
  EXPECT_EQ(runs, 1);
  const std::size_t whole = filter->GetOutput()->GetNumberOfCells();
  const auto again = MakeFilter(MakeImage());
  again->Update();
  EXPECT_EQ(whole, again->GetOutput()->GetNumberOfCells());

  filter->SetDelta(3.0);
  filter->Update();
  EXPECT_EQ(runs, 2);
  EXPECT_LT(filter->GetOutput()->GetNumberOfCells(), whole);
  filter->AddLabel(Inner);
  filter->Update();
  EXPECT_EQ(Measure(filter->GetOutput()).Volumes.size(), 1u);
  filter->RemoveAllLabels();
  filter->SetDelta(2.0);
  filter->Update();
  EXPECT_EQ(filter->GetOutput()->GetNumberOfCells(), whole);
}

TEST(LabelImageToTetrahedralMeshFilter, ErrorsSayWhatToDo)
{
  const auto image = MakeImage();
  const auto filter = MakeFilter(image);
  filter->SetFacetAngle(40.0);
  EXPECT_TRUE(Has(ErrorOf(filter.GetPointer()), "FacetAngle is 40; it must be"));
  filter->SetFacetAngle(30.0);
  filter->SetRadiusEdgeRatio(1.5);
  EXPECT_TRUE(Has(ErrorOf(filter.GetPointer()), "RadiusEdgeRatio is 1.5"));
  filter->ForceOn();
  EXPECT_EQ(ErrorOf(filter.GetPointer()), "");
  filter->AddLabel(9);
  EXPECT_TRUE(Has(ErrorOf(filter.GetPointer()), "AddLabel()"));
  filter->RemoveAllLabels();

  const auto empty = Image::New();
  empty->SetRegions(Image::SizeType{ { 5, 5, 5 } });
  empty->Allocate(true);
  EXPECT_TRUE(Has(ErrorOf(MakeFilter(empty).GetPointer()), "no foreground"));
  const itk::SpacePrecisionType nowhere[3] = { std::nan(""), 0.0, 0.0 };
  image->SetOrigin(nowhere);
  EXPECT_TRUE(Has(ErrorOf(filter.GetPointer()), "origin"));

  const auto noise = itk::Image<short, 3>::New();
  noise->SetRegions(Image::SizeType{ { 5, 5, 5 } });
  noise->Allocate();
  noise->FillBuffer(-3);
  const auto bytes =
    itk::LabelImageToTetrahedralMeshFilter<itk::Image<short, 3>, MeshOf<unsigned char>>::New();
  bytes->SetInput(noise);
  EXPECT_TRUE(Has(ErrorOf(bytes.GetPointer()), "with vtkImageToTetMeshFilter. If it is a"));
  bytes->SetInput(MakeImage<short>());
  EXPECT_TRUE(Has(ErrorOf(bytes.GetPointer()), "The label 300 does not fit"));
}

TEST(LabelImageToTetrahedralMeshFilter, ObserversMayStopIt)
{
  const auto filter = MakeFilter(MakeImage());
  const auto here = std::this_thread::get_id();
  std::vector<float> fractions;
  bool stop = true;
  bool fail = false;
  int aborts = 0;
  Observe(filter, itk::AbortEvent(), [&aborts] { ++aborts; });
  Observe(filter, itk::ProgressEvent(),
    [&]
    {
      EXPECT_EQ(std::this_thread::get_id(), here);
      fractions.push_back(filter->GetProgress());
      filter->SetAbortGenerateData(stop);
      if (fail)
      {
        throw std::out_of_range("from the observer");
      }
    });
  EXPECT_THROW(filter->Update(), itk::ProcessAborted);
  EXPECT_EQ(aborts, 1);
  EXPECT_EQ(filter->GetOutput()->GetNumberOfCells(), 0u);
  EXPECT_LT(fractions.back(), 0.5f);

  stop = false;
  fail = true;
  EXPECT_THROW(filter->Update(), std::out_of_range);
  fail = false;
  fractions.clear();
  filter->Update();
  EXPECT_GT(filter->GetOutput()->GetNumberOfCells(), 100u);
  EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
  EXPECT_EQ(fractions.back(), 1.0f);
}

TEST(LabelImageToTetrahedralMeshFilter, WarnsOfWhatTheMeshLacks)
{
  const auto before = itk::OutputWindow::GetInstance();
  const auto warnings = Warnings::New();
  itk::OutputWindow::SetInstance(warnings);
  MakeFilter(MakeImage("plain", 10.0, 2.0), 6.0)->Update();
  itk::OutputWindow::SetInstance(before);
  EXPECT_TRUE(Has(warnings->Text, "for a Delta of 6")) << warnings->Text;
  EXPECT_TRUE(Has(warnings->Text, "7 (")) << warnings->Text;
}

TEST(LabelImageToTetrahedralMeshFilter, ParametersArriveAndHaveTheDefaultsOfTheTable)
{
  const auto defaults = Filter::New();
  const auto of = [](const char* name)
  {
    const auto& text = voxplex::FindParameter(name).Default;
    return text.empty() || text == "off" ? 0.0 : text == "on" ? 1.0 : std::stod(text);
  };
  EXPECT_EQ(defaults->GetDelta(), of("delta"));
  EXPECT_EQ(static_cast<double>(defaults->GetNumberOfElements()), of("elements"));
  EXPECT_EQ(defaults->GetRadiusEdgeRatio(), of("radius-edge"));
  EXPECT_EQ(defaults->GetFacetAngle(), of("facet-angle"));
  EXPECT_EQ(defaults->GetSmoothingSigma(), of("smoothing"));
  EXPECT_EQ(defaults->GetMinimumComponentVolume(), of("min-component-volume"));
  EXPECT_EQ(defaults->GetExactComponents(), of("exact-components"));
  EXPECT_EQ(defaults->GetOptimise(), of("optimise"));
  EXPECT_EQ(defaults->GetReproducible(), of("reproducible"));
  EXPECT_EQ(defaults->GetForce(), of("force"));

  const auto image = MakeImage("plain", 10.0, 1.5);
  const auto pointsWith = [&image](const std::function<void(Filter*)>& set)
  {
    const auto filter = MakeFilter(image, 4.0);
    set(filter);
    filter->Update();
    std::ostringstream points;
    for (const auto& point : filter->GetOutput()->GetPoints()->CastToSTLConstContainer())
    {
      points << point;
    }
    return points.str();
  };
  std::set<std::string> meshes{ pointsWith([](Filter*) {}) };
  EXPECT_TRUE(meshes.insert(pointsWith([](Filter* f) { f->SetDelta(0.0); })).second);
  EXPECT_TRUE(meshes
                .insert(pointsWith(
                  [](Filter* f)
                  {
                    f->SetDelta(0.0);
                    f->SetNumberOfElements(3000);
                  }))
                .second);
  EXPECT_TRUE(meshes.insert(pointsWith([](Filter* f) { f->SetRadiusEdgeRatio(1.95); })).second);
  EXPECT_TRUE(meshes.insert(pointsWith([](Filter* f) { f->SetFacetAngle(5.0); })).second);
  EXPECT_TRUE(meshes.insert(pointsWith([](Filter* f) { f->SetSmoothingSigma(0.0); })).second);
  EXPECT_TRUE(
    meshes.insert(pointsWith([](Filter* f) { f->SetMinimumComponentVolume(50.0); })).second);
  EXPECT_TRUE(meshes.insert(pointsWith([](Filter* f) { f->ExactComponentsOn(); })).second);
  EXPECT_TRUE(meshes.insert(pointsWith([](Filter* f) { f->OptimiseOff(); })).second);
  EXPECT_TRUE(meshes.insert(pointsWith([](Filter* f) { f->ReproducibleOn(); })).second);
  EXPECT_TRUE(meshes.insert(pointsWith([](Filter* f) { f->AddLabel(Outer); })).second);

  std::ostringstream printed;
  defaults->AddLabel(Inner);
  defaults->Print(printed);
  EXPECT_TRUE(Has(printed.str(), "FacetAngle: 30\n"));
  EXPECT_TRUE(Has(printed.str(), "Labels: 7\n"));
}
