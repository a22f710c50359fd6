/// Claims of parts by processes of several machines that share a folder, without a scheduler.
#pragma once

#include <condition_variable>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

namespace emscape::study {

/// A file that says which process works on a part. It is made with O_EXCL and touched every 30 s; it is
/// abandoned when its process has ended, or when it was not touched for kAbandoned_s. Two processes may hold
/// one claim for a moment where it was abandoned: both then compute the same.
class PartClaim {
 public:
  static constexpr double kAbandoned_s = 300;

  /// Claims a file, also one that was abandoned.
  /// @return null if another process holds it
  /// @throws Error (other) naming the file
  static std::unique_ptr<PartClaim> tryClaim(const std::filesystem::path& file);
  /// True if a process holds the claim.
  static bool isHeld(const std::filesystem::path& file);

  /// Removes the file, if it is still this process's.
  ~PartClaim();
  PartClaim(const PartClaim&) = delete;
  PartClaim& operator=(const PartClaim&) = delete;

 private:
  PartClaim(std::filesystem::path file, std::string holder);
  void touchRegularly();

  std::filesystem::path file_;
  std::string holder_;  ///< content of the file
  std::mutex mutex_;
  std::condition_variable ended_;
  bool has_ended_ = false;
  std::thread thread_;
};

}  // namespace emscape::study
