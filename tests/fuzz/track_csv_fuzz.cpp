// Any text as a track: a clear error, or a path that is finite everywhere.
#include <cstdint>
#include <string_view>

#include "motion/trajectory/recorded_path.hpp"
#include "motion/trajectory/track_csv.hpp"
#include "require.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace skyloop;
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    auto track = read_track_csv(text, "fuzz.csv", nullptr);
    if (!track) {
        require(track.error().message.starts_with("fuzz.csv:"));
        require(track.error().message.find('\n') == std::string::npos);
        return 0;
    }
    // The length of the text chooses among the ways to lead a curve.
    const auto gaps = clean_track(*track, Seconds(10), static_cast<GapPolicy>(size % 4));
    if (!gaps) return 0;
    const GpsTime start = to_gps_time(2304, 0.0);
    const RecordedPath path(
        *track, *gaps, start,
        {static_cast<VehicleClass>(size % track_vehicle_count), {}, static_cast<Smoothing>(size % 3)});
    for (int i = -1; i <= 21; ++i) {
        const TruthState state = path.at(advanced(start, Seconds(path.duration().value() * i / 20)));
        require(state.position.vector().allFinite() && state.velocity.vector().allFinite());
        require(state.orientation && state.orientation->attitude.body_to_ned().coeffs().allFinite());
        require(state.orientation->turn_rate.allFinite());
    }
    return 0;
}
