// Writes the records of four systems as a RINEX file and, as a u-blox receiver hears them, as a UBX log.
#include <cstdio>
#include <fstream>

#include "receiver/measurement/subframe_reception.hpp"
#include "receiver/protocol/ubx_fields.hpp"
#include "receiver/protocol/ubx_satellites.hpp"
#include "support/four_systems.hpp"
#include "world/flow/observations.hpp"
#include "world/rinex/rinex_writer.hpp"

namespace {

using namespace skyloop;

// The records of FourSystems with reference times that the messages can say: whole 8 s of BDT, quarters of UTC.
// Two geostationary satellites are among them.
class Sendable : public test::FourSystems {
public:
    [[nodiscard]] std::vector<SatelliteId> satellites() const override {
        auto all = test::FourSystems::satellites();
        all.push_back({Constellation::beidou, 3});
        all.push_back({Constellation::beidou, 60});
        return all;
    }
    [[nodiscard]] std::optional<Ephemeris> ephemeris(SatelliteId id, GpsTime time) const override {
        auto record = test::FourSystems::ephemeris(is_beidou_geo(id) ? SatelliteId{id.constellation, 14} : id, time);
        if (is_beidou_geo(id)) {
            auto& geostationary = std::get<KeplerEphemeris>(*record);
            geostationary.satellite = id;
            geostationary.sqrt_a = 6493.4;
            geostationary.i0 = 0.09;
        }
        if (auto* kepler = std::get_if<KeplerEphemeris>(&*record)) {
            if (id.constellation == Constellation::beidou) {
                kepler->toe += std::chrono::seconds(14);
                kepler->toc += std::chrono::seconds(14);
                kepler->iode = kepler->iodc = 3;
            }
            kepler->iode %= 256;
            kepler->cuc = 1.2e-6;
            kepler->crs = -31.5;
            kepler->cis = -7.5e-8;
            kepler->omega_dot = -8.1e-9;
            kepler->delta_n = 4.4e-9;
            kepler->idot = -1.1e-10;
        } else if (auto* glonass = std::get_if<GlonassEphemeris>(&*record)) {
            glonass->toe += std::chrono::seconds(18);
        }
        return record;
    }
};

std::uint8_t ubx_system(Constellation c) {
    switch (c) {
        case Constellation::galileo:
            return 2;
        case Constellation::beidou:
            return 3;
        case Constellation::glonass:
            return 6;
        default:
            return 0;
    }
}

void append(Bytes& log, const Bytes& frame) { log.insert(log.end(), frame.begin(), frame.end()); }

Bytes time_frame(GpsTime time) {
    RxmRawx raw;
    raw.rcv_tow = week_and_tow(time).tow_seconds();
    raw.week = static_cast<std::uint16_t>(week_and_tow(time).week);
    raw.leap_s = 18;
    raw.rec_stat = 1;
    raw.version = 1;
    return encode_frame(raw);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 3) return 2;
    const Sendable sent;
    const GpsTime start = to_gps_time(2300, 200000.0 - 100);
    std::vector<Ephemeris> records;
    Observations heard;
    for (const SatelliteId id : sent.satellites()) {
        records.push_back(*sent.ephemeris(id, start));
        Observation o;
        o.satellite = id;
        o.signal = first_signal(id.constellation);
        o.pseudorange = Metres(2.2e7);
        heard.signals.push_back(o);
    }
    SubframeReception reception;
    Bytes log;
    for (int i = 0; i <= 90; ++i) {
        const GpsTime now = start + std::chrono::seconds(i);
        append(log, time_frame(now));
        for (const Subframe& s : reception.receive(heard, sent, now)) {
            RxmSfrbx frame;
            frame.gnss_id = ubx_system(s.satellite.constellation);
            frame.sv_id = static_cast<std::uint8_t>(s.satellite.number);
            frame.sig_id = frame.gnss_id == 2 || is_beidou_geo(s.satellite) ? 1 : 0;
            frame.freq_id = static_cast<std::uint8_t>(s.frequency_channel + 7);
            frame.version = 2;
            frame.words = s.words;
            append(log, encode_frame(frame));
        }
    }
    std::ofstream(argv[1]) << navigation_text(records, {sent.ionosphere(), 18, "subframe_log", start});
    std::ofstream(argv[2], std::ios::binary)
        .write(reinterpret_cast<const char*>(log.data()), static_cast<std::streamsize>(log.size()));
    return 0;
}
