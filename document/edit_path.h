/// Paths to values by name: emitters.search radar.antenna.gain_dbi.
#pragma once

#include <string>

#include "document/schema.h"
#include "document/text_edit.h"

namespace emscape::document {

/// The value at the end of a path.
struct ResolvedPath {
  NodePath steps;
  std::string text;                 ///< the path, with quotes if an edit's text requires them
  std::string name;                 ///< of the key or item, for messages
  const ValueSpec* spec = nullptr;  ///< of the value
  bool required = false;            ///< a required key
  bool exists = false;              ///< the document has a value there
  std::string new_name;             ///< of a new item: the last step, which the list does not have
  std::string missing;              ///< of a new item: message for those who need an existing one
  bool is_list_required = false;    ///< item: the list is a required key
};

/// Follows a path from the root. Steps are separated by points: keys; items of a list by their name, or by
/// their index from 0 if they have none. Names are matched against those in the document, the longest first,
/// so that they may contain points; a name in double quotes (\" and \\ within) is taken literally. Keys need
/// not exist in the document; items must, except the last step, which may name a new item.
/// @throws Error (bad_input), without a location, for keys and items that do not exist; the message lists the
/// existing ones
ResolvedPath resolvePath(const std::string& path, const DocumentNodePtr& root, const ObjectSpec& spec);

/// A name in double quotes, with \" and \\ for a quote and a backslash.
std::string quotedName(const std::string& name);
/// A name as a step of a path: in quotes if it has characters of the path's own.
std::string pathStep(const std::string& name);

/// The byte of the first '=' of "PATH=VALUE" outside quoted names; npos if there is none.
std::size_t endOfPath(const std::string& text);

}  // namespace emscape::document
