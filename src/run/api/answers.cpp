// What a led run tells of its receivers' fixes and skies, and is told of the latter.
// What a led run is told and tells as JSON.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/core/json.hpp"
#include "base/core/words.hpp"
#include "base/time/utc_time.hpp"
#include "detail/session.hpp"
#include "firmware/messages/field_values.hpp"
#include "run/control/command_json.hpp"

namespace skyloop::inline run {
namespace {

constexpr float most_attenuation_db = 100, most_excess_m = 100'000;

// In the order of FixType.
constexpr std::array<std::uint8_t, 8> fix_type_numbers{SKY_FIX_NONE,      SKY_FIX_DEAD_RECKONING, SKY_FIX_2D,
                                                       SKY_FIX_3D,        SKY_FIX_DGNSS,          SKY_FIX_RTK_FLOAT,
                                                       SKY_FIX_RTK_FIXED, SKY_FIX_TIME_ONLY};

void add_position(sky_fix& told, const Fix& fix, const TruthState& truth) {
    told.lat_deg = fix.position.latitude.deg();
    told.lon_deg = fix.position.longitude.deg();
    told.height_ellipsoid_m = fix.position.height.above_ellipsoid.value();
    told.height_msl_m = above_sea_level(fix.position.height, fix.geoid_undulation).above_sea_level.value();
    told.vel_ned[0] = fix.velocity.north;
    told.vel_ned[1] = fix.velocity.east;
    told.vel_ned[2] = fix.velocity.down;
    const Eigen::Vector3d error = LocalFrame(truth.geodetic).to_enu(to_ecef(fix.position)).vector();
    std::copy_n(error.data(), 3, told.error_enu_m);
    told.pdop = static_cast<float>(fix.dop.pdop);
    told.hdop = static_cast<float>(fix.dop.hdop);
    told.vdop = static_cast<float>(fix.dop.vdop);
    told.h_acc_m = static_cast<float>(fix.horizontal_accuracy.value());
    told.v_acc_m = static_cast<float>(fix.vertical_accuracy.value());
    told.speed_acc_mps = static_cast<float>(fix.speed_accuracy.value());
    told.course_deg = static_cast<float>(fix.course.deg());
}

sky_sat satellite_of(const SatelliteInView& seen) {
    sky_sat told{};
    told.gnss_id = firmware::gnss_id(seen.id.constellation);
    told.sv_id = firmware::sv_id(seen.id);
    told.az_deg = static_cast<float>(seen.azimuth.deg());
    told.el_deg = static_cast<float>(seen.elevation.deg());
    const double a = seen.azimuth.rad(), e = seen.elevation.rad();
    told.los_ned[0] = static_cast<float>(std::cos(e) * std::cos(a));
    told.los_ned[1] = static_cast<float>(std::cos(e) * std::sin(a));
    told.los_ned[2] = static_cast<float>(-std::sin(e));
    if (seen.healthy) told.flags |= SKY_SAT_HEALTHY;
    return told;
}

void add_reported(sky_sat& told, const Fix& fix, SatelliteId id) {
    const auto found = std::find_if(fix.satellites.begin(), fix.satellites.end(),
                                    [&](const SatelliteStatus& s) { return s.id == id; });
    if (found == fix.satellites.end()) return;
    if (found->used) told.flags |= SKY_SAT_USED;
    if (!found->cn0) return;
    told.flags |= SKY_SAT_TRACKED;
    told.cn0_dbhz = static_cast<float>(found->cn0->value());
}

std::optional<SatelliteId> satellite_of_numbers(std::uint8_t gnss_id, std::uint8_t sv_id) {
    constexpr int most_satellites = 120;
    for (std::size_t system = 0; system < constellation_names.size(); ++system)
        for (int number = 1; number <= most_satellites; ++number) {
            const SatelliteId id{static_cast<Constellation>(system), number};
            if (firmware::gnss_id(id.constellation) != gnss_id) break;
            if (firmware::sv_id(id) == sv_id) return id;
        }
    return std::nullopt;
}

bool within(float value, float least, float most) { return value >= least && value <= most; }

Answer<ToldPath> told_path(const sky_los& los) {
    const auto of = [&](std::string_view what, float value, std::string_view expected) {
        return refuse(SKY_E_RANGE, fmt::format("satellite {}/{}: {} is {}; expected {}", los.gnss_id, los.sv_id, what,
                                               value, expected));
    };
    ToldPath path;
    path.blocked = los.state == SKY_LOS_BLOCKED;
    if (los.state == SKY_LOS_ATTENUATED) {
        if (!within(los.attenuation_db, 0, most_attenuation_db))
            return of("attenuation_db", los.attenuation_db, "0 to 100");
        path.attenuation = Decibels(los.attenuation_db);
    }
    if (los.reflections > ToldPath::most_reflections) return of("reflections", los.reflections, "0 to 4");
    for (std::size_t i = 0; i < los.reflections; ++i) {
        if (!within(los.excess_m[i], 0, most_excess_m)) return of("excess_m", los.excess_m[i], "0 to 100000");
        if (!within(los.reflection_db[i], -most_attenuation_db, 0))
            return of("reflection_db", los.reflection_db[i], "-100 to 0");
        path.reflections.push_back({Metres(los.excess_m[i]), Decibels(los.reflection_db[i])});
    }
    return path;
}

}  // namespace

Answer<sky_fix> Session::fix(std::uint32_t receiver) const {
    if (const auto checked = check_receiver(receiver); !checked) return refuse(checked.error());
    const Station& station = assembly_.emulator->stations()[receiver];
    sky_fix told{};
    const Report* report = watcher_->report(receiver);
    if (report == nullptr) return told;
    const firmware::NavigationState& state = *report->state;
    const Fix& fix = state.epoch.fix;
    told.type = fix_type_numbers[static_cast<std::size_t>(fix.type)];
    told.ok = state.fix_ok ? 1 : 0;
    told.satellites_used = static_cast<std::uint8_t>(std::clamp(fix.satellites_used(), 0, 255));
    told.jamming_state = static_cast<std::uint8_t>(std::clamp(state.monitors.told_jamming_state(), 0, 3));
    told.epochs = station.counts().epochs;
    told.sim_time_ns = sim_time(report->truth.time);
    told.gps_time_ns = fix.time.time_since_epoch().count();
    if (fix.has_position()) add_position(told, fix, report->truth);
    return told;
}

// Before the first epoch. A path counts what it is asked for beyond its samples as shown: the question is a copy's.
SkyView Session::sky_now(std::uint32_t receiver) const {
    const Simulation& simulation = assembly_.emulator->stations()[receiver].simulation();
    const auto vehicle = vehicles_.find(vehicle_of(receiver));
    if (vehicle == vehicles_.end()) return simulation.view(simulation.truth_at(now()));
    const auto antenna = make_antenna_path(scenario_, receiver, std::make_unique<LivePath>(*vehicle->second.path));
    return simulation.view(antenna->at(now()));
}

Answer<std::vector<sky_sat>> Session::satellites(std::uint32_t receiver) const {
    if (const auto checked = check_receiver(receiver); !checked) return refuse(checked.error());
    const auto& trace = watcher_->trace(receiver);
    const Report* report = watcher_->report(receiver);
    const SkyView view = trace ? trace->sky : sky_now(receiver);
    std::vector<sky_sat> told;
    for (std::size_t i = 0; i < view.satellites.size(); ++i) {
        const SatelliteInView& seen = view.satellites[i];
        told.push_back(satellite_of(seen));
        if (!trace) continue;
        if (report != nullptr) add_reported(told.back(), report->state->epoch.fix, seen.id);
        if (i < trace->arrivals.satellites.size() && trace->arrivals.satellites[i].line_of_sight)
            told.back().flags |= SKY_SAT_SEEN;
    }
    return told;
}

Answer<void> Session::tell_path(std::uint32_t receiver, const sky_los& los) {
    if (const auto checked = check_receiver(receiver); !checked) return checked;
    const auto id = satellite_of_numbers(los.gnss_id, los.sv_id);
    if (!id)
        return refuse(SKY_E_ARG, fmt::format("satellite {}/{}: no such; expected gnss_id and sv_id as sky_get_sats() "
                                             "tells them",
                                             los.gnss_id, los.sv_id));
    if (los.state > SKY_LOS_BLOCKED)
        return refuse(SKY_E_UNSUPPORTED, fmt::format("satellite {}/{}: state {} is not known to this version",
                                                     los.gnss_id, los.sv_id, los.state));
    const auto path = told_path(los);
    if (!path) return refuse(path.error());
    if (los.state == SKY_LOS_UNKNOWN)
        obstacles_[receiver]->erase(*id);
    else
        obstacles_[receiver]->insert_or_assign(*id, *path);
    return {};
}

namespace {

constexpr std::array<std::string_view, 5> questions{"status", "config", "ports", "faults", "commands"};

// Bytes that are no UTF-8, of file names, become replacement characters.
std::string text_of(const Json& json) { return json_text(json); }

bool leads_time(CommandVerb verb) {
    return verb == CommandVerb::pause || verb == CommandVerb::resume || verb == CommandVerb::step ||
           verb == CommandVerb::speed;
}

}  // namespace

// A name that fits nothing would do nothing.
Answer<void> Session::check_target(const Command& command) const {
    const auto& stations = assembly_.emulator->stations();
    std::vector<std::string> names;
    for (const Station& station : stations)
        names.push_back(station.name());
    for (const std::string& name : command.receivers)
        if (std::find(names.begin(), names.end(), name) == names.end())
            return refuse(SKY_E_ARG,
                          fmt::format("receiver '{}': no such; expected one of {}", name, fmt::join(names, ", ")));
    const bool of_fault = command.verb == CommandVerb::start_fault || command.verb == CommandVerb::stop_fault;
    const std::string fault = of_fault ? command.parameters.text("fault") : std::string();
    if (fault.empty() || started_.contains(fault) || watcher_->has_seen(fault)) return {};
    for (const FaultEntry& entry : scenario_.faults)
        if (entry.when.name == fault) return {};
    return refuse(SKY_E_ARG, fmt::format("fault '{}': neither the scenario nor a command has one of that name",
                                         fault.substr(0, 60)));
}

Answer<void> Session::command(std::string_view json) {
    if (const auto running = check_running(); !running) return running;
    const auto command = command_from_json(json, "caller");
    if (!command) return refuse(command.error());
    if (leads_time(command->verb))
        return refuse(SKY_E_UNSUPPORTED, fmt::format("{}: time is led by sky_advance()", command_name(command->verb)));
    if (command->verb == CommandVerb::move_to && !vehicles_.empty())
        return refuse(SKY_E_UNSUPPORTED,
                      fmt::format("move_to: sky_set_truth() says where vehicle {} is", vehicles_.begin()->first));
    if (const auto checked = check_target(*command); !checked) return checked;
    if (!commands_.push(*command)) return refuse(SKY_E_STATE, "too many commands wait for the next sky_advance()");
    if (command->verb == CommandVerb::start_fault && command->parameters.has("kind"))
        started_.insert(command->parameters.text("name"));
    return {};
}

Answer<std::string> Session::query(std::string_view what) {
    if (what == "status") return watcher_->status(now());
    if (what == "config") return config_text();
    if (what == "ports") return ports_text();
    if (what == "faults") return fault_kinds_json();
    if (what == "commands") return command_kinds_json();
    return refuse(SKY_E_UNSUPPORTED, fmt::format("'{}' is unknown; expected one of {}{}", what.substr(0, 60),
                                                 fmt::join(questions, ", "), did_you_mean(what, questions)));
}

std::string Session::config_text() const {
    Json receivers = Json::array();
    for (std::size_t i = 0; i < scenario_.receivers.size(); ++i)
        receivers.push_back({{"name", receiver_name(scenario_, i)},
                             {"board", scenario_.receivers[i].board},
                             {"vehicle", vehicle_of(i)}});
    return text_of({{"version", SKYLOOP_VERSION},
                    {"abi", fmt::format("{}.{}", SKY_ABI_MAJOR, SKY_ABI_MINOR)},
                    {"scenario", scenario_.name},
                    {"model", model_name(scenario_.model)},
                    {"seed", scenario_.run.seed},
                    {"digest", assembly_.digest},
                    {"start_utc", utc_text(assembly_.start, 3)},
                    {"start_sim_ns", start_sim_ns_},
                    {"receivers", std::move(receivers)},
                    {"warnings", assembly_.warnings},
                    {"details", assembly_.details}});
}

std::string Session::ports_text() const {
    Json list = Json::array();
    const auto& stations = assembly_.emulator->stations();
    for (std::size_t i = 0; i < ports_.size(); ++i) {
        const Station& station = stations[ports_[i].receiver];
        const PortSpeed speed = station.speed(ports_[i].id);
        list.push_back({{"port", i},
                        {"receiver", ports_[i].receiver},
                        {"receiver_name", station.name()},
                        {"name", firmware::port_names[static_cast<std::size_t>(ports_[i].id)]},
                        {"baud", speed ? Json(*speed) : Json(nullptr)},
                        {"bytes_pending", ports_[i].led->pending()}});
    }
    return text_of(list);
}

}  // namespace skyloop::inline run
