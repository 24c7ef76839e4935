#include "run/feed/mavlink_endpoint.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <utility>

#include "base/core/threads.hpp"
#include "detail/feed_link.hpp"
#include "run/feed/mavlink_component.hpp"

namespace skyloop::inline run {
namespace {

using namespace std::chrono_literals;
using SteadyTime = MavlinkComponent::Time;

constexpr std::size_t longest_datagram = 2048;
constexpr int datagrams_at_once = 64;
constexpr auto heartbeat_period = 1s;
constexpr auto flood_pause = 10ms;
constexpr int patience_ms = 50;  // of one wait: how late a stop, a heartbeat or a held state may be

class UdpEndpoint final : public MavlinkEndpoint {
public:
    UdpEndpoint(MavlinkAddress address, MavlinkParts parts)
        : address_(std::move(address)), component_(std::move(parts.receivers), parts.push) {}
    ~UdpEndpoint() override {
        stop_ = true;
        if (thread_.joinable()) thread_.join();
    }

    Result<void> open() {
        const TcpAddress where{address_.host, address_.port};
        auto socket = address_.speaks_first ? connected_datagrams(where) : listening_socket(where, SOCK_DGRAM);
        if (!socket) return fail(socket.error().code, "--mavlink: " + socket.error().message);
        socket_ = std::move(*socket);
        port_ = own_port(socket_.value());
        return {};
    }

    void start(const std::function<std::thread(std::function<void()>)>& thread) {
        const auto work = [this] { run(); };
        thread_ = thread ? thread(work) : std::thread(work);
    }

    [[nodiscard]] std::uint16_t port() const override { return port_; }
    [[nodiscard]] std::string description() const override {
        const TcpAddress shown{address_.host, address_.speaks_first ? address_.port : port_};
        return fmt::format("{}:{} (system {}, component {})", address_.speaks_first ? "udpout" : "udp",
                           shown_address(shown), mavlink_own_system, mavlink_own_component);
    }

private:
    void run() {
        SteadyTime heartbeat_at = std::chrono::steady_clock::now();
        while (!stop_) {
            pollfd wait{socket_.value(), POLLIN, 0};
            ::poll(&wait, 1, patience_ms);
            const SteadyTime now = std::chrono::steady_clock::now();
            const int taken = take(now);
            component_.look(now);
            if (now >= heartbeat_at) {
                beat();
                heartbeat_at = now + heartbeat_period;
            }
            if (taken == datagrams_at_once) std::this_thread::sleep_for(flood_pause);
        }
    }

    int take(SteadyTime now) {
        int taken = 0;
        for (; taken < datagrams_at_once && !stop_; ++taken) {
            FeedPeer from;
            from.length = sizeof from.storage;
            const auto size = ::recvfrom(socket_.value(), buffer_.data(), buffer_.size(), MSG_TRUNC,
                                         reinterpret_cast<sockaddr*>(&from.storage), &from.length);
            if (size < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) break;
            // A peer that is not there yet says so by ICMP, as an error of this call: the next one may be there.
            if (size < 0 || static_cast<std::size_t>(size) > longest_datagram) continue;
            hear(ByteSpan(buffer_.data(), static_cast<std::size_t>(size)), from, now);
        }
        return taken;
    }

    void hear(ByteSpan datagram, const FeedPeer& from, SteadyTime now) {
        const FeedPeer* peer = address_.speaks_first ? nullptr : &from;
        peers_.forget_old(steady_clock_ns());
        if (peer != nullptr && !peers_.has_room_for(from)) return;
        const MavlinkComponent::Heard heard = component_.hear(datagram, now);
        if (!heard.any) return;
        if (peer != nullptr) peers_.remember(from, steady_clock_ns());
        for (const Bytes& answer : heard.answers)
            send_datagram(socket_.value(), answer, peer);
    }

    void beat() {
        peers_.forget_old(steady_clock_ns());
        if (!address_.speaks_first && peers_.empty()) return;
        const Bytes frame = component_.heartbeat();
        if (address_.speaks_first) send_datagram(socket_.value(), frame, nullptr);
        peers_.send_to_all(socket_.value(), frame);
    }

    MavlinkAddress address_;
    MavlinkComponent component_;  // of the thread alone, once it runs
    FileDescriptor socket_;
    std::uint16_t port_ = 0;
    DatagramPeers peers_;
    std::array<std::uint8_t, longest_datagram> buffer_{};
    std::atomic<bool> stop_{false};
    std::thread thread_;
};

}  // namespace

Result<MavlinkAddress> parse_mavlink_address(std::string_view text) {
    const bool speaks_first = text.starts_with("udpout:");
    const std::string_view rest = text.substr(text.find(':') + 1);
    const bool known = (speaks_first || text.starts_with("udp:")) && (!speaks_first || rest.find(':') != rest.npos);
    const auto where = parse_tcp_address(rest);
    if (!known || !where || (speaks_first && where->port == 0))
        return fail(ErrorCode::usage,
                    fmt::format("'{}' is no MAVLink address; expected udp:[HOST:]PORT or udpout:HOST:PORT", text));
    return MavlinkAddress{speaks_first, where->host, where->port};
}

Result<std::unique_ptr<MavlinkEndpoint>> MavlinkEndpoint::start(const MavlinkAddress& address, MavlinkParts parts) {
    const auto thread = std::move(parts.thread);
    auto endpoint = std::make_unique<UdpEndpoint>(address, std::move(parts));
    if (const auto opened = endpoint->open(); !opened) return fail(opened.error());
    endpoint->start(thread);
    return endpoint;
}

}  // namespace skyloop::inline run
