#include "firmware/dronecan/node_parameters.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>

namespace skyloop::firmware {
namespace {

struct NodeParameter {
    std::string_view name;
    std::uint32_t key;
    std::int64_t least, most;
};

// Named as those of AP_Periph, GPS_TYPE before and GPS1_TYPE since ArduPilot 4.6.
constexpr NodeParameter node_parameters[] = {
    {"CAN_NODE", NodeSettings::node_id, 0, 127},
    {"GPS_TYPE", NodeSettings::gps_type, 0, 255},
    {"GPS1_TYPE", NodeSettings::gps_type, 0, 255},
    {"GPS_MB_ONLY_PORT", NodeSettings::moving_base_port, -1, 255},
    {"GPS_RATE_MS", SentenceSettings::fix_interval_ms, 10, 10'000},
};

constexpr std::uint64_t as_automatic = 1;

const NodeParameter* find_parameter(const DronecanGetSetRequest& request) {
    const std::string_view name(request.name.data(), request.name.size());
    if (name.empty()) return request.index < std::size(node_parameters) ? &node_parameters[request.index] : nullptr;
    const auto* const found = std::ranges::find(node_parameters, name, &NodeParameter::name);
    return found == std::end(node_parameters) ? nullptr : found;
}

std::optional<std::int64_t> whole_number(const DronecanValue& value) {
    if (value.tag == DronecanValue::integer_value) return value.integer.raw;
    if (value.tag == DronecanValue::boolean_value) return static_cast<std::int64_t>(value.boolean.raw);
    if (value.tag == DronecanValue::real_value && std::fabs(value.real) < 1e9F) return std::llround(value.real.raw);
    return std::nullopt;
}

// Settings are of 32 bits, and some of these have a sign.
std::int64_t number_of(std::uint64_t stored) { return static_cast<std::int32_t>(static_cast<std::uint32_t>(stored)); }

DronecanValue integer(std::int64_t number) {
    DronecanValue value;
    value.tag = DronecanValue::integer_value;
    value.integer = number;
    return value;
}

DronecanNumber limit(std::int64_t number) {
    DronecanNumber value;
    value.tag = DronecanValue::integer_value;
    value.integer = number;
    return value;
}

}  // namespace

std::vector<OwnSetting> node_settings(const BoardProfile& board, const ReceiverOptions& options) {
    // Several nodes of one bus have several ids.
    constexpr std::size_t most_id = 125;
    const auto fixed = static_cast<std::size_t>(board.can.node_id);
    const std::size_t id = fixed == 0 ? 0 : (fixed - 1 + options.number) % most_id + 1;
    return {{NodeSettings::node_id, "can_node", id},
            {NodeSettings::gps_type, "gps_type", as_automatic},
            {NodeSettings::moving_base_port, "gps_mb_only_port", 0}};
}

DronecanGetSetResponse get_or_set(const DronecanGetSetRequest& request, SentenceSettings& settings) {
    const NodeParameter* const parameter = find_parameter(request);
    DronecanGetSetResponse answer;
    if (parameter == nullptr) return answer;
    const auto wanted = whole_number(request.value);
    if (wanted && *wanted >= parameter->least && *wanted <= parameter->most)
        settings.set(in_ram, parameter->key, static_cast<std::uint64_t>(*wanted));
    answer.value = integer(number_of(settings.value(parameter->key)));
    answer.default_value = integer(number_of(settings.stored(ConfigLayer::factory, parameter->key).value_or(0)));
    answer.least = limit(parameter->least);
    answer.most = limit(parameter->most);
    answer.name.assign(parameter->name.begin(), parameter->name.end());
    return answer;
}

void save_parameters(SentenceSettings& settings) {
    for (const NodeParameter& parameter : node_parameters)
        settings.set(in_flash, parameter.key, settings.value(parameter.key));
}

void erase_parameters(SentenceSettings& settings) { settings.clear(in_battery | in_flash); }

}  // namespace skyloop::firmware
