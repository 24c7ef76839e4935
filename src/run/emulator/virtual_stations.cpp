#include "run/emulator/virtual_stations.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "base/core/bytes.hpp"
#include "base/time/utc_time.hpp"
#include "run/output/rtcm_writer.hpp"

namespace skyloop::inline run {
namespace {

constexpr std::uint16_t last_number = 4095;                   // of DF003, 12 bits
constexpr std::size_t most_waiting = std::size_t{64} << 10U;  // for a client, until the caster takes it
constexpr Nanoseconds patience = std::chrono::milliseconds(500);

GpsTime whole_second(GpsTime time) {
    return GpsTime(std::chrono::floor<std::chrono::seconds>(time.time_since_epoch()));
}

}  // namespace

class VirtualStations::Mount : public CorrectionsSource {
public:
    Mount(std::shared_ptr<VirtualStations> stations, SourceRecord about, int msm)
        : stations_(std::move(stations)), about_(std::move(about)) {
        terms_->msm = msm;
    }
    [[nodiscard]] std::string table_line(bool needs_password) const override {
        SourceRecord record = about_;
        record.needs_password = needs_password;
        record.bit_rate = terms_->bit_rate;
        return source_line(record);
    }
    [[nodiscard]] std::unique_ptr<CorrectionsStream> open() override { return stations_->join(terms_); }

private:
    const std::shared_ptr<VirtualStations> stations_;
    const SourceRecord about_;
    const std::shared_ptr<Terms> terms_ = std::make_shared<Terms>();
};

class VirtualStations::Stream : public CorrectionsStream {
public:
    Stream(std::shared_ptr<VirtualStations> stations, std::shared_ptr<Client> client)
        : stations_(std::move(stations)), client_(std::move(client)) {}
    Stream(const Stream&) = delete;
    Stream& operator=(const Stream&) = delete;
    ~Stream() override { stations_->leave(client_); }

    Bytes take() override { return stations_->take(*client_); }
    void hear_position(std::string_view gga) override {
        if (const auto place = client_place(gga)) stations_->hear(*client_, *place);
    }

private:
    std::shared_ptr<VirtualStations> stations_;
    std::shared_ptr<Client> client_;
};

std::shared_ptr<CorrectionsSource> VirtualStations::mount(SourceRecord about, int msm) {
    about.wants_position = about.network = true;
    return std::make_shared<Mount>(shared_from_this(), std::move(about), msm);
}

std::unique_ptr<CorrectionsStream> VirtualStations::join(const std::shared_ptr<Terms>& terms) {
    const std::lock_guard lock(mutex_);
    if (clients_.size() >= most_clients) return nullptr;
    clients_.push_back(std::make_shared<Client>(Client{terms}));
    return std::make_unique<Stream>(shared_from_this(), clients_.back());
}

void VirtualStations::leave(const std::shared_ptr<Client>& client) {
    const std::lock_guard lock(mutex_);
    std::erase(clients_, client);
    changed_ = true;
}

void VirtualStations::hear(Client& client, const ClientPlace& place) {
    const std::lock_guard lock(mutex_);
    client.place = place;
    changed_ = true;
}

Bytes VirtualStations::take(Client& client) {
    const std::lock_guard lock(mutex_);
    return std::exchange(client.waiting, {});
}

bool VirtualStations::look(GpsTime now) {
    const GpsTime second = whole_second(now);
    if (changed_.exchange(false)) follow_clients(second);
    bool any = false;
    for (Station& station : stations_) {
        if (station.last >= second) continue;
        if (any && now - second < patience) break;  // the next look comes soon
        observe(station, second);
        any = true;
    }
    return any;
}

void VirtualStations::follow_clients(GpsTime second) {
    std::vector<std::pair<std::shared_ptr<Client>, std::optional<ClientPlace>>> told;
    {
        const std::lock_guard lock(mutex_);
        for (const auto& client : clients_)
            told.emplace_back(client, client->place);
    }
    std::erase_if(stations_, [&](const Station& station) {
        return std::none_of(told.begin(), told.end(), [&](const auto& one) { return one.first == station.client; });
    });
    for (const auto& [client, place] : told)
        if (place && serve(client, *place, second)) {
            changed_ = true;  // others may be waiting: with the next look
            return;
        }
}

// Whether a station begins.
bool VirtualStations::serve(const std::shared_ptr<Client>& client, const ClientPlace& place, GpsTime second) {
    const auto known = std::find_if(stations_.begin(), stations_.end(),
                                    [&](const Station& station) { return station.client == client; });
    const Geodetic there = on_ellipsoid(place, sky_.geoid());
    const Position<Ecef> point = to_ecef(there);
    if (known != stations_.end() && (point - known->chosen_for).length() <= reach) return false;
    // A client that is now here and now there costs the loop no more than one station a second.
    if (known != stations_.end() && known->begun == second) {
        changed_ = true;
        return false;
    }
    const std::uint16_t number = free_number();
    auto antenna = sky_.antenna(station_place(there), fnv1a_64(fmt::format("seed {} virtual {}", seed_, number)));
    // What its air is made from has been there at the start; of a file that has gone meanwhile the client hears
    // nothing.
    if (!antenna) return false;
    Station begun{client, number, point, std::move(*antenna), second, second};
    if (known != stations_.end())
        *known = std::move(begun);
    else
        stations_.push_back(std::move(begun));
    return true;
}

std::uint16_t VirtualStations::free_number() {
    do
        newest_ = static_cast<std::uint16_t>(newest_ % last_number + 1);
    while (std::any_of(stations_.begin(), stations_.end(),
                       [this](const Station& station) { return station.number == newest_; }));
    return newest_;
}

void VirtualStations::observe(Station& station, GpsTime second) {
    station.last = second;
    const Observations observations = station.antenna->observe(second);
    const firmware::RtcmEpoch epoch{observations, LeapSeconds::announced().offset(second), MetresPerSecond(0),
                                    station.number};
    std::vector<Bytes> frames;
    const std::int64_t period = second.time_since_epoch() / std::chrono::seconds(station_every_s);
    if (std::exchange(station.told_in, period) != period)
        frames = station_frames({station.number, station.antenna->position(), version_,
                                 firmware::has_msm_signals(epoch, Constellation::glonass), true});
    std::size_t bytes = 0;
    for (Bytes& frame : observation_frames(epoch, station.client->terms->msm)) {
        bytes += frame.size();
        frames.push_back(std::move(frame));
    }
    station.client->terms->bit_rate = static_cast<int>(8 * bytes);
    const std::lock_guard lock(mutex_);
    Bytes& waiting = station.client->waiting;
    if (waiting.size() > most_waiting) waiting.clear();
    for (const Bytes& frame : frames)
        waiting.insert(waiting.end(), frame.begin(), frame.end());
}

}  // namespace skyloop::inline run
