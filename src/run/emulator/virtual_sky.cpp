#include "run/emulator/virtual_sky.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "base/geo/local_frame.hpp"
#include "detail/modern_assembly.hpp"
#include "receiver/measurement/measurement_engine.hpp"
#include "receiver/protocol/nmea_messages.hpp"
#include "world/sky/observe_sky.hpp"

namespace skyloop::inline run {
namespace {

constexpr Metres lowest{-1000}, highest{20'000};
constexpr Metres most_undulation{150};  // of EGM96: -107 to 85 m
constexpr double grid_m = 5, farthest_latitude_deg = 89.99;

// The next corner of a grid beyond the nearest one. @param step of the grid, both in one unit
double corner_beside(double value, double step) { return (std::round(value / step) + 1) * step; }

}  // namespace

std::optional<ClientPlace> client_place(std::string_view gga) {
    const auto message = decode_nmea(gga);
    const Gga* const told = message ? std::get_if<Gga>(&*message) : nullptr;
    if (told == nullptr || told->quality == 0 || !told->position) return std::nullopt;
    const Metres height = told->altitude.value_or(Metres(0));
    if (!place_from_degrees(told->position->latitude.deg(), told->position->longitude.deg(), 0)) return std::nullopt;
    if (height < lowest || height > highest) return std::nullopt;
    ClientPlace place{told->position->latitude, told->position->longitude, {height}};
    if (told->geoid_separation && std::abs(told->geoid_separation->value()) <= most_undulation.value())
        place.undulation = told->geoid_separation;
    return place;
}

Geodetic on_ellipsoid(const ClientPlace& place, const Geoid* geoid) {
    const Metres otherwise = geoid != nullptr ? geoid->undulation(place.latitude, place.longitude) : Metres(0);
    return {place.latitude, place.longitude, {place.height.above_sea_level + place.undulation.value_or(otherwise)}};
}

Geodetic station_place(const Geodetic& client) {
    const double clamped = std::clamp(client.latitude.deg(), -farthest_latitude_deg, farthest_latitude_deg);
    const CurvatureRadii radii = curvature_radii(Angle::degrees(clamped));
    constexpr double degree = 180 / std::numbers::pi;
    const double latitude = std::min(corner_beside(clamped, grid_m / radii.meridian * degree), farthest_latitude_deg);
    // From the latitude of the grid, so that each row of it has one grid of its own.
    const double parallel = curvature_radii(Angle::degrees(latitude)).prime_vertical * std::cos(latitude / degree);
    const double longitude = corner_beside(client.longitude.deg(), grid_m / parallel * degree);
    const double height = std::round(client.height.above_ellipsoid.value() / grid_m) * grid_m;
    return Geodetic::degrees(latitude, std::remainder(longitude, 360), height);
}

class VirtualAntenna::Parts {
public:
    Parts(const NavigationSource& source, std::shared_ptr<const PreciseTruth> products, const Geodetic& place,
          MeasurementEngine engine)
        : navigation(source), precise(std::move(products)), measurement(std::move(engine)) {
        truth.geodetic = place;
        truth.position = to_ecef(place);
    }

    const NavigationSource& navigation;
    std::shared_ptr<const PreciseTruth> precise;
    TruthState truth;
    ReceiverSettings settings;
    SkyObserver observer{precise.get()};
    std::vector<std::unique_ptr<PropagationEffect>> effects;
    MeasurementEngine measurement;
};

VirtualAntenna::VirtualAntenna(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
VirtualAntenna::~VirtualAntenna() = default;

const Position<Ecef>& VirtualAntenna::position() const { return parts_->truth.position; }

Observations VirtualAntenna::observe(GpsTime time) {
    Parts& p = *parts_;
    p.truth.time = time;
    const SkyView sky = p.observer.observe(p.truth, p.navigation);
    Arrivals arrivals = free_space(sky);
    for (const auto& effect : p.effects)
        effect->apply(arrivals, sky, p.truth);
    return p.measurement.measure(arrivals, time, p.settings).observations;
}

struct VirtualSky::Ground {
    const NavigationSource& navigation;
    std::shared_ptr<const PreciseTruth> precise;
    ModernWorld world;
    MeasurementParameters measurement;
    std::set<SystemSignal> signals;
};

namespace {

// The receiver of a reference station, and nothing around it.
void stand_in_the_open(ModernPropagationParameters& p, const ModernLinkParameters& geodetic) {
    p.channel_model = {};
    p.stretches.clear();
    p.foliage.enabled = false;
    p.interference.enabled = false;
    ModernLinkParameters link = geodetic;
    link.received = p.link.received;
    link.satellite_pattern = p.link.satellite_pattern;
    link.satellite_spread = p.link.satellite_spread;
    p.link = std::move(link);
    p.loss_model.antenna_film = Decibels(0);
}

MeasurementParameters network_receiver(const ModernSettings& survey) {
    MeasurementParameters measurement = survey.measurement;
    for (ErrorTerm* term : {&measurement.multipath, &measurement.receiver_clock, &measurement.cycle_slips})
        term->enabled = false;
    return measurement;
}

std::set<SystemSignal> signals_of(const NavigationSource& navigation) {
    std::set<SystemSignal> signals;
    for (const SatelliteId satellite : navigation.satellites())
        for (const Signal signal : emulated_signals(satellite.constellation))
            signals.insert({satellite.constellation, signal});
    return signals;
}

}  // namespace

Result<VirtualSky> VirtualSky::of(const Scenario& scenario, const World& world) {
    if (scenario.model.sensor_model)
        return fail(ErrorCode::usage,
                    "virtual stations measure, and a sensor model does not; expected model.name = \"modern\"");
    auto modern = modern_world_of(
        scenario, world.navigation,
        {world.geoid, world.start, world.data, std::make_shared<GasLossTable>(),  // which the receivers do not share
         world.precise});
    if (!modern) return fail(modern.error());
    ModernSettings survey = ModernSettings::of(ModernPreset::survey);
    survey.errors = scenario.model.modern.errors;
    survey.propagation.scintillation = modern->parameters.scintillation;
    survey = effective(std::move(survey));
    stand_in_the_open(modern->parameters, survey.propagation.link);
    VirtualSky sky(std::make_shared<Ground>(Ground{world.navigation, world.precise, std::move(*modern),
                                                   network_receiver(survey), signals_of(world.navigation)}));
    // What would be refused at the first client is refused now.
    if (const auto tried = sky.antenna(Geodetic::degrees(0, 0, 0), 0); !tried) return fail(tried.error());
    return sky;
}

Result<std::unique_ptr<VirtualAntenna>> VirtualSky::antenna(const Geodetic& place, std::uint64_t seed) const {
    auto effects = modern_effects(ground_->world.parameters, ground_->world.context);
    if (!effects) return fail(effects.error());
    auto parts = std::make_unique<VirtualAntenna::Parts>(ground_->navigation, ground_->precise, place,
                                                         MeasurementEngine(ground_->measurement, seed));
    parts->effects = std::move(*effects);
    parts->settings.signals = ground_->signals;
    return std::make_unique<VirtualAntenna>(std::move(parts));
}

const std::set<SystemSignal>& VirtualSky::signals() const { return ground_->signals; }
const Geoid* VirtualSky::geoid() const { return ground_->world.context.geoid; }

}  // namespace skyloop::inline run
