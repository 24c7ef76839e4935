// Any bytes as a file of fixes: one clear sentence, or samples on the Earth.
#include <cmath>
#include <cstdint>
#include <string_view>

#include "require.hpp"
#include "study/analysis/comparison.hpp"
#include "study/analysis/fix_series.hpp"

namespace {

using namespace skyloop;

bool on_earth(const Geodetic& place) {
    return std::abs(place.latitude.deg()) <= 90 + 1e-9 && std::abs(place.longitude.deg()) <= 180 + 1e-9 &&
           std::isfinite(place.height.above_ellipsoid.value());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto series = parse_fix_series({reinterpret_cast<const char*>(data), size}, "fuzz.csv");
    if (!series) {
        require(series.error().message.starts_with("fuzz.csv") && is_one_line(series.error().message));
        return 0;
    }
    require(series->fixes() > 0 && series->fixes() <= series->samples.size());
    for (const FixSample& sample : series->samples) {
        require(!sample.has_fix || on_earth(sample.position));
        require(!sample.truth || on_earth(*sample.truth));
    }
    require(!series->interval || std::isfinite(series->interval->value()));
    for (const std::string& warning : series->warnings)
        require(is_one_line(warning));
    // Whatever could be read can be compared, and is not far from itself.
    if (const auto comparison = compare(*series, *series)) {
        for (const DistributionDistance& distance : comparison->distances)
            require(distance.total_variation == 0 && distance.kolmogorov_smirnov == 0);
        require(!comparison_text(*comparison).empty() && !comparison_json(*comparison).empty());
    }
    const FixSeries part = slice(*series, {1, 2, 5});
    require(part.fixes() <= 5 && part.samples.size() <= series->samples.size());
    require(windows(*series, 3).size() == series->fixes() / 3);
    return 0;
}
