// What a led run is told and tells as JSON.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "base/core/spelling.hpp"
#include "base/time/utc_time.hpp"
#include "detail/session.hpp"
#include "run/control/command_json.hpp"

namespace skyloop {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<std::string_view, 5> questions{"status", "config", "ports", "faults", "commands"};

// Bytes that are no UTF-8, of file names, become replacement characters.
std::string text_of(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

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
                    {"start_utc", format_utc(to_utc(assembly_.start, LeapSeconds::announced()))},
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

}  // namespace skyloop
