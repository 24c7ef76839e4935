#include <fmt/format.h>

#include <utility>

#include "skyloop/base/process.hpp"
#include "switch_parts.hpp"

namespace skyloop {
namespace {

constexpr Seconds command_patience{10};
constexpr std::size_t shown_of_output = 200;  // characters

// The last line that is not empty.
std::string last_line(std::string_view text) {
    while (!text.empty() && (text.back() == '\n' || text.back() == '\r' || text.back() == ' '))
        text.remove_suffix(1);
    const std::size_t begin = text.rfind('\n');
    return std::string(text.substr(begin == std::string_view::npos ? 0 : begin + 1).substr(0, shown_of_output));
}

class CommandSwitch : public Actuator {
public:
    explicit CommandSwitch(SwitchCommands commands) : commands_(std::move(commands)) {}

    Result<void> cut() override { return order(commands_.cut, PowerState::cut); }
    Result<void> restore() override { return order(commands_.restore, PowerState::on); }
    Result<std::optional<PowerState>> state() override {
        if (commands_.state.empty()) return std::optional<PowerState>();
        const auto output = run(commands_.state);
        if (!output) return fail(output.error());
        const std::string said = last_line(*output);
        for (const PowerState known : {PowerState::on, PowerState::cut})
            if (said == to_string(known)) return known;
        return fail(ErrorCode::outside,
                    fmt::format("'{}' printed '{}'; expected on or cut", commands_.state.front(), said));
    }
    [[nodiscard]] std::string description() const override { return fmt::format("command {}", commands_.cut.front()); }

private:
    // What it printed.
    static Result<std::string> run(const std::vector<std::string>& command) {
        ProcessRequest request;
        request.command = command;
        request.timeout = command_patience;
        request.output_limit = 4096;
        const auto done = run_process(request);
        if (!done) return fail(done.error());
        if (done->exit_code == 0) return done->output;
        const std::string how = done->timed_out   ? fmt::format("did not end within {:g} s", command_patience.value())
                                : done->exit_code ? fmt::format("ended with exit code {}", *done->exit_code)
                                                  : fmt::format("was ended by signal {}", done->signal.value_or(0));
        const std::string said = last_line(done->errors);
        return fail(ErrorCode::outside,
                    fmt::format("'{}' {}{}{}", command.front(), how, said.empty() ? "" : ": ", said));
    }
    Result<void> order(const std::vector<std::string>& command, PowerState wanted) {
        if (const auto output = run(command); !output) return fail(output.error());
        const auto now = state();
        if (!now) return fail(now.error());
        if (*now && **now != wanted)
            return fail(ErrorCode::outside, fmt::format("'{}' did its work, and '{}' says {} all the same",
                                                        command.front(), commands_.state.front(), to_string(**now)));
        return {};
    }

    SwitchCommands commands_;
};

}  // namespace

Result<std::unique_ptr<Actuator>> open_switch(const SwitchCommands& commands) {
    return std::make_unique<CommandSwitch>(commands);
}

}  // namespace skyloop
