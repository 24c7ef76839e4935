/// A node's wire to a CAN bus. On the receiver's side it carries frames as lines of SLCAN, whatever the bus is.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/can_frame.hpp"
#include "base/core/result.hpp"
#include "wire/transport/serial.hpp"
#include "wire/transport/transport.hpp"

namespace skyloop::inline wire {

/// A bus as it was asked for.
struct CanAddress {
    enum class Kind { slcan_device, slcan_pty, socketcan, multicast };
    Kind kind = Kind::slcan_pty;
    std::string name;        ///< the link of a pty, or empty; a CAN interface
    SerialAddress serial{};  ///< of an adapter
    int bus = 0;             ///< of multicast
};
/// Reads "slcan:DEVICE[@BAUD]", "slcan:pty[:LINK]", "socketcan:INTERFACE" and "mcast:BUS". Fails with `usage`.
Result<CanAddress> parse_can_address(std::string_view text);

/// What a bus has beyond the nodes of this run.
class CanEnd : public WireReports {
public:
    virtual void send(const CanFrame& frame) = 0;
    /// Frames of others since the last call.
    virtual std::vector<CanFrame> receive() = 0;
    /// Somebody is there, as far as one knows.
    virtual bool connected() { return true; }
    /// "/tmp/can0 (slcan)".
    [[nodiscard]] virtual std::string description() const = 0;
};

/// Where a host opens a pseudo-terminal as its SLCAN adapter (SlcanAdapter). What the host does not read in time is
/// lost, a frame at a time.
Result<std::unique_ptr<CanEnd>> serve_slcan(std::unique_ptr<Transport> terminal);
/// A real SLCAN adapter: its channel is opened at 1 Mbit/s, anew whenever it comes back.
Result<std::unique_ptr<CanEnd>> use_slcan_adapter(std::unique_ptr<Transport> adapter);
/// Fails with `outside`.
Result<std::unique_ptr<CanEnd>> open_can_end(const CanAddress& address);

/// A bus with the nodes of this run on it: each hears the others, and what the end brings. State: frames that a node
/// has not taken yet, at most `most_waiting` of each; more are lost.
class CanBus {
public:
    static constexpr std::size_t most_waiting = 65536;

    explicit CanBus(std::unique_ptr<CanEnd> end) : end_(std::move(end)) {}
    /// The number of a new node.
    std::size_t join();
    void leave(std::size_t node) { inboxes_.erase(node); }
    void send(std::size_t from, const CanFrame& frame);
    std::vector<CanFrame> take(std::size_t node);
    /// Takes what the end has brought.
    void poll();
    [[nodiscard]] CanEnd& end() { return *end_; }
    [[nodiscard]] const CanEnd& end() const { return *end_; }

private:
    void deliver(const CanFrame& frame, std::size_t but_not);
    std::unique_ptr<CanEnd> end_;
    std::map<std::size_t, std::vector<CanFrame>> inboxes_;
    std::size_t next_ = 1;
};

/// The buses of a run by their addresses: receivers that name the same one are nodes of one bus. State: those that are
/// open.
class CanBuses {
public:
    /// Fails with `outside`.
    Result<std::shared_ptr<CanBus>> open(const CanAddress& address, const std::string& uri);

private:
    std::map<std::string, std::weak_ptr<CanBus>> open_;
};

/// State: the unfinished line of the receiver.
class CanTransport : public Transport {
public:
    explicit CanTransport(std::shared_ptr<CanBus> bus) : bus_(std::move(bus)), node_(bus_->join()) {}
    ~CanTransport() override { bus_->leave(node_); }
    CanTransport(const CanTransport&) = delete;
    CanTransport& operator=(const CanTransport&) = delete;

    std::size_t write(ByteSpan bytes) override;
    Bytes read() override;
    LineState line() override;
    std::vector<std::string> take_news() override { return bus_->end().take_news(); }
    [[nodiscard]] std::string failure() const override { return bus_->end().failure(); }
    [[nodiscard]] std::string notice() const override { return bus_->end().notice(); }
    [[nodiscard]] std::string other_end() const override { return bus_->end().other_end(); }
    [[nodiscard]] std::string description() const override { return bus_->end().description(); }

private:
    std::shared_ptr<CanBus> bus_;
    std::size_t node_;
    SlcanLines lines_;
};

}  // namespace skyloop::inline wire
