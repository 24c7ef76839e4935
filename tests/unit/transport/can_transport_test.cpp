// Nodes on a bus whose end is an SLCAN adapter, played or used.
#include "wire/transport/can_transport.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/memory_transport.hpp"
#include "wire/transport/open_transport.hpp"

namespace skyloop {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

// A serial line whose other end is the test.
class Line : public Transport {
public:
    struct Ends {
        std::string written, to_read;
        bool connected = true;
        std::size_t takes = 1U << 20;
    };
    explicit Line(Ends& ends) : ends_(ends) {}
    std::size_t write(ByteSpan bytes) override {
        const std::size_t taken = std::min(bytes.size(), ends_.takes);
        ends_.written += to_string(bytes.first(taken));
        return taken;
    }
    Bytes read() override { return to_bytes(std::exchange(ends_.to_read, {})); }
    LineState line() override { return {ends_.connected, 9600}; }
    [[nodiscard]] std::string description() const override { return "line"; }

private:
    Ends& ends_;
};

TEST(CanTransport, IsAnAdapterForAHost) {
    Line::Ends host;
    const auto bus = std::make_shared<CanBus>(std::move(serve_slcan(std::make_unique<Line>(host)).value()));
    CanTransport node(bus);
    EXPECT_EQ(node.description(), "line (slcan)");
    EXPECT_FALSE(node.line().connected) << "the channel is closed";
    node.write(to_bytes("T18042A0A2017D\r"));
    EXPECT_THAT(host.written, IsEmpty());
    host.to_read = "S8\rO\r";
    EXPECT_TRUE(node.line().connected);
    EXPECT_FALSE(node.line().baud) << "the host's speed means nothing on the bus";
    EXPECT_EQ(host.written, "\r\r");
    host.written.clear();
    node.write(to_bytes("T18042A0A2"));
    node.write(to_bytes("017D\r"));
    EXPECT_EQ(host.written, "T18042A0A2017D\r");
    host.to_read = "T1E01AAFF1C2\r";
    EXPECT_EQ(to_string(node.read()), "T1E01AAFF1C2\r");
    host.connected = false;
    node.read();
    host.connected = true;
    EXPECT_FALSE(node.line().connected) << "a new host finds the channel closed";
}

TEST(CanTransport, LosesWholeFramesOfAHostThatReadsTooSlowly) {
    Line::Ends host;
    const auto bus = std::make_shared<CanBus>(std::move(serve_slcan(std::make_unique<Line>(host)).value()));
    CanTransport node(bus);
    host.to_read = "O\r";
    node.read();
    host.written.clear();
    host.takes = 0;
    for (int i = 0; i < 10'000; ++i)
        node.write(to_bytes("T18042A0A2017D\r"));
    host.takes = 1U << 20;
    node.write(to_bytes("T18042A0A2017D\r"));
    EXPECT_EQ(host.written.size() % 15, 0U);
    EXPECT_GT(host.written.size(), 60'000U);
    EXPECT_LT(host.written.size(), 70'000U);
    EXPECT_THAT(node.notice(), HasSubstr("CAN frames were lost"));
}

TEST(CanTransport, OpensTheChannelOfAnAdapterEachTimeThatItComes) {
    Line::Ends adapter;
    const auto bus = std::make_shared<CanBus>(std::move(use_slcan_adapter(std::make_unique<Line>(adapter)).value()));
    CanTransport node(bus);
    EXPECT_TRUE(node.line().connected);
    EXPECT_EQ(adapter.written, "\r\r\rC\rS8\rO\r");
    adapter.written.clear();
    adapter.to_read = "\r\a\r\rz\rT18042A0A2017D\r\aT18042A0B2017D\r";
    EXPECT_EQ(to_string(node.read()), "T18042A0A2017D\rT18042A0B2017D\r");
    node.write(to_bytes("T18042A0A2017D\r"));
    EXPECT_EQ(adapter.written, "T18042A0A2017D\r");
    adapter.connected = false;
    node.read();
    adapter.connected = true;
    adapter.written.clear();
    node.read();
    EXPECT_THAT(adapter.written, HasSubstr("S8\rO\r"));
}

TEST(CanTransport, LetsTheNodesOfABusHearEachOther) {
    Line::Ends host;
    const auto bus = std::make_shared<CanBus>(std::move(serve_slcan(std::make_unique<Line>(host)).value()));
    CanTransport a(bus), b(bus);
    a.write(to_bytes("T18042A0A2017D\r"));
    EXPECT_THAT(a.read(), IsEmpty());
    EXPECT_EQ(to_string(b.read()), "T18042A0A2017D\r");
    EXPECT_THAT(b.read(), IsEmpty());
}

TEST(CanBuses, AreSharedByTheirAddress) {
    CanBuses buses;
    const auto address = parse_can_address("slcan:pty").value();
    const auto a = buses.open(address, "dronecan:slcan:pty").value();
    EXPECT_EQ(buses.open(address, "dronecan:slcan:pty").value(), a);
    EXPECT_NE(open_transport("dronecan:slcan:pty").value()->description(), a->end().description());
}

TEST(CanAddress, IsReadOrRefused) {
    using Kind = CanAddress::Kind;
    EXPECT_EQ(parse_can_address("slcan:pty")->kind, Kind::slcan_pty);
    EXPECT_EQ(parse_can_address("slcan:pty:/tmp/can0")->name, "/tmp/can0");
    EXPECT_EQ(parse_can_address("slcan:/dev/ttyACM0@3000000")->serial.baud, 3'000'000U);
    EXPECT_EQ(parse_can_address("slcan:/dev/ttyACM0")->serial.baud, 115'200U);
    EXPECT_EQ(parse_can_address("socketcan:vcan0")->name, "vcan0");
    EXPECT_EQ(parse_can_address("mcast:7")->bus, 7);
    EXPECT_EQ(parse_can_address("mcast:256").error().message,
              "bus '256' is not understood; expected mcast:BUS, 0 to 255");
    EXPECT_EQ(parse_can_address("can0").error().message,
              "'can0' is no CAN bus; expected slcan:DEVICE[@BAUD], slcan:pty[:LINK], socketcan:INTERFACE or mcast:BUS");
    EXPECT_THAT(parse_can_address("slcan:pty:").error().message, HasSubstr("a path is missing"));
    EXPECT_THAT(open_transport("dronecan:").error().message, HasSubstr("a bus is missing"));
    EXPECT_THAT(open_transport("dronecan:socketcan:nocan77").error().message, HasSubstr("CAN interface 'nocan77'"));
}

}  // namespace
}  // namespace skyloop
