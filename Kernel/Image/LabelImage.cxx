// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Image/LabelImage.h"

#include "Base/Error.h"
#include "Base/GridIndex.h"
#include "Image/LabelValue.h"
#include "Image/ScalarTypes.h"
#include "Parallel/ParallelFor.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <limits>
#include <memory>
#include <mutex>
#include <sstream>
#include <string>
#include <type_traits>
#include <utility>

namespace voxplex
{
namespace
{

/** Whether values of the type index a table. Values of other types use a hash table. */
template <typename T>
inline constexpr bool IsSmall = std::is_integral_v<T> && sizeof(T) <= 2;

/** No slot is this. */
constexpr LabelId NoSlot = std::numeric_limits<LabelId>::max();

/** Of labels that were not asked for so many are noted for messages, at least. */
constexpr std::size_t NotedOthers = 1000;

/** Slots of values of small types: a table with an entry for every value. */
template <typename T>
class SlotTable
{
public:
  SlotTable()
    : Slots(std::size_t{ 1 } << (8 * sizeof(T)), NoSlot)
  {
  }
  LabelId Find(T value) const { return this->Slots[Key(value)]; }
  void Insert(T value, LabelId slot) { this->Slots[Key(value)] = slot; }

private:
  static std::size_t Key(T value) { return static_cast<std::make_unsigned_t<T>>(value); }
  std::vector<LabelId> Slots;
};

/** Slots of labels of large types: a hash table with open addressing, which grows. */
template <typename T>
requires(!IsSmall<T>) class SlotTable<T>
{
public:
  LabelId Find(T value) const { return this->Entries[this->Position(value)].Slot; }
  /** The value must be new. */
  void Insert(T value, LabelId slot)
  {
    if (2 * ++this->Count > this->Entries.size())
    {
      std::vector<Entry> old(2 * this->Entries.size());
      old.swap(this->Entries);
      --this->Shift;
      for (const Entry& entry : old)
      {
        if (entry.Slot != NoSlot)
        {
          this->Entries[this->Position(entry.Value)] = entry;
        }
      }
    }
    this->Entries[this->Position(value)] = { value, slot };
  }

private:
  struct Entry
  {
    T Value{};
    LabelId Slot = NoSlot;
  };

  std::size_t Position(T value) const
  {
    const auto key = static_cast<std::uint64_t>(value);
    std::size_t at = (key * 0x9e3779b97f4a7c15u) >> this->Shift;
    while (this->Entries[at].Slot != NoSlot && this->Entries[at].Value != value)
    {
      at = (at + 1) % this->Entries.size();
    }
    return at;
  }
  unsigned Shift = 54; ///< 64 - log2 of the number of entries
  std::vector<Entry> Entries{ std::size_t{ 1 } << 10 };
  std::size_t Count = 0;
};

/** The number of rows that a thread reads at once. */
std::size_t RowsAtOnce(std::size_t rowLength)
{
  return std::max<std::size_t>(1, (std::size_t{ 1 } << 18) / rowLength);
}

/** The labels in the rows that one thread reads. */
template <int D>
struct Census
{
  std::vector<std::int64_t> Values; ///< of each slot
  std::vector<std::int64_t> Counts;
  std::vector<char> Kept;
  std::array<std::int64_t, static_cast<std::size_t>(D)> Min;
  std::array<std::int64_t, static_cast<std::size_t>(D)> Max;

  Census()
  {
    this->Min.fill(std::numeric_limits<std::int64_t>::max());
    this->Max.fill(-1);
  }
};

template <typename Array>
std::string Format(const Array& values, const char* separator = ", ")
{
  std::ostringstream s;
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    s << (i ? separator : "") << values[i];
  }
  return s.str();
}

/** What is wrong with a value, and what to do about it if the image is a segmentation. */
template <typename T>
std::pair<const char*, const char*> Diagnose(T value)
{
  if constexpr (std::is_floating_point_v<T>)
  {
    if (!std::isfinite(value))
    {
      return { "is not finite", "set such voxels to 0" };
    }
    if (std::floor(value) != value)
    {
      return { "is not whole", "resample it without interpolation (nearest neighbour)" };
    }
  }
  const bool isNegative = std::is_signed_v<T> && !(value > T(0));
  if (isNegative)
  {
    return { "is negative",
      "choose the labels to mesh with {labels}, if some are above 0, or change its numbers so that "
      "the background is 0 and labels are above" };
  }
  return { "exceeds the largest label, 9223372036854775807",
    "choose the labels to mesh with {labels}, or set such voxels to 0" };
}

template <typename T, int D>
[[noreturn]] void ThrowBadValue(T value, std::size_t voxel, const GridGeometry<D>& grid)
{
  const auto [wrong, remedy] = Diagnose(NearestLabel(value));
  std::ostringstream s;
  s.precision(std::numeric_limits<T>::max_digits10);
  s << "The value " << +value << " at index (" << Format(IndexAt(voxel, grid.Dimensions)) << ") "
    << wrong
    << "; labels are whole numbers from 0 (background). If these are grey values, as those of a "
       "CT, segment the image first, or mesh an isosurface of it with {isosurface}. If it is a "
       "segmentation, "
    << remedy << ".";
  throw InputError(s.str());
}

[[noreturn]] void ThrowTooManyLabels(std::size_t voxels)
{
  throw InputError("The image has more than " + std::to_string(MaximumNumberOfLabels(voxels)) +
    " distinct labels, of less than 8 voxels on average; it is most likely a grey-value image. "
    "Segment it first, or mesh an isosurface of it with {isosurface}{array:, or choose the array "
    "that "
    "holds the segmentation}, or choose the labels to mesh with {labels}.");
}

/** A LabelSelection that can be asked quickly. */
class Choice
{
public:
  explicit Choice(const LabelSelection& selection)
    : Only(SortedOnce(selection.Only))
    , But(SortedOnce(selection.But))
  {
  }

  template <typename T>
  bool Keeps(T value) const
  {
    const auto label = static_cast<std::int64_t>(value);
    return label != 0 &&
      (this->Only.empty() || std::binary_search(this->Only.begin(), this->Only.end(), label)) &&
      !std::binary_search(this->But.begin(), this->But.end(), label);
  }

  /** Whether only labels that were asked for count. */
  bool IsNarrow() const { return !this->Only.empty(); }

  /** Whether a label must be noted: it is kept or excluded, or all labels count. */
  template <typename T>
  bool Counts(T value) const
  {
    const auto label = static_cast<std::int64_t>(value);
    return this->Only.empty() || std::binary_search(this->Only.begin(), this->Only.end(), label) ||
      std::binary_search(this->But.begin(), this->But.end(), label);
  }

  const std::vector<std::int64_t> Only;
  const std::vector<std::int64_t> But;

private:
  static std::vector<std::int64_t> SortedOnce(std::vector<std::int64_t> values)
  {
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end()), values.end());
    return values;
  }
};

/** The first 20, and how many there are. */
std::string Some(const std::vector<std::int64_t>& labels)
{
  const std::vector<std::int64_t> shown(
    labels.begin(), labels.begin() + std::min<std::ptrdiff_t>(20, std::ssize(labels)));
  return Format(shown) +
    (labels.size() > shown.size() ? ", ... (" + std::to_string(labels.size()) + " in all)" : "");
}

/**
 * Throws if a selected label is 0, or does not occur.
 * @param occurring the labels of the image, in increasing order
 */
void CheckSelected(const std::vector<std::int64_t>& selected,
  const std::vector<std::int64_t>& occurring, const std::string& was, const std::string& purpose)
{
  std::vector<std::int64_t> missing;
  for (const std::int64_t value : selected)
  {
    if (value == 0)
    {
      throw InputError("Label 0 was " + was +
        ", but 0 is background, which is never meshed; remove it from " + purpose + ".");
    }
    if (!std::binary_search(occurring.begin(), occurring.end(), value))
    {
      missing.push_back(value);
    }
  }
  if (!missing.empty())
  {
    throw InputError(
      (missing.size() == 1 ? "Label " + Some(missing) + " was " + was + ", but does"
                           : "Labels " + Some(missing) + " were " + was + ", but do") +
      " not occur in the image; its labels are " + Some(occurring) + ". Correct " + purpose + ".");
  }
}

/**
 * @brief The first pass: counts the voxels of each value, and finds the bounding box of the labels
 * to mesh. Rows are read run by run, since segmentations consist of long runs.
 */
template <typename T, int D>
class CensusTaker
{
public:
  CensusTaker(std::span<const T> scalars, const GridGeometry<D>& grid, const Choice& choice)
    : Scalars(scalars)
    , Grid(grid)
    , RowLength(static_cast<std::size_t>(grid.Dimensions[0]))
    , Labels(choice)
    , MostSlots(MaximumNumberOfLabels(scalars.size()) + 2) // background, and one more
    , FirstBad(scalars.size())
  {
  }

  /** @throws InputError if a value is not a label, or there are too many */
  std::vector<Census<D>> Run(unsigned threads, const std::stop_token& stop)
  {
    std::vector<std::unique_ptr<TypedCensus>> all; // those that no chunk uses now are in `idle`
    std::vector<TypedCensus*> idle;
    std::mutex mutex;
    ParallelFor(
      0, this->Scalars.size() / this->RowLength, RowsAtOnce(this->RowLength), threads,
      [&](std::size_t begin, std::size_t end)
      {
        TypedCensus* census = nullptr;
        {
          const std::scoped_lock lock(mutex);
          if (idle.empty())
          {
            all.push_back(std::make_unique<TypedCensus>());
            idle.push_back(all.back().get());
          }
          census = idle.back();
          idle.pop_back();
        }
        for (std::size_t row = begin; row < end && !this->TooMany.load(std::memory_order_relaxed);
             ++row)
        {
          this->ReadRow(*census, row);
        }
        const std::scoped_lock lock(mutex);
        idle.push_back(census);
      },
      stop);
    if (this->FirstBad != this->Scalars.size())
    {
      ThrowBadValue<T, D>(this->Scalars[this->FirstBad], this->FirstBad, this->Grid);
    }
    if (this->TooMany)
    {
      ThrowTooManyLabels(this->Scalars.size());
    }
    std::vector<Census<D>> censuses;
    for (const auto& census : all)
    {
      censuses.push_back(std::move(*census));
    }
    return censuses;
  }

private:
  struct TypedCensus : Census<D>
  {
    SlotTable<T> Slots;
  };

  void ReadRow(TypedCensus& census, std::size_t row)
  {
    const std::size_t n = this->RowLength;
    const T* values = this->Scalars.data() + row * n;
    auto index = IndexAt(row * n, this->Grid.Dimensions);
    for (std::size_t i = 0; i < n;)
    {
      std::size_t end = i + 1;
      while (end < n && values[end] == values[i])
      {
        ++end;
      }
      const T value = NearestLabel(values[i]);
      if (!IsLabel(value) && !(this->Labels.IsNarrow() && IsWhole(value)))
      {
        std::size_t bad = this->FirstBad.load(std::memory_order_relaxed);
        while (row * n + i < bad && !this->FirstBad.compare_exchange_weak(bad, row * n + i))
        {
        }
        return;
      }
      const LabelId slot = this->SlotOf(census, value);
      if (slot != NoSlot)
      {
        census.Counts[slot] += static_cast<std::int64_t>(end - i);
      }
      if (slot != NoSlot && census.Kept[slot])
      {
        index[0] = static_cast<std::int64_t>(i);
        for (std::size_t a = 0; a < D; ++a)
        {
          census.Min[a] = std::min(census.Min[a], index[a]);
          census.Max[a] = std::max(census.Max[a], index[a]);
        }
        census.Max[0] = std::max(census.Max[0], static_cast<std::int64_t>(end) - 1);
      }
      i = end;
    }
  }

  /** None if the value is none of the labels that were asked for, or if there are too many. */
  LabelId SlotOf(TypedCensus& census, T value)
  {
    if (!IsLabel(value))
    {
      return NoSlot;
    }
    LabelId slot = census.Slots.Find(value);
    if (slot != NoSlot)
    {
      return slot;
    }
    if (census.Values.size() >= NotedOthers && !this->Labels.Counts(value))
    {
      return slot;
    }
    if (census.Values.size() == this->MostSlots)
    {
      this->TooMany.store(true, std::memory_order_relaxed);
      return slot;
    }
    slot = static_cast<LabelId>(census.Values.size());
    census.Slots.Insert(value, slot);
    census.Values.push_back(static_cast<std::int64_t>(value));
    census.Counts.push_back(0);
    census.Kept.push_back(this->Labels.Keeps(value) ? 1 : 0);
    return slot;
  }

  const std::span<const T> Scalars;
  const GridGeometry<D>& Grid;
  const std::size_t RowLength;
  const Choice& Labels;
  const std::size_t MostSlots;
  std::atomic<std::size_t> FirstBad; ///< the first voxel without a label, or the number of voxels
  std::atomic<bool> TooMany{ false };
};

/**
 * The labels to mesh, in increasing order after background, from the censuses of all threads.
 * @throws InputError as FromScalars()
 */
template <int D>
Census<D> Join(
  const std::vector<Census<D>>& censuses, const Choice& choice, std::size_t numberOfVoxels)
{
  Census<D> labels;
  std::vector<std::pair<std::int64_t, std::int64_t>> all;
  for (const Census<D>& census : censuses)
  {
    for (std::size_t s = 0; s < census.Values.size(); ++s)
    {
      all.emplace_back(census.Values[s], census.Counts[s]);
    }
    for (std::size_t a = 0; a < D; ++a)
    {
      labels.Min[a] = std::min(labels.Min[a], census.Min[a]);
      labels.Max[a] = std::max(labels.Max[a], census.Max[a]);
    }
  }
  std::sort(all.begin(), all.end());
  std::vector<std::int64_t> occurring;
  labels.Values.push_back(0);
  labels.Counts.push_back(0);
  for (std::size_t i = 0; i < all.size();)
  {
    const std::int64_t value = all[i].first;
    std::int64_t count = 0;
    for (; i < all.size() && all[i].first == value; ++i)
    {
      count += all[i].second;
    }
    if (value != 0)
    {
      occurring.push_back(value);
    }
    const bool kept = choice.Keeps(value);
    if (kept && labels.Values.size() > MaximumNumberOfLabels(numberOfVoxels))
    {
      ThrowTooManyLabels(numberOfVoxels);
    }
    if (kept)
    {
      labels.Values.push_back(value);
      labels.Counts.push_back(count);
    }
  }
  CheckSelected(choice.Only, occurring, "asked for", "{labels}, the labels to keep");
  CheckSelected(choice.But, occurring, "excluded", "the labels to exclude");
  if (labels.Values.size() == 1)
  {
    if (!occurring.empty())
    {
      throw InputError("All labels of the image are excluded; correct the labels to exclude.");
    }
    throw InputError("The image has no foreground: all " + std::to_string(numberOfVoxels) +
      " voxels are 0.{array: Choose the array that holds the segmentation.}");
  }
  return labels;
}

/** The sixth powers of lengths are numbers. */
constexpr double SmallestSpacing = 1e-45;
constexpr double LargestSpacing = 1e45;

} // namespace

template <int D>
void CheckGrid(const GridGeometry<D>& grid, std::size_t scalars)
{
  std::size_t voxels = 1;
  for (std::size_t a = 0; a < D; ++a)
  {
    const std::int64_t n = grid.Dimensions[a];
    if (n < 2)
    {
      throw InputError("The image has " + std::to_string(n) + " voxel(s) along axis " +
        std::to_string(a) + " (dimensions " + Format(grid.Dimensions, " x ") + "); a " +
        std::to_string(D) + "D mesh needs at least two along each axis.");
    }
    if (voxels > std::numeric_limits<std::size_t>::max() / 16 / static_cast<std::size_t>(n))
    {
      throw InputError("The image's dimensions " + Format(grid.Dimensions, " x ") +
        " are too large to be addressed; crop or resample it.");
    }
    voxels *= static_cast<std::size_t>(n);
  }
  if (voxels != scalars)
  {
    throw InputError("The image has " + std::to_string(scalars) + " scalars, but its dimensions " +
      Format(grid.Dimensions, " x ") + " ask for " + std::to_string(voxels) +
      "; pass exactly one value per voxel.");
  }
  for (std::size_t r = 0; r < D; ++r)
  {
    for (std::size_t c = 0; c < D; ++c)
    {
      const double v = grid.IndexToFrame[r][c];
      const bool good = r == c ? v >= SmallestSpacing && v <= LargestSpacing
        : r < c                ? std::isfinite(v)
                               : v == 0.0;
      if (good)
      {
        continue;
      }
      std::ostringstream s;
      if (r == c)
      {
        s << "The spacing along axis " << r << " is " << v << "; it must be positive, from "
          << SmallestSpacing << " to " << LargestSpacing
          << ". Correct the image's spacing, or take another unit.";
      }
      else
      {
        s << "Element (" << r << ", " << c << ") of the index-to-frame matrix is " << v
          << "; the matrix must be finite and upper triangular. Correct the image's axes.";
      }
      throw InputError(s.str());
    }
  }
}

template <int D>
template <typename T>
LabelImage<D> LabelImage<D>::FromScalars(std::span<const T> scalars, const GridGeometry<D>& grid,
  const LabelSelection& selection, unsigned threads, const std::stop_token& stop)
{
  CheckGrid(grid, scalars.size());
  const Choice choice(selection);
  const auto censuses = CensusTaker<T, D>(scalars, grid, choice).Run(threads, stop);

  LabelImage image;
  image.WholeGrid = grid;
  const Census<D> labels = Join(censuses, choice, scalars.size());
  image.LabelValues = labels.Values;
  image.LabelCounts = labels.Counts;
  SlotTable<T> ids;
  for (std::size_t id = 1; id < labels.Values.size(); ++id)
  {
    ids.Insert(static_cast<T>(labels.Values[id]), static_cast<LabelId>(id));
  }
  const Index& min = labels.Min;
  const Index& max = labels.Max;

  // Second pass: writes the dense ids of the bounding box.
  image.Origin = min;
  for (std::size_t a = 0; a < D; ++a)
  {
    image.Extent[a] = max[a] - min[a] + 1;
  }
  if constexpr (D == 4)
  {
    const auto& m = grid.IndexToFrame;
    const bool upright = m[0][3] == 0.0 && m[1][3] == 0.0 && m[2][3] == 0.0;
    image.CutInTime = { upright && min[3] == 0, upright && max[3] == grid.Dimensions[3] - 1 };
  }
  const auto e0 = static_cast<std::size_t>(image.Extent[0]);
  image.Voxels.resize(CountCells(image.Extent));
  ParallelFor(
    0, image.Voxels.size() / e0, RowsAtOnce(e0), threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t row = begin; row < end; ++row)
      {
        const Index at = IndexAt(row * e0, image.Extent);
        Index from;
        for (std::size_t a = 0; a < D; ++a)
        {
          from[a] = at[a] + min[a];
        }
        const T* in = scalars.data() + OffsetOf(from, grid.Dimensions);
        LabelId* out = image.Voxels.data() + row * e0;
        for (std::size_t i = 0; i < e0;)
        {
          const T value = in[i];
          const T label = NearestLabel(value);
          const LabelId slot = IsLabel(label) ? ids.Find(label) : NoSlot;
          const LabelId id = slot != NoSlot ? slot : LabelId{ 0 };
          do
          {
            out[i++] = id;
          } while (i < e0 && in[i] == value);
        }
      }
    },
    stop);
  image.LabelCounts[0] = static_cast<std::int64_t>(image.Voxels.size());
  for (std::size_t id = 1; id < image.LabelCounts.size(); ++id)
  {
    image.LabelCounts[0] -= image.LabelCounts[id];
  }
  return image;
}

template <int D>
LabelImage<D> LabelImage<D>::WithFrames(const GridGeometry<D>& grid, const Index& origin,
  const Index& extent, UninitialisedVector<LabelId> ids) const
{
  LabelImage image;
  image.WholeGrid = grid;
  image.Origin = origin;
  image.Extent = extent;
  image.Voxels = std::move(ids);
  image.LabelValues = this->LabelValues;
  image.LabelCounts.assign(this->LabelCounts.size(), 0);
  for (const LabelId id : image.Voxels)
  {
    ++image.LabelCounts[id];
  }
  image.CutInTime = this->CutInTime;
  image.Periodic = this->Periodic;
  return image;
}

//------------------------------------------------------------------------------------------------
template <int D>
void LabelImage<D>::MakePeriodicInTime()
{
  const std::int64_t frames = this->WholeGrid.Dimensions[D - 1];
  Index box = this->Extent;
  box[D - 1] = 1;
  std::int64_t differ = 0;
  Index example{};
  for (std::size_t k = 0; k < CountCells(box); ++k)
  {
    Index first = IndexAt(k, box);
    Index last = first;
    first[D - 1] = -this->Origin[D - 1];
    last[D - 1] = frames - 1 - this->Origin[D - 1];
    if (this->At(first) != this->At(last))
    {
      example = differ++ == 0 ? first : example;
    }
  }
  if (differ > 0)
  {
    std::string voxel;
    for (std::size_t a = 0; a + 1 < D; ++a)
    {
      voxel += (a == 0 ? "" : ", ") + std::to_string(this->Origin[a] + example[a]);
    }
    throw InputError(
      "a periodic mesh needs a last frame that is equal to the first one; they differ in " +
      std::to_string(differ) + " voxels, one of which is (" + voxel +
      "); if the series ends one frame before the period does, append its first frame");
  }
  this->Periodic = true;
}

//------------------------------------------------------------------------------------------------
template <int D>
void LabelImage<D>::Relabel(const Index& first, std::int64_t length, LabelId label)
{
  LabelId* const run = this->Voxels.data() + OffsetOf(first, this->Extent);
  for (std::int64_t i = 0; i < length; ++i)
  {
    LabelId& id = run[i];
    --this->LabelCounts[id];
    ++this->LabelCounts[label];
    id = label;
  }
}

template class LabelImage<3>;
template class LabelImage<4>;
template void CheckGrid<3>(const GridGeometry<3>&, std::size_t);
template void CheckGrid<4>(const GridGeometry<4>&, std::size_t);

#define VOXPLEX_INSTANTIATE(T)                                                                     \
  template LabelImage<3> LabelImage<3>::FromScalars<T>(std::span<const T>, const GridGeometry<3>&, \
    const LabelSelection&, unsigned, const std::stop_token&);                                      \
  template LabelImage<4> LabelImage<4>::FromScalars<T>(std::span<const T>, const GridGeometry<4>&, \
    const LabelSelection&, unsigned, const std::stop_token&)
VOXPLEX_FOR_EACH_SCALAR_TYPE(VOXPLEX_INSTANTIATE);
#undef VOXPLEX_INSTANTIATE

} // namespace voxplex
