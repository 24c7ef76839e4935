#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string>

#include "base/core/bytes.hpp"
#include "detail/rtcm3_ephemeris_fields.hpp"
#include "receiver/protocol/field_lister.hpp"
#include "receiver/protocol/rtcm3.hpp"
#include "receiver/protocol/rtcm3_descriptors.hpp"
#include "receiver/protocol/rtcm3_ephemeris.hpp"
#include "receiver/protocol/rtcm3_legacy.hpp"
#include "receiver/protocol/rtcm3_ublox.hpp"

namespace skyloop::inline receiver {
namespace {

DecodedValue rounded(double value) {
    constexpr double per_metre = 1e4;
    return {std::round(value * per_metre) / per_metre};
}
DecodedValue rounded(std::optional<double> value) { return value ? rounded(*value) : DecodedValue(); }

DecodedValue cell_value(const Rtcm3MsmCell& cell) {
    std::vector<DecodedField> fields;
    fields.push_back({"satellite", {std::uint64_t(cell.satellite)}});
    fields.push_back({"signal", {std::uint64_t(cell.signal)}});
    fields.push_back({"pseudorange_m", rounded(cell.range_m)});
    fields.push_back({"phase_range_m", rounded(cell.phase_range_m)});
    fields.push_back({"range_rate_mps", rounded(cell.phase_range_rate)});
    fields.push_back({"lock_s", {cell.lock_s}});
    fields.push_back({"half_cycle_unknown", {std::uint64_t(cell.half_cycle_unknown)}});
    fields.push_back({"cno_dbhz", {cell.cno_dbhz}});
    return {std::move(fields)};
}

void list_carrier(const Rtcm3LegacyCarrier& carrier, std::string_view name, int number, std::vector<DecodedField>& to) {
    const auto named = [&](std::string_view quantity) { return fmt::format("{}_{}", name, quantity); };
    to.push_back({named("code"), {std::uint64_t(carrier.code)}});
    to.push_back({named("pseudorange_m"), rounded(carrier.range_m)});
    to.push_back({named("phase_range_m"), rounded(carrier.phase_range_m)});
    to.push_back({named("lock_s"), {carrier.lock_s}});
    if (is_extended_legacy(number)) to.push_back({named("cno_dbhz"), {carrier.cno_dbhz}});
}

// The basic messages tell ranges and phases modulo the light's way in one or two milliseconds.
DecodedValue legacy_value(const Rtcm3LegacySatellite& satellite, int number) {
    std::vector<DecodedField> fields;
    fields.push_back({"satellite", {std::uint64_t(satellite.satellite)}});
    if (number >= 1009) fields.push_back({"frequency_channel", {std::int64_t{satellite.frequency_channel}}});
    list_carrier(satellite.l1, "l1", number, fields);
    if (satellite.l2) list_carrier(*satellite.l2, "l2", number, fields);
    return {std::move(fields)};
}

// The fields of an ephemeris under their names (detail/rtcm3_ephemeris_fields.hpp).
class EphemerisLister {
public:
    explicit EphemerisLister(ByteSpan payload) : reader_(payload) { reader_.skip(12); }
    void whole(std::string_view name, std::int64_t&, int width) { add(name, {reader_.get(width)}); }
    void time(std::string_view name, std::int64_t&, int width, int step) {
        add(name, {reader_.get(width) * static_cast<std::uint64_t>(step)});
    }
    void scaled(std::string_view name, double&, int width, double step) {
        add(name, {static_cast<double>(reader_.get_signed(width)) * step});
    }
    void unsigned_scaled(std::string_view name, double&, int width, double step) {
        add(name, {static_cast<double>(reader_.get(width)) * step});
    }
    void circle(std::string_view name, double& value) { scaled(name, value, 32, sc * step(-31)); }
    void magnitude(std::string_view name, double&, int width, double step) {
        const bool negative = reader_.get(1) != 0;
        add(name, {static_cast<double>(reader_.get(width - 1)) * (negative ? -step : step)});
    }
    void skip(int width) { reader_.skip(static_cast<std::size_t>(width)); }
    [[nodiscard]] bool complete() const { return reader_.ok(); }
    std::vector<DecodedField> take() { return std::move(fields_); }

private:
    void add(std::string_view name, DecodedValue value) { fields_.push_back({std::string(name), std::move(value)}); }

    BitReader reader_;
    std::vector<DecodedField> fields_;
};

std::optional<std::vector<DecodedField>> listed_ephemeris(int number, ByteSpan payload) {
    EphemerisLister lister(payload);
    KeplerFields kepler;
    GlonassFields glonass;
    if (!ephemeris_fields(lister, number, kepler, glonass) || !lister.complete()) return std::nullopt;
    return lister.take();
}

std::optional<std::vector<DecodedField>> listed_descriptors(const Rtcm3Message& message) {
    const auto told = decode_descriptors(message);
    if (!told) return std::nullopt;
    std::vector<DecodedField> fields{{"station", {std::uint64_t(told->station)}},
                                     {"antenna", {told->antenna}},
                                     {"antenna_setup", {std::uint64_t(told->antenna_setup)}}};
    if (told->number != 1007) fields.push_back({"antenna_serial", {told->antenna_serial}});
    if (told->number != 1033) return fields;
    fields.push_back({"receiver", {told->receiver}});
    fields.push_back({"firmware", {told->firmware}});
    fields.push_back({"receiver_serial", {told->receiver_serial}});
    return fields;
}

std::vector<DecodedField> ublox_head_fields(const Rtcm3UbloxHead& head, std::uint64_t subtype) {
    return {{"subtype", {subtype}},
            {"station", {std::uint64_t(head.station)}},
            {"kind", {std::uint64_t(head.kind)}},
            {"tow_s", {head.epoch / 1e3}}};
}

// What is inside of 4072.0 real receivers have in another order, which nobody has published.
std::optional<std::vector<DecodedField>> listed_ublox(const Rtcm3Message& message) {
    if (const auto told = decode_moving_station(message)) {
        auto fields = ublox_head_fields(told->head, 0);
        constexpr std::array<std::string_view, 3> axes{"x", "y", "z"};
        for (std::size_t i = 0; i < 3; ++i)
            fields.push_back({fmt::format("ecef_{}_m", axes[i]), {static_cast<double>(told->position[i]) / 1e4}});
        for (std::size_t i = 0; i < 3; ++i)
            fields.push_back({fmt::format("velocity_{}_mps", axes[i]), {told->velocity[i] / 1e3}});
        fields.push_back({"position_acc_m", {told->position_deviation_mm / 1e3}});
        fields.push_back({"velocity_acc_mps", {told->velocity_deviation / 1e3}});
        return fields;
    }
    const auto told = decode_station_biases(message);
    if (!told) return std::nullopt;
    std::vector<DecodedValue> biases;
    for (const Rtcm3StationBiases::Bias& bias : told->biases)
        biases.push_back({std::vector<DecodedField>{{"gnss_id", {std::uint64_t{bias.system}}},
                                                    {"band", {std::uint64_t{bias.band}}},
                                                    {"offset", {std::int64_t{bias.offset}}},
                                                    {"deviation", {std::uint64_t{bias.deviation}}}}});
    auto fields = ublox_head_fields(told->head, 1);
    fields.push_back({"biases", {std::move(biases)}});
    return fields;
}

// Of a payload, whose frame is not at hand.
Rtcm3Message message_of(int number, ByteSpan payload) {
    BitReader bits(payload);
    bits.skip(12);
    Rtcm3Message message{number, {}, static_cast<int>(bits.get(12)), payload};
    return message;
}

class RtcmLister {
public:
    explicit RtcmLister(ByteSpan payload) : reader_(payload) {}

    std::uint64_t number(std::string_view name, unsigned bits) {
        const std::uint64_t value = reader_.get(static_cast<int>(bits));
        fields_.push_back({std::string(name), {value}});
        return value;
    }
    template <FieldText Declared>
    void scaled(unsigned bits, bool is_signed) {
        static constexpr FieldFormat format = field_format(Declared.view());
        const auto width = static_cast<int>(bits);
        fields_.push_back({std::string(format.name), is_signed ? scaled_value(reader_.get_signed(width), format)
                                                               : scaled_value(reader_.get(width), format)});
    }
    /// The numbers of the bits that are set, the first being 1.
    void mask(std::string_view name, unsigned bits) {
        std::vector<DecodedValue> set;
        for (unsigned i = 1; i <= bits; ++i)
            if (reader_.get(1) != 0) set.push_back({std::uint64_t{i}});
        fields_.push_back({std::string(name), {std::move(set)}});
    }
    void skip(unsigned bits) { reader_.skip(bits); }
    [[nodiscard]] bool complete() const { return reader_.ok(); }
    std::vector<DecodedField> take() { return std::move(fields_); }

private:
    BitReader reader_;
    std::vector<DecodedField> fields_;
};

// Of 1071 …, 1081 … and so on (RTCM 10403.3, table 3.5-78).
constexpr std::array<std::string_view, 7> msm_systems{"GPS", "GLONASS", "Galileo", "SBAS", "QZSS", "BeiDou", "NavIC"};

bool is_gps_observables(int number) { return number >= 1001 && number <= 1004; }
bool is_glonass_observables(int number) { return number >= 1009 && number <= 1012; }

// On L1, extended with ambiguity and C/N0 or not, then on both carriers.
std::string observables_name(int number) {
    const int form = number - (is_gps_observables(number) ? 1001 : 1009);
    return fmt::format("{} L1{} observables{}", is_gps_observables(number) ? "GPS" : "GLONASS",
                       form >= 2 ? " and L2" : "", form % 2 == 0 ? ", basic" : "");
}

struct Rtcm3Name {
    int number;
    std::string_view name;
};
constexpr std::array<Rtcm3Name, 14> rtcm3_names{{
    {1005, "station position"},
    {1006, "station position and antenna height"},
    {1007, "antenna"},
    {1008, "antenna"},
    {1019, "GPS ephemeris"},
    {1020, "GLONASS ephemeris"},
    {1033, "receiver and antenna"},
    {1041, "NavIC ephemeris"},
    {1042, "BeiDou ephemeris"},
    {1044, "QZSS ephemeris"},
    {1045, "Galileo F/NAV ephemeris"},
    {1046, "Galileo I/NAV ephemeris"},
    {1230, "GLONASS code-phase biases"},
    {4072, "u-blox reference station"},
}};

std::string rtcm3_name(int number) {
    if (is_gps_observables(number) || is_glonass_observables(number)) return observables_name(number);
    if (const auto kind = msm_kind(number))
        return fmt::format("{} MSM{}", msm_systems[static_cast<std::size_t>((number - 1071) / 10)], *kind);
    for (const Rtcm3Name& known : rtcm3_names)
        if (known.number == number) return std::string(known.name);
    return {};
}

// GPS, Galileo, QZSS and BeiDou count milliseconds of a week, GLONASS a day and milliseconds of it (DF034, DF416).
void list_msm(int number, RtcmLister& to) {
    to.number("station", 12);
    if ((number - 1071) / 10 == 1) {
        to.number("day_of_week", 3);
        to.scaled<"time_of_day_s*1e-3">(27, false);
    } else {
        to.scaled<"tow_s*1e-3">(30, false);
    }
    to.number("more_follow", 1);
    to.number("issue", 3);
    to.skip(7);
    to.number("clock_steering", 2);
    to.number("external_clock", 2);
    to.number("smoothing", 1);
    to.number("smoothing_interval", 3);
    to.mask("satellites", 64);
    to.mask("signals", 32);
}

void list_station(int number, RtcmLister& to) {
    to.number("station", 12);
    to.number("itrf_year", 6);
    to.skip(4);
    to.scaled<"ecef_x_m*1e-4">(38, true);
    to.skip(2);
    to.scaled<"ecef_y_m*1e-4">(38, true);
    to.skip(2);
    to.scaled<"ecef_z_m*1e-4">(38, true);
    if (number == 1006) to.scaled<"antenna_height_m*1e-4">(16, false);
}

// Legacy observables: the head alone (RTCM 10403.3, tables 3.5-1 and 3.5-9).
void list_observables(int number, RtcmLister& to) {
    to.number("station", 12);
    if (is_gps_observables(number))
        to.scaled<"tow_s*1e-3">(30, false);
    else
        to.scaled<"time_of_day_s*1e-3">(27, false);
    to.number("more_follow", 1);
    to.number("satellites", 5);
    to.number("divergence_free", 1);
    to.number("smoothing_interval", 3);
}

// The cells of observations that are there as a whole.
void list_cells(int number, ByteSpan payload, std::vector<DecodedField>& to) {
    const Rtcm3Message message{number, {}, 0, payload};
    std::vector<DecodedValue> cells;
    if (const auto observed = decode_msm(message))
        for (const Rtcm3MsmCell& cell : observed->cells)
            cells.push_back(cell_value(cell));
    else if (const auto observables = decode_legacy(message))
        for (const Rtcm3LegacySatellite& satellite : observables->satellites)
            cells.push_back(legacy_value(satellite, number));
    else
        return;
    to.push_back({"cells", {std::move(cells)}});
}

bool list_known(int number, RtcmLister& to) {
    if (msm_kind(number)) {
        list_msm(number, to);
    } else if (number == 1005 || number == 1006) {
        list_station(number, to);
    } else if (is_gps_observables(number) || is_glonass_observables(number)) {
        list_observables(number, to);
    } else if (number == 1230) {
        to.number("station", 12);
    } else if (number == 4072) {
        to.number("subtype", 12);
    } else {
        return false;
    }
    return to.complete();
}

}  // namespace

void list_rtcm3(ByteSpan payload, DecodedMessage& message) {
    if (payload.size() < 2) {
        message.id = "none";
        message.payload.assign(payload.begin(), payload.end());
        return;
    }
    RtcmLister lister(payload);
    const int number = payload[0] << 4 | payload[1] >> 4;
    lister.skip(12);
    message.id = fmt::format("{}", number);
    message.name = rtcm3_name(number);
    if (auto descriptors = listed_descriptors({number, {}, 0, payload})) {
        message.fields = std::move(*descriptors);
    } else if (auto own = listed_ublox(message_of(number, payload))) {
        message.fields = std::move(*own);
    } else if (auto ephemeris = listed_ephemeris(number, payload)) {
        message.fields = std::move(*ephemeris);
    } else if (list_known(number, lister)) {
        message.fields = lister.take();
        list_cells(number, payload, message.fields);
    } else {
        message.payload.assign(payload.begin(), payload.end());
    }
}

}  // namespace skyloop::inline receiver
