// Any bytes as a navigation file: a clear error or usable records, never a crash, a hang or an orbit that is no number.
#include <cmath>
#include <cstdint>
#include <string_view>

#include "base/geo/geodetic.hpp"
#include "require.hpp"
#include "world/gnss/foreign_records.hpp"
#include "world/gnss/navigation_data.hpp"
#include "world/gnss/orbit.hpp"
#include "world/rinex/navigation_file.hpp"
#include "world/sky/observe_sky.hpp"

namespace {

using skyloop::is_one_line;
using skyloop::require;

void check_records(const skyloop::NavigationFile& file) {
    require(!file.records.empty());
    for (const skyloop::Ephemeris& record : file.records) {
        const skyloop::SatelliteState state = satellite_state(record, toe_of(record));
        require(state.position.vector().allFinite() && state.velocity.vector().allFinite());
        require(std::isfinite(state.clock_bias) && std::isfinite(state.clock_drift));
        if (const auto* kepler = std::get_if<skyloop::KeplerEphemeris>(&record))
            require(std::abs((kepler->toe - kepler->toc).count()) <= std::int64_t{86'400'000'000'000});
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace skyloop;
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    Result<NavigationFile> file = read_navigation(text, "fuzz.nav");
    if (!file) {
        require(file.error().code == ErrorCode::input && is_one_line(file.error().message));
        return 0;
    }
    for (const std::string& warning : file->warnings)
        require(is_one_line(warning));
    check_records(*file);

    for (const DroppedRecord& dropped : drop_foreign_records(file->records))
        require(is_one_line(dropped.reason));
    const GpsTime time = toe_of(file->records.front());
    const NavigationData orbits(file->records, file->ionosphere, "fuzz.nav");
    require(orbits.record_count() <= file->records.size());
    TruthState truth;
    truth.time = time;
    truth.geodetic = Geodetic::degrees(46.5, 30.7, 80);
    truth.position = to_ecef(truth.geodetic);
    for (const SatelliteInView& seen : observe_sky(truth, orbits).satellites)
        require(std::isfinite(seen.range.value()) && std::isfinite(seen.range_rate.value()));
    const Result<NavigationData> moved = rebased(orbits, time + std::chrono::days(1234));
    // The first record may be of a message that another one supersedes.
    if (moved)
        require(moved->satellites_at(time + std::chrono::days(1234)) >= orbits.satellites_at(time));
    else
        require(orbits.satellites_at(time) == 0);
    return 0;
}
