#include "world/gnss/broadcast_lnav.hpp"

#include <bit>
#include <cmath>

#include "detail/broadcast_fields.hpp"
#include "world/gnss/orbit.hpp"

namespace skyloop::inline world {

int lnav_accuracy_index(double metres) {
    constexpr std::array<double, 15> bounds{2.4, 3.4, 4.85, 6.85, 9.65, 13.65, 24,  48,
                                            96,  192, 384,  768,  1536, 3072,  6144};
    for (std::size_t i = 0; i < bounds.size(); ++i)
        if (metres >= 0 && metres <= bounds[i]) return static_cast<int>(i);
    return 15;
}

void put_klobuchar(BitWriter& bits, const KlobucharCoefficients& coefficients) {
    constexpr std::array<int, 4> alpha_exponents{-30, -27, -24, -24}, beta_exponents{11, 14, 16, 16};
    for (std::size_t i = 0; i < 4; ++i)
        put_scaled(bits, coefficients.alpha[i], 8, power_of_two(alpha_exponents[i]));
    for (std::size_t i = 0; i < 4; ++i)
        put_scaled(bits, coefficients.beta[i], 8, power_of_two(beta_exponents[i]));
}

LeapChange leap_change(const LeapSeconds& leap_seconds, GpsTime time) {
    const LeapSeconds::Step* chosen = nullptr;
    for (const LeapSeconds::Step& step : leap_seconds.steps()) {
        // One that is to come is announced half a year before.
        if (step.from - time > std::chrono::hours(24 * 183)) break;
        chosen = &step;
    }
    if (chosen == nullptr) return {static_cast<std::uint64_t>(week_and_tow(time).week), 1, leap_seconds.offset(time)};
    const WeekAndTow before = week_and_tow(chosen->from - std::chrono::seconds(60));
    const auto day = static_cast<std::uint64_t>(before.tow / std::chrono::hours(24)) + 1;
    return {static_cast<std::uint64_t>(before.week), day, chosen->offset};
}

namespace {

constexpr int data_bits = 24;
constexpr std::uint32_t preamble = 0x8B;

// Which data bits, d1 the highest, go into D25 … D30 (table 20-XIV), and which of the two bits before.
constexpr std::array<std::uint32_t, 6> parity_masks{0xEC7CD2, 0x763E69, 0xBB1F34, 0x5D8F9A, 0xAEC7CD, 0x2DEA27};
constexpr std::array<bool, 6> parity_takes_last{false, true, false, true, true, false};  // D30*; else D29*

std::uint32_t parity_of(std::uint32_t data, bool d29, bool d30) {
    std::uint32_t parity = 0;
    for (std::size_t i = 0; i < parity_masks.size(); ++i) {
        const bool before = parity_takes_last[i] ? d30 : d29;
        const bool odd = (std::popcount(data & parity_masks[i]) & 1) != 0;
        parity = parity << 1 | static_cast<std::uint32_t>(odd != before);
    }
    return parity;
}

// The data of the first two words (20.3.3.1 and 20.3.3.2), and the rest of the stream in the other eight.
LnavData with_header(int subframe, GpsTime end, const BitWriter& rest) {
    LnavData data{};
    data[0] = preamble << 16;
    const auto sixes = static_cast<std::uint32_t>(week_and_tow(end).tow / std::chrono::seconds(6));
    constexpr std::uint32_t anti_spoofing = 1u << 5;
    data[1] = sixes << 7 | anti_spoofing | static_cast<std::uint32_t>(subframe) << 2;
    for (std::size_t word = 2; word < data.size(); ++word)
        data[word] = static_cast<std::uint32_t>(rest.field((word - 2) * data_bits, data_bits));
    return data;
}

double tow_of(GpsTime time) { return week_and_tow(time).tow_seconds(); }

std::uint64_t week_bits(GpsTime time) { return static_cast<std::uint64_t>(week_and_tow(time).week); }

bool of_qzss(const KeplerEphemeris& r) { return r.satellite.constellation == Constellation::qzss; }

// The curve was fitted to more than the usual four hours, of QZSS two. Of QZSS records hold the flag itself
// (RINEX 3.05, table A12), some the hours.
bool long_fit(const KeplerEphemeris& r) {
    if (!of_qzss(r)) return r.fit_interval_h > 4;
    return r.fit_interval_h == 1 || r.fit_interval_h > 2;
}

BitWriter clock_fields(const KeplerEphemeris& r, GpsTime end) {
    // QZSS has L2C alone there, always (IS-QZSS-PNT, LNAV, subframe 1).
    const std::uint64_t code_on_l2 = of_qzss(r) ? 2 : 1, no_data_on_p = of_qzss(r) ? 1 : 0;
    const auto issue = static_cast<std::uint64_t>(r.iodc);
    BitWriter bits;
    bits.put(week_bits(end - std::chrono::seconds(6)), 10);
    bits.put(code_on_l2, 2);
    bits.put_signed(lnav_accuracy_index(r.accuracy_m), 4);
    bits.put_signed(r.health, 6);
    bits.put(issue >> 8, 2);
    bits.put(no_data_on_p, 1);
    bits.put(0, 23 + 24 + 24);
    bits.put(0, 16);
    put_scaled(bits, r.tgd, 8, power_of_two(-31));
    bits.put(issue, 8);
    put_scaled_unsigned(bits, tow_of(r.toc), 16, 16);
    put_scaled(bits, r.af2, 8, power_of_two(-55));
    put_scaled(bits, r.af1, 16, power_of_two(-43));
    put_scaled(bits, r.af0, 22, power_of_two(-31));
    return bits;
}

BitWriter first_orbit_fields(const KeplerEphemeris& r) {
    BitWriter bits;
    bits.put_signed(r.iode, 8);
    put_scaled(bits, r.crs, 16, power_of_two(-5));
    put_semicircles(bits, r.delta_n, 16, -43);
    put_circle(bits, r.m0, 32);
    put_scaled(bits, r.cuc, 16, power_of_two(-29));
    put_scaled_unsigned(bits, r.e, 32, power_of_two(-33));
    put_scaled(bits, r.cus, 16, power_of_two(-29));
    put_scaled_unsigned(bits, r.sqrt_a, 32, power_of_two(-19));
    put_scaled_unsigned(bits, tow_of(r.toe), 16, 16);
    bits.put(long_fit(r) ? 1 : 0, 1);
    constexpr std::uint64_t no_offset_age = 31;
    bits.put(no_offset_age, 5);
    return bits;
}

BitWriter second_orbit_fields(const KeplerEphemeris& r) {
    BitWriter bits;
    put_scaled(bits, r.cic, 16, power_of_two(-29));
    put_circle(bits, r.omega0, 32);
    put_scaled(bits, r.cis, 16, power_of_two(-29));
    put_circle(bits, r.i0, 32);
    put_scaled(bits, r.crc, 16, power_of_two(-5));
    put_circle(bits, r.omega, 32);
    put_semicircles(bits, r.omega_dot, 24, -43);
    bits.put_signed(r.iode, 8);
    put_semicircles(bits, r.idot, 14, -43);
    return bits;
}

}  // namespace

LnavWords lnav_words(const LnavData& data) {
    LnavWords words{};
    bool d29 = false, d30 = false;  // of word 10 before
    for (std::size_t i = 0; i < data.size(); ++i) {
        std::uint32_t upright = data[i] & 0xFFFFFF;
        std::uint32_t parity = parity_of(upright, d29, d30);
        if (i == 1 || i == 9) {
            // Of the four endings exactly one gives a word that ends in 00.
            upright &= ~3u;
            for (std::uint32_t ending = 0; ending < 4; ++ending) {
                parity = parity_of(upright | ending, d29, d30);
                if ((parity & 3) != 0) continue;
                upright |= ending;
                break;
            }
        }
        // Sent is upright ⊕ D30*; handed out is what was received, turned upright again, parity and register with it.
        const std::uint32_t inverted = d30 ? ~0u : 0u;
        const std::uint32_t before = (d29 ? 2u : 0u) | (d30 ? 1u : 0u);
        words[i] = ((before << 30 | parity) ^ (inverted & 0xC000'003Fu)) | upright << 6;
        d29 = (parity & 2) != 0;
        d30 = (parity & 1) != 0;
    }
    return words;
}

LnavWords lnav_ephemeris_subframe(const KeplerEphemeris& record, int subframe, GpsTime end) {
    const BitWriter fields = subframe == 1   ? clock_fields(record, end)
                             : subframe == 2 ? first_orbit_fields(record)
                                             : second_orbit_fields(record);
    return lnav_words(with_header(subframe, end, fields));
}

namespace {

constexpr int page_count = 25;
constexpr int qzss_satellites = 10;
constexpr double almanac_step_s = 4096;

struct LnavPage {
    const LnavSystemData& system;
    GpsTime time;
    // One reference for all almanacs: the last whole step of the week.
    [[nodiscard]] GpsTime reference() const {
        const WeekAndTow now = week_and_tow(time);
        return to_gps_time(now.week, almanac_step_s * std::floor(now.tow_seconds() / almanac_step_s));
    }
    [[nodiscard]] std::optional<KeplerEphemeris> record(int number) const {
        if (system.source == nullptr) return std::nullopt;
        const auto found = system.source->ephemeris({system.of, number}, time);
        if (!found || !std::holds_alternative<KeplerEphemeris>(*found)) return std::nullopt;
        return std::get<KeplerEphemeris>(*found);
    }
    [[nodiscard]] std::uint64_t health(int number) const {
        const auto found = record(number);
        return found && found->health_bits_clear() ? 0 : 0b111111;
    }
    [[nodiscard]] bool of_qzss() const { return system.of == Constellation::qzss; }
    void put_head(BitWriter& bits, std::uint64_t page_id) const {
        bits.put(of_qzss() ? 3 : 1, 2);  // the data id
        bits.put(page_id, 6);
    }
};

BitWriter empty_page(const LnavPage& page) {
    BitWriter bits;
    page.put_head(bits, 0);
    bits.put(0xAAAA, 16);
    for (int word = 4; word <= 10; ++word)
        bits.put(0xAAAAAA, data_bits);
    return bits;
}

// What eccentricity and inclination of an almanac are told from.
struct AlmanacReference {
    double e = 0, inclination = 0.3 * std::numbers::pi;
};

// Of QZSS two orbits: quasi-zenith ones, and from satellite 7 on geostationary ones (IS-QZSS-PNT, LNAV, almanac).
AlmanacReference almanac_reference(const LnavPage& page, int number) {
    if (!page.of_qzss()) return {};
    return number < 7 ? AlmanacReference{0.06, 0.25 * std::numbers::pi} : AlmanacReference{0, 0};
}

BitWriter almanac_page(const LnavPage& page, int number) {
    const std::optional<KeplerEphemeris> found = page.record(number);
    if (!found) return empty_page(page);
    const AlmanacReference base = almanac_reference(page, number);
    const GpsTime reference = page.reference();
    const KeplerEphemeris r = carried_almanac(*found, reference);

    BitWriter bits;
    page.put_head(bits, static_cast<std::uint64_t>(number));
    if (base.e > 0) {
        put_scaled(bits, r.e - base.e, 16, power_of_two(-21));
    } else {
        put_scaled_unsigned(bits, r.e, 16, power_of_two(-21));
    }
    put_scaled_unsigned(bits, tow_of(reference), 8, almanac_step_s);
    put_semicircles(bits, r.i0 - base.inclination, 16, -19);
    put_semicircles(bits, r.omega_dot, 16, -38);
    bits.put(r.health_bits_clear() ? 0 : 0xFF, 8);
    put_scaled_unsigned(bits, r.sqrt_a, 24, power_of_two(-11));
    put_circle(bits, r.omega0, 24);
    put_circle(bits, r.omega, 24);
    put_circle(bits, r.m0, 24);
    BitWriter offset;
    put_scaled(offset, r.af0, 11, power_of_two(-20));
    bits.put(offset.field(0, 8), 8);
    put_scaled(bits, r.af1, 11, power_of_two(-38));
    bits.put(offset.field(8, 3), 3);
    return bits;
}

// Page 25 of subframe 5.
BitWriter first_health_page(const LnavPage& page) {
    BitWriter bits;
    page.put_head(bits, 51);
    put_scaled_unsigned(bits, tow_of(page.reference()), 8, almanac_step_s);
    bits.put(week_bits(page.reference()), 8);
    const int told = page.of_qzss() ? qzss_satellites : 24;
    for (int number = 1; number <= told; ++number)
        bits.put(page.health(number), 6);
    bits.put(0, 6 * (24 - told));
    return bits;
}

// Page 25 of subframe 4.
BitWriter second_health_page(const LnavPage& page) {
    constexpr std::uint64_t encrypted_and_new = 0b1001;  // block II and later, anti-spoofing on
    BitWriter bits;
    page.put_head(bits, 63);
    for (int number = 1; number <= 32; ++number)
        bits.put(page.record(number) ? encrypted_and_new : 0, 4);
    bits.put(0, 2);
    for (int number = 25; number <= 32; ++number)
        bits.put(page.health(number), 6);
    return bits;
}

// Page 18 of subframe 4; without coefficients zeros, as satellites of old sent.
BitWriter ionosphere_page(const LnavPage& page) {
    KlobucharCoefficients c{};
    if (page.system.source != nullptr) {
        const BroadcastIonosphere& known = page.system.source->ionosphere();
        c = (page.of_qzss() ? known.qzss : known.gps).value_or(c);
    }
    const LeapChange change = leap_change(page.system.leap_seconds, page.time);
    BitWriter bits;
    page.put_head(bits, 56);
    put_klobuchar(bits, c);
    bits.put(0, 24);  // A1: GPS time is UTC but for whole seconds
    bits.put(0, 32);  // A0
    put_scaled_unsigned(bits, tow_of(page.reference()), 8, almanac_step_s);
    bits.put(week_bits(page.reference()), 8);
    bits.put_signed(page.system.leap_seconds.offset(page.time), 8);
    bits.put(change.week, 8);
    bits.put(change.day, 8);
    bits.put_signed(change.offset, 8);
    return bits;
}

BitWriter gps_page(const LnavPage& page, int subframe, int number) {
    if (subframe == 5) return number < page_count ? almanac_page(page, number) : first_health_page(page);
    if (number == page_count) return second_health_page(page);
    if (number == 18) return ionosphere_page(page);
    if (number >= 2 && number <= 10 && number != 6) return almanac_page(page, number <= 5 ? number + 23 : number + 22);
    return empty_page(page);
}

// QZSS may send any page in either subframe at any time; here it has its own where GPS has those.
BitWriter page_of(const LnavPage& page, int subframe, int number) {
    if (!page.of_qzss()) return gps_page(page, subframe, number);
    if (subframe == 5 && number <= qzss_satellites) return almanac_page(page, number);
    if (subframe == 5 && number == page_count) return first_health_page(page);
    return subframe == 4 && number == 18 ? ionosphere_page(page) : empty_page(page);
}

}  // namespace

LnavWords lnav_system_subframe(const LnavSystemData& system, int subframe, GpsTime end) {
    const LnavPage page{system, end};
    const auto frame = week_and_tow(end - std::chrono::seconds(6)).tow / std::chrono::seconds(30);
    const int number = static_cast<int>(frame % page_count) + 1;
    return lnav_words(with_header(subframe, end, page_of(page, subframe, number)));
}

}  // namespace skyloop::inline world
