/// Use of GDAL and PROJ that neither prints nor reaches the network.
#pragma once

#include <algorithm>
#include <cstring>
#include <optional>
#include <string>

#include "base/geodesy/gdal.h"

namespace emscape::scenario {

/// In the scope and thread of this object, suppresses GDAL's output and stores the first line of its first
/// failure. It also prevents downloads: a GML file names its schema by URL, a GeoJSON file its coordinate
/// system, and any file may name others by /vsicurl/http://... .
class GdalMessages {
 public:
  GdalMessages() {
    CPLPushErrorHandlerEx(&GdalMessages::take, this);
    CPLHTTPPushFetchCallback(&GdalMessages::refuseFetch, nullptr);
    const char* const outer = CPLGetThreadLocalConfigOption(kAllowedAddress, nullptr);
    if (outer != nullptr) allowed_outside_ = outer;
    CPLSetThreadLocalConfigOption(kAllowedAddress, "none");
  }
  ~GdalMessages() {
    CPLSetThreadLocalConfigOption(kAllowedAddress, allowed_outside_ ? allowed_outside_->c_str() : nullptr);
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
    // Addresses of this process tell nothing.
    const std::size_t address = self->first_failure_.find("0x");
    if (address != std::string::npos) {
      const std::size_t end = self->first_failure_.find_first_not_of("0123456789abcdefABCDEF", address + 2);
      self->first_failure_.replace(address, std::min(end, self->first_failure_.size()) - address, "the file");
    }
    // PROJ repeats the whole query of a database that it cannot read.
    if (self->first_failure_.find("SQLite error on SELECT") != std::string::npos)
      self->first_failure_ = "PROJ: its database proj.db cannot be read";
  }

  static CPLHTTPResult* refuseFetch(const char*, CSLConstList, GDALProgressFunc, void*, CPLHTTPFetchWriteFunc,
                                    void*, void*) {
    auto* const result = static_cast<CPLHTTPResult*>(CPLCalloc(1, sizeof(CPLHTTPResult)));
    result->nStatus = 1;
    result->pszErrBuf = CPLStrdup("files are read without the network");
    return result;
  }

  /// The option that names the only file that GDAL's virtual file systems of the network open.
  static constexpr const char* kAllowedAddress = "CPL_VSIL_CURL_ALLOWED_FILENAME";

  std::string first_failure_;
  std::optional<std::string> allowed_outside_;  ///< by an outer scope
};

}  // namespace emscape::scenario
