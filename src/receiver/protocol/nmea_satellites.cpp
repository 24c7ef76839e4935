#include "receiver/protocol/nmea_satellites.hpp"

#include <array>
#include <span>

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

// The numbering in one byte (u-blox M8 protocol specification, "Satellite Numbering").
constexpr std::array<NumberRange, 7> single_byte_ranges{{
    {1, 32, Constellation::gps, 1},
    {33, 32, Constellation::beidou, 6},
    {65, 32, Constellation::glonass, 1},
    {120, 39, Constellation::sbas, 20},
    {159, 5, Constellation::beidou, 1},
    {193, 10, Constellation::qzss, 1},
    {211, 36, Constellation::galileo, 1},
}};

std::optional<SatelliteId> lookup(std::span<const NumberRange> ranges, int number) {
    for (const NumberRange& range : ranges)
        if (number >= range.first && number < range.first + range.count)
            return SatelliteId{range.constellation, range.from + number - range.first};
    return std::nullopt;
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

struct SignalId {
    Constellation constellation;
    Signal signal;
    int id;
};

// Of version 4.11. L2 and L5 are those of which receivers tell the civil long code and the pilot.
constexpr std::array<SignalId, 18> signal_ids{{
    {Constellation::gps, Signal::l1, 1},
    {Constellation::gps, Signal::l2, 6},
    {Constellation::gps, Signal::l5, 8},
    {Constellation::qzss, Signal::l1, 1},
    {Constellation::qzss, Signal::l2, 6},
    {Constellation::qzss, Signal::l5, 8},
    {Constellation::sbas, Signal::l1, 1},
    {Constellation::galileo, Signal::l1, 7},
    {Constellation::galileo, Signal::l5, 1},
    {Constellation::galileo, Signal::e5b, 2},
    {Constellation::beidou, Signal::b1i, 1},
    {Constellation::beidou, Signal::e5b, 0xB},
    {Constellation::beidou, Signal::l1, 3},
    {Constellation::beidou, Signal::l5, 5},
    {Constellation::beidou, Signal::b3i, 8},
    {Constellation::glonass, Signal::g1, 1},
    {Constellation::glonass, Signal::g2, 3},
    {Constellation::navic, Signal::l5, 1},
}};

}  // namespace

int nmea_signal_id(Constellation constellation, Signal signal, NmeaVersion version) {
    constexpr int b2i_before_4_11 = 3;
    if (constellation == Constellation::beidou && signal == Signal::e5b && version < NmeaVersion::v4_11)
        return b2i_before_4_11;
    for (const SignalId& row : signal_ids)
        if (row.constellation == constellation && row.signal == signal) return row.id;
    return 0;
}

NmeaSystem nmea_system(Constellation constellation, NmeaVersion version) {
    // In the order of Constellation.
    static constexpr std::array<NmeaSystem, constellation_names.size()> systems{
        {gps_group, gps_group, {"GA", 3, 7}, {"GB", 4, 1}, {"GQ", 5, 1}, {"GL", 2, 1}, {"GI", 6, 1}}};
    if (constellation == Constellation::qzss && version < NmeaVersion::v4_11) return gps_group;
    return systems.at(static_cast<std::size_t>(constellation));
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
        if (const auto satellite = lookup({&*own, 1}, number)) return satellite;
    return lookup(common_ranges, number);
}

std::optional<int> single_byte_number(SatelliteId satellite) {
    for (const NumberRange& range : single_byte_ranges) {
        const int place = satellite.number - range.from;
        if (satellite.constellation == range.constellation && place >= 0 && place < range.count)
            return range.first + place;
    }
    return std::nullopt;
}

std::optional<SatelliteId> single_byte_satellite(int number) { return lookup(single_byte_ranges, number); }

}  // namespace skyloop::inline receiver
