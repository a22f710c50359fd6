#include "base/files/file_reading.h"

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <iterator>
#include <system_error>

#include "base/files/descriptor.h"
#include "base/files/inputs.h"
#include "base/large_array.h"
#include "emscape/base/error.h"

namespace emscape {
namespace fs = std::filesystem;
namespace {

/// @tparam Bytes  a container of bytes that can be resized
template <class Bytes>
Bytes readAll(const fs::path& path, std::uintmax_t max_bytes) {
  const auto fail = [&](const std::string& cause) {
    throw Error(ErrorCode::bad_input, {path.string()}, cause);
  };
  if (!inputExists(path)) fail("there is no such file");
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::is_directory(status)) fail("cannot read: it is a folder");
  if (!fs::is_regular_file(status)) fail("cannot read: it is not a regular file");
  errno = 0;
  std::ifstream stream(path, std::ios::binary);
  if (!stream) fail("cannot read: " + causeOf(errno));
  const std::uintmax_t size = fs::file_size(path, error);
  if (error) fail("cannot read: " + error.message());
  if (size > max_bytes) {
    fail("is " + std::to_string(size) + " bytes large, more than the allowed " + std::to_string(max_bytes));
  }
  Bytes bytes;
  bytes.reserve(static_cast<std::size_t>(size));
  ByteCheckpoints checkpoints;
  for (std::size_t done = 0; done < size;) {
    const std::size_t part = std::min(static_cast<std::size_t>(size) - done, ByteCheckpoints::kBytes / 8);
    bytes.resize(done + part);
    stream.read(reinterpret_cast<char*>(bytes.data()) + done, static_cast<std::streamsize>(part));
    if (static_cast<std::size_t>(stream.gcount()) != part) fail("cannot read: it ended early");
    done += part;
    checkpoints.add(part);
  }
  return bytes;
}

}  // namespace

bool inputExists(const fs::path& path) {
  std::error_code failure;
  const fs::file_status status = fs::status(path, failure);
  if (status.type() == fs::file_type::none)
    throw Error(ErrorCode::bad_input, {path.string()}, "cannot read: " + failure.message());
  return fs::exists(status);
}

std::vector<fs::directory_entry> entriesOf(const fs::path& folder) {
  std::error_code failure;
  std::vector<fs::directory_entry> entries;
  for (fs::directory_iterator at(folder, failure); !failure && at != fs::directory_iterator();
       at.increment(failure))
    entries.push_back(*at);
  if (failure) throw Error(ErrorCode::bad_input, {folder.string()}, "cannot read: " + failure.message());
  return entries;
}

std::vector<std::uint8_t> readWhole(const fs::path& path, std::uintmax_t max_bytes) {
  return readAll<std::vector<std::uint8_t>>(path, max_bytes);
}

std::string readWholeText(const fs::path& path, std::uintmax_t max_bytes) {
  return readAll<std::string>(path, max_bytes);
}

std::string readTextOrPipe(const fs::path& path) {
  std::error_code ignored;
  const fs::file_status status = fs::status(path, ignored);
  if (!fs::is_fifo(status) && !fs::is_character_file(status) && !fs::is_socket(status))
    return readWholeText(path);
  errno = 0;
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw Error(ErrorCode::bad_input, {path.string()}, "cannot read: " + causeOf(errno));
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

}  // namespace emscape
