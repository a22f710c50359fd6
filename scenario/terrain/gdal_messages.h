/// Messages of GDAL and PROJ, kept instead of printed.
#pragma once

#include <cpl_error.h>

#include <string>

namespace emscape::scenario {

/// Keeps GDAL from printing and stores its first message, in the scope and thread of this object.
class GdalMessages {
 public:
  GdalMessages() { CPLPushErrorHandlerEx(&GdalMessages::take, this); }
  ~GdalMessages() { CPLPopErrorHandler(); }
  GdalMessages(const GdalMessages&) = delete;
  GdalMessages& operator=(const GdalMessages&) = delete;

  bool hasFailure() const { return !first_failure_.empty(); }
  /// `problem`, with GDAL's reason if it gave one.
  std::string explain(const std::string& problem) const {
    return first_failure_.empty() ? problem : problem + " (" + first_failure_ + ")";
  }

 private:
  static void CPL_STDCALL take(CPLErr severity, CPLErrorNum, const char* message) {
    auto* self = static_cast<GdalMessages*>(CPLGetErrorHandlerUserData());
    if (severity >= CE_Failure && self->first_failure_.empty()) self->first_failure_ = message;
  }

  std::string first_failure_;
};

}  // namespace emscape::scenario
