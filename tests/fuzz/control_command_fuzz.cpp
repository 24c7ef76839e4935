// Any text as a command or a live fault in JSON: one line of refusal, or a command that is written as it was read.
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "require.hpp"
#include "run/control/command_json.hpp"

namespace {

using namespace skyloop;

void check_command(const Result<Command>& command) {
    if (!command) {
        require(command.error().code == ErrorCode::input && !command.error().message.empty());
        require(command.error().message.find('\n') == std::string::npos);
        return;
    }
    const std::string text = command_json(*command);
    require(nlohmann::json::accept(text));
    const auto again = command_from_json(text, "fuzz");
    require(again.has_value());
    require(again->verb == command->verb && again->receivers == command->receivers);
    require(again->parameters.values().size() == command->parameters.values().size());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    check_command(command_from_json(text, "fuzz"));
    check_command(live_fault_from_json(text, "fuzz"));
    return 0;
}
