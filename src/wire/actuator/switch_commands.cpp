#include <fmt/format.h>

#include <chrono>
#include <utility>

#include "base/core/process.hpp"
#include "detail/switch_parts.hpp"

namespace skyloop::inline wire {
namespace {

constexpr Seconds command_patience{10};
constexpr std::chrono::seconds unwanted_patience{1};
constexpr std::size_t shown_of_output = 200;  // characters

// The last line that is not empty.
std::string last_line(std::string_view text) {
    text = text.substr(0, text.find_last_not_of("\n\r ") + 1);
    return std::string(text.substr(text.rfind('\n') + 1).substr(0, shown_of_output));
}

// True once a condition has not held for a while: a cut that is shorter than its command takes is not lost for that.
std::function<bool()> when_long_untrue(const std::function<bool()>& condition) {
    if (!condition) return {};
    using Clock = std::chrono::steady_clock;  // commands live by the host's time
    return [&condition, since = std::optional<Clock::time_point>()]() mutable {
        if (condition()) return since.reset(), false;
        if (!since) since = Clock::now();
        return Clock::now() - *since >= unwanted_patience;
    };
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
    void ask_while_cutting(const std::function<bool()>& wanted) override { cut_wanted_ = wanted; }
    void tell_process_groups(const ProcessGroupListener& listener) override { group_listener_ = listener; }
    [[nodiscard]] std::string description() const override { return fmt::format("command {}", commands_.cut.front()); }

private:
    // What it printed.
    Result<std::string> run(const std::vector<std::string>& command, std::function<bool()> cancelled = {}) {
        ProcessRequest request;
        request.command = command;
        request.timeout = command_patience;
        request.output_limit = 4096;
        request.cancelled = std::move(cancelled);
        request.group = group_listener_;
        const auto done = run_process(request);
        if (!done) return fail(done.error());
        if (done->exit_code == 0) return done->output;
        const std::string how = done->cancelled   ? "had not ended when the power was wanted back"
                                : done->timed_out ? fmt::format("did not end within {:g} s", command_patience.value())
                                : done->exit_code ? fmt::format("ended with exit code {}", *done->exit_code)
                                                  : fmt::format("was ended by signal {}", done->signal.value_or(0));
        const std::string said = last_line(done->errors);
        return fail(ErrorCode::outside,
                    fmt::format("'{}' {}{}{}", command.front(), how, said.empty() ? "" : ": ", said));
    }
    Result<void> order(const std::vector<std::string>& command, PowerState wanted) {
        auto cancelled = wanted == PowerState::cut ? when_long_untrue(cut_wanted_) : nullptr;
        if (const auto output = run(command, std::move(cancelled)); !output) return fail(output.error());
        const auto now = state();
        if (!now) return fail(now.error());
        if (*now && **now != wanted)
            return fail(ErrorCode::outside, fmt::format("'{}' did its work, and '{}' says {} all the same",
                                                        command.front(), commands_.state.front(), to_string(**now)));
        return {};
    }

    SwitchCommands commands_;
    std::function<bool()> cut_wanted_;
    ProcessGroupListener group_listener_;
};

}  // namespace

Result<std::unique_ptr<Actuator>> open_switch(const SwitchCommands& commands) {
    return std::make_unique<CommandSwitch>(commands);
}

}  // namespace skyloop::inline wire
