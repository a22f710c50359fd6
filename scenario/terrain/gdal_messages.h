/// Use of GDAL and PROJ that neither prints nor reaches the network.
#pragma once

#include <algorithm>
#include <cstring>
#include <string>

#include "base/geodesy/gdal.h"

namespace emscape::scenario {

/// In the scope and thread of this object, suppresses GDAL's output and stores the first line of its first
/// failure. It also prevents downloads: a GML file names its schema by URL, a GeoJSON file its coordinate
/// system. Names that begin with /vsi are not covered; callers do not open such files.
class GdalMessages {
 public:
  GdalMessages() {
    CPLPushErrorHandlerEx(&GdalMessages::take, this);
    CPLHTTPPushFetchCallback(&GdalMessages::refuseFetch, nullptr);
  }
  ~GdalMessages() {
    CPLHTTPPopFetchCallback();
    CPLPopErrorHandler();
  }
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
    if (severity < CE_Failure || !self->first_failure_.empty()) return;
    // PROJ reads a name that contains a brace as JSON.
    if (std::strstr(message, "[json.exception") != nullptr) return;
    self->first_failure_ = message;
    self->first_failure_.resize(std::min(self->first_failure_.find('\n'), self->first_failure_.size()));
  }

  static CPLHTTPResult* refuseFetch(const char*, CSLConstList, GDALProgressFunc, void*, CPLHTTPFetchWriteFunc,
                                    void*, void*) {
    auto* const result = static_cast<CPLHTTPResult*>(CPLCalloc(1, sizeof(CPLHTTPResult)));
    result->nStatus = 1;
    result->pszErrBuf = CPLStrdup("files are read without the network");
    return result;
  }

  std::string first_failure_;
};

}  // namespace emscape::scenario
