#include <fmt/format.h>

#include <chrono>
#include <memory>
#include <optional>
#include <thread>
#include <variant>

#include "commands.hpp"
#include "run_options.hpp"
#include "wire/actuator/actuator_uri.hpp"

namespace skyloop::host {
namespace {

struct PowerOptions {
    std::string uri, what;
    Verbosity verbosity;
};

// What cannot be asked without being changed.
std::optional<Error> unaskable(const PowerOptions& options) {
    if (options.what != "state") return std::nullopt;
    const auto uri = parse_actuator_uri(options.uri);
    if (!uri || !std::holds_alternative<ModemLineAddress>(*uri)) return std::nullopt;
    return Error{
        ErrorCode::usage,
        fmt::format("{}: the state of a modem line cannot be asked: Linux asserts RTS and DTR when the device is "
                    "opened, which would switch it; expected on or off",
                    options.uri)};
}

// A hub's port that the kernel has switched on again when what was plugged in had gone.
Result<void> stays_off(Actuator& actuator, const PowerOptions& options) {
    const auto uri = parse_actuator_uri(options.uri);
    if (options.what != "off" || !uri || !std::holds_alternative<HubPortAddress>(*uri)) return {};
    constexpr std::chrono::seconds until_kernel_has_looked{1};
    std::this_thread::sleep_for(until_kernel_has_looked);
    const auto state = actuator.state();
    if (!state || *state != PowerState::on) return {};
    return fail(ErrorCode::outside, fmt::format("{}: its power came back by itself", actuator.description()));
}

int switch_power(const PowerOptions& options) {
    const Messages messages(options.verbosity);
    if (const auto refused = unaskable(options)) return messages.error(*refused);
    const auto actuator = open_actuator(options.uri);
    if (!actuator) return messages.error(actuator.error());
    Result<void> done;
    if (options.what == "on") done = (*actuator)->restore();
    if (options.what == "off") done = (*actuator)->cut();
    if (!done) return messages.error(done.error());
    if (const auto stays = stays_off(**actuator, options); !stays) return messages.error(stays.error());
    const auto state = (*actuator)->state();
    if (!state) return messages.error(state.error());
    const std::string asked = options.what == "off" ? "cut, as far as it was told" : "on, as far as it was told";
    fmt::print("{}: {}\n", (*actuator)->description(),
               *state                    ? to_string(**state)
               : options.what == "state" ? "it does not tell"
                                         : asked);
    return 0;
}

}  // namespace

Action add_power_command(CLI::App& app) {
    CLI::App* command = app.add_subcommand("power", "Switch an actuator by hand, to check how it is wired");
    auto options = std::make_shared<PowerOptions>();
    command
        ->add_option("URI", options->uri,
                     "relay:VID:PID/N gpio:VID:PID/N hub:PORT_PATH line:DEVICE/rts line:DEVICE/dtr command:CUT|RESTORE")
        ->required();
    command
        ->add_option("WORD", options->what,
                     "on, off (it stays cut) or state (not of a modem line, which asking would switch)")
        ->required()
        ->check(CLI::IsMember({"on", "off", "state"}));
    add_verbosity_options(*command, options->verbosity);
    return [options] { return switch_power(*options); };
}

}  // namespace skyloop::host
