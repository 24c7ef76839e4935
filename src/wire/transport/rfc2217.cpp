#include "wire/transport/rfc2217.hpp"

#include <algorithm>
#include <utility>

namespace skyloop::inline wire {
namespace {

// Telnet commands: RFC 854, "TELNET COMMAND STRUCTURE".
constexpr std::uint8_t se = 240, sb = 250, will = 251, wont = 252, ask_do = 253, ask_dont = 254, iac = 255;
// Options: RFC 856, RFC 858, RFC 2217 section 2.
constexpr std::uint8_t binary = 0, suppress_go_ahead = 3, com_port = 44;
constexpr std::array<std::uint8_t, 3> known_options{binary, suppress_go_ahead, com_port};

// Commands of the client: RFC 2217, section 2. The server's answers have 100 more.
namespace com_command {
constexpr std::uint8_t signature = 0, baud_rate = 1, data_size = 2, parity = 3, stop_size = 4, set_control = 5,
                       line_state = 6, modem_state = 7, flow_suspend = 8, flow_resume = 9, line_state_mask = 10,
                       modem_state_mask = 11, purge_data = 12;
constexpr std::uint8_t of_server = 100;
}  // namespace com_command

// NOTIFY-MODEMSTATE: carrier, data set ready and clear to send. The emulated device is always there.
constexpr std::uint8_t lines_up = 128 | 32 | 16;
// NOTIFY-LINESTATE: the transmitter has nothing left.
constexpr std::uint8_t transmitter_empty = 64 | 32;

constexpr std::uint32_t least_baud = 50, most_baud = 12'000'000;
constexpr std::size_t most_sub_bytes = 128;
constexpr std::size_t most_answer_bytes = 65536;
// Of commands that are followed at one call: a client that floods must not hold the loop. Clients send some ten at
// once.
constexpr int most_telnet_commands = 64;
constexpr std::size_t most_data_waiting = 65536;   // of the client, not read yet
constexpr std::size_t most_bytes_waiting = 65536;  // for the client

}  // namespace

Bytes ComPortServer::escaped(ByteSpan data) {
    Bytes bytes;
    bytes.reserve(data.size() + 8);
    for (const std::uint8_t byte : data) {
        if (byte == iac) bytes.push_back(iac);
        bytes.push_back(byte);
    }
    return bytes;
}

void ComPortServer::begin() {
    settings_ = {};
    options_ = {};
    agreed_ = false;
    state_ = State::data;
    held_ = false;
    answers_.clear();
    // What is offered here stands for us already; an agreement is then no news to answer.
    for (Option& option : options_)
        option = {true, true};
    answer(Bytes{iac, will, binary, iac, ask_do, binary, iac, will, suppress_go_ahead, iac, ask_do, suppress_go_ahead,
                 iac, will, com_port, iac, ask_do, com_port});
}

std::size_t ComPortServer::receive(ByteSpan bytes) {
    if (held_) {
        if (!data_.empty()) return 0;
        held_ = false;
        finish_sub();
    }
    followed_ = 0;
    std::size_t taken = 0;
    while (taken < bytes.size() && !held_ && followed_ < most_telnet_commands)
        take(bytes[taken++]);
    return taken;
}

void ComPortServer::take(std::uint8_t byte) {
    switch (state_) {
        case State::data:
            if (byte == iac)
                state_ = State::command;
            else
                data_.push_back(byte);
            return;
        case State::command:
            return take_command(byte);
        case State::option:
            state_ = State::data;
            return negotiate(verb_, byte);
        case State::sub:
        case State::sub_command:
            return take_sub(byte);
    }
}

// A command without an option, such as NOP or BREAK, ends with itself and means nothing here.
void ComPortServer::take_command(std::uint8_t byte) {
    state_ = State::data;
    if (byte == iac) {
        data_.push_back(byte);
    } else if (byte == sb) {
        sub_.clear();
        sub_too_long_ = false;
        state_ = State::sub;
    } else if (byte >= will && byte <= ask_dont) {
        verb_ = byte;
        state_ = State::option;
    }
}

void ComPortServer::take_sub(std::uint8_t byte) {
    if (state_ == State::sub && byte == iac) {
        state_ = State::sub_command;
        return;
    }
    if (state_ == State::sub_command && byte == se) {
        state_ = State::data;
        const bool new_speed = sub_.size() > 1 && sub_[0] == com_port && sub_[1] == com_command::baud_rate;
        held_ = new_speed && !data_.empty();
        if (!held_) finish_sub();
        return;
    }
    // Any other command inside: the end has been lost, and this is the next one.
    if (state_ == State::sub_command && byte != iac) return take_command(byte);
    state_ = State::sub;
    if (sub_.size() < most_sub_bytes)
        sub_.push_back(byte);
    else
        sub_too_long_ = true;
}

// A client whose own request met our offer on the way says nothing more of the option (pyserial does not): its first
// command is an agreement, too.
void ComPortServer::finish_sub() {
    ++followed_;
    if (sub_too_long_ || sub_.size() < 2 || sub_[0] != com_port) return;
    agree();
    carry_out(sub_[1], ByteSpan(sub_).subspan(2));
}

ComPortServer::Option* ComPortServer::known(std::uint8_t option) {
    const auto* const found = std::find(known_options.begin(), known_options.end(), option);
    if (found == known_options.end()) return nullptr;
    return &options_[static_cast<std::size_t>(found - known_options.begin())];
}

// Only a change is answered: RFC 854, "The Network Virtual Terminal", and RFC 1143.
void ComPortServer::negotiate(std::uint8_t verb, std::uint8_t option) {
    ++followed_;
    Option* const mine = known(option);
    const bool wanted = verb == will || verb == ask_do;
    const bool about_theirs = verb == will || verb == wont;
    if (mine == nullptr) {
        if (wanted) answer(Bytes{iac, about_theirs ? ask_dont : wont, option});
        return;
    }
    if (option == com_port && wanted) {
        // The client speaks of the option as its own, some servers' clients of ours: either is an agreement.
        agree();
    }
    bool& stands = about_theirs ? mine->theirs : mine->ours;
    if (stands == wanted) return;
    stands = wanted;
    const std::uint8_t yes = about_theirs ? ask_do : will, no = about_theirs ? ask_dont : wont;
    answer(Bytes{iac, wanted ? yes : no, option});
}

void ComPortServer::agree() {
    if (!std::exchange(agreed_, true)) answer_byte(com_command::of_server + com_command::modem_state, lines_up);
}

void ComPortServer::answer(ByteSpan bytes) {
    if (answers_.size() + bytes.size() > most_answer_bytes) return;
    answers_.insert(answers_.end(), bytes.begin(), bytes.end());
}

void ComPortServer::answer_option(std::uint8_t command, ByteSpan value) {
    Bytes bytes{iac, sb, com_port, command};
    const Bytes inner = escaped(value);
    bytes.insert(bytes.end(), inner.begin(), inner.end());
    bytes.push_back(iac);
    bytes.push_back(se);
    answer(bytes);
}

void ComPortServer::carry_out(std::uint8_t command, ByteSpan value) {
    switch (command) {
        case com_command::signature:
            // With a text the client tells its own name, without one it asks for ours.
            if (value.empty()) answer_option(com_command::of_server + com_command::signature, to_bytes(signature_));
            return;
        case com_command::baud_rate:
            return set_baud(value);
        case com_command::modem_state:
            return answer_byte(com_command::of_server + com_command::modem_state, lines_up);
        case com_command::line_state:
            return answer_byte(com_command::of_server + com_command::line_state, transmitter_empty);
        case com_command::flow_suspend:
        case com_command::flow_resume:
            settings_.suspended = command == com_command::flow_suspend;
            return;
        default:
            if (value.size() == 1) carry_out_on_line(command, value[0]);
    }
}

// 0 asks for the present value; what the port cannot have is answered with it, too.
void ComPortServer::carry_out_on_line(std::uint8_t command, std::uint8_t value) {
    const auto set = [&](std::uint8_t& setting, std::uint8_t least, std::uint8_t most) {
        if (value >= least && value <= most) setting = value;
        answer_byte(static_cast<std::uint8_t>(com_command::of_server + command), setting);
    };
    switch (command) {
        case com_command::data_size:
            return set(settings_.data_bits, 5, 8);
        case com_command::parity:
            return set(settings_.parity, 1, 5);
        case com_command::stop_size:
            return set(settings_.stop_bits, 1, 3);
        case com_command::set_control:
            return control(value);
        case com_command::line_state_mask:
        case com_command::modem_state_mask:
            // The states never change, so that a mask takes nothing away.
            return answer_byte(static_cast<std::uint8_t>(com_command::of_server + command), value);
        case com_command::purge_data:
            return purge(value);
        default:
            return;
    }
}

void ComPortServer::set_baud(ByteSpan value) {
    if (value.size() != 4) return;
    std::uint32_t asked = 0;
    for (const std::uint8_t byte : value)
        asked = asked << 8U | byte;  // network order
    if (asked >= least_baud && asked <= most_baud) settings_.baud = asked;
    const std::uint32_t now = settings_.baud.value_or(own_baud_);
    const auto byte = [&](unsigned shift) { return static_cast<std::uint8_t>(now >> shift); };
    answer_option(com_command::of_server + com_command::baud_rate, Bytes{byte(24), byte(16), byte(8), byte(0)});
}

// RFC 2217, section 3, SET-CONTROL: each group has a value that asks for the present state.
void ComPortServer::control(std::uint8_t value) {
    const auto line = [&](bool& state, std::uint8_t ask) {
        if (value != ask) state = value == ask + 1;
        answer_byte(com_command::of_server + com_command::set_control,
                    static_cast<std::uint8_t>(state ? ask + 1 : ask + 2));
    };
    constexpr std::uint8_t ask_break = 4, ask_dtr = 7, ask_rts = 10, ask_inbound = 13, last_inbound = 16;
    // Flow control by DCD (17), DTR (18, inbound) or DSR (19) the port does not have: the answer says what it has.
    constexpr std::uint8_t by_dcd = 17, by_dsr = 19;
    if (value < ask_break || value == by_dcd || value == by_dsr) {
        if (value != 0 && value < ask_break) settings_.flow = value;
        return answer_byte(com_command::of_server + com_command::set_control, settings_.flow);
    }
    if (value < ask_dtr) return line(settings_.sends_break, ask_break);
    if (value < ask_rts) return line(settings_.dtr, ask_dtr);
    if (value < ask_inbound) return line(settings_.rts, ask_rts);
    if (value <= last_inbound && value != ask_inbound) settings_.inbound_flow = value;
    answer_byte(com_command::of_server + com_command::set_control, settings_.inbound_flow);
}

// 1: what waits for the client, which here is nothing but the socket's own; 2: what waits for the device; 3: both.
void ComPortServer::purge(std::uint8_t value) {
    if (value < 1 || value > 3) return;
    if (value != 1) data_.clear();
    answer_byte(com_command::of_server + com_command::purge_data, value);
}

Rfc2217Transport::Rfc2217Transport(std::unique_ptr<TcpTransport> server)
    : server_(std::move(server)), port_("skyloop, an emulated GNSS receiver") {}

Result<std::unique_ptr<Rfc2217Transport>> Rfc2217Transport::listen(const TcpAddress& address) {
    auto server = TcpTransport::listen(address);
    if (!server) return fail(server.error());
    return std::unique_ptr<Rfc2217Transport>(new Rfc2217Transport(std::move(*server)));
}

// What an earlier client has written is heard; its commands are nobody's any more.
void Rfc2217Transport::meet_client() {
    met_ = server_->connections();
    waiting_.clear();
    port_.begin();
}

void Rfc2217Transport::follow() {
    if (unparsed_.empty() && port_.data_waiting() < most_data_waiting) {
        Bytes fresh = server_->read();
        if (server_->connections() != met_) meet_client();
        unparsed_ = std::move(fresh);
    }
    parsed_ += port_.receive(ByteSpan(unparsed_).subspan(parsed_));
    if (parsed_ == unparsed_.size()) {
        unparsed_.clear();
        parsed_ = 0;
    }
    if (server_->connections() != met_ || waiting_.size() > most_bytes_waiting) return;
    const Bytes answers = port_.take_answers();
    waiting_.insert(waiting_.end(), answers.begin(), answers.end());
    send_waiting();
}

void Rfc2217Transport::send_waiting() {
    if (waiting_.empty()) return;
    const std::size_t taken = server_->write(waiting_);
    waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(taken));
}

std::size_t Rfc2217Transport::write(ByteSpan bytes) {
    follow();
    // Nor is anything for a next client that is not met yet: its options come first.
    if (!server_->line().connected || server_->connections() != met_) return bytes.size();
    if (port_.settings().suspended || !waiting_.empty()) return 0;
    std::size_t left = server_->write(ComPortServer::escaped(bytes));
    std::size_t taken = 0;
    for (; taken < bytes.size() && left > 0; ++taken) {
        const std::size_t width = bytes[taken] == iac ? 2 : 1;
        // Half of a pair has left: the other half must come next.
        if (left < width) waiting_.push_back(iac);
        left -= std::min(left, width);
    }
    return taken;
}

// What stood there at the last look: with bytes that came since, the speed may have changed.
Bytes Rfc2217Transport::read() {
    Bytes data = port_.take_data();
    follow();
    return data;
}

LineState Rfc2217Transport::line() {
    follow();
    return {server_->line().connected, port_.settings().baud};
}

std::string Rfc2217Transport::description() const {
    const std::string under = server_->description();
    return under.substr(0, under.rfind(' ')) + " (rfc2217)";
}

}  // namespace skyloop::inline wire
