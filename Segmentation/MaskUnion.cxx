// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "MaskUnion.h"

#include "Refuse.h"
#include "ShownText.h"

#include <algorithm>
#include <limits>

namespace voxplex
{

MaskUnion::MaskUnion(const ScalarImage& grid, const VoxelAllocator& allocate, std::string word)
  : Image(grid)
  , Word(std::move(word))
{
  this->Image.Type = ScalarType::UInt16;
  this->Image.Frames = 1;
  const std::size_t count = this->Image.NumberOfVoxels();
  this->Image.Scalars = allocate(count * sizeof(Set));
  std::fill_n(static_cast<Set*>(this->Image.Scalars.get()), count, Set{ 0 });
}

std::uint32_t MaskUnion::AddName(std::string name, std::uint16_t label)
{
  this->Names.push_back(std::move(name));
  const auto number = static_cast<std::uint32_t>(this->Names.size());
  this->Labels.push_back(label > 0 ? label : static_cast<Set>(number));
  return number;
}

std::span<MaskUnion::Set> MaskUnion::AllSets() const
{
  return { static_cast<Set*>(this->Image.Scalars.get()), this->Image.NumberOfVoxels() };
}

/** The set that has this mask, too. */
MaskUnion::Set MaskUnion::With(Set set, std::uint32_t number)
{
  const auto [successor, isNew] = this->Successors.try_emplace({ set, number });
  if (isNew)
  {
    constexpr std::size_t most = std::numeric_limits<Set>::max();
    RefuseIf(this->Members.size() > most || number > most, "there are more than ", most, ' ',
      this->Word, ", or different overlaps of them");
    successor->second = static_cast<Set>(this->Members.size());
    std::vector<std::uint32_t> members = this->Members[set];
    members.push_back(number);
    this->Members.push_back(std::move(members));
  }
  return successor->second;
}

template <typename T, typename TNumberOf>
void MaskUnion::Add(std::span<Set> to, const T* voxels, TNumberOf&& numberOf)
{
  Set last = 0; // voxels come in runs
  Set successor = 0;
  std::uint32_t lastNumber = 0;
  for (Set& set : to)
  {
    const std::uint32_t number = numberOf(*voxels++);
    if (number == 0)
    {
      continue;
    }
    if (set != last || number != lastNumber)
    {
      last = set;
      lastNumber = number;
      successor = this->With(set, number);
    }
    set = successor;
  }
}

void MaskUnion::AddMask(const ScalarImage& mask, double threshold)
{
  const auto number = static_cast<std::uint32_t>(this->Names.size());
  bool hasSeveral = false;
  Dispatch(mask.Type,
    [&](auto zero)
    {
      using T = decltype(zero);
      T inside = 0;
      this->Add(this->AllSets(), static_cast<const T*>(mask.Scalars.get()),
        [&](T voxel)
        {
          if constexpr (std::is_floating_point_v<T>)
          {
            constexpr T rounding = T(1e-3);
            if (!(voxel >= -rounding && voxel <= 1 + rounding))
            {
              Refuse("it has the value ", voxel,
                ", and the real numbers of a mask are probabilities from 0 to 1: save it with "
                "whole numbers");
            }
          }
          else if (voxel != 0)
          {
            hasSeveral = hasSeveral || (inside != 0 && voxel != inside);
            inside = voxel;
          }
          return IsInside(voxel, threshold) ? number : 0;
        });
    });
  if (hasSeveral)
  {
    this->WithSeveralValues.push_back(number);
  }
}

void MaskUnion::AddSlice(
  const std::vector<std::uint8_t>& voxels, std::size_t slice, std::uint32_t number)
{
  this->Add(this->AllSets().subspan(slice * voxels.size(), voxels.size()), voxels.data(),
    [number](std::uint8_t voxel) { return voxel != 0 ? number : 0; });
}

void MaskUnion::AddLayer(const ScalarImage& image, int frame,
  const std::unordered_map<std::int64_t, std::uint32_t>& numbers)
{
  Dispatch(image.Type,
    [&](auto zero)
    {
      using T = decltype(zero);
      std::unordered_map<T, std::uint32_t>
        own; // by the type of the voxels: others could be taken for one
      for (const auto& [value, number] : numbers)
      {
        if (Holds<T>(value))
        {
          own.emplace(static_cast<T>(value), number);
        }
      }
      T last = 0;
      std::uint32_t number = 0;
      this->Add(this->AllSets(),
        static_cast<const T*>(image.Scalars.get()) +
          image.NumberOfVoxels() * static_cast<std::size_t>(frame),
        [&](T voxel)
        {
          if (voxel != last)
          {
            last = voxel;
            const auto found = own.find(voxel);
            number = found == own.end() ? 0 : found->second;
          }
          return number;
        });
    });
}

/** The sum, and the pairs that share most. */
void MaskUnion::WarnOfOverlaps(
  Overlap rule, const Counts& voxels, std::vector<std::string>& warnings) const
{
  using Pair = std::pair<std::uint32_t, std::uint32_t>;
  std::map<Pair, std::uint64_t> shared;
  std::uint64_t sum = 0;
  for (std::size_t set = 0; set < this->Members.size(); ++set)
  {
    const std::vector<std::uint32_t>& members = this->Members[set];
    sum += members.size() > 1 ? voxels[set] : 0;
    for (std::size_t i = 0; i < members.size() && voxels[set] > 0; ++i)
    {
      for (std::size_t j = i + 1; j < members.size(); ++j)
      {
        shared[{ members[i], members[j] }] += voxels[set];
      }
    }
  }
  if (sum == 0)
  {
    return;
  }
  std::vector<std::pair<Pair, std::uint64_t>> pairs(shared.begin(), shared.end());
  std::stable_sort(
    pairs.begin(), pairs.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
  constexpr std::size_t most = 5;
  std::string text = this->Word + " overlap in " + std::to_string(sum) + " voxels, which the " +
    (rule == Overlap::Smallest ? "smallest" : "first") + " of them gets: ";
  for (std::size_t i = 0; i < std::min(most, pairs.size()); ++i)
  {
    const auto& [both, count] = pairs[i];
    text += (i > 0 ? ", " : "") + Excerpt(this->NameOf(both.first)) + " and " +
      Excerpt(this->NameOf(both.second)) + " (" + std::to_string(count) + ")";
  }
  warnings.push_back(
    text + (pairs.size() > most ? ", " + std::to_string(pairs.size() - most) + " more" : ""));
}

void MaskUnion::WarnOf(const std::string& what, const std::vector<std::uint32_t>& numbers,
  std::vector<std::string>& warnings) const
{
  constexpr std::size_t most = 100; // a header may list 65535
  std::string names;
  for (std::size_t i = 0; i < std::min(most, numbers.size()); ++i)
  {
    names += (i > 0 ? ", " : "") + Excerpt(this->NameOf(numbers[i]));
  }
  if (!names.empty())
  {
    warnings.push_back(this->Word + what + names +
      (numbers.size() > most ? ", and " + std::to_string(numbers.size() - most) + " more" : ""));
  }
}

ScalarImage MaskUnion::Finish(Overlap rule, std::vector<std::string>& warnings)
{
  const std::span<Set> sets = this->AllSets();
  Counts voxels(this->Members.size());
  for (const Set set : sets)
  {
    ++voxels[set];
  }
  Counts sizes(this->Names.size() + 1);
  for (std::size_t set = 0; set < voxels.size(); ++set)
  {
    for (const std::uint32_t number : this->Members[set])
    {
      sizes[number] += voxels[set];
    }
  }
  std::vector<Set> labels(voxels.size());
  Counts left(sizes.size());
  for (std::size_t set = 1; set < voxels.size(); ++set)
  {
    const std::vector<std::uint32_t>& members = this->Members[set];
    const auto first = rule == Overlap::Order
      ? std::min_element(members.begin(), members.end())
      : std::min_element(members.begin(), members.end(),
          [&sizes](std::uint32_t a, std::uint32_t b)
          { return std::pair(sizes[a], a) < std::pair(sizes[b], b); });
    labels[set] = this->Labels[*first - 1];
    left[*first] += voxels[set];
  }
  for (Set& set : sets)
  {
    set = labels[set];
  }
  std::vector<std::uint32_t> empty;
  std::vector<std::uint32_t> hidden;
  for (std::uint32_t number = 1; number < sizes.size(); ++number)
  {
    if (left[number] == 0)
    {
      (sizes[number] == 0 ? empty : hidden).push_back(number);
    }
  }
  this->WarnOfOverlaps(rule, voxels, warnings);
  this->WarnOf(" without a voxel: ", empty, warnings);
  this->WarnOf(" of which overlaps leave no voxel: ", hidden, warnings);
  this->WarnOf(
    " with several values, all of which are inside: ", this->WithSeveralValues, warnings);
  return this->Image;
}

} // namespace voxplex
