// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file JsonWriter.h
 * @brief Text in JSON, written piece by piece.
 */
#ifndef voxplex_JsonWriter_h
#define voxplex_JsonWriter_h

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <locale>
#include <span>
#include <sstream>
#include <string>
#include <string_view>

namespace voxplex
{

/** Writes nested JSON objects. */
class JsonWriter
{
public:
  JsonWriter()
  {
    this->Text.imbue(std::locale::classic());
    this->Text.precision(std::numeric_limits<double>::max_digits10);
    this->Text << "{";
  }

  void Begin(const std::string& name)
  {
    this->Name(name);
    this->Text << "{";
    this->First = true;
  }

  void End()
  {
    this->Text << "}";
    this->First = false;
  }

  void BeginList(const std::string& name)
  {
    this->Name(name);
    this->Text << "[";
    this->First = true;
  }

  /** An object of a list; ends with End(). */
  void BeginItem()
  {
    this->Text << (this->First ? "{" : ", {");
    this->First = true;
  }

  void EndList()
  {
    this->Text << "]";
    this->First = false;
  }

  void Add(const std::string& name, double value)
  {
    this->Name(name);
    this->Write(value);
  }

  void AddNull(const std::string& name)
  {
    this->Name(name);
    this->Text << "null";
  }

  /** A number of a list. */
  void AddItem(double value)
  {
    this->Text << (this->First ? "" : ", ");
    this->First = false;
    this->Write(value);
  }

  void Add(const std::string& name, std::int64_t value)
  {
    this->Name(name);
    this->Text << value;
  }

  void Add(const std::string& name, std::uint64_t value)
  {
    this->Name(name);
    this->Text << value;
  }

  void Add(const std::string& name, bool value)
  {
    this->Name(name);
    this->Text << (value ? "true" : "false");
  }

  /** The text must not need escapes. */
  void Add(const std::string& name, std::string_view text)
  {
    this->Name(name);
    this->Text << '"' << text << '"';
  }

  template <typename T>
  void Add(const std::string& name, std::span<const T> values)
  {
    this->Name(name);
    this->Text << "[";
    for (std::size_t i = 0; i < values.size(); ++i)
    {
      this->Text << (i ? ", " : "") << values[i];
    }
    this->Text << "]";
  }

  std::string Finish()
  {
    this->Text << "}";
    return this->Text.str();
  }

private:
  void Write(double value)
  {
    if (std::isfinite(value))
    {
      this->Text << value;
    }
    else
    {
      this->Text << "null"; // JSON has no infinity
    }
  }

  void Name(const std::string& name)
  {
    this->Text << (this->First ? "" : ", ") << '"' << name << "\": ";
    this->First = false;
  }

  std::ostringstream Text;
  bool First = true;
};

} // namespace voxplex

#endif
