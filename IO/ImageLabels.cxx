// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "ImageLabels.h"

#include <limits>
#include <type_traits>
#include <unordered_map>
#include <utility>

namespace voxplex::io
{
namespace
{

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

/** Keyed by the scalars' own type: comparing values of different types could take one for another. */
template <typename T>
void KeepSeen(const ScalarImage& image, LabelTable& table)
{
  std::unordered_map<T, std::int64_t> unseen;
  for (const auto& [label, entry] : table.Entries)
  {
    if (Holds<T>(label))
    {
      unseen.emplace(static_cast<T>(label), label);
    }
  }
  LabelTable seen;
  const T* const scalars = static_cast<const T*>(image.Scalars.get());
  const std::size_t count = image.NumberOfVoxels() * static_cast<std::size_t>(image.Frames);
  T last = 0; // the background, and then the previous voxel: they come in runs
  for (std::size_t i = 0; i < count && !unseen.empty(); ++i)
  {
    if (scalars[i] != last)
    {
      last = scalars[i];
      const auto found = unseen.find(last);
      if (found != unseen.end())
      {
        seen.Entries.insert(table.Entries.extract(found->second));
        unseen.erase(found);
      }
    }
  }
  table = std::move(seen);
}

} // namespace

void KeepLabelsOf(const ScalarImage& image, LabelTable& table)
{
  switch (image.Type)
  {
    case ScalarType::Int8:
      return KeepSeen<std::int8_t>(image, table);
    case ScalarType::UInt8:
      return KeepSeen<std::uint8_t>(image, table);
    case ScalarType::Int16:
      return KeepSeen<std::int16_t>(image, table);
    case ScalarType::UInt16:
      return KeepSeen<std::uint16_t>(image, table);
    case ScalarType::Int32:
      return KeepSeen<std::int32_t>(image, table);
    case ScalarType::UInt32:
      return KeepSeen<std::uint32_t>(image, table);
    case ScalarType::Int64:
      return KeepSeen<std::int64_t>(image, table);
    case ScalarType::UInt64:
      return KeepSeen<std::uint64_t>(image, table);
    case ScalarType::Float32:
      return KeepSeen<float>(image, table);
    case ScalarType::Float64:
      return KeepSeen<double>(image, table);
  }
}

} // namespace voxplex::io
