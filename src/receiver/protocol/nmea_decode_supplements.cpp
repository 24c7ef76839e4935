#include "detail/nmea_field_reader.hpp"

namespace skyloop::nmea_decoding {

Result<NmeaMessage> decode_gns(FieldReader r) {
    Gns m;
    m.talker = r.talker();
    m.time = r.time(0);
    m.position = r.position(1);
    for (const char letter : r.text(5)) {
        if (std::string_view("NADEFRMSP").find(letter) == std::string_view::npos) r.refuse(5, "mode indicators");
        m.modes.push_back(static_cast<NmeaMode>(letter));
    }
    m.satellites_used = r.integer(6, "a number of satellites").value_or(0);
    m.hdop = r.number(7, "a DOP");
    m.altitude = r.metres(8, "an altitude");
    m.geoid_separation = r.metres(9, "a geoid separation");
    if (const auto age = r.number(10, "an age of corrections")) m.correction_age = Seconds(*age);
    m.correction_station = r.integer(11, "a station number");
    return r.finish(std::move(m), 12);
}

Result<NmeaMessage> decode_gbs(FieldReader r) {
    Gbs m;
    m.talker = r.talker();
    m.time = r.time(0);
    m.latitude = r.metres(1, "an error");
    m.longitude = r.metres(2, "an error");
    m.altitude = r.metres(3, "an error");
    m.satellite = r.integer(4, "a satellite");
    m.missed_probability = r.number(5, "a probability");
    m.bias = r.metres(6, "a bias");
    m.bias_deviation = r.metres(7, "a deviation");
    m.system_id = r.integer(8, "a system id", 16);
    m.signal_id = r.integer(9, "a signal id", 16);
    return r.finish(std::move(m), 8);
}

Result<NmeaMessage> decode_grs(FieldReader r) {
    constexpr std::size_t first = 2, last = 14;
    Grs m;
    m.talker = r.talker();
    m.time = r.time(0);
    m.mode = r.integer(1, "a mode").value_or(0);
    for (std::size_t i = first; i < last; ++i)
        m.residuals.push_back(r.metres(i, "a residual"));
    while (!m.residuals.empty() && !m.residuals.back())
        m.residuals.pop_back();
    m.system_id = r.integer(14, "a system id", 16);
    m.signal_id = r.integer(15, "a signal id", 16);
    return r.finish(std::move(m), 14);
}

Result<NmeaMessage> decode_dtm(FieldReader r) {
    Dtm m;
    m.talker = r.talker();
    m.datum = r.text(0);
    m.subdivision = r.text(1);
    const double north = r.number(2, "an offset").value_or(0), east = r.number(4, "an offset").value_or(0);
    m.latitude_minutes = r.either(3, "NS", "N or S") ? north : -north;
    m.longitude_minutes = r.either(5, "EW", "E or W") ? east : -east;
    m.altitude_m = r.number(6, "an offset").value_or(0);
    m.reference = r.text(7);
    return r.finish(std::move(m), 8);
}

Result<NmeaMessage> decode_vlw(FieldReader r) {
    constexpr double nautical_mile = 1852.0;
    Vlw m;
    m.talker = r.talker();
    if (const auto total = r.number(4, "a distance")) m.total = Metres(*total * nautical_mile);
    if (const auto trip = r.number(6, "a distance")) m.since_reset = Metres(*trip * nautical_mile);
    return r.finish(std::move(m), 4);
}

Result<NmeaMessage> decode_ths(FieldReader r) {
    Ths m;
    m.talker = r.talker();
    m.heading = r.degrees(0, "a heading");
    if (r.text(1).size() != 1 || std::string_view("AEMSV").find(r.text(1)[0]) == std::string_view::npos)
        r.refuse(1, "a mode");
    else
        m.mode = r.text(1)[0];
    return r.finish(std::move(m), 2);
}

Result<NmeaMessage> decode_hdt(FieldReader r) {
    Hdt m;
    m.talker = r.talker();
    m.heading = r.degrees(0, "a heading");
    r.either(1, "T", "T");
    return r.finish(std::move(m), 2);
}

}  // namespace skyloop::nmea_decoding
