// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Lists.h
 * @brief Properties of filters that are lists, sets or maps.
 */
#ifndef voxplex_Lists_h
#define voxplex_Lists_h

#include "vtkIndent.h"
#include "vtkObject.h"

#include <cstddef>
#include <iterator>
#include <ostream>
#include <string>
#include <vector>

namespace voxplex
{

inline void ModifyIf(vtkObject* filter, bool changed)
{
  if (changed)
  {
    filter->Modified();
  }
}

template <typename List>
void Clear(vtkObject* filter, List& items)
{
  ModifyIf(filter, !items.empty());
  items.clear();
}

/** The item with an index, or `none` if the index is out of range. */
template <typename List>
typename List::value_type ItemAt(const List& items, int index, typename List::value_type none)
{
  return index >= 0 && index < std::ssize(items) ? *std::next(items.begin(), index) : none;
}

/** A text of a list that a getter shows; empty if the index is out of range. */
inline const std::string& TextAt(const std::vector<std::string>& texts, int index)
{
  static const std::string none;
  return index >= 0 && index < std::ssize(texts) ? texts[static_cast<std::size_t>(index)] : none;
}

/** Sets the size of a key of a map. */
template <typename Map>
void SetSize(vtkObject* filter, Map& sizes, const typename Map::key_type& key, double size)
{
  const auto [place, isNew] = sizes.try_emplace(key, size);
  ModifyIf(filter, isNew || place->second != size);
  place->second = size;
}

/** The size of a key; 0 if it has none. */
template <typename Map>
double SizeOf(const Map& sizes, const typename Map::key_type& key)
{
  const auto found = sizes.find(key);
  return found == sizes.end() ? 0.0 : found->second;
}

/** For PrintSelf(). `print` writes an item; `none` stands for an empty list. */
template <typename List, typename Printer>
void PrintList(std::ostream& os, vtkIndent indent, const char* name, const List& items,
  const char* none, Printer&& print)
{
  os << indent << name << ':' << (items.empty() ? none : "");
  for (const auto& item : items)
  {
    print(os << ' ', item);
  }
  os << '\n';
}

template <typename List>
void PrintList(
  std::ostream& os, vtkIndent indent, const char* name, const List& items, const char* none)
{
  PrintList(os, indent, name, items, none, [](std::ostream& to, const auto& item) { to << item; });
}

} // namespace voxplex

#endif
