#include "receiver/protocol/rtcm3_legacy.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/core/bytes.hpp"
#include "world/gnss/constants.hpp"

namespace skyloop::inline receiver {
namespace {

constexpr double range_step_m = 0.02, phase_step_of_legacy_m = 0.0005, cno_step_dbhz = 0.25;
constexpr double rollover_cycles = 1500;
constexpr int difference_bits = 14, legacy_phase_bits = 20;
constexpr std::size_t most_legacy_satellites = 31;
constexpr int first_channel = -7;

// What the eight messages differ in.
struct LegacyForm {
    bool glonass, extended, both;
    [[nodiscard]] int epoch_bits() const { return glonass ? 27 : 30; }
    [[nodiscard]] int range_bits() const { return glonass ? 25 : 24; }
    [[nodiscard]] int whole_bits() const { return glonass ? 7 : 8; }
    [[nodiscard]] double modulus_m() const { return speed_of_light * (glonass ? 2e-3 : 1e-3); }
};
std::optional<LegacyForm> legacy_form(int number) {
    const bool gps = number >= 1001 && number <= 1004, glonass = number >= 1009 && number <= 1012;
    if (!gps && !glonass) return std::nullopt;
    const int place = number - (glonass ? 1009 : 1001);
    return LegacyForm{glonass, place % 2 == 1, place >= 2};
}

// Lock times by their indicators (table 3.4-2): from `first` on one more is `step` seconds more.
struct LockRow {
    int first, step, seconds;
};
constexpr std::array<LockRow, 6> lock_rows{
    {{0, 1, 0}, {24, 2, 24}, {48, 4, 72}, {72, 8, 168}, {96, 16, 360}, {120, 32, 744}}};
constexpr int longest_lock = 127, longest_lock_s = 937;

double lock_of_indicator(int indicator) {
    if (indicator >= longest_lock) return longest_lock_s;
    double seconds = 0;
    for (const LockRow& row : lock_rows)
        if (indicator >= row.first) seconds = row.seconds + row.step * (indicator - row.first);
    return seconds;
}
int indicator_of_lock(double seconds) {
    if (seconds >= longest_lock_s) return longest_lock;
    int indicator = 0;
    for (const LockRow& row : lock_rows)
        if (seconds >= row.seconds) indicator = row.first + static_cast<int>(seconds - row.seconds) / row.step;
    return indicator;
}

// The number that means that there is none is the least one.
constexpr std::int64_t no_number(int width) { return -(std::int64_t{1} << (width - 1)); }
void put_difference(BitWriter& bits, std::optional<double> steps, int width) {
    const std::int64_t none = no_number(width);
    const std::int64_t number = steps && std::abs(*steps) < static_cast<double>(-none) ? std::llround(*steps) : none;
    bits.put_signed(number < -none ? number : none, width);
}
std::optional<double> get_difference(BitReader& bits, int width, double step) {
    const std::int64_t number = bits.get_signed(width);
    if (number == no_number(width)) return std::nullopt;
    return static_cast<double>(number) * step;
}

void put_phase(BitWriter& bits, const Rtcm3LegacyCarrier& carrier, double told_range_m) {
    constexpr double reach_m = 262.1435;
    std::optional<double> beyond;
    if (carrier.phase_range_m) beyond = *carrier.phase_range_m - told_range_m;
    const double rollover = rollover_cycles * carrier.wavelength_m;
    if (beyond && std::abs(*beyond) > reach_m) *beyond -= std::round(*beyond / rollover) * rollover;
    if (beyond) *beyond /= phase_step_of_legacy_m;
    put_difference(bits, beyond, legacy_phase_bits);
}

void put_cno(BitWriter& bits, double cno_dbhz) {
    bits.put_signed(std::llround(std::clamp(cno_dbhz / cno_step_dbhz, 0.0, 255.0)), 8);
}

// The range that a client puts together, which all else of the satellite is counted from.
struct ToldRange {
    std::int64_t whole, steps;
    [[nodiscard]] double metres(const LegacyForm& form) const {
        return static_cast<double>(whole) * form.modulus_m() + static_cast<double>(steps) * range_step_m;
    }
};
// What the fields have room for.
bool can_be_told(double range_m, const LegacyForm& form) {
    return range_m >= 0 && range_m < std::exp2(form.whole_bits()) * form.modulus_m() - range_step_m;
}

ToldRange told_range(double range_m, const LegacyForm& form) {
    const double whole = std::floor(range_m / form.modulus_m());
    ToldRange told{static_cast<std::int64_t>(whole), std::llround((range_m - whole * form.modulus_m()) / range_step_m)};
    // The modulus is no multiple of the step: what rounds beyond it is nearer to the next one's beginning.
    if (static_cast<double>(told.steps) * range_step_m >= form.modulus_m()) told = {told.whole + 1, 0};
    return told;
}

void put_second_carrier(BitWriter& bits, const Rtcm3LegacySatellite& from, double told_m, const LegacyForm& form) {
    Rtcm3LegacyCarrier l2 = from.l2.value_or(Rtcm3LegacyCarrier());
    constexpr double reach = 8191.5;
    std::optional<double> difference;
    if (l2.range_m) difference = (*l2.range_m - told_m) / range_step_m;
    if (difference && std::abs(*difference) >= reach) difference.reset();
    if (!difference && !l2.phase_range_m) l2 = {};  // then there is nothing to tell of it
    bits.put_signed(l2.code, 2);
    put_difference(bits, difference, difference_bits);
    put_phase(bits, l2, told_m);
    bits.put_signed(indicator_of_lock(l2.lock_s), 7);
    if (form.extended) put_cno(bits, l2.cno_dbhz);
}

void put_satellite(BitWriter& bits, const Rtcm3LegacySatellite& from, const LegacyForm& form) {
    const ToldRange told = told_range(*from.l1.range_m, form);
    bits.put_signed(from.satellite, 6);
    bits.put_signed(from.l1.code, 1);
    if (form.glonass) bits.put_signed(from.frequency_channel - first_channel, 5);
    bits.put_signed(told.steps, form.range_bits());
    put_phase(bits, from.l1, told.metres(form));
    bits.put_signed(indicator_of_lock(from.l1.lock_s), 7);
    if (form.extended) {
        bits.put_signed(told.whole, form.whole_bits());
        put_cno(bits, from.l1.cno_dbhz);
    }
    if (form.both) put_second_carrier(bits, from, told.metres(form), form);
}

std::optional<double> added(std::optional<double> difference, double range_m) {
    if (difference) *difference += range_m;
    return difference;
}

Rtcm3LegacyCarrier get_second_carrier(BitReader& bits, double told_m, const LegacyForm& form) {
    Rtcm3LegacyCarrier l2;
    l2.code = static_cast<int>(bits.get(2));
    l2.range_m = added(get_difference(bits, difference_bits, range_step_m), told_m);
    l2.phase_range_m = added(get_difference(bits, legacy_phase_bits, phase_step_of_legacy_m), told_m);
    l2.lock_s = lock_of_indicator(static_cast<int>(bits.get(7)));
    if (form.extended) l2.cno_dbhz = static_cast<double>(bits.get(8)) * cno_step_dbhz;
    return l2;
}

Rtcm3LegacySatellite get_satellite(BitReader& bits, const LegacyForm& form) {
    Rtcm3LegacySatellite to;
    to.satellite = static_cast<int>(bits.get(6));
    to.l1.code = static_cast<int>(bits.get(1));
    if (form.glonass) to.frequency_channel = static_cast<int>(bits.get(5)) + first_channel;
    ToldRange told{0, static_cast<std::int64_t>(bits.get(form.range_bits()))};
    const auto phase = get_difference(bits, legacy_phase_bits, phase_step_of_legacy_m);
    to.l1.lock_s = lock_of_indicator(static_cast<int>(bits.get(7)));
    if (form.extended) {
        told.whole = static_cast<std::int64_t>(bits.get(form.whole_bits()));
        to.l1.cno_dbhz = static_cast<double>(bits.get(8)) * cno_step_dbhz;
    }
    const double told_m = told.metres(form);
    if (phase) to.l1.range_m = told_m;  // else the field serves L2 alone (DF011)
    to.l1.phase_range_m = added(phase, told_m);
    if (form.both) to.l2 = get_second_carrier(bits, told_m, form);
    if (to.l2 && !to.l2->range_m && !to.l2->phase_range_m) to.l2.reset();
    return to;
}

}  // namespace

bool is_legacy_observables(int number) { return legacy_form(number).has_value(); }

bool is_extended_legacy(int number) {
    const auto form = legacy_form(number);
    return form && form->extended;
}

double legacy_range_modulus_m(int number) { return legacy_form(number).value_or(LegacyForm{}).modulus_m(); }

Bytes encode(const Rtcm3LegacyObservables& observables) {
    const auto form = legacy_form(observables.number);
    std::vector<Rtcm3LegacySatellite> told;
    for (const Rtcm3LegacySatellite& satellite : observables.satellites)
        if (form && satellite.l1.range_m && can_be_told(*satellite.l1.range_m, *form)) told.push_back(satellite);
    if (told.empty()) return {};
    told.resize(std::min(told.size(), most_legacy_satellites));
    BitWriter bits;
    bits.put_signed(observables.number, 12);
    bits.put_signed(observables.station, 12);
    bits.put(observables.epoch, form->epoch_bits());
    bits.put(observables.more ? 1 : 0, 1);
    bits.put(told.size(), 5);
    bits.put(observables.divergence_free ? 1 : 0, 1);
    bits.put_signed(observables.smoothing_interval, 3);
    for (const Rtcm3LegacySatellite& satellite : told)
        put_satellite(bits, satellite, *form);
    return encode_rtcm3(bits.bytes());
}

std::optional<Rtcm3LegacyObservables> decode_legacy(const Rtcm3Message& message) {
    const auto form = legacy_form(message.number);
    if (!form) return std::nullopt;
    BitReader bits(message.payload);
    Rtcm3LegacyObservables result;
    result.number = static_cast<int>(bits.get(12));
    result.station = static_cast<int>(bits.get(12));
    result.epoch = static_cast<std::uint32_t>(bits.get(form->epoch_bits()));
    result.more = bits.get(1) != 0;
    const auto count = bits.get(5);
    result.divergence_free = bits.get(1) != 0;
    result.smoothing_interval = static_cast<int>(bits.get(3));
    for (std::uint64_t i = 0; i < count && bits.ok(); ++i)
        result.satellites.push_back(get_satellite(bits, *form));
    if (!bits.ok()) return std::nullopt;
    return result;
}

}  // namespace skyloop::inline receiver
