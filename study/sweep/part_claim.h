/// Claims of parts by processes of several machines that share a folder, without a scheduler.
#pragma once

#include <condition_variable>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

namespace emscape::study {

/// A file that names the process that works on a part. It is created with O_EXCL and touched every 30 s. It
/// is abandoned if its process has ended, or if it was not touched for kAbandoned_s. For a moment two
/// processes may hold a claim that was abandoned; both then compute the same results.
class PartClaim {
 public:
  static constexpr double kAbandoned_s = 300;

  /// Claims a file, also an abandoned one.
  /// @return null if another process holds it
  /// @throws Error (other) naming the file
  static std::unique_ptr<PartClaim> tryClaim(const std::filesystem::path& file);
  /// True if a process holds the claim.
  static bool isHeld(const std::filesystem::path& file);

  /// Removes the file if this process still holds it.
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
