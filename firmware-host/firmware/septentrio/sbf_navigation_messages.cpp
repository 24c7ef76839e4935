// SBF blocks of navigation messages: the bits as they came, and the records that they hold.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>

#include "base/core/bytes.hpp"
#include "firmware/septentrio/sbf_messages.hpp"
#include "receiver/protocol/sbf_raw_blocks.hpp"
#include "world/gnss/broadcast_galileo.hpp"
#include "world/gnss/broadcast_lnav.hpp"

namespace skyloop::firmware {
namespace {

using namespace std::chrono_literals;

constexpr double per_semicircle = 1 / std::numbers::pi;

// The instant at which a message had been sent.
SbfTime sent_at(GpsTime end) {
    const WeekAndTow stamp = gps_stamp(end);
    return {whole_milliseconds(stamp), nearest<std::uint16_t>(static_cast<double>(stamp.week))};
}

std::uint16_t block_of_pages(const Subframe& message) {
    const bool l2 = message.signal == Signal::l2, l5 = message.signal == Signal::l5;
    switch (message.satellite.constellation) {
        case Constellation::gps:
            return l2 ? SbfGpsRawL2c::block_number : l5 ? SbfGpsRawL5::block_number : SbfGpsRawCa::block_number;
        case Constellation::qzss:
            return l2 ? SbfQzsRawL2c::block_number : l5 ? SbfQzsRawL5::block_number : SbfQzsRawL1Ca::block_number;
        case Constellation::glonass:
            return SbfGloRawCa::block_number;
        case Constellation::galileo:
            return l5 ? SbfGalRawFnav::block_number : SbfGalRawInav::block_number;
        case Constellation::beidou:
            return SbfBdsRaw::block_number;
        case Constellation::sbas:
            return SbfGeoRawL1::block_number;
        default:
            return 0;
    }
}

// Above a word of a subframe a u-blox keeps the last bits of the word before; parity and data are as SBF wants them.
std::vector<std::uint32_t> lnav_bits(const std::vector<std::uint32_t>& words) {
    std::vector<std::uint32_t> bits;
    for (const std::uint32_t word : words)
        bits.push_back(word & 0x3FFF'FFFF);
    return bits;
}

// An even page without its tail, and an odd one, of 120 bits in four words each.
std::vector<std::uint32_t> inav_bits(const std::vector<std::uint32_t>& words) {
    BitWriter bits;
    for (std::size_t page = 0; page < 2 && 4 * page + 4 <= words.size(); ++page) {
        for (std::size_t i = 0; i < 3; ++i)
            bits.put(words[4 * page + i], 32);
        const int rest = page == 0 ? 18 : 24;
        bits.put(words[4 * page + 3] >> (32 - rest), rest);
    }
    return bits.words();
}

// Ten words of 30 bits without gaps.
std::vector<std::uint32_t> d1_bits(const std::vector<std::uint32_t>& words) {
    BitWriter bits;
    for (const std::uint32_t word : words)
        bits.put(word, 30);
    return bits.words();
}

// 85 bits; what a u-blox hands out behind them is its own count of frames.
std::vector<std::uint32_t> string_bits(std::vector<std::uint32_t> words) {
    words.resize(3);
    words[2] &= ~0u << 11;
    return words;
}

// The 300 bits of CNAV.
std::vector<std::uint32_t> cnav_bits(std::vector<std::uint32_t> words) {
    words.back() &= ~0u << 20;
    return words;
}

std::vector<std::uint32_t> sbf_bits(const Subframe& message) {
    const bool second = message.signal == Signal::l2 || message.signal == Signal::l5;
    switch (message.satellite.constellation) {
        case Constellation::galileo:
            return second ? message.words : inav_bits(message.words);
        case Constellation::glonass:
            return string_bits(message.words);
        case Constellation::beidou:
            return d1_bits(message.words);
        case Constellation::sbas:
            return message.words;
        default:
            return second ? cnav_bits(message.words) : lnav_bits(message.words);
    }
}

template <class Page>
Bytes raw_page(const Subframe& message, const NavigationState& state) {
    const auto svid = sbf_svid(message.satellite);
    if (!svid) return {};
    Page page;
    page.time = sent_at(message.end);
    page.svid = *svid;
    page.source = sbf_signal_number(message.satellite.constellation, message.signal).value_or(0);
    if (message.satellite.constellation == Constellation::glonass)
        page.freq_nr = static_cast<std::uint8_t>(message.frequency_channel + 8);
    page.rx_channel = sbf_channel_number(state, message.satellite);
    const std::vector<std::uint32_t> bits = sbf_bits(message);
    std::copy_n(bits.begin(), std::min(bits.size(), page.words.size()), page.words.begin());
    return encode_sbf(page);
}

// The makers of blocks of pages, by their numbers.
template <class... Pages>
struct PageBlocks {
    static Bytes of(std::uint16_t number, const Subframe& message, const NavigationState& state) {
        Bytes block;
        ((number == Pages::block_number ? void(block = raw_page<Pages>(message, state)) : void()), ...);
        return block;
    }
};
using KnownPages = PageBlocks<SbfGpsRawCa, SbfGpsRawL2c, SbfGpsRawL5, SbfQzsRawL1Ca, SbfQzsRawL2c, SbfQzsRawL5,
                              SbfGloRawCa, SbfGalRawInav, SbfGalRawFnav, SbfGeoRawL1, SbfBdsRaw>;

float semicircles(double radians) { return static_cast<float>(radians * per_semicircle); }

std::uint32_t whole_seconds(const WeekAndTow& stamp) {
    return static_cast<std::uint32_t>(std::chrono::duration_cast<std::chrono::seconds>(stamp.tow).count());
}
// A system's weeks before its first one are negative.
std::uint16_t week_of(const WeekAndTow& stamp, std::int64_t modulus) {
    return static_cast<std::uint16_t>((stamp.week % modulus + modulus) % modulus);
}

// The times of BeiDou's records are those of its own week.
SbfKeplerOrbit sbf_orbit(const KeplerEphemeris& r, const WeekAndTow& toe) {
    SbfKeplerOrbit orbit;
    orbit.c_rs = static_cast<float>(r.crs);
    orbit.delta_n = semicircles(r.delta_n);
    orbit.m_0 = r.m0 * per_semicircle;
    orbit.c_uc = static_cast<float>(r.cuc);
    orbit.e = r.e;
    orbit.c_us = static_cast<float>(r.cus);
    orbit.sqrt_a = r.sqrt_a;
    orbit.toe = whole_seconds(toe);
    orbit.c_ic = static_cast<float>(r.cic);
    orbit.omega_0 = r.omega0 * per_semicircle;
    orbit.c_is = static_cast<float>(r.cis);
    orbit.i_0 = r.i0 * per_semicircle;
    orbit.c_rc = static_cast<float>(r.crc);
    orbit.omega = r.omega * per_semicircle;
    orbit.omega_dot = semicircles(r.omega_dot);
    orbit.idot = semicircles(r.idot);
    return orbit;
}

// The bits of a subframe's third word and on, as its maker put them there.
template <class Block>
Bytes lnav_record(const KeplerEphemeris& r, std::uint8_t svid, GpsTime end) {
    constexpr std::int64_t gps_weeks = 1024;
    const bool qzss = r.satellite.constellation == Constellation::qzss;
    const WeekAndTow toe = week_and_tow(r.toe), toc = week_and_tow(r.toc);
    Block block;
    block.time = sent_at(end);
    block.svid = svid;
    block.week = week_of(week_and_tow(end), gps_weeks);
    block.code_on_l2 = qzss ? 2 : 1;
    block.l2_data_flag = qzss ? 1 : 0;
    block.ura = static_cast<std::uint8_t>(lnav_accuracy_index(r.accuracy_m));
    block.health = static_cast<std::uint8_t>(r.health & 0x3F);
    block.iodc = static_cast<std::uint16_t>(r.iodc & 0x3FF);
    block.iode2 = block.iode3 = static_cast<std::uint8_t>(r.iode & 0xFF);
    block.fit_interval_flag = (qzss ? r.fit_interval_h == 1 || r.fit_interval_h > 2 : r.fit_interval_h > 4) ? 1 : 0;
    block.tgd.set(r.tgd);
    block.toc = whole_seconds(toc);
    block.af2.set(r.af2);
    block.af1.set(r.af1);
    block.af0.set(r.af0);
    block.orbit = sbf_orbit(r, toe);
    block.toc_week = week_of(toc, gps_weeks);
    block.toe_week = week_of(toe, gps_weeks);
    return encode_sbf(block);
}

Bytes beidou_record(const KeplerEphemeris& r, std::uint8_t svid, GpsTime end) {
    constexpr std::int64_t beidou_weeks = 8192;
    const WeekAndTow toe = bdt_week_and_tow(r.toe), toc = bdt_week_and_tow(r.toc);
    SbfBdsNav block;
    block.time = sent_at(end);
    block.svid = svid;
    block.week = week_of(bdt_week_and_tow(end), beidou_weeks);
    block.ura = static_cast<std::uint8_t>(lnav_accuracy_index(r.accuracy_m));
    block.health = r.health == 0 ? 0 : 1;
    block.aodc = static_cast<std::uint8_t>(r.iodc & 31);
    block.aode = static_cast<std::uint8_t>(r.iode & 31);
    block.tgd1.set(r.tgd);
    block.tgd2.set(r.tgd2);
    block.toc = whole_seconds(toc);
    block.af2.set(r.af2);
    block.af1.set(r.af1);
    block.af0.set(r.af0);
    block.orbit = sbf_orbit(r, toe);
    block.toc_week = week_of(toc, beidou_weeks);
    block.toe_week = week_of(toe, beidou_weeks);
    return encode_sbf(block);
}

// Of each signal a bit that says that it is told, its data validity status and its health status; records keep them as
// RINEX 3.05, table A8, has them: E1-B in bits 0-2, E5b in bits 6-8, the lowest of each the former.
std::uint16_t galileo_health(int health) {
    const auto signal = [&](int first) { return 1u | (static_cast<unsigned>(health) >> first & 7u) << 1; };
    return static_cast<std::uint16_t>(signal(0) | signal(6) << 4);
}

Bytes galileo_record(const KeplerEphemeris& r, std::uint8_t svid, GpsTime end) {
    constexpr std::int64_t galileo_weeks = 4096;
    const WeekAndTow toe = week_and_tow(r.toe), toc = week_and_tow(r.toc);
    SbfGalNav block;
    block.time = sent_at(end);
    block.svid = svid;
    block.orbit = sbf_orbit(r, toe);
    block.toc = whole_seconds(toc);
    block.af2.set(r.af2);
    block.af1.set(r.af1);
    block.af0 = r.af0;
    block.toe_week = week_of(toe, galileo_weeks);
    block.toc_week = week_of(toc, galileo_weeks);
    block.iod_nav = static_cast<std::uint16_t>(r.iode & 0x3FF);
    block.health = galileo_health(r.health);
    block.sisa_l1_e5b = static_cast<std::uint8_t>(inav_accuracy_index(r.accuracy_m));
    block.bgd_l1_e5a.set(r.tgd);
    block.bgd_l1_e5b.set(r.tgd2);
    return encode_sbf(block);
}

// N_T: the day, from 1 on, within the four years that begin with a leap year, by Moscow time (GLONASS ICD 5.1, 4.4).
std::uint16_t four_year_day(GpsTime time, int leap_seconds) {
    constexpr std::int64_t days_to_1996 = 5839, days_in_four_years = 1461;  // from 1980-01-06
    const auto moscow = (time + 3h - std::chrono::seconds(leap_seconds)).time_since_epoch();
    const std::int64_t days = std::chrono::duration_cast<std::chrono::hours>(moscow).count() / 24 - days_to_1996;
    return static_cast<std::uint16_t>(std::max<std::int64_t>(days, 0) % days_in_four_years + 1);
}

Bytes glonass_record(const GlonassEphemeris& r, std::uint8_t svid, GpsTime end, int leap_seconds) {
    constexpr double km = 1e-3;
    constexpr std::uint8_t unhealthy = 1u << 2;
    constexpr int quarter_hour_min = 15;
    constexpr std::uint8_t by_satellite = 0b11;  // both corrections of time
    SbfGloNav block;
    block.p = by_satellite;
    block.time = sent_at(end);
    block.svid = svid;
    block.freq_nr = static_cast<std::uint8_t>(r.frequency_channel + 8);
    for (std::size_t i = 0; i < 3; ++i) {
        block.position[i] = r.position_m[i] * km;
        block.velocity[i] = static_cast<float>(r.velocity_mps[i] * km);
        block.acceleration[i] = static_cast<float>(r.acceleration_mps2[i] * km);
    }
    block.gamma.set(r.clock_drift);
    block.tau.set(-r.clock_bias);
    block.dtau.set(r.group_delay_l2);
    const WeekAndTow toe = week_and_tow(r.toe);
    block.toe = whole_seconds(toe);
    block.toe_week = week_of(toe, 1024);
    block.health = r.healthy() ? std::uint8_t{0} : unhealthy;
    block.l = r.healthy() ? 0 : 1;
    block.tb = static_cast<std::uint16_t>(r.iode * quarter_hour_min);
    block.p2 = static_cast<std::uint8_t>(r.iode % 2);
    block.day = four_year_day(end, leap_seconds);
    block.accuracy.set(r.accuracy_m);
    return encode_sbf(block);
}

Bytes kepler_record(const KeplerEphemeris& r, std::uint8_t svid, GpsTime end) {
    switch (r.satellite.constellation) {
        case Constellation::gps:
            return lnav_record<SbfGpsNav>(r, svid, end);
        case Constellation::qzss:
            return lnav_record<SbfQzsNav>(r, svid, end);
        case Constellation::beidou:
            return beidou_record(r, svid, end);
        case Constellation::galileo:
            return galileo_record(r, svid, end);
        default:
            return {};
    }
}

}  // namespace

std::vector<Bytes> sbf_raw_pages(std::uint16_t number, const NavigationState& state) {
    std::vector<Bytes> blocks;
    for (const Subframe& message : state.epoch.subframes)
        if (block_of_pages(message) == number)
            if (Bytes block = KnownPages::of(number, message, state); !block.empty())
                blocks.push_back(std::move(block));
    return blocks;
}

Bytes sbf_record_block(const Subframe& message, const NavigationState& state) {
    const auto svid = sbf_svid(message.satellite);
    if (!message.record || !svid) return {};
    if (const auto* kepler = std::get_if<KeplerEphemeris>(&*message.record))
        return kepler_record(*kepler, *svid, message.end);
    if (const auto* glonass = std::get_if<GlonassEphemeris>(&*message.record))
        return glonass_record(*glonass, *svid, message.end, state.epoch.fix.leap_seconds);
    return {};
}

}  // namespace skyloop::firmware
