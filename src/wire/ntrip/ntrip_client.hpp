/// Corrections from a caster, whatever becomes of the way there.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/core/bytes.hpp"
#include "wire/ntrip/ntrip_address.hpp"

namespace skyloop::inline wire {

struct NtripClientSettings {
    NtripAddress address;
    std::chrono::seconds position_every{10};  ///< the caster is told where the receiver is; 0: never
    std::uint64_t seed = 1;                   ///< of the pauses between attempts
};

/// What became of it so far.
struct NtripClientCounts {
    bool connected = false;         ///< corrections come, or may
    int version = 0;                ///< of NTRIP that the caster spoke last; 0: none yet
    std::uint64_t bytes = 0;        ///< of corrections
    std::uint64_t bytes_lost = 0;   ///< nobody took them: the run's time stood still
    std::uint64_t connections = 0;  ///< that brought a stream
    double age_s = 0;               ///< since the last bytes, or since the start
};

/// A client on a thread of its own. It speaks NTRIP 2.0, and 1.0 with casters that do not, and calls again when the
/// connection is lost, is refused, or has brought nothing for a minute: after 1 s, 2 s and so on to 60 s, each ±25 %,
/// and from 1 s on again once corrections have come. A TLS caster must show a certificate of its host that the system
/// trusts.
class NtripClient {
public:
    explicit NtripClient(NtripClientSettings settings);
    /// Hangs up.
    ~NtripClient();
    NtripClient(const NtripClient&) = delete;
    NtripClient& operator=(const NtripClient&) = delete;

    /// Calls the caster. Once.
    void start();
    /// What has come since the last call; never waits. At most 64 kB are kept: of more, the oldest are lost.
    Bytes take();
    /// Where the receiver is from now on: a GGA sentence without the end of its line.
    void tell_position(std::string gga);
    [[nodiscard]] bool wants_position() const;
    /// Corrections come, or may.
    [[nodiscard]] bool connected() const;
    [[nodiscard]] NtripClientCounts counts() const;
    /// What has happened since the last call, in sentences: each problem once until it changes.
    std::vector<std::string> take_news();

private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace skyloop::inline wire
