#include "run/feed/feed_dialect.hpp"

#include <algorithm>
#include <iterator>

#include "detail/dialect_parts.hpp"

namespace skyloop::inline run {
namespace {

// One dialect.
struct NamedDialect {
    std::string_view name;
    std::unique_ptr<FeedDialect> (*make)(const FeedContext&);
    bool steps = false;
};

constexpr NamedDialect dialects[] = {
    {"ardupilot-json", make_ardupilot_json_dialect},
    {"betaflight", make_betaflight_dialect},
    {"flightgear", make_flightgear_dialect},
    {"flightgear-generic", make_flightgear_generic_dialect},
    {"gpsd", make_gpsd_dialect},
    {"jsbsim", make_jsbsim_dialect},
    {"json", make_json_dialect, true},
    {"mavlink", make_mavlink_dialect},
    {"nmea", make_nmea_dialect},
    {"px4", make_px4_dialect},
    {"ubx", make_ubx_dialect},
    {"xplane", make_xplane_dialect},
};

}  // namespace

std::unique_ptr<FeedDialect> make_dialect(std::string_view name, const FeedContext& context) {
    for (const NamedDialect& dialect : dialects)
        if (dialect.name == name) return dialect.make(context);
    return nullptr;
}

bool knows_steps(std::string_view dialect) {
    return std::any_of(std::begin(dialects), std::end(dialects),
                       [&](const NamedDialect& known) { return known.name == dialect && known.steps; });
}

}  // namespace skyloop::inline run
