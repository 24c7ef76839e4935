#include "run/output/rtcm_writer.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <iterator>
#include <memory>
#include <optional>
#include <set>
#include <utility>

#include "firmware/messages/field_values.hpp"
#include "firmware/messages/rtcm_observations.hpp"
#include "receiver/protocol/rtcm3.hpp"
#include "receiver/protocol/rtcm3_descriptors.hpp"
#include "receiver/protocol/rtcm3_ephemeris.hpp"
#include "receiver/protocol/rtcm3_signals.hpp"
#include "world/gnss/orbit.hpp"

namespace skyloop::inline run {
namespace {

constexpr std::array msm_systems_in_order{Constellation::gps,  Constellation::glonass, Constellation::galileo,
                                          Constellation::sbas, Constellation::qzss,    Constellation::beidou,
                                          Constellation::navic};

// Comes at the first epoch and then at the first in each period of GPS time.
class Cadence {
public:
    explicit Cadence(std::int64_t seconds) : seconds_(seconds) {}
    bool due(GpsTime now) {
        if (seconds_ == 0) return false;
        const std::int64_t period = now.time_since_epoch() / std::chrono::seconds(seconds_);
        return std::exchange(last_, period) != period;
    }

private:
    std::int64_t seconds_;
    std::optional<std::int64_t> last_;
};

// What the messages of one epoch are made from, copied out of the loop.
struct RtcmRecord {
    Observations observations;
    int leap_seconds = 18;
    MetresPerSecond clock_drift{0};
    bool station_due = false;
    Position<Ecef> antenna;
    GpsTime now;
    std::vector<Ephemeris> ephemerides;
};

class RtcmWriter {
public:
    RtcmWriter(const OutputSettings& settings, const WriterSources& sources)
        : settings_(settings), sources_(sources), stations_(settings.every_s), records_(settings.ephemerides_s) {}

    // On the loop's thread.
    RtcmRecord note(const EpochSeen& seen) {
        const firmware::NavigationState& state = seen.reported;
        RtcmRecord record;
        record.observations = state.epoch.observations;
        record.leap_seconds = state.epoch.fix.leap_seconds;
        record.clock_drift = state.epoch.fix.clock_drift;
        record.antenna = seen.trace.truth.position;
        record.now = seen.trace.truth.time;
        record.station_due = stations_.due(record.now);
        if (!record.observations.signals.empty() && records_.due(record.now)) record.ephemerides = observed(record);
        return record;
    }

    // On the output's thread.
    [[nodiscard]] std::vector<Bytes> told(const RtcmRecord& record) const {
        const firmware::RtcmEpoch epoch{record.observations, record.leap_seconds, record.clock_drift,
                                        settings_.station};
        std::vector<Bytes> frames;
        if (record.station_due)
            frames = station_frames({settings_.station, record.antenna, sources_.version,
                                     firmware::has_msm_signals(epoch, Constellation::glonass)});
        std::ranges::move(observation_frames(epoch, settings_.msm), std::back_inserter(frames));
        for (const Ephemeris& ephemeris : record.ephemerides)
            if (Bytes frame = encode_ephemeris(ephemeris, record.now); !frame.empty()) frames.push_back(frame);
        return frames;
    }

private:
    // As they are broadcast just now; almanacs as the ephemerides that they come to.
    [[nodiscard]] std::vector<Ephemeris> observed(const RtcmRecord& record) const {
        std::set<SatelliteId> satellites;
        for (const Observation& o : record.observations.signals)
            satellites.insert(o.satellite);
        std::vector<Ephemeris> found;
        for (const SatelliteId satellite : satellites) {
            auto one =
                sources_.broadcast == nullptr ? std::nullopt : sources_.broadcast->ephemeris(satellite, record.now);
            if (one && message_of(*one) == NavigationMessage::almanac)
                one = ephemeris_of_almanac(std::get<KeplerEphemeris>(*one), record.now);
            if (one) found.push_back(*one);
        }
        return found;
    }

    const OutputSettings settings_;
    const WriterSources sources_;
    Cadence stations_, records_;
};

}  // namespace

std::vector<Bytes> station_frames(const BaseStation& base) {
    std::vector<Bytes> frames;
    Rtcm3Station station;
    station.station = base.number;
    for (std::size_t i = 0; i < 3; ++i)
        station.position[i] = std::llround(base.antenna.vector()[static_cast<Eigen::Index>(i)] * 1e4);
    station.antenna_height = 0;
    station.computed = base.computed;
    frames.push_back(encode(station));
    const std::string no_model = "ADVNULLANTENNA";  // as rcvr_ant.tab of the IGS calls it
    for (const int number : {1008, 1033})
        frames.push_back(encode(Rtcm3Descriptors{number, base.number, no_model, 0, "", "SKYLOOP", base.version, ""}));
    if (!base.glonass) return frames;
    Rtcm3GlonassBiases biases;
    biases.station = base.number;
    biases.aligned = true;
    biases.bias[0] = biases.bias[2] = 0;  // of L1 C/A and L2 C/A, the signals that are observed
    frames.push_back(encode(biases));
    return frames;
}

std::vector<Bytes> observation_frames(const firmware::RtcmEpoch& epoch, int kind) {
    std::vector<Constellation> systems;
    for (const Constellation system : msm_systems_in_order)
        if (firmware::has_msm_signals(epoch, system)) systems.push_back(system);
    std::vector<Bytes> frames;
    for (const Constellation system : systems)
        std::ranges::move(firmware::msm_frames(epoch, msm_number(system, kind), system != systems.back()),
                          std::back_inserter(frames));
    return frames;
}

EpochWriter make_rtcm_writer(const OutputSettings& settings, const WriterSources& sources) {
    return [writer = std::make_shared<RtcmWriter>(settings, sources)](const EpochSeen& seen, const std::string&,
                                                                      std::uint64_t) -> EpochJob {
        if (!seen.leaves || !seen.reported.time.time) return [] { return std::vector<Bytes>{}; };
        return [writer, record = writer->note(seen)] { return writer->told(record); };
    };
}

}  // namespace skyloop::inline run
