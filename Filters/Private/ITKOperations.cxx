// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Private/ITKOperations.h"

#include <itkBinaryImageToLabelMapFilter.h>
#include <itkImage.h>
#include <itkLabelMap.h>
#include <itkLabelObject.h>
#include <itkSignedMaurerDistanceMapImageFilter.h>

#include <algorithm>
#include <limits>

namespace voxplex
{

namespace
{

/** An image of ITK of these voxels, which are not copied. ITK does not write to inputs. */
template <typename T>
typename itk::Image<T, 3>::Pointer View(
  std::span<const T> voxels, const VoxelIndex& dimensions, const Point<3>& spacing)
{
  using Image = itk::Image<T, 3>;
  typename Image::SizeType size;
  for (unsigned a = 0; a < 3; ++a)
  {
    size[a] = static_cast<itk::SizeValueType>(dimensions[a]);
  }
  const auto image = Image::New();
  image->SetRegions(typename Image::RegionType(size));
  image->SetSpacing(spacing.data());
  image->GetPixelContainer()->SetImportPointer(const_cast<T*>(voxels.data()), voxels.size(), false);
  return image;
}

} // namespace

template <typename T>
std::vector<Piece> FindPieces(std::span<const T> voxels, const VoxelIndex& dimensions, T value,
  bool corners, std::int64_t largest)
{
  using Map = itk::LabelMap<itk::LabelObject<itk::SizeValueType, 3>>;
  const auto filter = itk::BinaryImageToLabelMapFilter<itk::Image<T, 3>, Map>::New();
  filter->SetInput(View(voxels, dimensions, { 1.0, 1.0, 1.0 }));
  filter->SetInputForegroundValue(value);
  // Objects get the first numbers but this one: there must be enough for noise.
  filter->SetOutputBackgroundValue(std::numeric_limits<itk::SizeValueType>::max());
  filter->SetFullyConnected(corners);
  filter->Update();

  std::vector<Piece> pieces;
  for (typename Map::ConstIterator i(filter->GetOutput()); !i.IsAtEnd(); ++i)
  {
    const auto* const object = i.GetLabelObject();
    if (static_cast<std::int64_t>(object->Size()) > largest)
    {
      continue;
    }
    Piece piece;
    piece.First = dimensions;
    for (itk::SizeValueType l = 0; l < object->GetNumberOfLines(); ++l)
    {
      const auto& line = object->GetLine(l);
      const auto& index = line.GetIndex();
      const Piece::Run run{ { index[0], index[1], index[2] },
        static_cast<std::int64_t>(line.GetLength()) };
      for (std::size_t a = 0; a < 3; ++a)
      {
        piece.First[a] = std::min(piece.First[a], run.First[a]);
        piece.Last[a] = std::max(piece.Last[a], run.First[a] + (a == 0 ? run.Length - 1 : 0));
      }
      piece.Voxels += run.Length;
      piece.Runs.push_back(run);
    }
    pieces.push_back(std::move(piece));
  }
  return pieces;
}

std::vector<float> DistancesToSites(
  std::span<const unsigned char> sites, const VoxelIndex& dimensions, const Point<3>& spacing)
{
  using Distances = itk::Image<float, 3>;
  const auto filter =
    itk::SignedMaurerDistanceMapImageFilter<itk::Image<unsigned char, 3>, Distances>::New();
  filter->SetInput(View(sites, dimensions, spacing));
  filter->SetBackgroundValue(0);
  filter->SetSquaredDistance(false);
  filter->SetUseImageSpacing(true);
  filter->SetInsideIsPositive(false);
  filter->Update();
  const float* const first = filter->GetOutput()->GetBufferPointer();
  std::vector<float> distances(first, first + sites.size());
  std::transform(distances.begin(), distances.end(), distances.begin(),
    [](float distance) { return std::max(distance, 0.0f); }); // sites have negative ones
  return distances;
}

template std::vector<Piece> FindPieces<LabelId>(
  std::span<const LabelId>, const VoxelIndex&, LabelId, bool, std::int64_t);
template std::vector<Piece> FindPieces<unsigned char>(
  std::span<const unsigned char>, const VoxelIndex&, unsigned char, bool, std::int64_t);

} // namespace voxplex
