// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ScalarImage.h
 * @brief A 3D or 4D image as a file or a vtkImageData has it, without VTK.
 */
#ifndef voxplex_ScalarImage_h
#define voxplex_ScalarImage_h

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace voxplex
{

enum class ScalarType
{
  Int8,
  UInt8,
  Int16,
  UInt16,
  Int32,
  UInt32,
  Int64,
  UInt64,
  Float32,
  Float64
};

/** The type of integers of 1, 2, 4 or 8 bytes; empty for other sizes. */
constexpr std::optional<ScalarType> IntegerType(std::size_t bytes, bool isSigned)
{
  using enum ScalarType;
  constexpr std::array types{ Int8, UInt8, Int16, UInt16, Int32, UInt32, Int64, UInt64 };
  for (std::size_t i = 0; i < types.size(); ++i)
  {
    if (bytes == std::size_t{ 1 } << i / 2 && isSigned == (i % 2 == 0))
    {
      return types[i];
    }
  }
  return std::nullopt;
}

/** Calls function with a 0 of the type. */
template <typename TFunction>
constexpr auto Dispatch(ScalarType type, TFunction&& function)
{
  switch (type)
  {
    case ScalarType::Int8:
      return function(std::int8_t());
    case ScalarType::UInt8:
      return function(std::uint8_t());
    case ScalarType::Int16:
      return function(std::int16_t());
    case ScalarType::UInt16:
      return function(std::uint16_t());
    case ScalarType::Int32:
      return function(std::int32_t());
    case ScalarType::UInt32:
      return function(std::uint32_t());
    case ScalarType::Int64:
      return function(std::int64_t());
    case ScalarType::UInt64:
      return function(std::uint64_t());
    case ScalarType::Float32:
      return function(float());
    default:
      return function(double());
  }
}

/** Of each type, in their order: its names, between bars. */
using TypeNames = std::array<std::string_view, 10>;

/** Empty for other names. */
inline std::optional<ScalarType> FindType(std::string_view name, const TypeNames& names)
{
  const std::string key = "|" + std::string(name) + "|";
  const bool isName = !name.empty() && name.find('|') == name.npos;
  const auto type = std::find_if(
    names.begin(), names.end(), [&](std::string_view all) { return all.find(key) != all.npos; });
  return isName && type != names.end()
    ? std::optional(static_cast<ScalarType>(type - names.begin()))
    : std::nullopt;
}

constexpr std::size_t SizeOf(ScalarType type)
{
  return Dispatch(type, [](auto zero) { return sizeof zero; });
}

/** Whether a scalar type has this very number. */
template <typename T>
bool Holds(std::int64_t label)
{
  if constexpr (std::is_floating_point_v<T>)
  {
    return label <= std::int64_t{ 1 } << std::numeric_limits<T>::digits;
  }
  else
  {
    return std::in_range<T>(label);
  }
}

/**
 * One scalar a voxel and frame, first axis fastest, time slowest. Voxel (i, j, k) lies at Origin +
 * Direction * (Spacing * ijk); frame n at TimeOrigin + n * TimeSpacing, or if there are Times at the n-th of them.
 */
struct ScalarImage
{
  ScalarType Type = ScalarType::UInt8;
  std::array<int, 3> Dimensions{};
  std::array<double, 3> Origin{};
  std::array<double, 3> Spacing{};
  std::array<double, 9> Direction{}; ///< row-major; column j is the direction of axis j, LPS

  // What masks that are joined must know. Others are placed anyway.
  bool HasPlace =
    true; ///< whether the file says where it lies: else origin and direction are a guess
  bool HasSpacing = true; ///< the same of the spacing
  std::string Unit;       ///< of lengths; empty: millimetres

  int Frames = 1; ///< 1: a 3D image
  double TimeOrigin = 0.0;
  double TimeSpacing = 1.0;  ///< positive
  std::vector<double> Times; ///< increasing; empty if frames are equally spaced

  std::shared_ptr<void> Scalars; ///< keeps the reader's own buffer alive
  int Dimension() const { return this->Frames > 1 ? 4 : 3; }
  double TimeOf(int frame) const
  {
    return this->Times.empty() ? this->TimeOrigin + frame * this->TimeSpacing
                               : this->Times[static_cast<std::size_t>(frame)];
  }
  /** Of one frame. */
  std::size_t NumberOfVoxels() const
  {
    return static_cast<std::size_t>(this->Dimensions[0]) *
      static_cast<std::size_t>(this->Dimensions[1]) * static_cast<std::size_t>(this->Dimensions[2]);
  }
};

/** Gives memory for so many bytes of voxels, in which nothing is set. */
using VoxelAllocator = std::function<std::shared_ptr<void>(std::size_t bytes)>;

/** The heap's. */
inline std::shared_ptr<void> AllocateVoxels(std::size_t bytes)
{
  const std::shared_ptr<std::byte[]> memory(new std::byte[bytes]);
  return { memory, memory.get() };
}

} // namespace voxplex

#endif
