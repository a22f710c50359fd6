/// The handshake of real-time ACMI: what client and host send before the stream.
#pragma once

#include <string>
#include <string_view>

namespace emscape::interop {

/// Hashes of a password: of its UTF-16LE text. A host accepts either.
/// @see CRC-64/WE (polynomial 42F0E1EBA9EA3693) and CRC-32/ISO-HDLC; lower-case hexadecimal without padding
std::string acmiHash64(const std::string& password);
std::string acmiHash32(const std::string& password);

/// What each side sends. @param password  empty: none
std::string acmiClientHello(const std::string& name, const std::string& password);
std::string acmiHostHello(const std::string& name);

/// Checks what the other side has sent, without the NUL at its end.
/// @return empty, or what is wrong with it
std::string acmiHostFault(std::string_view hello);
std::string acmiClientFault(std::string_view hello, const std::string& password);

}  // namespace emscape::interop
