#include "wire/transport/tcp_client.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "detail/tcp_socket.hpp"

namespace skyloop::inline wire {
namespace {

constexpr std::int64_t second_ns = 1'000'000'000;
constexpr std::int64_t hurry_ns = 60 * second_ns;  // a program that is started beside this one has come by then
constexpr std::int64_t hurried_pause_ns = second_ns / 200, pause_ns = second_ns / 2;
constexpr std::int64_t answer_patience_ns = 5 * second_ns;

}  // namespace

struct TcpClientTransport::Route {
    AddressList all;
    const addrinfo* next = nullptr;
};

TcpClientTransport::TcpClientTransport(TcpAddress address, std::unique_ptr<Route> route, Clock clock)
    : address_(std::move(address)), route_(std::move(route)), clock_(std::move(clock)), alone_since_ns_(clock_()) {}

TcpClientTransport::~TcpClientTransport() = default;

Result<std::unique_ptr<TcpClientTransport>> TcpClientTransport::open(const TcpAddress& address, Clock clock) {
    if (address.port == 0)
        return fail(ErrorCode::usage, fmt::format("tcp-connect {}: port 0 cannot be called; expected 1 to 65535",
                                                  shown_address(address)));
    auto found = look_up(address, "tcp-connect", false);
    if (!found) return fail(found.error());
    auto route = std::make_unique<Route>();
    route->all = std::move(*found);
    std::unique_ptr<TcpClientTransport> wire(new TcpClientTransport(address, std::move(route), std::move(clock)));
    wire->begin_attempt(wire->alone_since_ns_);
    return wire;
}

void TcpClientTransport::begin_attempt(std::int64_t now_ns) {
    attempt_began_ns_ = now_ns;
    const addrinfo* where = route_->next != nullptr ? route_->next : route_->all.get();
    route_->next = where->ai_next;
    socket_ = make_socket(*where);
    if (!socket_.open()) return give_up(errno);
    prepare_connection(socket_.value());
    if (::connect(socket_.value(), where->ai_addr, where->ai_addrlen) == 0) return connected();
    if (errno != EINPROGRESS && errno != EINTR) give_up(errno);
}

void TcpClientTransport::follow_attempt(std::int64_t now_ns) {
    pollfd state{socket_.value(), POLLOUT, 0};
    if (::poll(&state, 1, 0) <= 0) {
        if (now_ns - attempt_began_ns_ >= answer_patience_ns) give_up(ETIMEDOUT);
        return;
    }
    int reason = 0;
    socklen_t size = sizeof reason;
    if (::getsockopt(socket_.value(), SOL_SOCKET, SO_ERROR, &reason, &size) != 0) reason = errno;
    if (reason != 0) return give_up(reason);
    connected();
}

void TcpClientTransport::give_up(int reason) {
    socket_ = FileDescriptor();
    if (!std::exchange(attempted_, true))
        news_.push_back(fmt::format("{}: {}; trying again", shown_address(address_), std::strerror(reason)));
}

void TcpClientTransport::connected() {
    if (calls_itself(socket_.value())) return give_up(ECONNREFUSED);
    connected_ = true;
    attempted_ = false;
    ++connections_;
    news_.push_back(fmt::format("{}: connected", shown_address(address_)));
}

void TcpClientTransport::lose() {
    socket_ = FileDescriptor();
    connected_ = false;
    attempted_ = true;  // the sentence below says what will be done
    alone_since_ns_ = attempt_began_ns_ = clock_();
    news_.push_back(fmt::format("{}: connection lost; trying again", shown_address(address_)));
}

void TcpClientTransport::follow() {
    if (connected_) {
        if (receive_available(socket_.value(), unread_) != StreamState::open) lose();
        return;
    }
    const std::int64_t now_ns = clock_();
    if (socket_.open()) return follow_attempt(now_ns);
    const std::int64_t pause = now_ns - alone_since_ns_ < hurry_ns ? hurried_pause_ns : pause_ns;
    if (now_ns - attempt_began_ns_ >= pause) begin_attempt(now_ns);
}

std::size_t TcpClientTransport::write(ByteSpan bytes) {
    follow();
    if (!connected_) return bytes.size();
    StreamState state = StreamState::open;
    const std::size_t taken = send_available(socket_.value(), bytes, state);
    if (state != StreamState::gone) return taken;
    lose();
    return bytes.size();
}

Bytes TcpClientTransport::read() {
    follow();
    return std::exchange(unread_, {});
}

LineState TcpClientTransport::line() {
    follow();
    return {connected_, std::nullopt};
}

std::vector<std::string> TcpClientTransport::take_news() { return std::exchange(news_, {}); }

std::string TcpClientTransport::description() const { return shown_address(address_) + " (tcp-connect)"; }

}  // namespace skyloop::inline wire
