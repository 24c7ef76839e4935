#include "wire/transport/can_transport.hpp"

#include <fmt/format.h>

#include <chrono>
#include <utility>

#include "base/core/number_text.hpp"
#include "wire/can/can_sockets.hpp"
#include "wire/can/slcan_adapter.hpp"
#include "wire/transport/pty.hpp"

namespace skyloop::inline wire {
namespace {

constexpr std::size_t most_unsent = 65536;  // bytes that wait for a host that reads slowly
constexpr std::uint32_t adapter_baud = 115200;
constexpr std::string_view can_shapes = "slcan:DEVICE[@BAUD], slcan:pty[:LINK], socketcan:INTERFACE or mcast:BUS";

std::uint64_t milliseconds_of_host() {
    return static_cast<std::uint64_t>(
        std::chrono::duration_cast<std::chrono::milliseconds>(std::chrono::steady_clock::now().time_since_epoch())
            .count());
}

// Lines to a serial line, each whole or not at all.
class LineSender {
public:
    explicit LineSender(std::unique_ptr<Transport> line) : line_(std::move(line)) {}
    void send(std::string_view text) {
        if (text.empty()) return;
        if (unsent_.size() + text.size() > most_unsent)
            ++lost_;
        else
            unsent_.add(to_bytes(text));
        flush();
    }
    void flush() {
        if (!unsent_.empty()) unsent_.sent(line_->write(unsent_.waiting()));
    }
    void forget() { unsent_.clear(); }
    [[nodiscard]] Transport& line() { return *line_; }
    [[nodiscard]] const Transport& line() const { return *line_; }
    [[nodiscard]] std::string notice() const {
        return lost_ == 0
                   ? line_->notice()
                   : fmt::format("{}: {} CAN frames were lost, since their reader was too slow", description(), lost_);
    }
    /// "/dev/ttyACM0 (slcan)".
    [[nodiscard]] std::string description() const {
        const std::string line = line_->description();
        return line.substr(0, line.rfind(" (")) + " (slcan)";
    }

private:
    std::unique_ptr<Transport> line_;
    SendBuffer unsent_;
    std::uint64_t lost_ = 0;
};

// A bus at the other end of a serial line.
class LineEnd : public CanEnd {
public:
    explicit LineEnd(std::unique_ptr<Transport> line) : out_(std::move(line)) {}
    std::vector<std::string> take_news() override { return out_.line().take_news(); }
    [[nodiscard]] std::string failure() const override { return out_.line().failure(); }
    [[nodiscard]] std::string notice() const override { return out_.notice(); }
    [[nodiscard]] std::string description() const override { return out_.description(); }

protected:
    LineSender out_;
};

class SlcanServer : public LineEnd {
public:
    using LineEnd::LineEnd;

    void send(const CanFrame& frame) override { out_.send(adapter_.line_of(frame, milliseconds_of_host())); }
    std::vector<CanFrame> receive() override {
        if (!out_.line().line().connected) {
            adapter_.close();
            out_.forget();
            return {};
        }
        SlcanAdapter::Taken taken = adapter_.take(out_.line().read());
        out_.send(taken.answers);
        out_.flush();
        return std::move(taken.frames);
    }
    bool connected() override { return adapter_.is_open(); }

private:
    SlcanAdapter adapter_;
};

class SlcanClient : public LineEnd {
public:
    using LineEnd::LineEnd;

    void send(const CanFrame& frame) override {
        if (open_) out_.send(slcan_line(frame));
    }
    std::vector<CanFrame> receive() override {
        const bool there = out_.line().line().connected;
        if (there && !std::exchange(open_, there)) {
            // What was half written before is ended; an adapter whose channel is open would refuse a speed.
            out_.forget();
            out_.send("\r\r\rC\rS8\rO\r");
        }
        open_ = there;
        out_.flush();
        std::vector<CanFrame> frames;
        for (std::string line : lines_.feed(out_.line().read())) {
            // BEL ends an answer, and stands before what follows.
            line.erase(0, line.find_last_of('\a') + 1);
            if (const auto frame = parse_slcan_line(line)) frames.push_back(*frame);
        }
        return frames;
    }
    bool connected() override { return open_; }

private:
    SlcanLines lines_;
    bool open_ = false;
};

class SocketEnd : public CanEnd {
public:
    SocketEnd(std::unique_ptr<CanSocket> socket, std::string description)
        : socket_(std::move(socket)), description_(std::move(description)) {}
    void send(const CanFrame& frame) override {
        if (!socket_->send(frame)) ++lost_;
    }
    std::vector<CanFrame> receive() override { return socket_->receive(); }
    [[nodiscard]] std::string notice() const override {
        return lost_ == 0 ? std::string()
                          : fmt::format("{}: {} CAN frames were lost, since nobody took them from the bus",
                                        description_, lost_);
    }
    [[nodiscard]] std::string description() const override { return description_; }

private:
    std::unique_ptr<CanSocket> socket_;
    std::string description_;
    std::uint64_t lost_ = 0;
};

Result<std::unique_ptr<CanEnd>> socket_end(Result<std::unique_ptr<CanSocket>> socket, std::string description) {
    if (!socket) return fail(socket.error());
    return std::unique_ptr<CanEnd>(std::make_unique<SocketEnd>(std::move(*socket), std::move(description)));
}

Result<CanAddress> parse_slcan(std::string_view rest) {
    constexpr std::string_view pty = "pty";
    CanAddress address;
    if (rest == pty) return address;
    if (rest.starts_with("pty:")) {
        address.name = rest.substr(pty.size() + 1);
        if (address.name.empty()) return fail(ErrorCode::usage, "a path is missing behind 'slcan:pty:'");
        return address;
    }
    address.kind = CanAddress::Kind::slcan_device;
    auto serial = parse_serial_address(rest);
    if (!serial) return fail(serial.error());
    address.serial = std::move(*serial);
    if (!address.serial.baud) address.serial.baud = adapter_baud;
    return address;
}

}  // namespace

Result<CanAddress> parse_can_address(std::string_view text) {
    const std::size_t colon = text.find(':');
    const std::string_view kind = text.substr(0, colon);
    const std::string_view rest = colon == std::string_view::npos ? std::string_view() : text.substr(colon + 1);
    if (kind == "slcan" && !rest.empty()) return parse_slcan(rest);
    CanAddress address;
    if (kind == "socketcan" && !rest.empty()) {
        address.kind = CanAddress::Kind::socketcan;
        address.name = rest;
        return address;
    }
    const auto bus = number_in<int>(rest);
    if (kind == "mcast" && bus && *bus >= 0 && *bus <= most_multicast_bus) {
        address.kind = CanAddress::Kind::multicast;
        address.bus = *bus;
        return address;
    }
    if (kind == "mcast")
        return fail(ErrorCode::usage,
                    fmt::format("bus '{}' is not understood; expected mcast:BUS, 0 to {}", rest, most_multicast_bus));
    return fail(ErrorCode::usage, fmt::format("'{}' is no CAN bus; expected {}", text, can_shapes));
}

Result<std::unique_ptr<CanEnd>> serve_slcan(std::unique_ptr<Transport> terminal) {
    return std::unique_ptr<CanEnd>(std::make_unique<SlcanServer>(std::move(terminal)));
}

Result<std::unique_ptr<CanEnd>> use_slcan_adapter(std::unique_ptr<Transport> adapter) {
    return std::unique_ptr<CanEnd>(std::make_unique<SlcanClient>(std::move(adapter)));
}

Result<std::unique_ptr<CanEnd>> open_can_end(const CanAddress& address) {
    switch (address.kind) {
        case CanAddress::Kind::slcan_device: {
            auto serial = SerialTransport::open(address.serial);
            if (!serial) return fail(serial.error());
            return use_slcan_adapter(std::move(*serial));
        }
        case CanAddress::Kind::slcan_pty: {
            auto pty = address.name.empty() ? PtyTransport::open() : PtyTransport::open(address.name);
            if (!pty) return fail(pty.error());
            return serve_slcan(std::move(*pty));
        }
        case CanAddress::Kind::socketcan:
            return socket_end(open_socketcan(address.name), address.name + " (socketcan)");
        case CanAddress::Kind::multicast:
            break;
    }
    return socket_end(open_multicast_bus(address.bus), fmt::format("mcast:{} (can-multicast)", address.bus));
}

std::size_t CanBus::join() {
    inboxes_[next_] = {};
    return next_++;
}

void CanBus::deliver(const CanFrame& frame, std::size_t but_not) {
    for (auto& [node, inbox] : inboxes_)
        if (node != but_not && inbox.size() < most_waiting) inbox.push_back(frame);
}

void CanBus::send(std::size_t from, const CanFrame& frame) {
    end_->send(frame);
    deliver(frame, from);
}

void CanBus::poll() {
    constexpr std::size_t nobody = 0;
    for (const CanFrame& frame : end_->receive())
        deliver(frame, nobody);
}

std::vector<CanFrame> CanBus::take(std::size_t node) {
    poll();
    return std::exchange(inboxes_.at(node), {});
}

Result<std::shared_ptr<CanBus>> CanBuses::open(const CanAddress& address, const std::string& uri) {
    if (auto there = open_[uri].lock()) return there;
    auto end = open_can_end(address);
    if (!end) return fail(end.error());
    auto bus = std::make_shared<CanBus>(std::move(*end));
    open_[uri] = bus;
    return bus;
}

std::size_t CanTransport::write(ByteSpan bytes) {
    for (const std::string& line : lines_.feed(bytes))
        if (const auto frame = parse_slcan_line(line)) bus_->send(node_, *frame);
    return bytes.size();
}

Bytes CanTransport::read() {
    std::string text;
    for (const CanFrame& frame : bus_->take(node_))
        text += slcan_line(frame);
    return to_bytes(text);
}

// A host that opens the channel is seen by what it writes, which the link would not read before.
LineState CanTransport::line() {
    const bool was = bus_->end().connected();
    if (!was) bus_->poll();
    return {bus_->end().connected(), std::nullopt};
}

}  // namespace skyloop::inline wire
