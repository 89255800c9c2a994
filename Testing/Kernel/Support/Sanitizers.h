// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Tests do less where a sanitizer makes everything many times slower.
#ifndef voxplex_Sanitizers_h
#define voxplex_Sanitizers_h

namespace voxplex
{

#if defined(__SANITIZE_THREAD__) || defined(__SANITIZE_ADDRESS__)
inline constexpr bool Sanitized = true;
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer) || __has_feature(address_sanitizer)
inline constexpr bool Sanitized = true;
#else
inline constexpr bool Sanitized = false;
#endif
#else
inline constexpr bool Sanitized = false;
#endif

} // namespace voxplex

/** For a test of what meshes are like whose code other tests run with the sanitizers, too. */
#define VOXPLEX_NOT_WITH_SANITIZERS()                                                              \
  if (voxplex::Sanitized)                                                                          \
  {                                                                                                \
    GTEST_SKIP() << "other tests run the same code with the sanitizers";                           \
  }                                                                                                \
  static_assert(true)

#endif
