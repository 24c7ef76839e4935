#include "receiver/pvt/augmentation.hpp"

#include <cmath>

#include "world/gnss/constants.hpp"

namespace skyloop::inline receiver {
namespace {

constexpr int enough_served = 4;  // satellites for a position
constexpr int told_iode_bits = 0xFF;
constexpr SkyDirection zenith{Angle(), Angle::degrees(90)};
constexpr Seconds way_of_a_range{0.075};

bool is_of_issue(const Ephemeris& record, int iode) { return (iode_of(record) & told_iode_bits) == iode; }

}  // namespace

void Augmentation::hear(std::span<const Subframe> messages, const ReceiverSettings& settings) {
    for (const Subframe& message : messages)
        if (message.satellite.constellation == Constellation::sbas)
            satellites_[message.satellite].hear(message, settings.sbas_test_mode);
}

// Messages speak of the record before until they have come round (DO-229, A.4.4.7).
void Augmentation::remember_records(const Input& input) {
    std::optional<SatelliteId> last;
    for (const Observation& o : input.observations.signals) {
        if (last == o.satellite || !sbas_mask_slot(o.satellite)) continue;
        last = o.satellite;
        const std::optional<Ephemeris> record = input.received.ephemeris(o.satellite, input.time);
        if (!record) continue;
        Records& known = records_.try_emplace(o.satellite, Records{*record}).first->second;
        if (iode_of(known.current) == iode_of(*record) && toe_of(known.current) == toe_of(*record)) continue;
        known.previous = known.current;
        known.current = *record;
    }
}

int Augmentation::served(const SbasData& data, const Input& input) const {
    if (!data.ionosphere(frame_->origin(), zenith, input.time)) return 0;
    int count = 0;
    for (const auto& [id, records] : records_)
        count += data.correction(id, input.time) ? 1 : 0;
    return count;
}

void Augmentation::begin(const Input& input) {
    time_ = input.time;
    frame_.reset();
    if (satellites_.empty()) return;
    remember_records(input);
    const std::optional<SatelliteId> before = source_;
    source_.reset();
    if (!input.settings.sbas_corrections || !input.place) return;
    frame_.emplace(*input.place);
    int most = enough_served - 1;
    for (const auto& [id, data] : satellites_) {
        const int count = served(data, input);
        if (count > most || (before == id && count >= enough_served)) source_ = id;
        most = std::max(most, count);
        if (source_ == before && before) return;
    }
}

std::optional<Transmitter> Augmentation::moved_to(int iode, const RangeEquation& equation) const {
    const auto known = records_.find(equation.satellite);
    if (known == records_.end()) return std::nullopt;
    const auto& [current, previous] = known->second;
    if (is_of_issue(current, iode)) return equation.transmitter;
    if (!previous || !is_of_issue(*previous, iode)) return std::nullopt;
    // Both are parabolas beside each other: the instant need not be exact.
    const SatelliteState now = satellite_state(current, time_, -way_of_a_range);
    const SatelliteState then = satellite_state(*previous, time_, -way_of_a_range);
    Transmitter moved = equation.transmitter;
    moved.position = Position<Ecef>(moved.position.vector() + then.position.vector() - now.position.vector());
    moved.clock_bias += Seconds(then.clock_bias - now.clock_bias);
    return moved;
}

void Augmentation::correct(RangeEquation& equation) const {
    if (!source_ || !frame_) return;
    const SbasData& data = satellites_.at(*source_);
    const LookAngles look = frame_->look_angles(equation.transmitter.position);
    const auto delay = data.ionosphere(frame_->origin(), {look.azimuth, look.elevation}, time_);
    if (!delay || look.elevation <= Angle()) return;
    const double ratio = carrier_frequency_l1 / equation.carrier.value();
    const Metres ionosphere = *delay * (ratio * ratio);
    equation.pseudorange -= ionosphere;
    equation.grid = ionosphere;
    equation.carrier = Hertz(0);
    const std::optional<SbasCorrection> told = data.correction(equation.satellite, time_);
    if (!told) return;
    auto transmitter = moved_to(told->iode, equation);
    if (!transmitter) return;
    transmitter->position = Position<Ecef>(transmitter->position.vector() + told->orbit_m);
    transmitter->clock_bias += Seconds(told->clock_s);
    equation.transmitter = *transmitter;
    equation.pseudorange += told->range;
    equation.sbas = AppliedSbas{told->udre_index, told->range, ionosphere};
}

}  // namespace skyloop::inline receiver
