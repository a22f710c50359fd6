#include "apps/manual/manual_page.h"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <sstream>

namespace emscape::manual {
namespace {

/// Escapes a text, so that nothing is interpreted as a macro or an escape. Hyphens become ASCII ones, which
/// can be copied.
std::string roff(const std::string& text) {
  std::string result;
  for (const char c : text) {
    const bool at_line_begin = result.empty() || result.back() == '\n';
    if (at_line_begin && (c == '.' || c == '\'')) result += "\\&";
    if (c == '\\') {
      result += "\\e";
    } else if (c == '-') {
      result += "\\-";
    } else {
      result += c;
    }
  }
  return result;
}

std::string upper(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::toupper(c); });
  return text;
}

std::string listed(const std::vector<std::string>& words) {
  std::string result;
  for (const std::string& word : words) result += (result.empty() ? "" : ", ") + word;
  return result;
}

/// Name and value as a tagged paragraph, followed by the help.
std::string optionText(const OptionDescription& option) {
  std::string text = ".TP\n";
  for (const std::string& name : option.names) {
    if (&name != &option.names.front()) text += ", ";
    text += "\\fB" + roff(name) + "\\fR";
  }
  const bool is_positional = option.names.front().front() != '-';
  if (!option.value.empty() && !is_positional) text += " \\fI" + roff(option.value) + "\\fR";
  text += "\n" + roff(option.help) + "\n";
  if (!option.choices.empty()) text += ".br\nOne of: " + roff(listed(option.choices)) + ".\n";
  if (!option.allowed.empty()) text += ".br\nAllowed: " + roff(option.allowed) + ".\n";
  if (!option.default_value.empty()) text += ".br\nDefault: " + roff(option.default_value) + ".\n";
  if (option.required && !is_positional) text += ".br\nRequired.\n";
  return text;
}

std::string optionTexts(const CommandDescription& command) {
  std::string text;
  for (const OptionDescription& option : command.positionals) text += optionText(option);
  for (const OptionDescription& option : command.options) text += optionText(option);
  return text;
}

/// The text below the options: paragraphs are filled, indented lines are kept, "Examples:" and "Exit status:"
/// become sections.
std::string footerText(const std::string& footer, const char* section) {
  std::string text;
  bool is_kept = false;  // between .nf and .fi
  const auto keep = [&](bool kept) {
    if (kept != is_kept) text += kept ? ".nf\n" : ".fi\n";
    is_kept = kept;
  };
  std::istringstream lines(footer);
  for (std::string line; std::getline(lines, line);) {
    if (line.empty()) {
      keep(false);
      if (!text.empty()) text += ".PP\n";
    } else if (line == "Examples:" || line == "Example:") {
      keep(false);
      text += fmt::format("{} EXAMPLES\n", section);
    } else if (line.rfind("Exit status: ", 0) == 0) {
      keep(false);
      text += fmt::format("{} EXIT STATUS\n{}\n", section, roff(line.substr(13)));
    } else {
      keep(line.front() == ' ');
      text += roff(line) + "\n";
    }
  }
  keep(false);
  // Removes empty paragraphs before a section or at the end.
  for (std::size_t at; (at = text.find(".PP\n.S")) != std::string::npos;) text.erase(at, 4);
  while (text.size() >= 4 && text.compare(text.size() - 4, 4, ".PP\n") == 0) text.erase(text.size() - 4);
  return text;
}

/// The text, preceded by a paragraph macro unless it begins with a section.
std::string paragraphs(const std::string& text) {
  return text.empty() || text.rfind(".S", 0) == 0 ? text : ".PP\n" + text;
}

std::string synopsis(const std::string& path, const CommandDescription& command) {
  std::string text = "\\fB" + roff(path) + "\\fR [\\fIOPTIONS\\fR]";
  for (const OptionDescription& positional : command.positionals) {
    const std::string name = "\\fI" + roff(positional.names.front()) + "\\fR";
    text += positional.required ? " " + name : " [" + name + "]";
  }
  if (!command.subcommands.empty()) text += " \\fISUBCOMMAND\\fR";
  return text + "\n";
}

std::string pageName(const std::string& program, const std::string& subcommand) {
  return program + "-" + subcommand;
}

std::string header(const std::string& page, const std::string& program, const std::string& version,
                   const std::string& summary) {
  return fmt::format(".TH {} 1 \"\" \"{} {}\" \"User Commands\"\n.SH NAME\n{} \\- {}\n.SH SYNOPSIS\n",
                     roff(upper(page)), program, version, roff(page), roff(summary));
}

ManualPage programPage(const CommandDescription& program, const std::string& version) {
  std::string summary = program.summary;
  if (!summary.empty() && summary.back() == '.') summary.pop_back();
  std::string text = header(program.name, program.name, version, summary) + synopsis(program.name, program);
  text += ".SH SUBCOMMANDS\n";
  for (const CommandDescription& subcommand : program.subcommands) {
    text += fmt::format(".TP\n\\fB{}\\fR(1)\n{}\n", roff(pageName(program.name, subcommand.name)),
                        roff(subcommand.summary));
  }
  text += ".SH OPTIONS\nThey may be before or after the subcommand.\n" + optionTexts(program);
  return {program.name + ".1", text + paragraphs(footerText(program.footer, ".SH"))};
}

ManualPage subcommandPage(const CommandDescription& program, const CommandDescription& subcommand,
                          const std::string& version) {
  const std::string page = pageName(program.name, subcommand.name);
  const std::string path = program.name + " " + subcommand.name;
  std::string text = header(page, program.name, version, subcommand.summary) + synopsis(path, subcommand);
  text += ".SH OPTIONS\n" + optionTexts(subcommand);
  text += fmt::format(".PP\nThe options of \\fB{}\\fR(1) are taken, too.\n", roff(program.name));
  text += paragraphs(footerText(subcommand.footer, ".SH"));
  for (const CommandDescription& inner : subcommand.subcommands) {
    text += fmt::format(".SH \"{}\"\n{}.PP\n{}.\n", roff(upper(subcommand.name + " " + inner.name)),
                        synopsis(path + " " + inner.name, inner), roff(inner.summary));
    text += optionTexts(inner);
    text += paragraphs(footerText(inner.footer, ".SS"));
  }
  text += fmt::format(".SH SEE ALSO\n\\fB{}\\fR(1)\n", roff(program.name));
  return {page + ".1", text};
}

}  // namespace

std::vector<ManualPage> manualPages(const CommandDescription& program, const std::string& version) {
  std::vector<ManualPage> pages{programPage(program, version)};
  for (const CommandDescription& subcommand : program.subcommands) {
    pages.push_back(subcommandPage(program, subcommand, version));
  }
  return pages;
}

}  // namespace emscape::manual
