#include <fmt/format.h>

#include <memory>

#include "commands.hpp"
#include "run_options.hpp"
#include "skyloop/actuator/actuator_uri.hpp"

namespace skyloop::host {
namespace {

struct PowerOptions {
    std::string uri, what;
    Verbosity verbosity;
};

int switch_power(const PowerOptions& options) {
    const Messages messages(options.verbosity);
    const auto actuator = open_actuator(options.uri);
    if (!actuator) return messages.error(actuator.error());
    Result<void> done;
    if (options.what == "on") done = (*actuator)->restore();
    if (options.what == "off") done = (*actuator)->cut();
    if (!done) return messages.error(done.error());
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
        ->add_option("uri", options->uri,
                     "relay:VID:PID/N gpio:VID:PID/N hub:PORT_PATH line:DEVICE/rts line:DEVICE/dtr command:CUT|RESTORE")
        ->required();
    command->add_option("what", options->what, "on, off (it stays cut) or state")
        ->required()
        ->check(CLI::IsMember({"on", "off", "state"}));
    add_verbosity_options(*command, options->verbosity);
    return [options] { return switch_power(*options); };
}

}  // namespace skyloop::host
