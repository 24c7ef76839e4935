#include <fmt/format.h>
#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <tuple>
#include <utility>

#include "base/core/threads.hpp"
#include "detail/feed_link.hpp"

namespace skyloop::inline run {
namespace {

constexpr int feed_receive_buffer = 4 << 20;  // FEEDS.md 3.1: at least 1 MiB; some thousand datagrams
constexpr int feed_backlog = 8;
constexpr std::size_t most_datagram_peers = 8;
constexpr std::int64_t datagram_peer_memory_ns = 10'000'000'000;

tl::unexpected<Error> socket_failure(const TcpAddress& address, std::string_view why) {
    return fail(ErrorCode::outside, fmt::format("{}: {}", shown_address(address), why));
}

FileDescriptor open_socket(const FeedPeer& where, int type) {
    return FileDescriptor(::socket(where.storage.ss_family, type | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
}

// From the wall clock, in which the kernel tells when something came, to the steady one.
std::int64_t steady_less_wall_ns() {
    timespec wall{};
    clock_gettime(CLOCK_REALTIME, &wall);
    return steady_clock_ns() - (wall.tv_sec * std::int64_t{1'000'000'000} + wall.tv_nsec);
}

}  // namespace

bool FeedPeer::operator==(const FeedPeer& other) const {
    return length == other.length && std::memcmp(&storage, &other.storage, length) == 0;
}

bool same_host(const FeedPeer& a, const FeedPeer& b) {
    if (a.storage.ss_family != b.storage.ss_family) return false;
    if (a.storage.ss_family == AF_INET)
        return reinterpret_cast<const sockaddr_in&>(a.storage).sin_addr.s_addr ==
               reinterpret_cast<const sockaddr_in&>(b.storage).sin_addr.s_addr;
    const in6_addr& one = reinterpret_cast<const sockaddr_in6&>(a.storage).sin6_addr;
    return std::memcmp(&one, &reinterpret_cast<const sockaddr_in6&>(b.storage).sin6_addr, sizeof one) == 0;
}

std::string shown_peer(const FeedPeer& peer) {
    std::array<char, NI_MAXHOST> host{};
    std::array<char, NI_MAXSERV> service{};
    if (::getnameinfo(peer.get(), peer.length, host.data(), host.size(), service.data(), service.size(),
                      NI_NUMERICHOST | NI_NUMERICSERV) != 0)
        return "an unknown address";
    const std::string name(host.data());
    return (name.find(':') == std::string::npos ? name : "[" + name + "]") + ":" + service.data();
}

Result<std::vector<FeedPeer>> resolve_host(const TcpAddress& address, int type) {
    addrinfo hints{};
    hints.ai_socktype = type;
    hints.ai_flags = AI_NUMERICSERV;
    addrinfo* found = nullptr;
    const int code = ::getaddrinfo(address.host.c_str(), std::to_string(address.port).c_str(), &hints, &found);
    if (code != 0) return socket_failure(address, ::gai_strerror(code));
    std::vector<FeedPeer> peers;
    for (const addrinfo* each = found; each != nullptr; each = each->ai_next) {
        FeedPeer peer;
        peer.length = each->ai_addrlen;
        std::memcpy(&peer.storage, each->ai_addr, each->ai_addrlen);
        peers.push_back(peer);
    }
    ::freeaddrinfo(found);
    return peers;
}

Result<FileDescriptor> listening_socket(const TcpAddress& address, int type) {
    const auto where = resolve_host(address, type);
    if (!where) return fail(where.error());
    FileDescriptor socket = open_socket(where->front(), type);
    if (!socket.open()) return socket_failure(address, std::strerror(errno));
    if (type == SOCK_STREAM) set_socket_option(socket.value(), SOL_SOCKET, SO_REUSEADDR, 1);
    if (::bind(socket.value(), where->front().get(), where->front().length) != 0 ||
        (type == SOCK_STREAM && ::listen(socket.value(), feed_backlog) != 0))
        return socket_failure(address, std::strerror(errno));
    return socket;
}

Result<FileDescriptor> connected_datagrams(const TcpAddress& address) {
    const auto where = resolve_host(address, SOCK_DGRAM);
    if (!where) return fail(where.error());
    FileDescriptor socket = open_socket(where->front(), SOCK_DGRAM);
    if (!socket.open() || ::connect(socket.value(), where->front().get(), where->front().length) != 0)
        return socket_failure(address, std::strerror(errno));
    return socket;
}

Result<FileDescriptor> bound_datagrams(const FeedPeer& to, std::uint16_t wanted) {
    FileDescriptor socket = open_socket(to, SOCK_DGRAM);
    const auto bind_to = [&](std::uint16_t port) {
        FeedPeer own;  // any address of this machine: by which one the other end is reached, routes say
        own.length = to.length;
        own.storage.ss_family = to.storage.ss_family;
        if (to.storage.ss_family == AF_INET)
            reinterpret_cast<sockaddr_in&>(own.storage).sin_port = htons(port);
        else
            reinterpret_cast<sockaddr_in6&>(own.storage).sin6_port = htons(port);
        return ::bind(socket.value(), own.get(), own.length) == 0;
    };
    if (!socket.open() || (!bind_to(wanted) && (errno != EADDRINUSE || !bind_to(0))))
        return fail(ErrorCode::outside, fmt::format("port {} of our own: {}", wanted, std::strerror(errno)));
    return socket;
}

FileDescriptor begin_connecting(const FeedPeer& to, std::string& why) {
    FileDescriptor socket = open_socket(to, SOCK_STREAM);
    if (socket.open() && (::connect(socket.value(), to.get(), to.length) == 0 || errno == EINPROGRESS)) return socket;
    why = std::strerror(errno);
    return {};
}

ConnectState finish_connecting(int socket, std::string& why) {
    pollfd wait{socket, POLLOUT, 0};
    if (::poll(&wait, 1, 0) <= 0 || wait.revents == 0) return ConnectState::pending;
    int error = 0;
    socklen_t size = sizeof error;
    if (::getsockopt(socket, SOL_SOCKET, SO_ERROR, &error, &size) != 0) error = errno;
    if (error == 0 && calls_itself(socket)) error = ECONNREFUSED;
    if (error == 0) return ConnectState::open;
    why = std::strerror(error);
    return ConnectState::failed;
}

std::uint16_t own_port(int socket) {
    FeedPeer own;
    own.length = sizeof own.storage;
    if (::getsockname(socket, reinterpret_cast<sockaddr*>(&own.storage), &own.length) != 0) return 0;
    if (own.storage.ss_family == AF_INET) return ntohs(reinterpret_cast<const sockaddr_in&>(own.storage).sin_port);
    if (own.storage.ss_family == AF_INET6) return ntohs(reinterpret_cast<const sockaddr_in6&>(own.storage).sin6_port);
    return 0;
}

// What the network does not take is lost, as anything on UDP may be.
void send_datagram(int socket, ByteSpan bytes, const FeedPeer* to) {
    constexpr int flags = MSG_NOSIGNAL | MSG_DONTWAIT;
    if (to == nullptr)
        std::ignore = ::send(socket, bytes.data(), bytes.size(), flags);
    else
        std::ignore = ::sendto(socket, bytes.data(), bytes.size(), flags, to->get(), to->length);
}

void DatagramPeers::forget_old(std::int64_t now_ns) {
    std::erase_if(peers_, [&](const Heard& heard) { return now_ns > heard.at_ns + datagram_peer_memory_ns; });
}

bool DatagramPeers::has_room_for(const FeedPeer& peer) const {
    const auto is_he = [&](const Heard& heard) { return heard.peer == peer; };
    return peers_.size() < most_datagram_peers || std::any_of(peers_.begin(), peers_.end(), is_he);
}

void DatagramPeers::remember(const FeedPeer& peer, std::int64_t now_ns) {
    const auto is_he = [&](const Heard& heard) { return heard.peer == peer; };
    const auto known = std::find_if(peers_.begin(), peers_.end(), is_he);
    if (known != peers_.end())
        known->at_ns = now_ns;
    else if (peers_.size() < most_datagram_peers)
        peers_.push_back({peer, now_ns});
}

void DatagramPeers::send_to_all(int socket, ByteSpan bytes) const {
    for (const Heard& heard : peers_)
        send_datagram(socket, bytes, &heard.peer);
}

DatagramReader::DatagramReader(int socket)
    : socket_(socket), bytes_(std::make_unique_for_overwrite<std::uint8_t[]>(batch * longest)) {
    set_socket_option(socket, SOL_SOCKET, SO_TIMESTAMPNS, 1);
    set_socket_option(socket, SOL_SOCKET, SO_RXQ_OVFL, 1);
    set_socket_option(socket, SOL_SOCKET, SO_RCVBUF, feed_receive_buffer);
    set_socket_option(socket, SOL_SOCKET, SO_RCVBUFFORCE, feed_receive_buffer);  // above the limit, where allowed
    for (std::size_t i = 0; i < batch; ++i) {
        parts_[i] = {bytes_.get() + i * longest, longest};
        messages_[i].msg_hdr.msg_iov = &parts_[i];
        messages_[i].msg_hdr.msg_iovlen = 1;
        messages_[i].msg_hdr.msg_name = &peers_[i].storage;
        messages_[i].msg_hdr.msg_control = controls_[i].data();
    }
}

const std::vector<FeedDatagram>& DatagramReader::take() {
    taken_.clear();
    for (mmsghdr& message : messages_) {
        message.msg_hdr.msg_namelen = sizeof(sockaddr_storage);
        message.msg_hdr.msg_controllen = control_bytes;
    }
    const int count = ::recvmmsg(socket_, messages_.data(), batch, MSG_DONTWAIT, nullptr);
    const std::int64_t now_ns = steady_clock_ns(), shift_ns = count > 0 ? steady_less_wall_ns() : 0;
    for (int i = 0; i < count; ++i) {
        const auto at = static_cast<std::size_t>(i);
        msghdr& header = messages_[at].msg_hdr;
        peers_[at].length = header.msg_namelen;
        FeedDatagram datagram{{bytes_.get() + at * longest, messages_[at].msg_len}, &peers_[at], now_ns};
        for (cmsghdr* part = CMSG_FIRSTHDR(&header); part != nullptr; part = CMSG_NXTHDR(&header, part)) {
            if (part->cmsg_level != SOL_SOCKET) continue;
            if (part->cmsg_type == SCM_TIMESTAMPNS) {
                timespec wall{};
                std::memcpy(&wall, CMSG_DATA(part), sizeof wall);
                // A wall clock that is set just then must not bring a time that cannot be.
                constexpr std::int64_t oldest_ns = 10'000'000'000;
                datagram.received_ns = std::clamp(wall.tv_sec * std::int64_t{1'000'000'000} + wall.tv_nsec + shift_ns,
                                                  now_ns - oldest_ns, now_ns);
            } else if (part->cmsg_type == SO_RXQ_OVFL) {
                std::uint32_t seen = 0;
                std::memcpy(&seen, CMSG_DATA(part), sizeof seen);
                dropped_ += seen - dropped_seen_;
                dropped_seen_ = seen;
            }
        }
        taken_.push_back(datagram);
    }
    return taken_;
}

std::uint64_t DatagramReader::take_dropped() { return std::exchange(dropped_, 0); }

pollfd FeedStream::wait(bool reads) const {
    const int events = (reads ? POLLIN : 0) | (waiting() > 0 ? POLLOUT : 0);
    return {socket_.value(), static_cast<short>(events), 0};
}

const Bytes& FeedStream::read(std::size_t most) {
    read_.resize(most);
    const auto count = ::recv(socket_.value(), read_.data(), read_.size(), MSG_DONTWAIT);
    const bool nothing = count < 0 && (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR);
    finished_ = finished_ || count == 0;
    gone_ = gone_ || (count < 0 && !nothing);
    read_.resize(count > 0 ? static_cast<std::size_t>(count) : 0);
    return read_;
}

bool FeedStream::hung_up() const {
    char byte = 0;
    const auto count = ::recv(socket_.value(), &byte, 1, MSG_DONTWAIT | MSG_PEEK);
    return count == 0 || (count < 0 && errno != EAGAIN && errno != EWOULDBLOCK && errno != EINTR);
}

void FeedStream::send(ByteSpan bytes) {
    waiting_.add(bytes);
    send_waiting();
}

void FeedStream::send_waiting() {
    while (!waiting_.empty() && !gone_) {
        const ByteSpan bytes = waiting_.waiting();
        const auto count = ::send(socket_.value(), bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
        if (count < 0 && (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR)) return;
        if (count < 0) gone_ = true;
        if (count > 0) waiting_.sent(static_cast<std::size_t>(count));
    }
    if (gone_) waiting_.clear();
}

void StreamConnector::put_off(std::int64_t now_ns) {
    next_try_ns_ = now_ns + wait_ns_;
    wait_ns_ = std::min(2 * wait_ns_, longest_wait_ns);
}

FileDescriptor StreamConnector::look(std::int64_t now_ns, std::string& why) {
    constexpr std::int64_t patience_ns = 5'000'000'000;
    if (!socket_.open()) {
        if (now_ns < next_try_ns_) return {};
        socket_ = begin_connecting(peers_[next_++ % peers_.size()], why);
        begun_ns_ = now_ns;
    }
    switch (socket_.open() ? finish_connecting(socket_.value(), why) : ConnectState::failed) {
        case ConnectState::open:
            return std::move(socket_);
        case ConnectState::pending:
            if (now_ns < begun_ns_ + patience_ns) return {};
            why = "no answer";
            break;
        case ConnectState::failed:
            break;
    }
    socket_ = FileDescriptor();
    // All addresses of the host are tried before a pause.
    if (next_ % peers_.size() == 0) put_off(now_ns);
    return {};
}

void StreamConnector::lost(std::int64_t now_ns, bool lasted) {
    if (lasted) wait_ns_ = first_wait_ns;
    put_off(now_ns);
}

}  // namespace skyloop::inline run
