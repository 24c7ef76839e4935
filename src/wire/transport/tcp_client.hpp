/// A receiver's port that calls a server: serial-to-network boxes and programs that listen.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "base/core/file_descriptor.hpp"
#include "base/core/result.hpp"
#include "base/core/threads.hpp"
#include "wire/transport/tcp.hpp"
#include "wire/transport/transport.hpp"

namespace skyloop::inline wire {

/// A connection that is made to a server and made again whenever it is lost.
///
/// While there is none it is tried every 5 ms for a minute, then every 500 ms, without waiting; of a host with several
/// addresses each in turn. What is written meanwhile is lost, as on any wire without its end. An attempt that is not
/// answered is given up after 5 s. A server that shuts its sending side has ended the connection. A socket has no line
/// speed.
///
/// Why so often: a UART of Betaflight's SITL whose first byte finds nobody connected never sends again (serial_tcp.c,
/// tcpDataOut() keeps it, and the driver waits for the buffer to be empty), and INAV sends the speed of the line once,
/// in its first second (gps_ublox.c, gpsProtocolStateThread).
class TcpClientTransport : public Transport {
public:
    /// Nanoseconds of a clock that never goes back.
    using Clock = std::function<std::int64_t()>;

    /// The host is looked up once, here, which may take its time. Fails with `usage` for port 0, with `outside` for an
    /// unknown host. That nobody listens is no failure.
    static Result<std::unique_ptr<TcpClientTransport>> open(const TcpAddress& address, Clock clock = steady_clock_ns);
    ~TcpClientTransport() override;
    TcpClientTransport(const TcpClientTransport&) = delete;
    TcpClientTransport& operator=(const TcpClientTransport&) = delete;

    std::size_t write(ByteSpan bytes) override;
    Bytes read() override;
    LineState line() override;
    /// Connections made and lost, and why the first attempt of a row failed.
    std::vector<std::string> take_news() override;
    /// "host:2000 (tcp-connect)".
    [[nodiscard]] std::string description() const override;

    /// Connections that there have been.
    [[nodiscard]] std::uint64_t connections() const { return connections_; }

private:
    struct Route;  // the addresses of the host

    TcpClientTransport(TcpAddress address, std::unique_ptr<Route> route, Clock clock);
    void follow();
    void begin_attempt(std::int64_t now_ns);
    void follow_attempt(std::int64_t now_ns);
    void give_up(int reason);
    void connected();
    void lose();

    TcpAddress address_;
    std::unique_ptr<Route> route_;
    FileDescriptor socket_;
    Clock clock_;
    bool connected_ = false;
    std::int64_t alone_since_ns_ = 0;
    std::int64_t attempt_began_ns_ = 0;
    bool attempted_ = false;  // since the last connection a failure has been told
    Bytes unread_;
    std::uint64_t connections_ = 0;
    std::vector<std::string> news_;
};

}  // namespace skyloop::inline wire
