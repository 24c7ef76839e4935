#include "firmware/unicore/log_parts.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "firmware/messages/field_values.hpp"
#include "firmware/unicore/settings.hpp"
#include "receiver/protocol/unicore_logs.hpp"

namespace skyloop::firmware {

std::uint32_t unicore_type_number(std::string_view word) { return unicore_number(unicore_type_words, word); }

std::uint32_t unicore_type(const NavigationState& state) {
    if (!has_solution(state)) return 0;
    if (state.place_given) return unicore_type_number("FIXEDPOS");
    switch (state.epoch.fix.type) {
        case FixType::dgnss:
            return unicore_type_number(state.epoch.fix.sbas_source ? "SBAS" : "PSRDIFF");
        case FixType::rtk_float:
            return unicore_type_number("NARROW_FLOAT");
        case FixType::rtk_fixed:
            return unicore_type_number("NARROW_INT");
        default:
            return unicore_type_number("SINGLE");
    }
}

std::uint8_t tracked_satellites(const Fix& fix) {
    return nearest<std::uint8_t>(static_cast<double>(
        std::ranges::count_if(fix.satellites, [](const SatelliteStatus& s) { return s.cn0.has_value(); })));
}

UnicoreDeviations position_deviations(const Fix& fix) {
    const double horizontal = std::hypot(fix.dop.ndop, fix.dop.edop);
    const double per_dop = horizontal > 0 ? fix.horizontal_accuracy.value() / horizontal : 0;
    return {per_dop * fix.dop.ndop, per_dop * fix.dop.edop, fix.vertical_accuracy.value()};
}

UnicoreDeviations velocity_deviations(const Fix& fix) {
    const double dops = std::hypot(fix.dop.ndop, fix.dop.edop, fix.dop.vdop);
    const double per_dop = dops > 0 ? fix.speed_accuracy.value() / dops : 0;
    return {per_dop * fix.dop.ndop, per_dop * fix.dop.edop, per_dop * fix.dop.vdop};
}

std::optional<OtherAntenna> other_antenna(const ReportContext& context) {
    const auto& relative = context.state.epoch.relative;
    if (!relative || !relative->base_moves) return std::nullopt;
    const double north = relative->north_m, east = relative->east_m, up = -relative->down_m;
    const double horizontal = std::hypot(north, east);
    if (!(horizontal > 0)) return std::nullopt;
    constexpr double degrees = 180 / std::numbers::pi;
    const double heading = std::atan2(east, north) * degrees;
    const double length = std::hypot(horizontal, up);
    const double down =
        relative->down_deviation.value() > 0 ? relative->down_deviation.value() : relative->deviation.value();
    return OtherAntenna{length,
                        heading < 0 ? heading + 360 : heading,
                        std::atan2(up, horizontal) * degrees,
                        std::min(180.0, relative->deviation.value() / horizontal * degrees),
                        std::min(90.0, down / length * degrees),
                        relative->fixed};
}

std::uint16_t unicore_prn(SatelliteId id) {
    constexpr int glonass = 37, galileo = 70, beidou = 160, qzss = 192, sbas = 100;
    switch (id.constellation) {
        case Constellation::glonass:
            return static_cast<std::uint16_t>(glonass + id.number);
        case Constellation::galileo:
            return static_cast<std::uint16_t>(galileo + id.number);
        case Constellation::beidou:
            return static_cast<std::uint16_t>(beidou + id.number);
        case Constellation::qzss:
            return static_cast<std::uint16_t>(qzss + id.number);
        case Constellation::sbas:
            return static_cast<std::uint16_t>(sbas + id.number);
        default:
            return static_cast<std::uint16_t>(id.number);
    }
}

void put_unicore_station(const NavigationState& state, std::array<char, 4>& to) {
    if (state.corrections.station && state.corrections.state != CorrectionState::none)
        put_text(to, std::to_string(*state.corrections.station));
}

float unicore_age(const NavigationState& state) {
    const bool corrected = state.corrections.state != CorrectionState::none && state.corrections.age;
    return corrected ? static_cast<float>(state.corrections.age->value()) : 0.0F;
}

}  // namespace skyloop::firmware
