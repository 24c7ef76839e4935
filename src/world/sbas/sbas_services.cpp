#include "world/sbas/sbas_services.hpp"

#include <algorithm>
#include <chrono>
#include <map>
#include <utility>

#include "detail/sbas_system_service.hpp"
#include "world/gnss/sbas_service.hpp"

namespace skyloop::inline world {
namespace {

constexpr int prn_of_first = 100;  // of S00

// A satellite whose system serves nobody here.
SbasMessage navigation_alone(const SbasEphemeris& record, GpsTime start) {
    constexpr std::int64_t period_s = 60;
    if (start.time_since_epoch() / std::chrono::seconds(1) % period_s == 0) return sbas_navigation(record);
    return SbasNull{};
}

class SbasServices : public SbasSource {
public:
    SbasServices(const SbasWorld& world, IonosphereMonitor ionosphere)
        : satellites_{world.navigation,
                      {world.parameters.signal_in_space_model, world.parameters.signal_in_space, world.context.seed},
                      world.context.precise},
          place_(world.place),
          ionosphere_(std::move(ionosphere)) {}

    std::optional<SbasWords> message(SatelliteId satellite, GpsTime end) override {
        const GpsTime start = end - std::chrono::seconds(1);
        const auto record = satellites_.navigation->ephemeris(satellite, start);
        if (!record || !std::holds_alternative<SbasEphemeris>(*record)) return std::nullopt;
        const auto& own = std::get<SbasEphemeris>(*record);
        const int prn = satellite.number + prn_of_first;
        const auto system = sbas_system(prn);
        if (!system) return encode_sbas(navigation_alone(own, start), start);
        return encode_sbas(service(*system).message(prn, own, start), start);
    }

private:
    SbasSystemService& service(SbasSystem system) {
        const auto known = systems_.find(system);
        if (known != systems_.end()) return known->second;
        return systems_.try_emplace(system, system, SbasSystemService::World{satellites_, place_}, ionosphere_)
            .first->second;
    }

    SatelliteMonitor::Truth satellites_;
    Geodetic place_;
    IonosphereMonitor ionosphere_;
    std::map<SbasSystem, SbasSystemService> systems_;
};

}  // namespace

Result<std::unique_ptr<SbasSource>> sbas_services(const SbasWorld& world) {
    const auto satellites = world.navigation->satellites();
    const bool some = std::any_of(satellites.begin(), satellites.end(),
                                  [](SatelliteId id) { return id.constellation == Constellation::sbas; });
    if (!some) return nullptr;
    auto ionosphere = IonosphereMonitor::create(world.parameters, world.context, world.place);
    if (!ionosphere) return fail(ionosphere.error());
    return std::make_unique<SbasServices>(world, std::move(*ionosphere));
}

}  // namespace skyloop::inline world
