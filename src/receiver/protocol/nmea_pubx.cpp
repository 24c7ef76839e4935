#include "receiver/protocol/nmea_pubx.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/core/number_text.hpp"
#include "detail/nmea_field_text.hpp"

namespace skyloop::inline receiver {
namespace {

using namespace nmea_encoding;
using nmea_decoding::FieldReader;

constexpr std::size_t pubx_most_satellites = 99;

std::optional<PubxMessage> read_position(FieldReader& r) {
    constexpr std::string_view states[] = {"NF", "DR", "G2", "G3", "D2", "D3", "RK", "TT"};
    PubxPosition m;
    m.time = r.time(1);
    m.position = r.position(2).value_or(NmeaPosition{});
    m.altitude = r.metres(6, "an altitude").value_or(Metres(0));
    if (std::find(std::begin(states), std::end(states), r.text(7)) == std::end(states)) r.refuse(7, "a fix status");
    m.status = r.text(7);
    m.horizontal_accuracy = r.metres(8, "an accuracy").value_or(Metres(0));
    m.vertical_accuracy = r.metres(9, "an accuracy").value_or(Metres(0));
    m.speed = MetresPerSecond(r.number(10, "a speed").value_or(0) / 3.6);
    m.course = r.degrees(11, "a course").value_or(Angle());
    m.down = MetresPerSecond(r.number(12, "a velocity").value_or(0));
    m.correction_age_s = r.integer(13, "an age of corrections");
    m.hdop = r.number(14, "a DOP").value_or(m.hdop);
    m.vdop = r.number(15, "a DOP").value_or(m.vdop);
    m.tdop = r.number(16, "a DOP").value_or(m.tdop);
    m.satellites_used = r.integer(17, "a number of satellites").value_or(0);
    m.dead_reckoning = r.integer(19, "a flag of dead reckoning").value_or(0) != 0;
    return m;
}

std::optional<PubxMessage> read_satellites(FieldReader& r) {
    constexpr std::size_t first = 2, block = 6;
    const int count = r.integer(1, "a number of satellites").value_or(0);
    if (r.size() != first + block * static_cast<std::size_t>(count))
        return r.refuse(1, "the number of satellites listed");
    PubxSatellites m;
    for (std::size_t at = first; at < r.size(); at += block) {
        PubxSatellite s;
        s.number = r.integer(at, "a satellite").value_or(0);
        if (r.text(at + 1).size() != 1 || std::string_view("Ue-").find(r.text(at + 1)[0]) == std::string_view::npos)
            return r.refuse(at + 1, "U, e or -");
        s.status = r.text(at + 1)[0];
        s.azimuth_deg = r.integer(at + 2, "an azimuth");
        s.elevation_deg = r.integer(at + 3, "an elevation");
        s.cn0_dbhz = r.integer(at + 4, "a C/N0");
        s.lock_s = r.integer(at + 5, "a lock time").value_or(0);
        m.satellites.push_back(s);
    }
    return m;
}

std::optional<PubxMessage> read_time(FieldReader& r) {
    PubxTime m;
    m.time = r.time(1);
    m.date = r.packed_date(2);
    m.utc_tow_s = r.number(3, "a time of week");
    m.utc_week = r.integer(4, "a week");
    std::string_view leap = r.text(5);
    m.leap_seconds_by_default = leap.ends_with('D');
    if (m.leap_seconds_by_default) leap.remove_suffix(1);
    const auto seconds = number_in<int>(leap);
    if (!seconds) r.refuse(5, "leap seconds");
    m.leap_seconds = seconds.value_or(0);
    m.clock_bias_ns = r.number(6, "a clock bias").value_or(0);
    m.clock_drift_ns_s = r.number(7, "a clock drift").value_or(0);
    m.granularity_ns = r.integer(8, "a granularity").value_or(0);
    return m;
}

}  // namespace

std::string encode(const PubxPosition& m, const NmeaFormat& format) {
    Sentence s("PUBX");
    s.text("00");
    add_time(s, m.time, format);
    add_position(s, m.position, format.coordinate_decimals);
    s.decimal(m.altitude.value(), 3).text(m.status);
    s.text(deviation_text(m.horizontal_accuracy)).text(deviation_text(m.vertical_accuracy));
    s.decimal(in_kmh(m.speed), 3).text(course_text(m.course, 2)).decimal(m.down.value(), 3);
    s.number(m.correction_age_s, 1);
    for (const double dop : {m.hdop, m.vdop, m.tdop})
        add_dop(s, dop, 2);
    return s.number(m.satellites_used).number(0).number(m.dead_reckoning ? 1 : 0).finish();
}

std::string encode(const PubxSatellites& m, const NmeaFormat&) {
    const std::size_t shown = std::min(m.satellites.size(), pubx_most_satellites);
    Sentence s("PUBX");
    s.text("03").number(static_cast<int>(shown), 2);
    for (std::size_t i = 0; i < shown; ++i) {
        const PubxSatellite& satellite = m.satellites[i];
        s.number(satellite.number).letter(satellite.status);
        s.number(satellite.azimuth_deg, 3);
        s.number(satellite.elevation_deg, 2);
        s.number(satellite.cn0_dbhz, 2);
        s.number(std::clamp(satellite.lock_s, 0, 64), 3);
    }
    return s.finish();
}

std::string encode(const PubxTime& m, const NmeaFormat& format) {
    Sentence s("PUBX");
    s.text("04");
    add_time(s, m.time, format);
    s.text(m.date ? date_text(*m.date) : "");
    add_decimal(s, m.utc_tow_s, 2);
    s.number(m.utc_week, 1);
    s.text(fmt::format("{}{}", m.leap_seconds, m.leap_seconds_by_default ? "D" : ""));
    return s.decimal(m.clock_bias_ns, 0).decimal(m.clock_drift_ns_s, 3).number(m.granularity_ns).finish();
}

Result<PubxMessage> decode_pubx(const SentenceView& sentence) {
    FieldReader r(sentence);
    std::optional<PubxMessage> message;
    std::size_t least_fields = 0;
    if (sentence.address == "PUBX" && sentence.field(0) == "00")
        message = read_position(r), least_fields = 20;
    else if (sentence.address == "PUBX" && sentence.field(0) == "03")
        message = read_satellites(r), least_fields = 2;
    else if (sentence.address == "PUBX" && sentence.field(0) == "04")
        message = read_time(r), least_fields = 9;
    else
        r.refuse(0, "PUBX 00, 03 or 04");
    if (const Result<void> good = r.verdict(least_fields); !good) return fail(good.error());
    return *message;
}

}  // namespace skyloop::inline receiver
