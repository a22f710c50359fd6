/// Items that have another name in an edited scenario.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "emscape/scenario/model/scenario.h"

namespace emscape::playback {

struct RenamedItem {
  std::string list;                   ///< emitters, platforms, receivers or targets
  std::string before, now;            ///< names
  std::string path_before, path_now;  ///< "emitters.jammer"
};

/// The item to which an edit gives a name.
std::optional<RenamedItem> renamedBy(const scenario::Edit& edit);

/// The items that have another name at the same place of their list. None of lists with more or fewer items,
/// and none whose name is elsewhere in the list now or whose other name was there before.
std::vector<RenamedItem> renamedItems(const scenario::Scenario& before, const scenario::Scenario& now);

/// A path with the new name in place of the old one, if it leads to one of the items or into it.
std::string renamedPath(const std::vector<RenamedItem>& items, const std::string& path);

/// The name that an item has after edits.
std::string nameAfter(const std::vector<scenario::Edit>& edits, const std::string& list, std::string name);

/// The paths that edits change, with the names that the items have after all of them.
std::set<std::string> editedPaths(const std::vector<scenario::Edit>& edits);

/// The edits with the renames of an item in a row as one, and without those that lead back to its first name;
/// the result has the same effect.
std::vector<scenario::Edit> foldedEdits(const std::vector<scenario::Edit>& edits);

/// The edits without those of a value or an item, where the others have the names that their items have then.
std::vector<scenario::Edit> editsWithout(const std::vector<scenario::Edit>& edits, const std::string& path);

}  // namespace emscape::playback
