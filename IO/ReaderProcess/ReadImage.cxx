// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "ImageReading/ReadImage.h"

#include "ReadApart.h"

#include <cstddef>
#include <memory>
#include <mutex>
#include <string>

#include <locale.h>
#ifdef __APPLE__
#include <xlocale.h>
#endif

namespace voxplex::io
{
namespace
{

#ifdef _WIN32 // where a thread does not take a locale for a while, but may have its own

/** In the C locale, for this thread: the libraries that read take a decimal comma for the end of a number. */
class PlainLocale
{
public:
  PlainLocale()
    : PreviousKind(_configthreadlocale(_ENABLE_PER_THREAD_LOCALE))
    , Previous(setlocale(LC_ALL, nullptr))
  {
    setlocale(LC_ALL, "C");
  }
  ~PlainLocale()
  {
    setlocale(LC_ALL, this->Previous.c_str());
    _configthreadlocale(this->PreviousKind);
  }
  PlainLocale(const PlainLocale&) = delete;
  PlainLocale& operator=(const PlainLocale&) = delete;

private:
  int PreviousKind;
  std::string Previous;
};

#else

/** In the C locale, for this thread: the libraries that read take a decimal comma for the end of a number. */
class PlainLocale
{
public:
  PlainLocale()
    : Plain(newlocale(LC_ALL_MASK, "C", nullptr))
    , Previous(uselocale(Plain))
  {
  }
  ~PlainLocale()
  {
    uselocale(this->Previous);
    freelocale(this->Plain);
  }
  PlainLocale(const PlainLocale&) = delete;
  PlainLocale& operator=(const PlainLocale&) = delete;

private:
  locale_t Plain;
  locale_t Previous;
};

#endif

ImageAnswer ReadInTurn(const ImageRequest& request)
{
  static std::mutex mutex; // the libraries have global state
  const std::lock_guard<std::mutex> turn(mutex);
  const PlainLocale locale;
  return ReadImageHere(request,
    [](std::size_t bytes)
    {
      const std::shared_ptr<std::byte[]> memory(new std::byte[bytes]);
      return std::shared_ptr<void>(memory, memory.get());
    });
}

} // namespace

ImageAnswer ReadImage(const ImageRequest& request)
{
#ifndef _WIN32 // where all images are read here: what a damaged one does to a library, it does to this process
  if (std::optional<ImageAnswer> answer = ReadApart(request))
  {
    return *std::move(answer);
  }
#endif
  return ReadInTurn(request);
}

} // namespace voxplex::io
