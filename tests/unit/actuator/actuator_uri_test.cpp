// What a user may type as power, and what is said of all else.
#include "wire/actuator/actuator_uri.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace skyloop {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

template <class Address>
Address address_of(std::string_view uri) {
    const auto parsed = parse_actuator_uri(uri);
    EXPECT_TRUE(parsed) << parsed.error().message;
    if (!parsed || !std::holds_alternative<Address>(*parsed)) {
        ADD_FAILURE() << uri << " is another kind";
        return {};
    }
    return std::get<Address>(*parsed);
}

std::string refusal_of(std::string_view uri) {
    const auto parsed = parse_actuator_uri(uri);
    if (parsed) return "taken";
    EXPECT_EQ(parsed.error().code, ErrorCode::usage);
    return parsed.error().message;
}

TEST(ActuatorUri, NamesARelay) {
    const auto plain = address_of<RelayAddress>("relay:16c0:05df/2");
    EXPECT_EQ(plain.board.ids, (UsbIds{0x16c0, 0x05df}));
    EXPECT_EQ(plain.number, 2);
    EXPECT_EQ(plain.active, ActiveLevel::cuts);
    const auto with_serial = address_of<RelayAddress>("relay:16c0:05df:HURTM/8,active=power");
    EXPECT_EQ(with_serial.board.serial, "HURTM");
    EXPECT_EQ(with_serial.number, 8);
    EXPECT_EQ(with_serial.active, ActiveLevel::powers);
    EXPECT_EQ(address_of<RelayAddress>("relay:16c0:05df@1-1.2/1,active=cut").board.port_path, "1-1.2");
}

TEST(ActuatorUri, NamesAPinAndAHubPort) {
    const auto pin = address_of<GpioAddress>("gpio:04d8:00dd/0,active=power");
    EXPECT_EQ(pin.board.ids, (UsbIds{0x04d8, 0x00dd}));
    EXPECT_EQ(pin.number, 0);
    EXPECT_EQ(pin.active, ActiveLevel::powers);
    EXPECT_EQ(address_of<HubPortAddress>("hub:1-1.4").port_path, "1-1.4");
    EXPECT_EQ(address_of<HubPortAddress>("hub:2-3").port_path, "2-3");
}

TEST(ActuatorUri, NamesAModemLine) {
    const auto rts = address_of<ModemLineAddress>("line:/dev/ttyUSB0/rts");
    EXPECT_EQ(rts.device, "/dev/ttyUSB0");
    EXPECT_EQ(rts.line, ModemLineAddress::Line::rts);
    EXPECT_EQ(rts.active, ActiveLevel::cuts);
    const auto dtr = address_of<ModemLineAddress>("line:/dev/serial/by-id/a,b/dtr,active=power");
    EXPECT_EQ(dtr.device, "/dev/serial/by-id/a,b");
    EXPECT_EQ(dtr.line, ModemLineAddress::Line::dtr);
    EXPECT_EQ(dtr.active, ActiveLevel::powers);
}

TEST(ActuatorUri, PartsTheWordsOfCommands) {
    const auto plain = address_of<SwitchCommands>("command:uhubctl -a off -p 2|uhubctl -a on -p 2");
    EXPECT_THAT(plain.cut, ElementsAre("uhubctl", "-a", "off", "-p", "2"));
    EXPECT_THAT(plain.restore, ElementsAre("uhubctl", "-a", "on", "-p", "2"));
    EXPECT_THAT(plain.state, IsEmpty());
    const auto quoted =
        address_of<SwitchCommands>(R"(command: sh -c 'echo "$1 | x" >f' "a\"b" c\ d|  'on'"e"f '' |state)");
    EXPECT_THAT(quoted.cut, ElementsAre("sh", "-c", R"(echo "$1 | x" >f)", "a\"b", "c d"));
    EXPECT_THAT(quoted.restore, ElementsAre("onef", ""));
    EXPECT_THAT(quoted.state, ElementsAre("state"));
    EXPECT_THAT(address_of<SwitchCommands>(R"(command:a '\'|b)").cut, ElementsAre("a", "\\"));
}

TEST(ActuatorUri, RefusesAllElse) {
    for (const char* uri : {"", "relay", "usb:16c0:05df/1", "RELAY:16c0:05df/1"})
        EXPECT_THAT(refusal_of(uri), HasSubstr("expected relay:VID:PID/N, gpio:VID:PID/N, hub:PORT_PATH")) << uri;
    for (const char* uri :
         {"relay:16c0:05df", "relay:16c0:05df/", "relay:16c0:05df/0", "relay:16c0:05df/9", "relay:16c0:05df/1x",
          "relay:16c0:05df/-1", "relay:16c0:05df/1,active=high", "relay:16c0:05df/1,", "relay:16c0:05df/99999999999"})
        EXPECT_THAT(refusal_of(uri), HasSubstr("with N from 1 to 8")) << uri;
    EXPECT_THAT(refusal_of("gpio:04d8:00dd/4"), HasSubstr("with N from 0 to 3"));
    EXPECT_THAT(refusal_of("relay:16c0/1"), HasSubstr("names no USB device"));
    for (const char* uri : {"hub:", "hub:1", "hub:1-", "hub:1-1.", "hub:1-a"})
        EXPECT_THAT(refusal_of(uri), HasSubstr("such as hub:1-1.4")) << uri;
    for (const char* uri : {"line:", "line:/rts", "line:/dev/ttyUSB0", "line:/dev/ttyUSB0/cts", "line:/dev/x/rts,low"})
        EXPECT_THAT(refusal_of(uri), HasSubstr("expected line:DEVICE/rts")) << uri;
    for (const char* uri : {"command:a", "command:a|b|c|d"})
        EXPECT_THAT(refusal_of(uri), HasSubstr("command:CUT|RESTORE")) << uri;
    for (const char* uri : {"command:|b", "command:a|", "command:a|b|", "command:''|b"})
        EXPECT_THAT(refusal_of(uri), HasSubstr("a program before, between and after each |")) << uri;
    for (const char* uri : {"command:a 'b|c", "command:a \"b|c", "command:a|b\\"})
        EXPECT_THAT(refusal_of(uri), HasSubstr("each quote to be closed")) << uri;
    EXPECT_NE(refusal_of(std::string_view("line:/dev/tty\0A/rts", 19)), "taken");
}

TEST(OpenActuator, SaysWhatIsNotThere) {
    const auto nothing = open_actuator("line:/dev/no-such-tty/rts");
    ASSERT_FALSE(nothing);
    EXPECT_EQ(nothing.error().code, ErrorCode::outside);
    EXPECT_THAT(nothing.error().message, HasSubstr("/dev/no-such-tty: No such file or directory"));
    const auto no_line = open_actuator("line:/dev/null/dtr");
    ASSERT_FALSE(no_line);
    EXPECT_EQ(no_line.error().message, "cannot use the modem lines of /dev/null: it has none");
}

bool one_switch_of(std::string_view a, std::string_view b) {
    const auto first = parse_actuator_uri(a), second = parse_actuator_uri(b);
    EXPECT_TRUE(first && second) << a << ' ' << b;
    EXPECT_EQ(may_be_one_switch(*first, *second), may_be_one_switch(*second, *first));
    return may_be_one_switch(*first, *second);
}

TEST(ActuatorUri, IsTheSameHoweverItIsWritten) {
    for (const char* same :
         {"relay:16C0:05DF/1", "relay:16c0:05df/1,active=power", "relay:16c0:05df@1-1/1", "relay:16c0:05df:HURTM/1"})
        EXPECT_TRUE(one_switch_of("relay:16c0:05df/1", same)) << same;
    for (const char* other : {"relay:16c0:05df/2", "relay:16c0:05de/1", "gpio:16c0:05df/1", "hub:1-1"})
        EXPECT_FALSE(one_switch_of("relay:16c0:05df/1", other)) << other;
    EXPECT_FALSE(one_switch_of("relay:16c0:05df@1-1/1", "relay:16c0:05df@1-2/1"));
    EXPECT_FALSE(one_switch_of("gpio:04d8:00dd:A/1", "gpio:04d8:00dd:B/1"));
    EXPECT_FALSE(one_switch_of("gpio:04d8:00dd:A/1", "gpio:04d8:00dd@1-1/1")) << "the lock of a run tells";
    EXPECT_TRUE(one_switch_of("hub:1-1.4", "hub:1-1.4"));
    EXPECT_FALSE(one_switch_of("hub:1-1.4", "hub:1-1.3"));
    EXPECT_TRUE(one_switch_of("line:/dev/ttyUSB0/rts", "line:/dev/../dev/ttyUSB0/dtr,active=power"));
    EXPECT_FALSE(one_switch_of("line:/dev/ttyUSB0/rts", "line:/dev/ttyUSB1/rts"));
    EXPECT_TRUE(one_switch_of("command:a|b", "command: a |'b'|c"));
    EXPECT_FALSE(one_switch_of("command:a|b", "command:a|c"));
}

}  // namespace
}  // namespace skyloop
