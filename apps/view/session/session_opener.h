/// Replaces the session on screen without blocking the window.
#pragma once

#include <functional>
#include <memory>

#include "apps/view/parts/opening.h"
#include "apps/view/session/session.h"
#include "base/worker.h"

namespace emscape::view {

/// Serves the request of Files: examines the file and opens it, both in the background; when the first
/// picture is ready, the new session replaces the old one. If it cannot be opened, the error is reported and
/// the old session is kept. For use by the window's thread.
class SessionOpener {
 public:
  using Make = std::function<std::unique_ptr<Session>(const ViewOptions&)>;

  /// @param make  creates a session that shares `files`
  SessionOpener(std::shared_ptr<Files> files, Make make) : files_(std::move(files)), make_(std::move(make)) {}

  /// @param session  replaced when the new one is ready
  /// @return true if it was replaced
  bool update(std::unique_ptr<Session>& session);
  /// True if update() must be called often.
  bool active() const { return task_.active() || files_->request || next_; }

 private:
  void take(Session& session);
  void replace(std::unique_ptr<Session>& session);
  void giveUp();
  void cancel(Session& session);
  bool close(std::unique_ptr<Session>& session);
  void endBeside(std::unique_ptr<Session> session);

  std::shared_ptr<Files> files_;
  const Make make_;
  AsyncTasks<Opening> task_;
  Opening opening_;
  std::optional<std::vector<std::string>>
      messages_before_;  // of the input that stays if the next one cannot be opened
  std::unique_ptr<Session> next_;
  Worker old_sessions_;
};

}  // namespace emscape::view
