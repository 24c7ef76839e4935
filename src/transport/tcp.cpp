#include "skyloop/transport/tcp.hpp"

#include <fmt/format.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <utility>

#include "tcp_socket.hpp"

namespace skyloop {
namespace {

constexpr int waiting_clients = 8;

// Gives a listening socket, or nothing with errno set.
FileDescriptor listen_at(const addrinfo& where) {
    FileDescriptor server = make_socket(where);  // its clients inherit the buffer
    if (!server.open()) return {};
    // A run that follows another finds its port free, though old connections still linger in TIME_WAIT.
    set_socket_option(server.value(), SOL_SOCKET, SO_REUSEADDR, 1);
    if (::bind(server.value(), where.ai_addr, where.ai_addrlen) != 0 ||
        ::listen(server.value(), waiting_clients) != 0) {
        const int reason = errno;
        server = FileDescriptor();
        errno = reason;
    }
    return server;
}

std::uint16_t port_of_socket(int socket) {
    sockaddr_storage name{};
    socklen_t size = sizeof name;
    if (::getsockname(socket, reinterpret_cast<sockaddr*>(&name), &size) != 0) return 0;
    std::array<char, NI_MAXSERV> service{};
    if (::getnameinfo(reinterpret_cast<sockaddr*>(&name), size, nullptr, 0, service.data(), service.size(),
                      NI_NUMERICSERV) != 0)
        return 0;
    unsigned port = 0;
    std::from_chars(service.data(), service.data() + std::strlen(service.data()), port);
    return static_cast<std::uint16_t>(port);
}

}  // namespace

Result<TcpAddress> parse_tcp_address(std::string_view text) {
    const auto refused = [&](std::string_view what) {
        return fail(ErrorCode::usage,
                    fmt::format("address '{}': {}; expected [HOST:]PORT, an IPv6 address in brackets", text, what));
    };
    TcpAddress address;
    std::string_view port = text;
    if (const std::size_t colon = text.rfind(':'); colon != std::string_view::npos) {
        std::string_view host = text.substr(0, colon);
        port = text.substr(colon + 1);
        if (host.size() > 2 && host.front() == '[' && host.back() == ']')
            host = host.substr(1, host.size() - 2);
        else if (host.find_first_of(":[]") != std::string_view::npos)
            return refused("the host is not understood");
        if (host.empty()) return refused("the host is missing");
        address.host = host;
    }
    unsigned number = 0;
    const auto [end, error] = std::from_chars(port.data(), port.data() + port.size(), number);
    if (port.empty() || error != std::errc() || end != port.data() + port.size() || number > 65535)
        return refused("a port from 0 to 65535 is missing");
    address.port = static_cast<std::uint16_t>(number);
    return address;
}

Result<std::unique_ptr<TcpTransport>> TcpTransport::listen(const TcpAddress& address) {
    const auto found = look_up(address, true);
    if (!found) return fail(found.error());
    int reason = 0;
    for (const addrinfo* where = found->get(); where != nullptr; where = where->ai_next) {
        FileDescriptor server = listen_at(*where);
        reason = errno;
        if (!server.open()) continue;
        TcpAddress actual = address;
        actual.port = port_of_socket(server.value());
        std::unique_ptr<TcpTransport> wire(new TcpTransport(std::move(server), std::move(actual)));
        if (!is_loopback(*where->ai_addr))
            wire->news_.push_back(fmt::format("{}: whoever reaches this machine can read and configure the receiver",
                                              wire->description()));
        return wire;
    }
    return fail(ErrorCode::outside,
                fmt::format("tcp {}: cannot be listened at: {}", shown_address(address), std::strerror(reason)));
}

void TcpTransport::drop_client() {
    client_ = FileDescriptor();
    client_finished_ = false;
}

// Reads what is there, since only that tells of a client that has gone; then lets the next one in, once all that the
// earlier one wrote has been handed on: bytes of two clients never stand together.
void TcpTransport::follow_clients() {
    if (client_.open() && !client_finished_) {
        const StreamState state = receive_available(client_.value(), unread_);
        client_finished_ = state == StreamState::finished;
        if (state == StreamState::gone) drop_client();
    }
    const bool may_change = unread_.empty();
    for (int i = 0; i < waiting_clients; ++i) {
        const bool taken = client_.open() && !client_finished_;
        if (!taken && !may_change) return;
        FileDescriptor next(::accept4(server_.value(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
        if (!next.open()) return;
        if (taken) {
            ++turned_away_;
            continue;
        }
        drop_client();
        client_ = std::move(next);
        ++connections_;
        prepare_connection(client_.value());
    }
}

std::size_t TcpTransport::write(ByteSpan bytes) {
    follow_clients();
    if (!client_.open()) return bytes.size();
    StreamState state = StreamState::open;
    const std::size_t taken = send_available(client_.value(), bytes, state);
    if (state != StreamState::gone) return taken;
    drop_client();  // and with it the bytes
    return bytes.size();
}

Bytes TcpTransport::read() {
    follow_clients();
    return std::exchange(unread_, {});
}

LineState TcpTransport::line() {
    follow_clients();
    return {client_.open(), std::nullopt};
}

std::vector<std::string> TcpTransport::take_news() { return std::exchange(news_, {}); }

std::string TcpTransport::notice() const {
    if (turned_away_ == 0) return {};
    return fmt::format("{}: {} more client{} came while one was connected and {} closed at once", description(),
                       turned_away_, turned_away_ == 1 ? "" : "s", turned_away_ == 1 ? "was" : "were");
}

std::string TcpTransport::description() const { return shown_address(address_) + " (tcp)"; }

}  // namespace skyloop
