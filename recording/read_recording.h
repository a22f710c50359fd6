/// Reads recordings of other programs.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "emscape/base/progress.h"
#include "recording/common/byte_source.h"
#include "recording/common/read_options.h"
#include "recording/common/recording.h"

namespace emscape::interop {

/// Reads a recording whose format is told by its content: Tacview's ACMI 2.0 to 2.2 (text, or zipped), DIS in
/// .pcap and .pcapng, in the text logs of KDIS and in Disco's .session. Files are streamed. A file that ends
/// too early is read to its end, which the tally reports, as it does records that cannot be read.
/// @param progress  may be empty; it may throw to stop the reading
/// @throws Error (bad_input) naming the file: it cannot be opened, has another format, or has no object with
/// a position
Recording readRecording(const std::string& file, const ReadOptions& options = {},
                        const ProgressSink& progress = {});

/// The same of bytes that were read from a file.
Recording readRecordingIn(std::string_view bytes, const std::string& file, const ReadOptions& options = {});
/// True if bytes begin as a recording of a known format does.
bool isRecording(std::string_view bytes, const ReadOptions& options = {});

/// Endings of files of recordings, for choosing files: ".acmi", ...; CSV and text logs have no ending of
/// theirs.
const std::vector<std::string>& recordingEndings();
/// The same in a line, ".acmi .pcap ...".
std::string recordingEndingsText();

/// What a file holds, or the recording in it if it is a zip file. @throws Error (bad_input)
std::unique_ptr<ByteSource> openRecording(const std::string& file);

/// One recording of several, on one time axis: epochs are aligned where all have one, else each begins at
/// its own t = 0.
Recording merged(std::vector<Recording> recordings);

}  // namespace emscape::interop
