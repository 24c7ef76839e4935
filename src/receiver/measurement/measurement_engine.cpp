#include "receiver/measurement/measurement_engine.hpp"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "detail/signal_channel.hpp"
#include "world/gnss/constants.hpp"

namespace skyloop::inline receiver {
namespace {

constexpr MetresPerSecond slowest_motion{1};  // that changes the multipath

// The oscillator's departures scaled by its term; nothing when it is switched off.
std::optional<ReceiverClock> clock_of(const MeasurementParameters& parameters, std::uint64_t seed) {
    const double factor = parameters.receiver_clock.factor();
    if (factor == 0) return std::nullopt;
    ReceiverClockParameters clock = parameters.clock;
    clock.noise.h0 *= factor * factor;
    clock.noise.h_minus_2 *= factor * factor;
    clock.bias = clock.bias * factor;
    clock.drift = clock.drift * factor;
    clock.temperature.per_kelvin *= factor;
    return ReceiverClock(clock, parameters.receiver_clock.stream(seed, "receiver_clock"));
}

const SignalArrival* find_signal(const Arrival& arrival, Signal signal) {
    const auto* found = std::find_if(arrival.signals.begin(), arrival.signals.end(),
                                     [signal](const SignalArrival& s) { return s.signal == signal; });
    return found == arrival.signals.end() ? nullptr : found;
}

}  // namespace

class MeasurementEngine::Channels {
public:
    Channels(const MeasurementParameters& parameters, std::uint64_t seed)
        : parameters_(parameters), seed_(seed), clock_(clock_of(parameters, seed)) {}

    Measurement measure(const Arrivals& arrivals, GpsTime time, const ReceiverSettings& settings) {
        follow_restarts(settings);
        Measurement result;
        ChannelEpoch epoch = begin_epoch(arrivals, time, result);
        result.observations.signals.reserve(channels_.size());
        result.terms.signals.reserve(channels_.size());
        for (const Arrival& arrival : arrivals.satellites) {
            track(arrival, epoch, settings);
            collect(arrival, epoch, result);
        }
        for (SignalChannel& channel : channels_)
            if (!channel.visited_at(time)) channel.miss(epoch);
        if (!found_ && !result.observations.signals.empty()) found_ = time;
        last_ = time;
        return result;
    }

private:
    using Key = std::pair<SatelliteId, Signal>;
    static Key key_of(const SignalChannel& channel) { return {channel.satellite(), channel.signal()}; }

    std::vector<SignalChannel>::iterator at_or_after(const Key& key) {
        return std::lower_bound(channels_.begin(), channels_.end(), key,
                                [](const SignalChannel& channel, const Key& k) { return key_of(channel) < k; });
    }

    SignalChannel& channel_of(SatelliteId satellite, Signal signal) {
        const Key key{satellite, signal};
        auto place = at_or_after(key);
        if (place == channels_.end() || key_of(*place) != key)
            place = channels_.emplace(place, parameters_, seed_, satellite, signal);
        return *place;
    }

    void follow_restarts(const ReceiverSettings& settings) {
        if (last_ && settings.restarts == restarts_) return;
        restarts_ = settings.restarts;
        start_ = settings.start;
        found_.reset();
        for (SignalChannel& channel : channels_)
            channel.forget();
    }

    // Brings the clock to this instant, and says what every channel needs to know of it.
    ChannelEpoch begin_epoch(const Arrivals& arrivals, GpsTime time, Measurement& result) {
        const Seconds passed = last_ ? std::max(difference(time, *last_), Seconds(0)) : Seconds(0);
        ChannelEpoch epoch{parameters_, time, passed, arrivals.antenna_speed > slowest_motion, {}, {}, {}, start_};
        const bool settled = found_ && difference(time, *found_) >= parameters_.acquisition.settled_after;
        if (settled) epoch.knowledge = StartKind::hot;
        if (!steps_ || steps_since_last_ != passed) {
            steps_ = noise_steps(parameters_, passed);
            steps_since_last_ = passed;
        }
        epoch.steps = *steps_;
        if (clock_) {
            const int jumped = clock_->jumped_milliseconds();
            clock_->advance(passed);
            result.observations.clock_was_set = clock_->jumped_milliseconds() != jumped;
            epoch.clock_bias = clock_->bias();
            epoch.clock_drift = clock_->drift();
        }
        result.terms.clock_bias = epoch.clock_bias;
        result.terms.clock_drift = epoch.clock_drift;
        result.observations.receive_time = advanced(time, Seconds(epoch.clock_bias.value() / speed_of_light));
        return epoch;
    }

    void track(const Arrival& arrival, const ChannelEpoch& epoch, const ReceiverSettings& settings) {
        bool leads = true, leader_locked = false;
        for (const SignalArrival& signal : arrival.signals) {
            if (!settings.tracks(arrival.id, signal.signal) || !signal.arrives) continue;
            SignalChannel& channel = channel_of(arrival.id, signal.signal);
            channel.track({arrival, signal, leads || leader_locked, !leads}, epoch);
            if (leads) leader_locked = channel.locked();
            leads = false;
        }
    }

    void collect(const Arrival& arrival, const ChannelEpoch& epoch, Measurement& result) {
        for (auto c = at_or_after({arrival.id, Signal{}}); c != channels_.end() && c->satellite() == arrival.id; ++c) {
            const SignalArrival* signal = find_signal(arrival, c->signal());
            if (!signal || !c->visited_at(epoch.now) || !c->locked()) continue;
            result.observations.signals.push_back(c->observation({arrival, *signal}, epoch));
            result.terms.signals.push_back(c->terms());
        }
    }

    MeasurementParameters parameters_;
    std::uint64_t seed_;
    std::optional<ReceiverClock> clock_;
    std::vector<SignalChannel> channels_;  // ascending by satellite, then signal
    std::optional<GpsTime> last_;
    std::optional<GpsTime> found_;  // when the first signal was, since the start
    StartKind start_ = StartKind::hot;
    int restarts_ = 0;
    std::optional<NoiseSteps> steps_;
    Seconds steps_since_last_;
};

MeasurementEngine::MeasurementEngine(const MeasurementParameters& parameters, std::uint64_t seed)
    : channels_(std::make_unique<Channels>(parameters, seed)) {}
MeasurementEngine::~MeasurementEngine() = default;
MeasurementEngine::MeasurementEngine(MeasurementEngine&&) noexcept = default;
MeasurementEngine& MeasurementEngine::operator=(MeasurementEngine&&) noexcept = default;

Measurement MeasurementEngine::measure(const Arrivals& arrivals, GpsTime time, const ReceiverSettings& settings) {
    return channels_->measure(arrivals, time, settings);
}

}  // namespace skyloop::inline receiver
