/// A caster of NTRIP 1.0 and 2.0.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/bytes.hpp"
#include "base/core/result.hpp"
#include "wire/transport/tcp.hpp"

namespace skyloop::inline wire {

/// What one client of a mount point is sent. On the caster's thread.
class CorrectionsStream {
public:
    virtual ~CorrectionsStream() = default;
    /// What has come since the last call, whole messages alone.
    virtual Bytes take() = 0;
    /// The client has told where it is. @param gga a sentence with a right checksum and a position
    virtual void hear_position(std::string_view gga) = 0;
};

/// What a mount point has to give. On the caster's thread.
class CorrectionsSource {
public:
    virtual ~CorrectionsSource() = default;
    /// Its line of the source table, as of source_line(). @param needs_password clients must show one
    [[nodiscard]] virtual std::string table_line(bool needs_password) const = 0;
    /// For a client that comes; null: there is no room for it now.
    [[nodiscard]] virtual std::unique_ptr<CorrectionsStream> open() = 0;
};

/// Where to listen, what there is, and for whom.
struct NtripCasterSettings {
    TcpAddress address;
    std::map<std::string, std::string> users{};  ///< passwords by names; empty: everybody is served
    std::map<std::string, std::shared_ptr<CorrectionsSource>> mounts{};
};

struct NtripCasterCounts {
    std::uint64_t clients = 0;  ///< that hear corrections now
    std::uint64_t served = 0;   ///< the same, of all that came
    std::uint64_t refused = 0;  ///< requests: malformed, too slow, of no mount point, without a right password
    std::uint64_t slow = 0;     ///< clients that were dropped: they read too slowly
    std::uint64_t bytes = 0;    ///< of corrections, once for each client
};

/// A server on a thread of its own. At most 200 clients hear corrections at once, and 64 others may be asking, with
/// 8 kB and 10 s for a request; more wait to be let in. A client for whom more than 64 kB wait is dropped.
class NtripCaster {
public:
    static constexpr int most_clients = 200, most_asking = 64;
    static constexpr std::size_t most_waiting_bytes = 65536;

    /// Listens when it returns. Fails with `outside` and a sentence that begins with "caster".
    static Result<std::unique_ptr<NtripCaster>> start(NtripCasterSettings settings);
    /// Hangs up on everybody.
    ~NtripCaster();
    NtripCaster(const NtripCaster&) = delete;
    NtripCaster& operator=(const NtripCaster&) = delete;

    /// A source has something new. From any thread; never waits.
    void wake();
    /// The port is never 0.
    [[nodiscard]] const TcpAddress& address() const;
    /// Only programs of this machine can connect.
    [[nodiscard]] bool loopback() const;
    [[nodiscard]] NtripCasterCounts counts() const;

private:
    class Impl;
    explicit NtripCaster(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace skyloop::inline wire
