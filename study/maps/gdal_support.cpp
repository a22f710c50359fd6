#include "study/maps/gdal_support.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>

#include "base/files/descriptor.h"
#include "base/files/own_file.h"
#include "base/geodesy/gdal_file.h"
#include "emscape/base/error.h"
#include "emscape/base/work.h"

namespace emscape::study {
namespace {

/// Why a file beside this one cannot be written: the libraries below GDAL (HDF5) lose the system's reason.
/// 0: it can be, or a trial is not possible.
int causeOfFailedWriting(const std::filesystem::path& file) {
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
  const Descriptor trial(::open(folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0600));
  if (!trial.isOpen()) return errno == ENOSPC || errno == EDQUOT || errno == EROFS ? errno : 0;
  const std::string bytes(std::size_t{1} << 16, '\1');
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t written = ::write(trial.number(), bytes.data() + done, bytes.size() - done);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return errno;
    done += static_cast<std::size_t>(written);
  }
  return 0;
}

}  // namespace

GDALDriverH driverOf(const char* name) {
  gdal::prepare();
  GDALDriverH driver = GDALGetDriverByName(name);
  if (driver == nullptr) throw Error(ErrorCode::other, fmt::format("GDAL has no driver '{}'", name));
  return driver;
}

void failWriting(const scenario::GdalMessages& messages, const std::filesystem::path& file) {
  int cause = errno;
  checkpoint();
  std::string text = messages.explain("cannot be written");
  // The SQL statement that failed tells nothing.
  const std::string after = ") failed: ";
  const std::size_t begin = text.find("sqlite3_"), end = text.rfind(after);
  if (begin < end && end != std::string::npos) text.erase(begin, end + after.size() - begin);
  // GDAL does not always say why.
  const bool is_limit = cause == EMFILE || cause == ENFILE || cause == ENOSPC || cause == EDQUOT;
  if (messages.hasFailure() || !is_limit) cause = causeOfFailedWriting(file);
  if (cause != 0 && text.find(causeOf(cause)) == std::string::npos) text += ": " + causeOf(cause);
  throw Error(ErrorCode::other, file.string() + ": " + text);
}

int goesOn(double /*done*/, const char* /*message*/, void* /*data*/) {
  return currentWork() == nullptr || !currentWork()->isStopped() ? TRUE : FALSE;
}

void requireOwnBeside(const std::filesystem::path& file) {
  for (const char* const ending : {kAuxiliary, ".ovr", ".msk", "-wal", "-journal", "-shm"})
    requireOwn(file.string() + ending);
}

gdal::Dataset memoryRaster(const MapGrid& grid, GDALDataType type, const std::filesystem::path& file) {
  const scenario::GdalMessages messages;
  gdal::Dataset dataset(GDALCreate(driverOf("MEM"), "", grid.width, grid.height, 1, type, nullptr));
  if (dataset == nullptr) failWriting(messages, file);
  double transform[6] = {grid.left_m, grid.cell_m, 0, grid.top_m, 0, -grid.cell_m};
  if (GDALSetGeoTransform(dataset.get(), transform) != CE_None ||
      GDALSetProjection(dataset.get(), grid.wkt.c_str()) != CE_None)
    failWriting(messages, file);
  return dataset;
}

std::string wkt2Of(OGRSpatialReferenceH reference) {
  static const char* const kOptions[] = {"FORMAT=WKT2_2019", nullptr};
  char* text = nullptr;
  const OGRErr failed = OSRExportToWktEx(reference, &text, kOptions);
  std::string wkt = text == nullptr ? "" : text;
  CPLFree(text);
  if (failed != OGRERR_NONE || wkt.empty())
    throw Error(ErrorCode::other, "PROJ gives no text of a coordinate system");
  return wkt;
}

gdal::SpatialReference referenceOf(const MapGrid& grid) {
  gdal::SpatialReference reference(OSRNewSpatialReference(grid.wkt.c_str()));
  OSRSetAxisMappingStrategy(reference.get(), OAMS_TRADITIONAL_GIS_ORDER);
  return reference;
}

}  // namespace emscape::study
