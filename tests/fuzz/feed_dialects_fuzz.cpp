// Dialects of live sources: the first byte picks one and says whether the rest comes in pieces.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <string_view>

#include "require.hpp"
#include "run/feed/feed_dialect.hpp"

namespace {

constexpr std::string_view names[] = {"ardupilot-json",
                                      "betaflight",
                                      "flightgear",
                                      "flightgear-generic",
                                      "gpsd",
                                      "jsbsim",
                                      "mavlink",
                                      "nmea",
                                      "px4",
                                      "ubx",
                                      "xplane"};

void check_sound(const skyloop::FeedNews& news) {
    constexpr double deepest_m = 5.3e6, highest_m = 7.5e6;
    for (const skyloop::TruthSample& sample : news.samples) {
        const double radius = sample.position.vector().norm();
        skyloop::require(radius > deepest_m && radius < highest_m);
        if (sample.velocity) skyloop::require(sample.velocity->vector().allFinite());
        if (sample.turn_rate) skyloop::require(sample.turn_rate->allFinite());
        if (sample.attitude) skyloop::require(std::isfinite(sample.attitude->yaw().rad()));
    }
    skyloop::require((news.refused > 0) == !news.refusal.empty());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace skyloop;
    if (size == 0) return 0;
    FeedContext context;
    context.origin = Geodetic::degrees(47, 8, 500);
    context.smooth = (data[0] & 0x80u) != 0;
    const auto dialect = make_dialect(names[(data[0] & 0x3Fu) % std::size(names)], context);
    const std::size_t longest = (data[0] & 0x40u) != 0 ? 7 : size;
    ByteSpan rest(data + 1, size - 1);
    std::int64_t now = 0;
    while (!rest.empty()) {
        const std::size_t piece = rest.size() < longest ? rest.size() : longest;
        check_sound(dialect->hear(rest.first(piece), now));
        rest = rest.subspan(piece);
        now += 20'000'000;
    }
    check_sound(dialect->hear(ByteSpan(data + 1, size - 1), now));
    for (const Bytes& word : dialect->say())
        require(!word.empty());
    dialect->reconnected();
    return 0;
}
