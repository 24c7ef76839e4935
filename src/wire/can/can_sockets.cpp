#include "wire/can/can_sockets.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <linux/can.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include "base/core/crc16.hpp"
#include "base/core/file_descriptor.hpp"

namespace skyloop::inline wire {
namespace {

constexpr std::size_t most_frames_a_look = 4096;
constexpr std::uint16_t datagram_magic = 0x2934, crc_start = 0xFFFF;
constexpr std::uint32_t extended_flag = 0x8000'0000;
constexpr std::size_t datagram_head = 10, covered_from = 4, longest_datagram = 74;
constexpr std::uint16_t multicast_port = 57732;

tl::unexpected<Error> refused_by_system(const std::string& what) {
    return fail(ErrorCode::outside, fmt::format("{}: {}", what, std::strerror(errno)));
}

class SocketCan : public CanSocket {
public:
    explicit SocketCan(FileDescriptor socket) : socket_(std::move(socket)) {}

    bool send(const CanFrame& frame) override {
        can_frame_t raw{};
        raw.can_id = frame.id | (frame.extended ? CAN_EFF_FLAG : 0U);
        raw.can_dlc = frame.size;
        std::copy(frame.data.begin(), frame.data.end(), raw.data);
        return ::write(socket_.value(), &raw, sizeof raw) == static_cast<ssize_t>(sizeof raw);
    }
    std::vector<CanFrame> receive() override {
        std::vector<CanFrame> frames;
        can_frame_t raw{};
        while (frames.size() < most_frames_a_look &&
               ::read(socket_.value(), &raw, sizeof raw) == static_cast<ssize_t>(sizeof raw)) {
            if ((raw.can_id & (CAN_RTR_FLAG | CAN_ERR_FLAG)) != 0) continue;
            const bool extended = (raw.can_id & CAN_EFF_FLAG) != 0;
            const std::size_t size = std::min<std::size_t>(raw.can_dlc, CanFrame::most_bytes);
            if (const auto frame = base::can_frame(raw.can_id & (extended ? CAN_EFF_MASK : CAN_SFF_MASK), extended,
                                                   ByteSpan(raw.data, size)))
                frames.push_back(*frame);
        }
        return frames;
    }

private:
    using can_frame_t = struct ::can_frame;
    FileDescriptor socket_;
};

class MulticastBus : public CanSocket {
public:
    MulticastBus(FileDescriptor in, FileDescriptor out, std::uint16_t own_port)
        : in_(std::move(in)), out_(std::move(out)), own_port_(own_port) {}

    bool send(const CanFrame& frame) override {
        const Bytes datagram = multicast_datagram(frame);
        return ::send(out_.value(), datagram.data(), datagram.size(), MSG_DONTWAIT) ==
               static_cast<ssize_t>(datagram.size());
    }
    std::vector<CanFrame> receive() override {
        std::vector<CanFrame> frames;
        std::array<std::uint8_t, longest_datagram + 1> buffer{};
        while (frames.size() < most_frames_a_look) {
            sockaddr_in from{};
            socklen_t size = sizeof from;
            const ssize_t count = ::recvfrom(in_.value(), buffer.data(), buffer.size(), MSG_DONTWAIT,
                                             reinterpret_cast<sockaddr*>(&from), &size);
            if (count < 0 && errno == EINTR) continue;
            if (count < 0) break;
            if (ntohs(from.sin_port) == own_port_) continue;
            if (const auto frame = parse_multicast_datagram(ByteSpan(buffer).first(static_cast<std::size_t>(count))))
                frames.push_back(*frame);
        }
        return frames;
    }

private:
    FileDescriptor in_, out_;
    std::uint16_t own_port_;
};

sockaddr_in group_of(int bus) {
    sockaddr_in group{};
    group.sin_family = AF_INET;
    group.sin_port = htons(multicast_port);
    group.sin_addr.s_addr = htonl(0xEF41'5200U | static_cast<std::uint32_t>(bus));  // 239.65.82.BUS
    return group;
}

bool join(int socket, const sockaddr_in& group) {
    const int yes = 1;
    ip_mreqn member{};
    member.imr_multiaddr = group.sin_addr;
    member.imr_address.s_addr = htonl(INADDR_LOOPBACK);
    member.imr_ifindex = static_cast<int>(::if_nametoindex("lo"));
    return ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes) == 0 &&
           ::bind(socket, reinterpret_cast<const sockaddr*>(&group), sizeof group) == 0 &&
           ::setsockopt(socket, IPPROTO_IP, IP_ADD_MEMBERSHIP, &member, sizeof member) == 0;
}

// Sends by the loopback interface, to this machine alone.
bool aim(int socket, const sockaddr_in& group) {
    const int yes = 1, hops = 0;
    ip_mreqn by{};
    by.imr_address.s_addr = htonl(INADDR_LOOPBACK);
    by.imr_ifindex = static_cast<int>(::if_nametoindex("lo"));
    return ::setsockopt(socket, IPPROTO_IP, IP_MULTICAST_IF, &by, sizeof by) == 0 &&
           ::setsockopt(socket, IPPROTO_IP, IP_MULTICAST_LOOP, &yes, sizeof yes) == 0 &&
           ::setsockopt(socket, IPPROTO_IP, IP_MULTICAST_TTL, &hops, sizeof hops) == 0 &&
           ::connect(socket, reinterpret_cast<const sockaddr*>(&group), sizeof group) == 0;
}

void put_number(Bytes& to, std::uint32_t value, unsigned bytes) {
    for (unsigned i = 0; i < bytes; ++i)
        to.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}

std::uint32_t number_at(ByteSpan bytes, std::size_t at, unsigned count) {
    std::uint32_t value = 0;
    for (unsigned i = 0; i < count; ++i)
        value |= std::uint32_t{bytes[at + i]} << (8 * i);
    return value;
}

}  // namespace

Result<std::unique_ptr<CanSocket>> open_socketcan(const std::string& interface) {
    const std::string what = fmt::format("CAN interface '{}'", interface);
    FileDescriptor socket(::socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW));
    if (!socket.open()) return refused_by_system(what);
    sockaddr_can address{};
    address.can_family = AF_CAN;
    address.can_ifindex = static_cast<int>(::if_nametoindex(interface.c_str()));
    if (address.can_ifindex == 0)
        return fail(
            ErrorCode::outside,
            fmt::format("{}: there is no such interface; 'ip link show type can' lists those that there are", what));
    if (::bind(socket.value(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
        return refused_by_system(what);
    return std::unique_ptr<CanSocket>(std::make_unique<SocketCan>(std::move(socket)));
}

Result<std::unique_ptr<CanSocket>> open_multicast_bus(int bus) {
    const std::string what = fmt::format("CAN bus by UDP multicast 239.65.82.{}:{}", bus, multicast_port);
    const sockaddr_in group = group_of(bus);
    FileDescriptor in(::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
    FileDescriptor out(::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
    if (!in.open() || !out.open() || !join(in.value(), group) || !aim(out.value(), group))
        return refused_by_system(what);
    sockaddr_in own{};
    socklen_t size = sizeof own;
    if (::getsockname(out.value(), reinterpret_cast<sockaddr*>(&own), &size) != 0) return refused_by_system(what);
    return std::unique_ptr<CanSocket>(
        std::make_unique<MulticastBus>(std::move(in), std::move(out), ntohs(own.sin_port)));
}

Bytes multicast_datagram(const CanFrame& frame) {
    Bytes body;
    put_number(body, 0, 2);
    put_number(body, frame.id | (frame.extended ? extended_flag : 0U), 4);
    body.insert(body.end(), frame.data.begin(), frame.data.begin() + frame.size);
    Bytes datagram;
    put_number(datagram, datagram_magic, 2);
    put_number(datagram, crc16_ccitt(body, crc_start), 2);
    datagram.insert(datagram.end(), body.begin(), body.end());
    return datagram;
}

std::optional<CanFrame> parse_multicast_datagram(ByteSpan datagram) {
    if (datagram.size() < datagram_head || number_at(datagram, 0, 2) != datagram_magic) return std::nullopt;
    if (number_at(datagram, 2, 2) != crc16_ccitt(datagram.subspan(covered_from), crc_start)) return std::nullopt;
    if (number_at(datagram, 4, 2) != 0) return std::nullopt;
    const std::uint32_t id = number_at(datagram, 6, 4);
    return base::can_frame(id & ~extended_flag, (id & extended_flag) != 0, datagram.subspan(datagram_head));
}

}  // namespace skyloop::inline wire
