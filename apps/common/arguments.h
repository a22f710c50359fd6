/// Values on a command line: CLI11 made stricter, and its messages in the form of the programs' own.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace emscape::app {

/// Leading zeros of whole numbers have no effect, and other prefixes such as 0x are refused: CLI11 would read
/// octal and hexadecimal numbers. Call after all options are added.
void readWholeNumbersAsDecimal(CLI::App& app);

/// Rejects missing values, empty ones, which CLI11 takes as 0 or as none, 'nan' and 'inf', which it accepts
/// as numbers, values of switches but on, off, true, false, yes, no, 1 and 0, and values of flags but true
/// and false.
/// @throws CLI::ValidationError naming the first such option of the program or its subcommands
void checkValues(const CLI::App& app);

/// The parser's message. Where CLI11 asks for a subcommand, it names the unknown word.
std::string messageOf(const CLI::App& app, const CLI::ParseError& error);

}  // namespace emscape::app
