/// Whom a client of NTRIP calls, as a user types it.
///
/// The folder ntrip is how corrections come and go over the Internet: NTRIP 1.0 (RTCM 10410.0) and 2.0 (RTCM 10410.1).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "base/core/result.hpp"
#include "wire/transport/tcp.hpp"

namespace skyloop::inline wire {

/// The port that IANA has given to casters, and that of casters with TLS.
inline constexpr std::uint16_t ntrip_port = 2101, ntrips_port = 2102;

/// A mount point of a caster, and who asks for it.
struct NtripAddress {
    TcpAddress caster{"127.0.0.1", ntrip_port};
    std::string mount;           ///< its name, without "/"
    std::string user, password;  ///< both empty: nobody in particular
    bool tls = false;
};

/// Reads "ntrip://[USER[:PASSWORD]@]HOST[:PORT]/MOUNT", or ntrips:// with TLS. User, password and mount point may have
/// %XX for any byte (RFC 3986, section 2.1). Fails with `usage` and a sentence that quotes the text without user and
/// password.
Result<NtripAddress> parse_ntrip_uri(std::string_view text);

/// "ntrip://127.0.0.1:2101/BASE": never user or password.
std::string shown_uri(const NtripAddress& address);
/// A URI as it may be shown: without user and password, whatever else it is.
std::string without_secrets(std::string_view uri);

}  // namespace skyloop::inline wire
