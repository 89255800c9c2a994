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
  Dispatch(image.Type, [&](auto zero) { KeepSeen<decltype(zero)>(image, table); });
}

} // namespace voxplex::io
