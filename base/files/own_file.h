/// Which files this program wrote and nobody changed since: no others are replaced or removed.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/files/descriptor.h"
#include "base/files/file_digest.h"

namespace emscape {

/// Which file of its name an output may replace.
enum class Replaces {
  nothing,
  own,  ///< an empty file, and one of isOwn()
  any   ///< the user was asked, or the content was checked
};

/// What a file is that isOwn() denies, with the remedy; to follow "is".
extern const char* const kForeignFile;

/// Records that this program wrote a file, with its size and checksum: in its extended attribute
/// "user.emscape", or, if that cannot be written, as its line of FOLDER/.emscape-files (at most 64 MB). If
/// neither can be written, the file counts as one of the user; the first one is warned of.
/// @param file  its final name  @param opened  the complete file, open for reading
/// @param patches  with which it will be complete
/// @return errno of reading the file, 0 if all went well
int recordOwn(const std::filesystem::path& file, const Descriptor& opened,
              const std::vector<FilePatch>& patches = {});

/// The size and checksum that recordOwn() found, which may not be those of a database's header; those of the
/// file if there is no record. @throws Error (bad_input) as digestOf()
FileDigest recordedDigestOf(const std::filesystem::path& file);

/// True for an empty file, and for one that is as recordOwn() found it. Of an SQLite database the header is
/// not compared: programs change it when they only read. Links are not followed.
bool isOwn(const std::filesystem::path& file);

/// What a file is that must not be replaced, be it a link, with the remedy; to follow "is". Empty for none,
/// and for one of isOwn().
std::string foreignText(const std::filesystem::path& file);

/// @throws Error (usage) that names the file, if there is one of foreignText()
void requireOwn(const std::filesystem::path& file);

}  // namespace emscape
