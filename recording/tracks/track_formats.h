/// Readers of tracks: files that have positions over time and no emissions.
#pragma once

#include <string>
#include <string_view>

#include "recording/common/byte_source.h"
#include "recording/common/read_options.h"
#include "recording/common/recording.h"

namespace emscape::interop {

/// Each reads a whole file.
/// @param name  of the file, for messages and for objects without a name
/// @throws Error (bad_input) that names the file: another format, or no position with a time

/// GPX 1.0 and 1.1: each <trk>, and each <rte> with times, is an object, each <wpt> a fixed one, <ele> the
/// height above mean sea level.
/// @see https://www.topografix.com/GPX/1/1/
Recording readGpx(ByteSource& source, const std::string& name, const ReadOptions& options);

/// KML 2.2 and 2.3: gx:Track and gx:MultiTrack, placemarks with a point and a time stamp, and points without
/// a time, which are fixed objects. Stamped points of one name are an object; those of a folder that all have
/// names and times of their own are one object, too.
/// @see OGC 12-007r2 and 14-068r2
Recording readKml(ByteSource& source, const std::string& name, const ReadOptions& options);

/// Ephemeris files of STK (stk.v.4 to 12) in fixed axes of the earth; positions between the points are those
/// of the file's interpolation.
Recording readStkEphemeris(ByteSource& source, const std::string& name, const ReadOptions& options);

/// Sentences RMC, GGA, GNS and ZDA of one receiver. @see NMEA 0183
Recording readNmea(ByteSource& source, const std::string& name, const ReadOptions& options);

/// Packets with positions: cartographicDegrees, cartographicRadians and cartesian in fixed axes, constant or
/// sampled. @see https://github.com/AnalyticalGraphicsInc/czml-writer/wiki/CZML-Guide
Recording readCzml(ByteSource& source, const std::string& name, const ReadOptions& options);

/// A table with a line of names. ReadOptions::columns tells which column is what; without it common names are
/// known, among them those of the OpenSky network.
Recording readTrackTable(ByteSource& source, const std::string& name, const ReadOptions& options);

/// True if the begin of a file is that of a table with columns of a position.
bool isTrackTable(std::string_view head, const ReadOptions& options);

}  // namespace emscape::interop
