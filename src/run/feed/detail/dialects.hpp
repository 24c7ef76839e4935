// The dialects, one maker each; listed by name in feed_dialect.cpp.
#pragma once

#include <memory>

#include "run/feed/feed_dialect.hpp"

namespace skyloop {

std::unique_ptr<FeedDialect> make_ardupilot_json_dialect(const FeedContext& context);
std::unique_ptr<FeedDialect> make_betaflight_dialect(const FeedContext& context);
std::unique_ptr<FeedDialect> make_flightgear_dialect(const FeedContext& context);
std::unique_ptr<FeedDialect> make_flightgear_generic_dialect(const FeedContext& context);
std::unique_ptr<FeedDialect> make_gpsd_dialect(const FeedContext& context);
std::unique_ptr<FeedDialect> make_jsbsim_dialect(const FeedContext& context);
std::unique_ptr<FeedDialect> make_json_dialect(const FeedContext& context);  // skyloop-truth/1
std::unique_ptr<FeedDialect> make_mavlink_dialect(const FeedContext& context);
std::unique_ptr<FeedDialect> make_nmea_dialect(const FeedContext& context);
std::unique_ptr<FeedDialect> make_px4_dialect(const FeedContext& context);
std::unique_ptr<FeedDialect> make_ubx_dialect(const FeedContext& context);
std::unique_ptr<FeedDialect> make_xplane_dialect(const FeedContext& context);

}  // namespace skyloop
