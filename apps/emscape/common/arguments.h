/// Values on a command line: CLI11 made stricter, and its messages in the form of the programs' own.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace emscape::app {

/// Makes zeros before a whole number mean nothing: CLI11 would read an octal number.
/// To be called when all options are there.
void readWholeNumbersAsDecimal(CLI::App& app);

/// Rejects missing values, empty ones, which CLI11 takes as 0 or as none, 'nan' and 'inf', which it accepts
/// as numbers, numbers of switches, and values of flags.
/// @throws CLI::ValidationError naming the first such option of the program or its subcommands
void checkValues(const CLI::App& app);

/// The parser's message. Where CLI11 asks for a subcommand, it names the unknown word.
std::string messageOf(const CLI::App& app, const CLI::ParseError& error);

}  // namespace emscape::app
