/// What the connections of one caster share. Everything in here but the counts is the caster thread's alone.
#pragma once

#include <atomic>
#include <boost/asio/ip/tcp.hpp>
#include <functional>
#include <set>
#include <string>

#include "wire/ntrip/ntrip_caster.hpp"

namespace skyloop::inline wire {

class CasterSession;

struct CasterCore {
    explicit CasterCore(NtripCasterSettings given) : settings(std::move(given)) {}

    NtripCasterSettings settings;
    std::set<CasterSession*> streaming{};  ///< that hear corrections
    int asking = 0;                        ///< all others
    std::function<void()> make_room{};     ///< called when one of them has gone
    std::atomic<std::uint64_t> clients{0}, served{0}, refused{0}, slow{0}, bytes{0};

    /// The whole source table, as of now.
    [[nodiscard]] std::string table() const;
};

/// Answers a client, and sends it what its mount point has.
void serve_ntrip(CasterCore& core, boost::asio::ip::tcp::socket socket);
/// Hands on what the sources have.
void pump_ntrip(CasterCore& core);

}  // namespace skyloop::inline wire
