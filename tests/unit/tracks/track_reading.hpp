/// How the tests of formats read texts.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <string_view>

#include "base/time/utc_time.hpp"
#include "motion/tracks/read_track.hpp"
#include "support/flat_geoid.hpp"

namespace skyloop::test {

inline ByteSpan bytes_of(std::string_view text) {
    return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

/// The track of a text, with a geoid that stands 10 m above the ellipsoid; the test fails where it is refused.
inline Track track_of(std::string_view text, const std::string& name = "t.txt",
                      const std::optional<Geodetic>& origin = std::nullopt) {
    const auto geoid = flat_geoid(10);
    EXPECT_TRUE(geoid.has_value());
    auto track = read_track(bytes_of(text), name, {&*geoid, origin});
    EXPECT_TRUE(track.has_value()) << (track ? "" : track.error().message);
    return track ? std::move(*track) : Track{};
}

/// Why a text is refused: one line that begins with the name.
inline std::string refusal_of_track(std::string_view text, const std::string& name = "t.txt") {
    const auto geoid = flat_geoid(10);
    const auto track = read_track(bytes_of(text), name, {&*geoid, {}});
    EXPECT_FALSE(track.has_value()) << text;
    if (track) return {};
    EXPECT_EQ(track.error().message.find('\n'), std::string::npos);
    EXPECT_TRUE(track.error().message.starts_with(name)) << track.error().message;
    return track.error().message;
}

/// The time of a row, UTC.
inline std::string utc_of(const Track& track, std::size_t row) {
    return format_utc(to_utc(track.origin.value_or(GpsTime{}) + track.points.at(row).time, LeapSeconds::announced()),
                      3);
}

inline Geodetic place_of(const Track& track, std::size_t row) { return to_geodetic(track.points.at(row).position); }

inline double height_of(const Track& track, std::size_t row) {
    return place_of(track, row).height.above_ellipsoid.value();
}

}  // namespace skyloop::test
