#include "world/gnss/sbas_service.hpp"

#include <array>
#include <utility>

namespace skyloop::inline world {

std::optional<SbasSystem> sbas_system(int prn) {
    using enum SbasSystem;
    static constexpr std::pair<int, SbasSystem> owners[] = {
        {131, waas},  {133, waas},  {135, waas}, {138, waas}, {120, egnos}, {121, egnos}, {123, egnos}, {124, egnos},
        {126, egnos}, {136, egnos}, {129, msas}, {137, msas}, {127, gagan}, {128, gagan}, {132, gagan}};
    for (const auto& [number, owner] : owners)
        if (number == prn) return owner;
    return std::nullopt;
}

bool SbasServiceArea::holds(const Geodetic& place) const {
    const double latitude = place.latitude.deg(), longitude = place.longitude.deg();
    return latitude >= south && latitude <= north && longitude >= west && longitude <= east;
}

SbasServiceArea sbas_service_area(SbasSystem system) {
    static constexpr std::array<SbasServiceArea, 4> areas{
        {{15, 72, -170, -50}, {20, 72, -40, 45}, {20, 50, 120, 150}, {0, 40, 60, 100}}};
    return areas.at(static_cast<std::size_t>(system));
}

bool sbas_under_test(int prn) { return prn == 126; }

}  // namespace skyloop::inline world
