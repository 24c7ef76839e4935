#include "wire/transport/open_transport.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "support/memory_transport.hpp"
#include "temporary_folder.hpp"

namespace skyloop {
namespace {

using testing::EndsWith;
using testing::HasSubstr;
using testing::StartsWith;

Error refusal(std::string_view uri) {
    const auto transport = open_transport(uri);
    EXPECT_FALSE(transport) << uri;
    return transport ? Error{} : transport.error();
}

TEST(OpenTransport, OpensWhatThisVersionHas) {
    const test::TemporaryFolder folder;
    EXPECT_EQ(open_transport("-").value()->description(), "standard output");
    EXPECT_THAT(open_transport("pty").value()->description(), StartsWith("/dev/pts/"));
    EXPECT_EQ(open_transport("pty:" + (folder / "gps0").string()).value()->description(),
              (folder / "gps0").string() + " (pty)");
    EXPECT_THAT(open_transport("tcp:0").value()->description(), StartsWith("127.0.0.1:"));
    EXPECT_THAT(open_transport("rfc2217:0").value()->description(), EndsWith(" (rfc2217)"));
    EXPECT_THAT(open_transport("tcp-connect:[::1]:9").value()->description(), StartsWith("[::1]:9 (tcp-connect)"));
    EXPECT_THAT(open_transport("usbip:0").value()->description(), EndsWith(" (usbip)"));
    EXPECT_THAT(open_transport("file:" + (folder / "a:b").string()).value()->description(), EndsWith("a:b (file)"));
}

TEST(OpenTransport, RefusesClearly) {
    EXPECT_EQ(
        refusal("tcp:host").message,
        "port 'tcp:host': address 'host': a port from 0 to 65535 is missing; expected [HOST:]PORT, an IPv6 address "
        "in brackets");
    EXPECT_THAT(refusal("tcp:").message, HasSubstr("a port is missing"));
    EXPECT_THAT(refusal("usbip:").message, HasSubstr("a port is missing"));
    EXPECT_EQ(refusal("tcp:70000").code, ErrorCode::usage);
    EXPECT_THAT(refusal("rfc2217").message, HasSubstr("a port is missing"));
    EXPECT_THAT(refusal("tcp-connect:").message, HasSubstr("a host and its port is missing"));
    for (const std::string uri : {"tcp-connect:2000", "tcp-connect:host:0"})
        EXPECT_THAT(refusal(uri).message, HasSubstr("'" + uri + "': whom to call is missing")) << uri;
    EXPECT_THAT(refusal("usb:").message, HasSubstr("a device is missing"));
    EXPECT_THAT(refusal("hid:10c4").message, StartsWith("port 'hid:10c4': '10c4' names no USB device"));
    EXPECT_EQ(refusal("usb:1546:01a8,rtscts").message, "port 'usb:1546:01a8,rtscts': a CDC-ACM device takes no rtscts");
    EXPECT_EQ(refusal("hid:ffff:fffe").code, ErrorCode::outside);
    EXPECT_THAT(refusal("ptty:gps0").message, HasSubstr("did you mean 'pty'?"));
    EXPECT_EQ(refusal("can:0").message,
              "port 'can:0': no such kind of port; expected pty[:LINK], serial:DEVICE[@BAUD], usb:VID:PID[:SERIAL], "
              "hid:VID:PID[:SERIAL], usbip:[HOST:]PORT, tcp:[HOST:]PORT[@BAUD], tcp-connect:HOST:PORT[@BAUD], "
              "rfc2217:[HOST:]PORT, dronecan:BUS, file:PATH, client:NAME or -");
    EXPECT_THAT(refusal("").message, HasSubstr("no such kind of port; expected pty[:LINK], "));
    EXPECT_THAT(refusal("pty:").message, HasSubstr("a path is missing"));
    EXPECT_THAT(refusal("file").message, HasSubstr("a path is missing"));
    EXPECT_THAT(refusal("file:").message, HasSubstr("a path is missing"));
    EXPECT_THAT(refusal("serial:").message, HasSubstr("a device is missing"));
    EXPECT_THAT(refusal("serial:/dev/ttyS0@quick").message,
                StartsWith("port 'serial:/dev/ttyS0@quick': line '/dev/ttyS0@quick': the speed 'quick'"));
    EXPECT_EQ(refusal("serial:/dev/no-such-tty").code, ErrorCode::outside);
    EXPECT_EQ(refusal("file:/no/such/folder/x").code, ErrorCode::outside);
}

TEST(OpenTransport, TakesASpeedBehindTheAddressOfASocket) {
    const auto speed = [](std::string_view uri) { return parse_port_uri(uri).value().baud; };
    EXPECT_EQ(speed("tcp:2000"), std::nullopt);
    EXPECT_EQ(speed("tcp:2000@115200"), 115200U);
    EXPECT_EQ(speed("tcp:0.0.0.0:2000@9600"), 9600U);
    EXPECT_EQ(speed("tcp-connect:[::1]:5762@230400"), 230400U);
    EXPECT_EQ(parse_port_uri("tcp-connect:[::1]:5762@230400")->address.port, 5762);
    EXPECT_EQ(refusal("tcp:2000@fast").message,
              "port 'tcp:2000@fast': the speed 'fast' is not understood; expected ADDRESS@BAUD, 50 to 12000000");
    EXPECT_THAT(refusal("tcp:2000@").message, HasSubstr("the speed ''"));
    EXPECT_EQ(refusal("rfc2217:2217@9600").code, ErrorCode::usage) << "its client sets the line";
    EXPECT_EQ(refusal("usbip:3240@9600").code, ErrorCode::usage);
}

TEST(OpenTransport, GuessesTheKindOfAnAddressWithoutOne) {
    const auto guess = [](std::string_view uri) {
        const std::string message = refusal(uri).message,
                          start = "port '" + std::string(uri) + "': no such kind of port; ";
        EXPECT_THAT(message, StartsWith(start));
        return message.substr(std::min(start.size(), message.size()));
    };
    EXPECT_EQ(guess("/dev/ttyUSB0"), "did you mean 'serial:/dev/ttyUSB0'?");
    EXPECT_EQ(guess("/dev/ttyACM0@115200"), "did you mean 'serial:/dev/ttyACM0@115200'?");
    EXPECT_EQ(guess("/dev/serial/by-id/usb-FTDI-if00"), "did you mean 'serial:/dev/serial/by-id/usb-FTDI-if00'?");
    EXPECT_EQ(guess("ttyS1"), "did you mean 'serial:/dev/ttyS1'?");
    EXPECT_EQ(guess("2000"), "did you mean 'tcp:2000'?");
    EXPECT_EQ(guess(":2000"), "did you mean 'tcp:2000'?");
    EXPECT_EQ(guess("localhost:2000"), "did you mean 'tcp:localhost:2000'?");
    EXPECT_EQ(guess("0.0.0.0:2000"), "did you mean 'tcp:0.0.0.0:2000'?");
    EXPECT_EQ(guess("gps0"), "did you mean 'pty:gps0'?");
    EXPECT_EQ(guess("/tmp/gps0"), "did you mean 'pty:/tmp/gps0'?");
    EXPECT_THAT(guess("udp:5000"), StartsWith("expected pty[:LINK], "));
    EXPECT_THAT(guess("tpc:2000"), StartsWith("did you mean 'tcp'?"));
}

TEST(MemoryTransport, KeepsAndFeedsBytes) {
    MemoryTransport wire;
    wire.feed(to_bytes("in"));
    wire.feed(to_bytes("put"));
    EXPECT_EQ(to_string(wire.read()), "input");
    EXPECT_TRUE(wire.read().empty());
    wire.set_room(4);
    EXPECT_EQ(wire.write(to_bytes("output")), 4U);
    EXPECT_EQ(wire.write(to_bytes("put")), 0U);
    wire.set_line({false, 9600});
    EXPECT_EQ(wire.write(to_bytes("lost")), 4U);
    EXPECT_EQ(to_string(wire.written()), "outp");
    EXPECT_EQ(wire.line().baud, 9600U);
    wire.set_receiver_baud(38400);
    EXPECT_EQ(wire.receiver_baud(), 38400U);
}

}  // namespace
}  // namespace skyloop
