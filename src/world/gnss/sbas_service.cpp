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

bool serves(SbasSystem system, const Geodetic& place) {
    struct Box {
        double south, north, west, east;  // degrees
    };
    static constexpr std::array<Box, 4> boxes{
        {{15, 72, -170, -50}, {20, 72, -40, 45}, {20, 50, 120, 150}, {0, 40, 60, 100}}};
    const Box& box = boxes.at(static_cast<std::size_t>(system));
    const double latitude = place.latitude.deg(), longitude = place.longitude.deg();
    return latitude >= box.south && latitude <= box.north && longitude >= box.west && longitude <= box.east;
}

}  // namespace skyloop::inline world
