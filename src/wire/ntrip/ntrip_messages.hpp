/// What clients ask casters, and how the text of a request is read and written: no sockets.
///
/// NTRIP 2.0 (RTCM 10410.1) is HTTP/1.1 with the header Ntrip-Version; NTRIP 1.0 (RTCM 10410.0) is like HTTP/1.0, but
/// for answers that begin with "ICY 200 OK" or "SOURCETABLE 200 OK".
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "wire/ntrip/ntrip_address.hpp"

namespace skyloop::inline wire {

/// A caster takes no longer head of a request, a client none of an answer.
inline constexpr std::size_t longest_ntrip_head = 8192;

/// Base 64 (RFC 4648, section 4).
std::string base64(std::string_view bytes);
/// Nothing for a text that is none.
std::optional<std::string> base64_decoded(std::string_view text);

/// What a client sends. @param version 1 or 2
/// @param mount empty: the source table
/// @param gga where it is, without the end of the line; empty: unknown, and not sent in version 1 at all
std::string ntrip_request_text(const NtripAddress& address, std::string_view mount, int version, std::string_view gga);

/// What a caster is asked.
struct NtripRequest {
    std::string method;          ///< "GET"
    std::string mount;           ///< without "/"; empty: the source table
    int version = 1;             ///< of NTRIP, 1 or 2
    bool chunked = false;        ///< HTTP/1.1, which an answer without an end needs chunks for
    std::string user, password;  ///< of the header Authorization; empty: it has none
    std::string gga;             ///< of the header Ntrip-GGA; empty: it is not there
};
/// Reads the head of a request, the empty line at its end included. Nothing for what is no request in HTTP.
std::optional<NtripRequest> parse_ntrip_request(std::string_view head);

/// What a caster says first; the source table and what a refusal says follow in it.
std::string ntrip_stream_answer(const NtripRequest& request);
std::string ntrip_table_answer(const NtripRequest& request, std::string_view table);
/// Of an unknown mount point: of version 1 the source table, of version 2 "404 Not Found".
std::string ntrip_missing_answer(const NtripRequest& request, std::string_view table);
/// "401 Unauthorized".
std::string ntrip_password_answer(const NtripRequest& request);
/// Any other. @param status of HTTP @param reason of HTTP, "Bad Request"
std::string ntrip_refusal(int status, std::string_view reason, std::string_view sentence);
/// A chunk (RFC 9112, section 7.1). @param bytes not empty
std::string ntrip_chunk(std::string_view bytes);

/// As long for a wrong secret as for the right one, wherever the first difference stands.
bool same_password(std::string_view given, std::string_view wanted);

/// A line that is a GGA sentence with a right checksum and a position, as clients tell where they are.
bool is_position_sentence(std::string_view line);

}  // namespace skyloop::inline wire
