/// One client of USB/IP that has imported a virtual serial device: what it submits, and what becomes of it.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/core/bytes.hpp"
#include "wire/transport/usbip_messages.hpp"

namespace skyloop::inline wire {

/// The device's end of an imported connection, without its socket: bytes of the client in, bytes for it out.
///
/// Transfers of the serial data end as bytes come and go, at the pace of a full-speed bus: 19 packets of 64 bytes in
/// each frame of 1 ms, both ways together (USB 2.0, table 5-9). The host listens from its first transfer of data to it
/// on, until it has cancelled all of them and DTR falls, or it has submitted no other for 5 s, with DTR set for 30 s: a
/// terminal that is open polls all the time and one that is closed never does, but a program may read now and then. DTR
/// alone does not count; not every program sets it, and receivers send without it.
///
/// All memory is bounded: while the client leaves answers unread no more of its commands are looked at, and a transfer
/// beyond those that any host submits is answered with an error, so that it can cancel the others.
class UsbipSession {
public:
    static constexpr std::size_t most_backlog = 16384;  ///< serial bytes that wait for the host, as a pty keeps

    /// @param device how it was listed
    UsbipSession(const UsbFace& face, UsbipDevice device);

    /// Bytes of the client in the order in which they came. To be given only while wants_bytes().
    void hear(ByteSpan bytes) { heard_.insert(heard_.end(), bytes.begin(), bytes.end()); }
    [[nodiscard]] bool wants_bytes() const { return heard_.size() < most_heard; }
    /// Acts on what was heard. Steady time, ns, never less than before.
    void run(std::int64_t now_ns);
    /// Sends the client bytes of the server's own, before the answers to come.
    void reply(ByteSpan bytes) { output_.add(bytes); }
    /// Bytes that the client is to be sent.
    [[nodiscard]] ByteSpan output() const { return output_.waiting(); }
    /// So many of them have been sent.
    void sent(std::size_t count) { output_.sent(count); }

    /// Offers serial bytes to the host; gives how many were taken. While it does not listen they are taken and lost;
    /// between the reads of one that reads now and then all are taken, and the oldest lost that do not fit.
    std::size_t put(ByteSpan bytes);
    /// Serial bytes of the host since the last call.
    Bytes take_received() { return std::exchange(received_, {}); }
    [[nodiscard]] bool listening() const { return listening_; }

    /// What the client did that no host does; the connection is then to be closed. Empty while all is well.
    [[nodiscard]] const std::string& mistake() const { return mistake_; }
    /// The client has sent a part of a message.
    [[nodiscard]] bool inside_message() const { return heard_.size() > parsed_; }
    /// Transfers that wait.
    [[nodiscard]] std::size_t pending() const { return out_.size() + in_.size() + notify_.size(); }
    [[nodiscard]] CdcAcmDevice& device() { return device_; }
    [[nodiscard]] const CdcAcmDevice& device() const { return device_; }

private:
    static constexpr std::size_t most_heard = usbip_most_data + 2 * usbip_header_bytes;
    using Queue = std::deque<UsbipSubmit>;

    void follow_commands();
    void act(UsbipSubmit submit);
    void act(const UsbipUnlink& unlink);
    void control(const UsbipSubmit& submit);
    void answer(const UsbipSubmit& submit, UsbipStatus status, std::uint32_t moved = 0, ByteSpan data = {});
    [[nodiscard]] bool overwhelmed() const;
    void refill(std::int64_t now_ns);
    void finish_out();
    void finish_in();
    void finish_notifications();
    bool finish_stalled(Queue& queue, std::uint8_t endpoint);
    void follow_listening(std::int64_t now_ns);
    void stop_listening();

    CdcAcmDevice device_;
    UsbipDevice listed_;
    Bytes heard_;
    std::size_t parsed_ = 0;  // of heard_
    SendBuffer output_;
    Queue out_, in_, notify_;
    std::size_t out_bytes_ = 0;  // in out_
    Bytes received_;
    std::deque<std::uint8_t> backlog_;
    std::int64_t budget_ = 0;  // bytes that the bus may carry by now
    std::optional<std::int64_t> last_run_ns_;
    bool listening_ = false;
    bool dtr_seen_ = false;                   // since the host listens
    std::optional<std::int64_t> idle_since_;  // all polls cancelled
    std::string mistake_;
};

}  // namespace skyloop::inline wire
