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

/** For PrintSelf(). */
inline void PrintText(std::ostream& os, vtkIndent indent, const char* name, const std::string& text)
{
  os << indent << name << ": " << (text.empty() ? "(none)" : text) << "\n";
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

// The functions of a filter for a map from labels to sizes, and for a set of labels, both in its Internals.
#define VOXPLEX_SIZES_OF_LABELS(filter, one, all, sizedLabel, map)                                 \
  void filter::Set##one(vtkTypeInt64 label, double value)                                          \
  {                                                                                                \
    voxplex::SetSize(this, this->Private->map, label, value);                                      \
  }                                                                                                \
  double filter::Get##one(vtkTypeInt64 label) const                                                \
  {                                                                                                \
    return voxplex::SizeOf(this->Private->map, label);                                             \
  }                                                                                                \
  void filter::Remove##one(vtkTypeInt64 label)                                                     \
  {                                                                                                \
    voxplex::ModifyIf(this, this->Private->map.erase(label) > 0);                                  \
  }                                                                                                \
  void filter::Clear##all()                                                                        \
  {                                                                                                \
    voxplex::Clear(this, this->Private->map);                                                      \
  }                                                                                                \
  int filter::GetNumberOf##all() const                                                             \
  {                                                                                                \
    return static_cast<int>(this->Private->map.size());                                            \
  }                                                                                                \
  vtkTypeInt64 filter::Get##sizedLabel(int index) const                                            \
  {                                                                                                \
    return voxplex::ItemAt(this->Private->map, index, {}).first;                                   \
  }

#define VOXPLEX_SET_OF_LABELS(filter, add, remove, clear, label, labels, set)                      \
  void filter::add(vtkTypeInt64 value)                                                             \
  {                                                                                                \
    voxplex::ModifyIf(this, this->Private->set.insert(value).second);                              \
  }                                                                                                \
  void filter::remove(vtkTypeInt64 value)                                                          \
  {                                                                                                \
    voxplex::ModifyIf(this, this->Private->set.erase(value) > 0);                                  \
  }                                                                                                \
  void filter::clear()                                                                             \
  {                                                                                                \
    voxplex::Clear(this, this->Private->set);                                                      \
  }                                                                                                \
  int filter::GetNumberOf##labels() const                                                          \
  {                                                                                                \
    return static_cast<int>(this->Private->set.size());                                            \
  }                                                                                                \
  vtkTypeInt64 filter::Get##label(int index) const                                                 \
  {                                                                                                \
    return voxplex::ItemAt(this->Private->set, index, 0);                                          \
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
