#include "motion/trajectory/vehicle_class.hpp"

#include <algorithm>

namespace skyloop {

const std::array<VehicleTraits, vehicle_class_count>& vehicle_classes() {
    using Speed = MetresPerSecond;
    constexpr double g = 9.80665;
    const auto deg = [](double value) { return Angle::degrees(value); };
    static const std::array<VehicleTraits, vehicle_class_count> classes{{
        {"fixed", 0.1, Speed(0.5), Speed(0.5), 0.1 * g, Speed(0.5), deg(0), deg(0)},
        {"pedestrian", 1, Speed(10), Speed(3), 0.8 * g, Speed(0.5), deg(180), deg(0)},
        {"car", 3, Speed(70), Speed(15), 1.2 * g, Speed(0.5), deg(90), deg(10)},
        {"rover", 3, Speed(15), Speed(5), 1.0 * g, Speed(0.5), deg(90), deg(10)},
        {"boat", 0.7, Speed(30), Speed(2), 0.6 * g, Speed(0.5), deg(45), deg(30)},
        {"plane", 5, Speed(320), Speed(60), 4 * g, Speed(3), deg(90), deg(60)},
        {"multirotor", 10, Speed(50), Speed(20), 3 * g, Speed(3), deg(90), deg(60)},
        {"balloon", 1, Speed(100), Speed(100), 3 * g, Speed(3), deg(90), deg(0)},
        {"rocket", 100, Speed(3000), Speed(3000), 20 * g, Speed(3), deg(90), deg(90)},
    }};
    return classes;
}

std::array<std::string_view, track_vehicle_count> track_vehicle_names() {
    std::array<std::string_view, track_vehicle_count> names;
    for (std::size_t i = 0; i < names.size(); ++i)
        names[i] = vehicle_classes()[i].name;
    return names;
}

const VehicleTraits& traits_of(VehicleClass vehicle) { return vehicle_classes()[static_cast<std::size_t>(vehicle)]; }

std::optional<VehicleClass> vehicle_class_named(std::string_view name) {
    const auto& classes = vehicle_classes();
    const auto found =
        std::find_if(classes.begin(), classes.end(), [&](const VehicleTraits& traits) { return traits.name == name; });
    if (found == classes.end()) return std::nullopt;
    return static_cast<VehicleClass>(found - classes.begin());
}

}  // namespace skyloop
