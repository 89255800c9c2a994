// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Fuzzing.h
 * @brief What the fuzzers share: files to read, and what a refusal must be like.
 */
#ifndef voxplex_fuzz_Fuzzing_h
#define voxplex_fuzz_Fuzzing_h

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace voxplex::fuzz
{

/** Prints what is wrong and aborts, which libFuzzer reports as a finding. */
[[noreturn]] void Fail(const std::string& what);

/** The path of a file in a folder of this process, which is removed when it ends. */
std::string PathOf(const std::string& name);

/** Replaces the file. */
void Write(const std::string& path, const void* data, std::size_t size);

/** A refusal is one line that names the file. */
void CheckRefusal(std::string_view message, const std::string& path);

} // namespace voxplex::fuzz

#endif
