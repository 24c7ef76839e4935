// Fields: semuconsulting/pynmeagps (nmeatypes_get_prop.py), SparkFun's LG290P library, captures of jclark/satpulse.
#include <fmt/format.h>

#include <cmath>

#include "firmware/messages/field_values.hpp"
#include "firmware/messages/make_message.hpp"
#include "firmware/quectel/settings.hpp"

namespace skyloop::firmware {
namespace {

struct Deviations {
    double north = 0, east = 0, down = 0;
};

// The horizontal deviation, parted as the DOPs are.
Deviations deviations_of(const Fix& fix) {
    const double horizontal = std::hypot(fix.dop.ndop, fix.dop.edop);
    const double per_dop = horizontal > 0 ? fix.horizontal_accuracy.value() / horizontal : 0;
    return {per_dop * fix.dop.ndop, per_dop * fix.dop.edop, fix.vertical_accuracy.value()};
}

std::string clock_text(const NavigationState& state) {
    if (!state.time.time) return {};
    constexpr std::uint32_t ms_ns = 1'000'000;
    const UtcTime utc = reported_utc(state);
    return fmt::format("{:02}{:02}{:02}.{:03}", utc.hour, utc.minute, utc.second, utc.nanosecond / ms_ns);
}

std::string date_text(const NavigationState& state) {
    if (!state.time.date) return {};
    const UtcTime utc = reported_utc(state);
    return fmt::format("{:04}{:02}{:02}", utc.year, utc.month, utc.day);
}

std::string epe_body(const ReportContext& context) {
    if (!has_solution(context.state)) return "PQTMEPE,2,,,,,";
    const Fix& fix = context.state.epoch.fix;
    const Deviations d = deviations_of(fix);
    const double horizontal = fix.horizontal_accuracy.value();
    return fmt::format("PQTMEPE,2,{:.3f},{:.3f},{:.3f},{:.3f},{:.3f}", d.north, d.east, d.down, horizontal,
                       std::hypot(horizontal, d.down));
}

std::string vel_body(const ReportContext& context) {
    const NavigationState& state = context.state;
    if (!has_solution(state)) return fmt::format("PQTMVEL,1,{},,,,,,,,,", clock_text(state));
    const Fix& fix = state.epoch.fix;
    return fmt::format("PQTMVEL,1,{},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.2f},{:.3f},{:.3f},{:.2f}", clock_text(state),
                       fix.velocity.north, fix.velocity.east, fix.velocity.down, fix.speed.value(),
                       std::hypot(fix.velocity.north, fix.velocity.east, fix.velocity.down),
                       state.course.value_or(fix.course).deg(), fix.speed_accuracy.value(), fix.speed_accuracy.value(),
                       reported_course_accuracy_deg(state));
}

// fix 0 none, 2 2D, 3 3D.
std::string pvt_body(const ReportContext& context) {
    const NavigationState& state = context.state;
    const Fix& fix = state.epoch.fix;
    const std::uint32_t tow = state.time.time ? whole_milliseconds(gps_stamp(fix.time)) : 0;
    const std::string head = fmt::format("PQTMPVT,1,{},{},{},", tow, date_text(state), clock_text(state));
    if (!has_solution(state)) return head + ",0,00,,,,,,,,,,,,";
    const int kind = fix.type == FixType::fix_2d ? 2 : 3;
    return head +
           fmt::format(",{},{:02},{},{:.8f},{:.8f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.2f},{:.2f},{:.2f}",
                       kind, fix.satellites_used(), fix.leap_seconds, fix.position.latitude.deg(),
                       fix.position.longitude.deg(), msl_height(fix), fix.geoid_undulation.value(), fix.velocity.north,
                       fix.velocity.east, fix.velocity.down, fix.speed.value(), state.course.value_or(fix.course).deg(),
                       reported_dop(fix.dop.hdop, has_dops(fix)), reported_dop(fix.dop.pdop, has_dops(fix)));
}

std::string dop_body(const ReportContext& context) {
    const Fix& fix = context.state.epoch.fix;
    const auto dop = [&](double value) { return reported_dop(value, has_dops(fix)); };
    return fmt::format("PQTMDOP,1,{},{:.2f},{:.2f},{:.2f},{:.2f},{:.2f},{:.2f},{:.2f}",
                       whole_milliseconds(gps_stamp(fix.time)), dop(fix.dop.gdop), dop(fix.dop.pdop), dop(fix.dop.tdop),
                       dop(fix.dop.vdop), dop(fix.dop.hdop), dop(fix.dop.ndop), dop(fix.dop.edop));
}

// valid 0 no, 1 under way, 2 done. The fifth field is not explained; captured: 11.
std::string survey_body(const ReportContext& context) {
    const NavigationState& state = context.state;
    const std::uint32_t tow = whole_milliseconds(gps_stamp(state.epoch.fix.time));
    const auto& survey = state.survey;
    if (!survey || !survey->mean())
        return fmt::format("PQTMSVINSTATUS,1,{},0,,11,0,0,0.0000,0.0000,0.0000,0.0000", tow);
    const auto mean = survey->mean()->vector();
    return fmt::format("PQTMSVINSTATUS,1,{},{},,11,{},{:.0f},{:.4f},{:.4f},{:.4f},{:.4f}", tow, survey->done() ? 2 : 1,
                       survey->positions(), survey->limits().least.value(), mean.x(), mean.y(), mean.z(),
                       survey->accuracy().value());
}

std::string end_body(const ReportContext& context) {
    const NavigationState& state = context.state;
    const WeekAndTow stamp = gps_stamp(state);
    return fmt::format("PQTMEOE,1,{},{},{},{}", clock_text(state), date_text(state), stamp.week,
                       whole_milliseconds(stamp));
}

}  // namespace

std::optional<std::string> quectel_sentence(std::string_view name, const ReportContext& context) {
    if (name == "PQTMEPE") return epe_body(context);
    if (name == "PQTMVEL") return vel_body(context);
    if (name == "PQTMPVT") return pvt_body(context);
    if (name == "PQTMDOP") return dop_body(context);
    if (name == "PQTMSVINSTATUS") return survey_body(context);
    if (name == "PQTMEOE") return end_body(context);
    return std::nullopt;
}

}  // namespace skyloop::firmware
