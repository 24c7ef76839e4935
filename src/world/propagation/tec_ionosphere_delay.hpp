/// The article's ionospheric delay: electron content times a fitted obliquity.
#pragma once

#include <utility>
#include <variant>

#include "world/gnss/ionosphere_maps.hpp"
#include "world/gnss/navigation_source.hpp"
#include "world/propagation/effect.hpp"

namespace skyloop {

/// Slant over vertical delay, 1 + 2.74·10⁻⁶ (96° − e)³ (MODELS.md 3.7, F_p).
double ionosphere_obliquity(Angle elevation);
/// 0.162 F_p(e) TEC, at L1 (MODELS.md 3.7). @param vertical electron content
Metres tec_delay(Tecu vertical, Angle elevation);
/// The electron content that gives a vertical delay at L1, c T_v / 0.162 (MODELS.md D-15).
Tecu tec_of_vertical_delay(Metres vertical_delay);

/// Writes the ionospheric delay of each arrival, at L1.
class TecIonosphereDelay : public PropagationEffect {
public:
    /// The same electron content everywhere.
    explicit TecIonosphereDelay(Tecu vertical) : content_(vertical) {}
    /// The electron content of the broadcast model above each satellite's pierce point.
    explicit TecIonosphereDelay(const KlobucharCoefficients& broadcast) : content_(broadcast) {}
    /// That of the maps there, with the obliquity of the article, not the maps' own mapping. After the last
    /// of them that one holds. Where and when they have none there is none: check_coverage() looks for that before.
    explicit TecIonosphereDelay(IonosphereMaps maps) : content_(std::move(maps)) {}

    void apply(Arrivals& arrivals, const SkyView& sky, const TruthState& truth) override;
    /// The vertical electron content that `satellite` is seen through.
    [[nodiscard]] Tecu vertical_content(const SatelliteInView& satellite, const TruthState& truth) const;

private:
    std::variant<Tecu, KlobucharCoefficients, IonosphereMaps> content_;
};

}  // namespace skyloop
