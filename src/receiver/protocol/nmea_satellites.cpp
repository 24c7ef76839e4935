#include "receiver/protocol/nmea_satellites.hpp"

#include <array>

namespace skyloop::inline receiver {
namespace {

constexpr NmeaSystem gps_group{"GP", 1, 1};

// Numbers `first` … `first + count − 1` stand for a constellation's satellites from `from` on.
struct NumberRange {
    int first;
    int count;
    Constellation constellation;
    int from;
};

// Ranges that mean the same beside every talker (vendor ranges included).
constexpr std::array<NumberRange, 8> common_ranges{{
    {1, 32, Constellation::gps, 1},
    {33, 32, Constellation::sbas, 20},
    {65, 32, Constellation::glonass, 1},
    {152, 7, Constellation::sbas, 52},
    {193, 10, Constellation::qzss, 1},
    {201, 63, Constellation::beidou, 1},
    {301, 36, Constellation::galileo, 1},
    {401, 63, Constellation::beidou, 1},
}};

std::optional<SatelliteId> lookup(const NumberRange& range, int number) {
    if (number < range.first || number >= range.first + range.count) return std::nullopt;
    return SatelliteId{range.constellation, range.from + number - range.first};
}

// The system that numbers from 1 on belong to.
std::optional<NumberRange> own_range(std::string_view talker, int system_id) {
    if (talker == "GL" || system_id == 2) return NumberRange{1, 32, Constellation::glonass, 1};
    if (talker == "GA" || system_id == 3) return NumberRange{1, 36, Constellation::galileo, 1};
    if (talker == "GB" || talker == "BD" || system_id == 4) return NumberRange{1, 63, Constellation::beidou, 1};
    if (talker == "GQ" || talker == "QZ" || system_id == 5) return NumberRange{1, 10, Constellation::qzss, 1};
    if (talker == "GI" || system_id == 6) return NumberRange{1, 14, Constellation::navic, 1};
    return std::nullopt;
}

std::optional<int> sbas_number(int number, NmeaNumbering numbering) {
    if (number >= 20 && number <= 51) return number + 13;
    if (number >= 52 && number <= 58 && numbering == NmeaNumbering::extended) return number + 100;
    return std::nullopt;
}

std::optional<int> within(int number, int last, int offset) {
    if (number < 1 || number > last) return std::nullopt;
    return number + offset;
}

// Galileo and BeiDou have numbers of their own from 4.10 on; before, only the maker's.
std::optional<int> added_in_4_10(int number, int last, int offset, bool since_4_10, NmeaNumbering numbering) {
    if (since_4_10) return within(number, last, 0);
    return numbering == NmeaNumbering::extended ? within(number, last, offset) : std::nullopt;
}

// L2 and L5 are those of which receivers tell the civil long code and the pilot.
int gps_signal_id(Signal signal) {
    switch (signal) {
        case Signal::l1:
            return 1;
        case Signal::l2:
            return 6;
        case Signal::l5:
            return 8;
        default:
            return 0;
    }
}

int galileo_signal_id(Signal signal) {
    switch (signal) {
        case Signal::l1:
            return 7;
        case Signal::l5:
            return 1;
        case Signal::e5b:
            return 2;
        default:
            return 0;
    }
}

int beidou_signal_id(Signal signal, NmeaVersion version) {
    switch (signal) {
        case Signal::b1i:
            return 1;
        case Signal::e5b:
            return version >= NmeaVersion::v4_11 ? 0xB : 3;
        case Signal::l1:
            return 3;
        case Signal::l5:
            return 5;
        case Signal::b3i:
            return 8;
        default:
            return 0;
    }
}

}  // namespace

int nmea_signal_id(Constellation constellation, Signal signal, NmeaVersion version) {
    switch (constellation) {
        case Constellation::gps:
        case Constellation::qzss:
            return gps_signal_id(signal);
        case Constellation::sbas:
            return signal == Signal::l1 ? 1 : 0;
        case Constellation::galileo:
            return galileo_signal_id(signal);
        case Constellation::beidou:
            return beidou_signal_id(signal, version);
        case Constellation::glonass:
            return signal == Signal::g1 ? 1 : signal == Signal::g2 ? 3 : 0;
        case Constellation::navic:
            return signal == Signal::l5 ? 1 : 0;
    }
    return 0;
}

NmeaSystem nmea_system(Constellation constellation, NmeaVersion version) {
    switch (constellation) {
        case Constellation::gps:
        case Constellation::sbas:
            return gps_group;
        case Constellation::glonass:
            return {"GL", 2, 1};
        case Constellation::galileo:
            return {"GA", 3, 7};
        case Constellation::beidou:
            return {"GB", 4, 1};
        case Constellation::qzss:
            return version >= NmeaVersion::v4_11 ? NmeaSystem{"GQ", 5, 1} : gps_group;
        case Constellation::navic:
            return {"GI", 6, 1};
    }
    return gps_group;
}

std::optional<int> nmea_satellite_number(SatelliteId satellite, NmeaVersion version, NmeaNumbering numbering) {
    const int n = satellite.number;
    const bool since_4_10 = version >= NmeaVersion::v4_10;
    switch (satellite.constellation) {
        case Constellation::gps:
            return within(n, 32, 0);
        case Constellation::sbas:
            return sbas_number(n, numbering);
        case Constellation::galileo:
            return added_in_4_10(n, 36, 300, since_4_10, numbering);
        case Constellation::beidou:
            return added_in_4_10(n, 63, 400, since_4_10, numbering);
        case Constellation::qzss:
            return added_in_4_10(n, 10, 192, version >= NmeaVersion::v4_11, numbering);
        case Constellation::glonass:
            return within(n, 32, 64);
        case Constellation::navic:
            return since_4_10 ? within(n, 14, 0) : std::nullopt;
    }
    return std::nullopt;
}

std::optional<SatelliteId> satellite_from_nmea(int number, std::string_view talker, int system_id) {
    if (const auto own = own_range(talker, system_id))
        if (const auto satellite = lookup(*own, number)) return satellite;
    for (const NumberRange& range : common_ranges)
        if (const auto satellite = lookup(range, number)) return satellite;
    return std::nullopt;
}

}  // namespace skyloop::inline receiver
