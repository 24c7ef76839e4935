/// Virtual reference stations: corrections for each client from a place beside its own.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "run/emulator/virtual_sky.hpp"
#include "wire/ntrip/ntrip_caster.hpp"
#include "wire/ntrip/source_table.hpp"

namespace skyloop::inline run {

/// The virtual stations of a run, one for each client of its mount points. A client is sent nothing until a GGA
/// sentence of it tells a place; from the next whole second of GPS time on its station observes, at 1 Hz. The station
/// stays where it is until the client tells a place that is farther than `reach` from the one by which it was chosen:
/// then another one begins, of another number.
///
/// The thread of the caster brings clients and places, that of the loop observes; neither holds the lock for longer
/// than a copy. What the receivers of the run do does not depend on any of it: nothing that has state is theirs, too.
///
/// State: the clients, their stations, and the number of the newest.
class VirtualStations : public std::enable_shared_from_this<VirtualStations> {
public:
    static constexpr std::size_t most_clients = 16;  ///< at once, of all mount points
    static constexpr Metres reach{5000};
    static constexpr std::int64_t station_every_s = 10;  ///< place, antenna and receiver are told

    /// @param version of skyloop, as the stations' firmware
    /// @param seed of the run's receivers; the stations have others
    VirtualStations(VirtualSky sky, std::uint64_t seed, std::string version)
        : sky_(std::move(sky)), seed_(seed), version_(std::move(version)) {}

    /// A mount point. Clients that come when there are most_clients find no room.
    /// @param about name, identifier and place of its record @param msm kind of the observations, 4 … 7
    std::shared_ptr<CorrectionsSource> mount(SourceRecord about, int msm);

    /// What is due by now, at most a station or two at a time, so that nobody waits for all of them; those that lag by
    /// half a second are all due. By the thread of the loop, as often as it comes round.
    /// @return whether there is something new for a client
    bool look(GpsTime now);

private:
    class Mount;
    class Stream;
    // What a mount point and its clients share.
    struct Terms {
        int msm = 7;
        std::atomic<int> bit_rate{0};  // of the newest epoch of any, without what comes now and then
    };
    struct Client {
        std::shared_ptr<Terms> terms;
        std::optional<ClientPlace> place{};
        Bytes waiting{};
    };
    struct Station {
        std::shared_ptr<Client> client;
        std::uint16_t number = 0;
        Position<Ecef> chosen_for;  // where the client was
        std::unique_ptr<VirtualAntenna> antenna;
        GpsTime begun;
        GpsTime last;                              // second that it has observed, or in which it began
        std::optional<std::int64_t> told_in = {};  // period of station_every_s
    };
    std::unique_ptr<CorrectionsStream> join(const std::shared_ptr<Terms>& terms);
    void leave(const std::shared_ptr<Client>& client);
    void hear(Client& client, const ClientPlace& place);
    Bytes take(Client& client);

    void follow_clients(GpsTime second);
    [[nodiscard]] bool serve(const std::shared_ptr<Client>& client, const ClientPlace& place, GpsTime second);
    [[nodiscard]] std::uint16_t free_number();
    void observe(Station& station, GpsTime second);

    const VirtualSky sky_;
    const std::uint64_t seed_;
    const std::string version_;

    std::mutex mutex_;
    std::vector<std::shared_ptr<Client>> clients_;  // and all that is in them but `terms`
    std::atomic<bool> changed_{false};

    // Of the loop.
    std::vector<Station> stations_;
    std::uint16_t newest_ = 0;
};

}  // namespace skyloop::inline run
