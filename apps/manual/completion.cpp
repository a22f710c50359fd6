#include "apps/manual/completion.h"

#include <fmt/core.h>

#include <functional>
#include <vector>

namespace emscape::manual {
namespace {

/// A command, its path from the program ("emscape bench field") and the options of the commands above it,
/// which may follow its name.
struct Visited {
  const CommandDescription& command;
  std::string path;
  std::vector<OptionDescription> options;
};

std::string nameOf(const OptionDescription& option) {
  return option.names.back();
}

/// True if the list has the option; commands repeat options of those above them, such as --help.
bool hasOption(const std::vector<OptionDescription>& options, const std::string& name) {
  for (const OptionDescription& option : options) {
    if (nameOf(option) == name) return true;
  }
  return false;
}

void visit(const CommandDescription& command, const std::string& path,
           const std::vector<OptionDescription>& above, const std::function<void(const Visited&)>& take) {
  Visited visited{command, path, command.options};
  for (const OptionDescription& option : above) {
    if (!hasOption(visited.options, nameOf(option))) visited.options.push_back(option);
  }
  take(visited);
  for (const CommandDescription& subcommand : command.subcommands) {
    visit(subcommand, path + " " + subcommand.name, visited.options, take);
  }
}

std::string joined(const std::vector<std::string>& words, const char* between) {
  std::string result;
  for (const std::string& word : words) result += (result.empty() ? "" : between) + word;
  return result;
}

std::vector<std::string> namesOf(const std::vector<CommandDescription>& commands) {
  std::vector<std::string> names;
  for (const CommandDescription& command : commands) names.push_back(command.name);
  return names;
}

bool isNumber(const OptionDescription& option) {
  return option.value == "INT" || option.value == "UINT" || option.value == "FLOAT";
}

/// The name of the shell function for a path.
std::string functionOf(const std::string& path) {
  std::string name = "_" + path;
  for (char& c : name) {
    if (c == ' ' || c == '-') c = '_';
  }
  return name;
}

/// Text in single quotes, inside a single-quoted shell text.
std::string quoted(const std::string& text) {
  std::string result;
  for (const char c : text) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return result;
}

/// Text escaped for the brackets and colons of zsh's _arguments.
std::string zshText(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '[' || c == ']' || c == ':' || c == '\\') result += '\\';
    result += c;
  }
  return quoted(result);
}

/// One argument of _arguments: '(-o --output)'{-o,--output}'[help]:value:action'.
std::string zshOption(const OptionDescription& option) {
  std::string text = option.repeats ? "'*'" : "'(" + joined(option.names, " ") + ")'";
  text += option.names.size() > 1 ? "{" + joined(option.names, ",") + "}" : option.names.front();
  text += "'[" + zshText(option.help) + "]";
  if (!option.value.empty()) {
    text += ":" + zshText(option.value) + ":";
    if (!option.choices.empty()) {
      text += "(" + quoted(joined(option.choices, " ")) + ")";
    } else if (!isNumber(option)) {
      text += "_files";
    }
  }
  return text + "'";
}

}  // namespace

std::string bashCompletion(const CommandDescription& program) {
  std::string options, subcommands, values;
  visit(program, program.name, {}, [&](const Visited& visited) {
    std::vector<std::string> names;
    for (const OptionDescription& option : visited.options) {
      names.insert(names.end(), option.names.begin(), option.names.end());
      if (option.value.empty()) continue;
      std::vector<std::string> patterns;
      for (const std::string& name : option.names) patterns.push_back("'" + visited.path + ":" + name + "'");
      const std::string action = !option.choices.empty() ? "words='" + joined(option.choices, " ") + "'"
                                 : isNumber(option)      ? "words="
                                                         : "files=1";
      values += fmt::format("    {}) takes_value=1 {} ;;\n", joined(patterns, " | "), action);
    }
    options += fmt::format("    '{}') words='{}' ;;\n", visited.path, joined(names, " "));
    const std::vector<std::string> inner = namesOf(visited.command.subcommands);
    if (inner.empty()) return;
    std::vector<std::string> paths;
    for (const std::string& name : inner) paths.push_back("'" + visited.path + " " + name + "'");
    subcommands += fmt::format("      {}) path=$path' '$word ;;\n", joined(paths, " | "));
    options += fmt::format("    '{}:subcommands') words='{}' ;;\n", visited.path, joined(inner, " "));
  });
  // Words are also split at '=': --backend=cpu arrives as three words.
  return fmt::format(R"(# Completion of {0} in bash; made from its command line's description.
{1}() {{
  local current=${{COMP_WORDS[COMP_CWORD]}} previous=${{COMP_WORDS[COMP_CWORD - 1]}} path={0} word words= files= takes_value=
  if [[ $current == '=' ]]; then
    current=
  elif [[ $previous == '=' ]]; then
    previous=${{COMP_WORDS[COMP_CWORD - 2]}}
  fi
  for word in "${{COMP_WORDS[@]:1:COMP_CWORD-1}}"; do
    case "$path $word" in
{2}    esac
  done
  case "$path:$previous" in
{3}  esac
  if [[ ! $takes_value ]]; then
    if [[ $current == -* ]]; then word=$path; else word=$path:subcommands; files=1; fi
    case $word in
{4}    esac
    [[ ! $words ]] || files=
  fi
  COMPREPLY=($(compgen -W "$words" -- "$current"))
  if [[ ! $files ]]; then compopt +o default 2>/dev/null; fi
}}
complete -o default -F {1} {0}
)",
                     program.name, functionOf(program.name), subcommands, values, options);
}

std::string zshCompletion(const CommandDescription& program) {
  std::string functions;
  visit(program, program.name, {}, [&](const Visited& visited) {
    const std::vector<CommandDescription>& inner = visited.command.subcommands;
    std::string text = functionOf(visited.path) + "() {\n";
    text +=
        inner.empty() ? "  _arguments -s" : "  local curcontext=$curcontext state line\n  _arguments -s -C";
    for (const OptionDescription& option : visited.options) text += " \\\n    " + zshOption(option);
    if (inner.empty()) {
      for (const OptionDescription& positional : visited.command.positionals) {
        text += " \\\n    ':" + zshText(positional.names.front()) + ":_files'";
      }
      functions += text + "\n}\n\n";
      return;
    }
    text += " \\\n    '1:subcommand:->subcommand' \\\n    '*::argument:->argument'\n  case $state in\n";
    text += "    subcommand)\n      local -a subcommands=(\n";
    for (const CommandDescription& command : inner) {
      text += fmt::format("        '{}:{}'\n", command.name, zshText(command.summary));
    }
    text += "      )\n      _describe subcommand subcommands ;;\n    argument)\n      case $line[1] in\n";
    for (const CommandDescription& command : inner) {
      text += fmt::format("        {}) {} ;;\n", command.name, functionOf(visited.path + " " + command.name));
    }
    functions += text + "      esac ;;\n  esac\n}\n\n";
  });
  return fmt::format(
      "#compdef {0}\n# Completion of {0} in zsh; made from its command line's description.\n\n{1}{2} "
      "\"$@\"\n",
      program.name, functions, functionOf(program.name));
}

}  // namespace emscape::manual
