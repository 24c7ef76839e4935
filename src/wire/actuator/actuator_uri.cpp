#include "wire/actuator/actuator_uri.hpp"

#include <fmt/format.h>

#include <array>
#include <optional>
#include <type_traits>

#include "base/core/number_text.hpp"
#include "detail/switch_parts.hpp"
#include "wire/transport/serial.hpp"

namespace skyloop::inline wire {
namespace {

constexpr std::string_view power_grammar =
    "relay:VID:PID/N, gpio:VID:PID/N, hub:PORT_PATH, line:DEVICE/rts, line:DEVICE/dtr or command:CUT|RESTORE";

tl::unexpected<Error> not_understood(std::string_view uri, std::string_view expected) {
    return fail(ErrorCode::usage, fmt::format("power '{}' is not understood; expected {}", uri, expected));
}

// Takes ",active=…" off the end; nothing when what stands there is no level.
std::optional<ActiveLevel> take_level(std::string_view& rest) {
    const std::size_t comma = rest.rfind(',');
    if (comma == std::string_view::npos) return ActiveLevel::cuts;
    const std::string_view option = rest.substr(comma + 1);
    rest = rest.substr(0, comma);
    if (option == "active=cut") return ActiveLevel::cuts;
    if (option == "active=power") return ActiveLevel::powers;
    return std::nullopt;
}

// VID:PID…/N[,active=…], of a relay or a pin.
template <class Address, int least, int most>
Result<ActuatorUri> parse_output(std::string_view uri, std::string_view rest) {
    const std::string expected =
        fmt::format("{}VID:PID[:SERIAL|@PORT_PATH]/N[,active=cut|,active=power] with N from {} to {}",
                    uri.substr(0, uri.find(':') + 1), least, most);
    const auto active = take_level(rest);
    const std::size_t slash = rest.rfind('/');
    if (!active || slash == std::string_view::npos) return not_understood(uri, expected);
    const auto number = number_in<int>(rest.substr(slash + 1));
    if (!number || *number < least || *number > most) return not_understood(uri, expected);
    auto board = parse_usb_address(rest.substr(0, slash));
    if (!board) return fail(ErrorCode::usage, fmt::format("power '{}': {}", uri, board.error().message));
    return Address{std::move(*board), *number, *active};
}

Result<ActuatorUri> parse_hub(std::string_view uri, std::string_view rest) {
    if (!is_usb_port_path(rest)) return not_understood(uri, "hub:PORT_PATH, bus and ports, such as hub:1-1.4");
    return HubPortAddress{std::string(rest)};
}

Result<ActuatorUri> parse_line(std::string_view uri, std::string_view rest) {
    constexpr std::string_view expected =
        "line:DEVICE/rts or line:DEVICE/dtr, then nothing, ,active=cut or ,active=power";
    const auto active = take_level(rest);
    const std::size_t slash = rest.rfind('/');
    if (!active || slash == std::string_view::npos || slash == 0) return not_understood(uri, expected);
    const std::string_view name = rest.substr(slash + 1);
    if (name != "rts" && name != "dtr") return not_understood(uri, expected);
    using Line = ModemLineAddress::Line;
    return ModemLineAddress{std::string(rest.substr(0, slash)), name == "rts" ? Line::rts : Line::dtr, *active};
}

// The words of commands, parted by "|"; nothing when a quote is left open.
class CommandWords {
public:
    static std::optional<std::vector<std::vector<std::string>>> of(std::string_view text) {
        CommandWords reader;
        for (const char c : text)
            reader.take(c);
        if (reader.quote_ != 0 || reader.escaped_) return std::nullopt;
        reader.end_word();
        return std::move(reader.commands_);
    }

private:
    void take(char c) {
        if (escaped_ || (quote_ == '\'' && c != '\'')) {
            escaped_ = false;
            word_ += c;
        } else if (c == '\\') {
            escaped_ = in_word_ = true;
        } else if (quote_ != 0) {
            if (c == quote_)
                quote_ = 0;
            else
                word_ += c;
        } else if (c == '"' || c == '\'') {
            quote_ = c;
            in_word_ = true;
        } else {
            take_bare(c);
        }
    }
    void take_bare(char c) {
        if (c == ' ' || c == '\t') return end_word();
        if (c == '|') {
            end_word();
            commands_.emplace_back();
            return;
        }
        in_word_ = true;
        word_ += c;
    }
    void end_word() {
        if (in_word_) commands_.back().push_back(std::move(word_));
        word_.clear();
        in_word_ = false;
    }

    std::vector<std::vector<std::string>> commands_{1};
    std::string word_;
    char quote_ = 0;
    bool escaped_ = false, in_word_ = false;
};

Result<ActuatorUri> parse_commands(std::string_view uri, std::string_view rest) {
    auto commands = CommandWords::of(rest);
    if (!commands) return not_understood(uri, "each quote to be closed");
    if (commands->size() < 2 || commands->size() > 3)
        return not_understood(uri, "command:CUT|RESTORE or command:CUT|RESTORE|STATE");
    for (const auto& command : *commands)
        if (command.empty() || command.front().empty())
            return not_understood(uri, "a program before, between and after each |");
    commands->resize(3);
    return SwitchCommands{std::move((*commands)[0]), std::move((*commands)[1]), std::move((*commands)[2])};
}

bool may_be_one_board(const UsbAddress& a, const UsbAddress& b) {
    const auto anywhere = [](const UsbAddress& board) { return board.serial.empty() && board.port_path.empty(); };
    if (a.ids != b.ids) return false;
    return anywhere(a) || anywhere(b) || (a.serial == b.serial && a.port_path == b.port_path);
}

// A relay or a pin, one of several on its board.
template <class OnBoard>
bool one_switch(const OnBoard& a, const OnBoard& b) {
    return a.number == b.number && may_be_one_board(a.board, b.board);
}
bool one_switch(const HubPortAddress& a, const HubPortAddress& b) { return a.port_path == b.port_path; }
// Both lines of a device are one: who has it open has it alone.
bool one_switch(const ModemLineAddress& a, const ModemLineAddress& b) {
    return place_of_device(a.device) == place_of_device(b.device);
}
bool one_switch(const SwitchCommands& a, const SwitchCommands& b) { return a.cut == b.cut && a.restore == b.restore; }

}  // namespace

bool may_be_one_switch(const ActuatorUri& a, const ActuatorUri& b) {
    return std::visit(
        [](const auto& x, const auto& y) {
            if constexpr (std::is_same_v<decltype(x), decltype(y)>) return one_switch(x, y);
            return false;
        },
        a, b);
}

Result<ActuatorUri> parse_actuator_uri(std::string_view uri) {
    using Parse = Result<ActuatorUri> (*)(std::string_view, std::string_view);
    constexpr std::array<std::pair<std::string_view, Parse>, 5> kinds{{{"relay:", parse_output<RelayAddress, 1, 8>},
                                                                       {"gpio:", parse_output<GpioAddress, 0, 3>},
                                                                       {"hub:", parse_hub},
                                                                       {"line:", parse_line},
                                                                       {"command:", parse_commands}}};
    // A zero would end what the system is given.
    if (uri.find('\0') == std::string_view::npos)
        for (const auto& [scheme, parse] : kinds)
            if (uri.starts_with(scheme)) return parse(uri, uri.substr(scheme.size()));
    return not_understood(uri, power_grammar);
}

Result<void> check_followed(Actuator& one, PowerState wanted, std::string_view otherwise) {
    const auto now = one.state();
    if (!now) return fail(now.error());
    if (!*now || **now == wanted) return {};
    return fail(ErrorCode::outside, fmt::format("{} did not follow: {}", one.description(), otherwise));
}

Result<std::unique_ptr<Actuator>> open_actuator(std::string_view uri) {
    const auto address = parse_actuator_uri(uri);
    if (!address) return fail(address.error());
    return std::visit([](const auto& one) { return open_switch(one); }, *address);
}

}  // namespace skyloop::inline wire
