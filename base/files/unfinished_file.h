/// Files that appear under their name only when they are complete.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <ostream>
#include <string>

#include "base/files/descriptor.h"
#include "base/files/own_file.h"

namespace emscape {

/// A file that is not complete yet: FOLDER/emscape.part-RANDOM/NAME. The inner folder is created for this
/// file and closed to other users, so that libraries and programs that create the file by name, and further
/// files beside it, meet neither links nor files of others in it. It contains a record with its own name,
/// locked while the object exists: the proof by which a later process removes what a killed one has left.
class UnfinishedFile {
 public:
  /// @throws Error (other) that names the file and the cause: missing folder, a folder or device of that
  /// name, no permission; (usage) as requireOwn()
  explicit UnfinishedFile(std::filesystem::path file, Replaces replaces = Replaces::own);
  /// Removes everything that was not published.
  ~UnfinishedFile();
  UnfinishedFile(const UnfinishedFile&) = delete;
  UnfinishedFile& operator=(const UnfinishedFile&) = delete;

  const std::filesystem::path& file() const { return file_; }
  /// The absolute name of the unfinished file, which does not exist yet: never an option, an address or the
  /// prefix of a driver.
  const std::filesystem::path& temporary() const { return temporary_; }
  /// Creates the file. `fill` gets a binary stream that seeks and throws on every failure.
  /// @throws Error (other) that names the file and the cause; exceptions that `fill` throws for reasons of
  /// its own pass through
  void write(const std::function<void(std::ostream&)>& fill);
  /// Records the file as this program's, flushes it to the disk and renames it.
  /// @param beside  ending of a file that belongs to it, as GDAL's .aux.xml: renamed before it if there is
  ///                one, else that of an earlier file is removed; empty: none. One of another program is an
  ///                error
  /// @throws Error (other) that names the file and the cause; (usage) if a file of that name is to stay. If
  /// it has come since the constructor, this one is kept as NAME-2, NAME-3 and so on
  void publish(const std::string& beside = "");
  /// Removes the published file again, if it is still there under its name.
  void withdraw();

 private:
  void makeOwnFolder();
  void removeOwnFolder();
  /// Records, flushes and renames a file of the inner folder. @return errno, 0 if all went well
  int rename(const std::string& name, const std::string& target, Replaces replaces);
  /// Keeps the file under a free name. @return the name, to follow why; empty if that failed
  std::string keptText();
  /// Of the file or one beside it, which may have come since the constructor.
  void requireStillOwn(const std::filesystem::path& file);

  std::filesystem::path file_, temporary_;
  Replaces replaces_;
  Descriptor folder_;
  std::string own_name_;  ///< of the inner folder
  struct {
    std::uint64_t device = 0, number = 0;
  } published_;  ///< the file's inode
  Descriptor own_folder_, record_;
};

/// Removes from a folder the inner folders of UnfinishedFile that ended processes have left.
/// @return their number; 0 if the folder does not exist
int removeAbandonedFiles(const std::filesystem::path& folder);

}  // namespace emscape
