#include "detail/state_vector_record.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "base/time/utc_time.hpp"

namespace skyloop::rinex {
namespace {

constexpr std::array<std::string_view, 3> axis_names{"X", "Y", "Z"};

// Position, velocity and acceleration, one axis a line, in kilometres.
template <class StateVector>
void read_state_vector(RecordFields& fields, StateVector& record) {
    constexpr double metres = 1000;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t line = axis + 1;
        record.position_m[axis] = metres * fields.number({line, 0, axis_names[axis], -5e4, 5e4, true});
        record.velocity_mps[axis] = metres * fields.number({line, 1, "the velocity", -6, 6, true});
        record.acceleration_mps2[axis] = metres * fields.number({line, 2, "the acceleration", -1e-4, 1e-4, false});
    }
}

// What keeps an orbit from running through the Earth, where the equations of motion lose their meaning.
void check_radius(RecordFields& fields, const std::array<double, 3>& position, double least_km, double most_km) {
    const double radius_km = std::hypot(position[0], position[1], position[2]) / 1000;
    if (!fields.defect() && !(radius_km >= least_km && radius_km <= most_km))
        fields.refuse(1, 0, fmt::format("a satellite {:.0f} km from the Earth's centre", radius_km),
                      fmt::format("{} to {} km", least_km, most_km));
}

// F_T of GLONASS in metres (ICD L1, L2 GLONASS 5.1, table 4.4); 15 is no value.
double glonass_accuracy(int index) {
    constexpr std::array<double, 15> metres{1, 2, 2.5, 4, 5, 7, 10, 12, 14, 16, 32, 64, 128, 256, 512};
    return index >= 0 && index < static_cast<int>(metres.size()) ? metres[static_cast<std::size_t>(index)] : 0;
}

}  // namespace

tl::expected<GlonassEphemeris, Defect> read_glonass_record(const RecordKind& kind, RecordFields fields) {
    GlonassEphemeris eph;
    eph.satellite = kind.satellite;
    eph.clock_bias = fields.number({0, 1, "the clock offset", -1, 1, false});
    eph.clock_drift = fields.number({0, 2, "the relative frequency offset", -1e-6, 1e-6, false});
    read_state_vector(fields, eph);
    check_radius(fields, eph.position_m, 20000, 32000);
    eph.health = fields.whole({1, 3, "the health", 0, 255, false});
    eph.frequency_channel = fields.whole({2, 3, "the frequency channel", -13, 255, false});
    if (eph.frequency_channel > 128) eph.frequency_channel -= 256;  // a signed byte written without its sign
    if (!fields.defect() && (eph.frequency_channel < -13 || eph.frequency_channel > 24))
        fields.refuse(2, 3, fmt::format("frequency channel {}", eph.frequency_channel), "a channel from -13 to 24");
    if (fields.line_count() > 4) {
        // 999999999999e-3 and the like stand for an unknown delay.
        const double delay = fields.number({4, 1, "the delay of L2", -1e12, 1e12, false});
        if (std::abs(delay) < 1e-6) eph.group_delay_l2 = delay;
        eph.accuracy_m = glonass_accuracy(fields.whole({4, 2, "the accuracy index", -1e9, 1e9, false}));
    }
    const GpsTime utc = fields.epoch();
    if (fields.defect()) return tl::make_unexpected(*fields.defect());
    eph.toe = from_utc_count(utc.time_since_epoch(), LeapSeconds::announced());
    constexpr std::int64_t moscow_s = 3 * 3600, quarter_hour_s = 900;
    const std::int64_t of_day = std::chrono::floor<std::chrono::seconds>(utc.time_since_epoch()).count() + moscow_s;
    eph.iode = static_cast<int>(of_day % seconds_per_day / quarter_hour_s);
    return eph;
}

tl::expected<SbasEphemeris, Defect> read_sbas_record(const RecordKind& kind, RecordFields fields) {
    SbasEphemeris eph;
    eph.satellite = kind.satellite;
    eph.clock_bias = fields.number({0, 1, "the clock offset", -1, 1, false});
    eph.clock_drift = fields.number({0, 2, "the relative frequency offset", -1e-6, 1e-6, false});
    read_state_vector(fields, eph);
    check_radius(fields, eph.position_m, 35000, 50000);
    eph.health = fields.whole({1, 3, "the health", 0, 65535, false});
    eph.accuracy_m = fields.number({2, 3, "the accuracy", -1, 1e12, false});
    eph.iode = fields.whole({3, 3, "the issue of data", 0, 65535, false});
    eph.toe = fields.epoch();
    if (fields.defect()) return tl::make_unexpected(*fields.defect());
    return eph;
}

}  // namespace skyloop::rinex
