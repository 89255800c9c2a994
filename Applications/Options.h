// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Options.h
 * @brief What the program can do, which options each of it has, and their help.
 */
#ifndef voxplex_cli_Options_h
#define voxplex_cli_Options_h

#include "Parameters.h"

#include <boost/program_options.hpp>

#include <optional>
#include <string>
#include <string_view>

namespace voxplex::cli
{

/** The verb of this name. */
std::optional<Verb> FindVerb(std::string_view name);

/** "voxplex measure", the command as users give it. */
std::string CommandOf(Verb verb);

/** All options of a verb, in groups, with their help. */
boost::program_options::options_description OptionsOf(Verb verb);

/** Whether an option says something of an image, and has no effect where there is none. */
bool NeedsImage(const std::string& option);

/** Which verbs have an option: "'voxplex measure' and 'voxplex convert'"; empty if none has. */
std::string CommandsWith(const std::string& option);

/** What the program does and how it is asked, in a screenful. */
std::string ShortHelp();

/** All options of a verb. */
std::string Help(Verb verb);

} // namespace voxplex::cli

#endif
