#include "skyloop/feed/mavlink_endpoint.hpp"

#include <fmt/format.h>
#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstring>
#include <tuple>
#include <utility>

#include "skyloop/feed/mavlink_component.hpp"
#include "skyloop/transport/file_descriptor.hpp"

namespace skyloop {
namespace {

using namespace std::chrono_literals;
using SteadyTime = MavlinkComponent::Time;

constexpr std::size_t longest_datagram = 2048, most_peers = 8;
constexpr int datagrams_at_once = 64;
constexpr auto heartbeat_period = 1s, peer_memory = 10s;
constexpr auto flood_pause = 10ms;
constexpr int patience_ms = 50;  // of one wait: how late a stop, a heartbeat or a held state may be

Error mavlink_failure(const MavlinkAddress& address, std::string_view reason) {
    return {ErrorCode::outside, fmt::format("--mavlink: {} port {}: {}", address.host, address.port, reason)};
}

std::string bracketed(const std::string& host) { return host.find(':') == std::string::npos ? host : "[" + host + "]"; }

}  // namespace

Result<MavlinkAddress> parse_mavlink_address(std::string_view text) {
    MavlinkAddress address;
    std::string_view rest = text;
    address.speaks_first = rest.starts_with("udpout:");
    const bool known = address.speaks_first || rest.starts_with("udp:");
    if (known) rest.remove_prefix(rest.find(':') + 1);
    const std::size_t colon = rest.rfind(':');
    std::string_view host, port = rest;
    if (colon != std::string_view::npos) {
        host = rest.substr(0, colon);
        port = rest.substr(colon + 1);
        const bool in_brackets = host.size() >= 2 && host.starts_with('[') && host.ends_with(']');
        if (in_brackets)
            host = host.substr(1, host.size() - 2);
        else if (host.find(':') != std::string_view::npos)
            host = {};
    }
    if (!host.empty()) address.host = host;
    const bool host_missing = host.empty() && (address.speaks_first || colon != std::string_view::npos);
    const auto read = std::from_chars(port.data(), port.data() + port.size(), address.port);
    const bool whole = !port.empty() && read.ec == std::errc() && read.ptr == port.data() + port.size();
    if (!known || host_missing || !whole || (address.speaks_first && address.port == 0))
        return fail(ErrorCode::usage,
                    fmt::format("'{}' is no MAVLink address; expected udp:[HOST:]PORT or udpout:HOST:PORT", text));
    return address;
}

class MavlinkEndpoint::Impl {
public:
    Impl(MavlinkAddress address, MavlinkParts parts)
        : address_(std::move(address)), component_(std::move(parts.receivers), parts.push) {}
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;
    ~Impl() {
        stop_ = true;
        if (thread_.joinable()) thread_.join();
    }

    Result<void> open() {
        const auto where = resolve(address_);
        if (!where) return fail(where.error());
        socket_ = FileDescriptor(::socket(where->storage.ss_family, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
        if (!socket_.open()) return fail(mavlink_failure(address_, std::strerror(errno)));
        // Connected, the kernel lets nobody else in.
        const int joined = address_.speaks_first ? ::connect(socket_.value(), where->get(), where->length)
                                                 : ::bind(socket_.value(), where->get(), where->length);
        if (joined != 0) return fail(mavlink_failure(address_, std::strerror(errno)));
        PeerAddress own;
        own.length = sizeof own.storage;
        std::array<char, 16> service{};
        if (::getsockname(socket_.value(), reinterpret_cast<sockaddr*>(&own.storage), &own.length) == 0 &&
            ::getnameinfo(own.get(), own.length, nullptr, 0, service.data(), service.size(),
                          NI_NUMERICSERV | NI_DGRAM) == 0)
            std::from_chars(service.data(), service.data() + std::strlen(service.data()), port_);
        return {};
    }

    void start(const std::function<std::thread(std::function<void()>)>& thread) {
        const auto work = [this] { run(); };
        thread_ = thread ? thread(work) : std::thread(work);
    }

    [[nodiscard]] std::uint16_t port() const { return port_; }
    [[nodiscard]] std::string description() const {
        return fmt::format("{}:{}:{} (system {}, component {})", address_.speaks_first ? "udpout" : "udp",
                           bracketed(address_.host), address_.speaks_first ? address_.port : port_, mavlink_own_system,
                           mavlink_own_component);
    }

private:
    // A socket address of either family.
    struct PeerAddress {
        sockaddr_storage storage{};
        socklen_t length = 0;
        [[nodiscard]] const sockaddr* get() const { return reinterpret_cast<const sockaddr*>(&storage); }
        bool operator==(const PeerAddress& other) const {
            return length == other.length && std::memcmp(&storage, &other.storage, length) == 0;
        }
    };
    struct Peer {
        PeerAddress address;
        SteadyTime heard_at{};
    };

    static Result<PeerAddress> resolve(const MavlinkAddress& address) {
        addrinfo hints{};
        hints.ai_socktype = SOCK_DGRAM;
        hints.ai_flags = AI_NUMERICSERV;
        addrinfo* found = nullptr;
        const int code = getaddrinfo(address.host.c_str(), std::to_string(address.port).c_str(), &hints, &found);
        if (code != 0) return fail(mavlink_failure(address, gai_strerror(code)));
        PeerAddress resolved;
        resolved.length = found->ai_addrlen;
        std::memcpy(&resolved.storage, found->ai_addr, found->ai_addrlen);
        freeaddrinfo(found);
        return resolved;
    }

    void run() {
        SteadyTime heartbeat_at = std::chrono::steady_clock::now();
        while (!stop_) {
            pollfd wait{socket_.value(), POLLIN, 0};
            ::poll(&wait, 1, patience_ms);
            const SteadyTime now = std::chrono::steady_clock::now();
            const int taken = take(now);
            component_.look(now);
            if (now >= heartbeat_at) {
                beat(now);
                heartbeat_at = now + heartbeat_period;
            }
            if (taken == datagrams_at_once) std::this_thread::sleep_for(flood_pause);
        }
    }

    int take(SteadyTime now) {
        int taken = 0;
        for (; taken < datagrams_at_once && !stop_; ++taken) {
            PeerAddress from;
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

    void hear(ByteSpan datagram, const PeerAddress& from, SteadyTime now) {
        if (!address_.speaks_first && !is_welcome(from, now)) return;
        const MavlinkComponent::Heard heard = component_.hear(datagram, now);
        if (!heard.any) return;
        if (!address_.speaks_first) remember(from, now);
        for (const Bytes& answer : heard.answers)
            send(answer, from);
    }

    bool is_welcome(const PeerAddress& from, SteadyTime now) {
        std::erase_if(peers_, [&](const Peer& peer) { return now > peer.heard_at + peer_memory; });
        return peers_.size() < most_peers || find(from) != peers_.end();
    }

    std::vector<Peer>::iterator find(const PeerAddress& address) {
        return std::find_if(peers_.begin(), peers_.end(), [&](const Peer& peer) { return peer.address == address; });
    }

    void remember(const PeerAddress& from, SteadyTime now) {
        if (const auto known = find(from); known != peers_.end())
            known->heard_at = now;
        else
            peers_.push_back({from, now});
    }

    void beat(SteadyTime now) {
        std::erase_if(peers_, [&](const Peer& peer) { return now > peer.heard_at + peer_memory; });
        if (!address_.speaks_first && peers_.empty()) return;
        const Bytes frame = component_.heartbeat();
        if (address_.speaks_first) return send(frame, {});
        for (const Peer& peer : peers_)
            send(frame, peer.address);
    }

    // What the network does not take is lost, as anything on UDP may be.
    void send(const Bytes& frame, const PeerAddress& to) const {
        if (address_.speaks_first)
            std::ignore = ::send(socket_.value(), frame.data(), frame.size(), MSG_NOSIGNAL);
        else
            std::ignore = ::sendto(socket_.value(), frame.data(), frame.size(), MSG_NOSIGNAL, to.get(), to.length);
    }

    MavlinkAddress address_;
    MavlinkComponent component_;  // of the thread alone, once it runs
    FileDescriptor socket_;
    std::uint16_t port_ = 0;
    std::vector<Peer> peers_;
    std::array<std::uint8_t, longest_datagram> buffer_{};
    std::atomic<bool> stop_{false};
    std::thread thread_;
};

MavlinkEndpoint::MavlinkEndpoint(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
MavlinkEndpoint::~MavlinkEndpoint() = default;

Result<std::unique_ptr<MavlinkEndpoint>> MavlinkEndpoint::start(const MavlinkAddress& address, MavlinkParts parts) {
    const auto thread = std::move(parts.thread);
    auto impl = std::make_unique<Impl>(address, std::move(parts));
    if (const auto opened = impl->open(); !opened) return fail(opened.error());
    impl->start(thread);
    return std::unique_ptr<MavlinkEndpoint>(new MavlinkEndpoint(std::move(impl)));
}

std::uint16_t MavlinkEndpoint::port() const { return impl_->port(); }

std::string MavlinkEndpoint::description() const { return impl_->description(); }

}  // namespace skyloop
