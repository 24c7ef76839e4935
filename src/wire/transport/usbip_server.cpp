#include "wire/transport/usbip_server.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "base/core/threads.hpp"
#include "detail/tcp_socket.hpp"

namespace skyloop::inline wire {
namespace {

constexpr std::size_t most_visitors = 8;
constexpr std::int64_t visitor_patience_ns = 5'000'000'000;
constexpr std::size_t most_request_bytes = 4096;  // a request and the first commands behind it
constexpr std::size_t most_news = 32;

std::string break_news(std::uint16_t duration_ms) {
    constexpr std::uint16_t until_told = 0xFFFF, ended = 0;  // PSTN 1.2, section 6.3.13
    if (duration_ms == ended) return "ends its break";
    if (duration_ms == until_told) return "begins a break";
    return fmt::format("sends a break of {} ms", duration_ms);
}

}  // namespace

struct UsbipTransport::Visitor {
    AcceptedTcp connection;
    std::int64_t until_ns = 0;
    Bytes heard, answer;
    bool answered = false;
    bool looked_at = false;  // what it may have said has been read
};

struct UsbipTransport::Importer {
    AcceptedTcp connection;
    UsbipSession session;
};

UsbipTransport::UsbipTransport(TcpListener listener, UsbFace face)
    : listener_(std::make_unique<TcpListener>(std::move(listener))), face_(std::move(face)) {
    if (!listener_->loopback())
        tell("USB/IP has no authentication: whoever reaches this address can attach the receiver");
}

UsbipTransport::~UsbipTransport() = default;

Result<std::unique_ptr<UsbipTransport>> UsbipTransport::listen(const TcpAddress& address, const UsbFace& face) {
    auto listener = TcpListener::open(address, "usbip");
    if (!listener) return fail(listener.error());
    return std::unique_ptr<UsbipTransport>(new UsbipTransport(std::move(*listener), face));
}

std::uint16_t UsbipTransport::port() const { return listener_->address().port; }

UsbipDevice UsbipTransport::listed() const {
    UsbipDevice device;
    device.path = "/sys/devices/skyloop/usb1/1-1";
    device.bus_id = "1-1";
    device.ids = face_.ids;
    device.release = face_.release;
    device.device_class = {2, 0, 0};
    device.configuration = static_cast<std::uint8_t>(importer_ && importer_->session.device().configured() ? 1 : 0);
    device.interfaces = {{2, 2, 1}, {10, 0, 0}};
    return device;
}

void UsbipTransport::tell(std::string news) {
    if (news_.size() < most_news)
        news_.push_back(std::move(news));
    else
        ++untold_;
}

void UsbipTransport::follow() {
    const std::int64_t now = steady_clock_ns();
    // First whoever has gone: the next one may be there already.
    if (importer_) follow_importer(now);
    accept_visitors(now);
    const std::uint64_t imports_before = imports_;
    std::erase_if(visitors_, [&](const auto& visitor) { return !serve(*visitor, now); });
    if (imports_ != imports_before) follow_importer(now);
}

void UsbipTransport::accept_visitors(std::int64_t now_ns) {
    while (visitors_.size() < most_visitors || make_room()) {
        auto connection = listener_->accept();
        if (!connection) return;
        visitors_.push_back(std::make_unique<Visitor>());
        visitors_.back()->connection = std::move(*connection);
        visitors_.back()->until_ns = now_ns + visitor_patience_ns;
    }
}

// Who comes and says nothing must not keep the others out. False: nobody waits, or all have said something.
bool UsbipTransport::make_room() {
    if (!listener_->any_waits()) return false;
    const auto silent = std::find_if(visitors_.begin(), visitors_.end(), [](const auto& visitor) {
        return visitor->looked_at && visitor->heard.empty() && !visitor->answered;
    });
    if (silent == visitors_.end()) return false;
    visitors_.erase(silent);
    return true;
}

// False when nothing is left to do with it.
bool UsbipTransport::serve(Visitor& visitor, std::int64_t now_ns) {
    const int socket = visitor.connection.socket.value();
    StreamState state = receive_available(socket, visitor.heard, most_request_bytes);
    visitor.looked_at = true;
    if (!visitor.answered && !answer_request(visitor)) return false;
    const std::size_t count = send_available(socket, visitor.answer, state);
    visitor.answer.erase(visitor.answer.begin(), visitor.answer.begin() + static_cast<std::ptrdiff_t>(count));
    if (visitor.answered && visitor.answer.empty()) return false;
    if (state == StreamState::open && now_ns < visitor.until_ns) return true;
    if (!visitor.answered && !visitor.heard.empty())
        tell(fmt::format("{} is closed: it did not end its request", visitor.connection.peer));
    return false;
}

// False when the visitor has become the importer, or is to be closed.
bool UsbipTransport::answer_request(Visitor& visitor) {
    const auto parsed = parse_usbip_request(visitor.heard);
    if (!parsed.mistake.empty()) {
        tell(fmt::format("{} is closed: {}", visitor.connection.peer, parsed.mistake));
        return false;
    }
    if (!parsed.message) return true;
    visitor.answered = true;
    const UsbipDevice device = listed();
    visitor.heard.erase(visitor.heard.begin(), visitor.heard.begin() + static_cast<std::ptrdiff_t>(parsed.size));
    if (parsed.message->kind == UsbipRequest::Kind::device_list) {
        visitor.answer = usbip_device_list(plugged_ ? &device : nullptr);
        return true;
    }
    if (!plugged_ || parsed.message->bus_id != device.bus_id) {
        visitor.answer = usbip_import_reply(UsbipImport::no_such_device, device);
        return true;
    }
    if (importer_) {
        visitor.answer = usbip_import_reply(UsbipImport::busy, device);
        return true;
    }
    import_by(visitor);
    return false;
}

void UsbipTransport::import_by(Visitor& visitor) {
    const UsbipDevice device = listed();
    ++imports_;
    tell(fmt::format("attached by {}", visitor.connection.peer));
    importer_ = std::make_unique<Importer>(Importer{std::move(visitor.connection), UsbipSession(face_, device)});
    importer_->session.reply(usbip_import_reply(UsbipImport::granted, device));
    importer_->session.hear(visitor.heard);
}

void UsbipTransport::follow_importer(std::int64_t now_ns) {
    UsbipSession& session = importer_->session;
    const int socket = importer_->connection.socket.value();
    StreamState state = StreamState::open;
    if (session.wants_bytes()) {
        Bytes heard;
        state = receive_available(socket, heard, usbip_most_data);
        session.hear(heard);
    }
    session.run(now_ns);
    session.sent(send_available(socket, session.output(), state));
    if (const auto duration = session.device().take_break())
        tell(fmt::format("{} {}", importer_->connection.peer, break_news(*duration)));
    if (!session.mistake().empty()) return end_import("is closed: " + session.mistake());
    if (state == StreamState::open) return;
    end_import(state == StreamState::finished && !session.inside_message() ? "has detached"
                                                                           : "is gone in the middle of a message");
}

// What the host wrote before it went is heard.
void UsbipTransport::end_import(const std::string& how) {
    const Bytes last = importer_->session.take_received();
    received_.insert(received_.end(), last.begin(), last.end());
    tell(fmt::format("{} {}", importer_->connection.peer, how));
    importer_.reset();
}

std::size_t UsbipTransport::write(ByteSpan bytes) {
    follow();
    if (!importer_) return bytes.size();
    const std::size_t taken = importer_->session.put(bytes);
    follow_importer(steady_clock_ns());
    return taken;
}

Bytes UsbipTransport::read() {
    follow();
    Bytes bytes = std::exchange(received_, {});
    if (!importer_) return bytes;
    const Bytes more = importer_->session.take_received();
    bytes.insert(bytes.end(), more.begin(), more.end());
    return bytes;
}

LineState UsbipTransport::line() {
    follow();
    LineState state;
    if (!importer_) return state;
    state.connected = importer_->session.listening();
    if (const auto& coding = importer_->session.device().line_coding(); coding && coding->baud > 0)
        state.baud = coding->baud;
    return state;
}

void UsbipTransport::set_plugged(bool plugged) {
    if (plugged_ == plugged) return;
    plugged_ = plugged;
    if (!plugged && importer_) end_import("has lost the receiver: it is unplugged");
}

std::vector<std::string> UsbipTransport::take_news() {
    if (untold_ > 0) news_.push_back(fmt::format("{} more such notices are left out", std::exchange(untold_, 0)));
    return std::exchange(news_, {});
}

std::string UsbipTransport::other_end() const {
    if (!importer_) return {};
    const CdcAcmDevice& device = importer_->session.device();
    std::string text = "attached by " + importer_->connection.peer;
    if (device.line_coding()) text += ", " + to_string(*device.line_coding());
    if (device.dtr()) text += ", DTR";
    if (device.rts()) text += ", RTS";
    return text;
}

std::string UsbipTransport::description() const { return shown_address(listener_->address()) + " (usbip)"; }

}  // namespace skyloop::inline wire
