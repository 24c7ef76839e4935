#include "world/propagation/propagation_parameters.hpp"

namespace skyloop::inline world {

std::vector<AtmosphericLayer> default_layers() {
    return {
        {"troposphere", Metres(0), Metres(12000), 7.5},
        {"stratosphere", Metres(12000), Metres(50000), 0},
        {"mesosphere", Metres(50000), Metres(85000), 0},
        {"thermosphere", Metres(85000), Metres(600000), 0},
    };
}

const std::vector<CloudDeck>& cloud_catalogue() {
    static const std::vector<CloudDeck> clouds{
        {"fog", Metres(0), Metres(300), 0.05},
        {"stratus", Metres(500), Metres(1200), 0.28},
        {"stratocumulus", Metres(600), Metres(1500), 0.45},
        {"cumulus", Metres(1000), Metres(2500), 0.50},
        {"nimbostratus", Metres(800), Metres(4000), 0.65},
        {"cumulus-congestus", Metres(1000), Metres(5000), 1.0},
        {"thunderstorm", Metres(1000), Metres(11000), 3.0},
    };
    return clouds;
}

const std::vector<Environment>& environment_catalogue() {
    static const std::vector<Environment> environments{
        {"countryside", Decibels(1)}, {"village", Decibels(5)},     {"suburb", Decibels(12)},
        {"city", Decibels(20)},       {"dense-city", Decibels(30)}, {"industrial", Decibels(40)},
    };
    return environments;
}

}  // namespace skyloop::inline world
