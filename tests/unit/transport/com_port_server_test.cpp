// Octets are those of RFC 854 and RFC 2217, section 2 and 3.
#include "wire/transport/rfc2217.hpp"

#include <gtest/gtest.h>

namespace skyloop {
namespace {

const Bytes agreement{255, 251, 44};  // IAC WILL COM-PORT-OPTION

ComPortServer begun() {
    ComPortServer port("a name");
    port.begin();
    port.receive(agreement);
    port.take_answers();
    return port;
}

Bytes option_of_port(std::uint8_t command, const Bytes& value) {
    Bytes bytes{255, 250, 44, command};
    bytes.insert(bytes.end(), value.begin(), value.end());
    bytes.insert(bytes.end(), {255, 240});
    return bytes;
}

// What one command is answered with.
Bytes answer_to(ComPortServer& port, std::uint8_t command, const Bytes& value) {
    const Bytes bytes = option_of_port(command, value);
    EXPECT_EQ(port.receive(bytes), bytes.size());
    return port.take_answers();
}

TEST(ComPortServer, OffersItsOptionsAndAnswersNoAgreement) {
    ComPortServer port("a name");
    port.begin();
    EXPECT_EQ(port.take_answers(),
              (Bytes{255, 251, 0, 255, 253, 0, 255, 251, 3, 255, 253, 3, 255, 251, 44, 255, 253, 44}));
    EXPECT_FALSE(port.agreed());
    port.receive(Bytes{255, 253, 0, 255, 251, 0, 255, 251, 44, 255, 253, 44});
    EXPECT_TRUE(port.agreed());
    EXPECT_EQ(port.take_answers(), option_of_port(107, {0xB0})) << "the modem lines, once";
    port.receive(Bytes{255, 253, 0, 255, 251, 44});
    EXPECT_TRUE(port.take_answers().empty()) << "nothing runs in a circle";
}

// What was asked for and what was offered may cross: then the client holds the option for agreed without a word.
TEST(ComPortServer, ACommandIsAnAgreement) {
    ComPortServer port("a name");
    port.begin();
    port.take_answers();
    Bytes both = option_of_port(107, {0xB0});
    const Bytes answer = option_of_port(104, {2});
    both.insert(both.end(), answer.begin(), answer.end());
    EXPECT_EQ(answer_to(port, 4, {2}), both);
    EXPECT_TRUE(port.agreed());
    EXPECT_EQ(answer_to(port, 4, {2}), answer) << "the modem lines, once";
}

TEST(ComPortServer, RefusesOtherOptionsAndFollowsARefusal) {
    ComPortServer port = begun();
    port.receive(Bytes{255, 253, 1, 255, 251, 24, 255, 254, 99, 255, 252, 99});
    EXPECT_EQ(port.take_answers(), (Bytes{255, 252, 1, 255, 254, 24}));
    port.receive(Bytes{255, 254, 0, 255, 254, 0, 255, 253, 0});
    EXPECT_EQ(port.take_answers(), (Bytes{255, 252, 0, 255, 251, 0})) << "off, and on again";
}

TEST(ComPortServer, DataMayHoldEveryByte) {
    Bytes all;
    for (int i = 0; i < 256; ++i)
        all.push_back(static_cast<std::uint8_t>(i));
    const Bytes escaped = ComPortServer::escaped(all);
    EXPECT_EQ(escaped.size(), 257U);
    ComPortServer port = begun();
    for (const std::uint8_t byte : escaped)
        port.receive(ByteSpan(&byte, 1));
    EXPECT_EQ(port.take_data(), all);
}

TEST(ComPortServer, SetsTheLine) {
    ComPortServer port = begun();
    port.set_own_baud(38400);
    EXPECT_EQ(answer_to(port, 1, {0, 0, 0, 0}), option_of_port(101, {0, 0, 0x96, 0})) << "asked, before one is set";
    EXPECT_EQ(port.settings().baud, std::nullopt);
    EXPECT_EQ(answer_to(port, 1, {0, 1, 0xC2, 0}), option_of_port(101, {0, 1, 0xC2, 0}));
    EXPECT_EQ(port.settings().baud, 115200U);
    EXPECT_EQ(answer_to(port, 2, {7}), option_of_port(102, {7}));
    EXPECT_EQ(answer_to(port, 3, {3}), option_of_port(103, {3}));
    EXPECT_EQ(answer_to(port, 4, {2}), option_of_port(104, {2}));
    EXPECT_EQ(answer_to(port, 4, {0}), option_of_port(104, {2})) << "asked";
    EXPECT_EQ(answer_to(port, 2, {9}), option_of_port(102, {7})) << "no such size: it stays";
    EXPECT_EQ(answer_to(port, 1, {0xFF, 0xFF, 0xFF, 0xFF}), Bytes()) << "two bytes, each of them twice";
}

TEST(ComPortServer, ASpeedThatCannotBeIsAnsweredWithTheOneThatIs) {
    ComPortServer port = begun();
    answer_to(port, 1, {0, 0, 0x25, 0x80});
    EXPECT_EQ(answer_to(port, 1, {0x7F, 0, 0, 0}), option_of_port(101, {0, 0, 0x25, 0x80}));
    EXPECT_EQ(answer_to(port, 1, {0, 0, 0, 49}), option_of_port(101, {0, 0, 0x25, 0x80}));
    EXPECT_EQ(answer_to(port, 1, {0, 1}), Bytes()) << "no four bytes";
    // 65535 has two IAC of its own, which come twice, both ways.
    EXPECT_EQ(answer_to(port, 1, {0, 0, 255, 255, 255, 255}), option_of_port(101, {0, 0, 255, 255, 255, 255}));
    EXPECT_EQ(port.settings().baud, 65535U);
}

TEST(ComPortServer, KeepsModemLinesBreakAndFlow) {
    ComPortServer port = begun();
    EXPECT_EQ(answer_to(port, 5, {7}), option_of_port(105, {9})) << "DTR is off";
    EXPECT_EQ(answer_to(port, 5, {8}), option_of_port(105, {8}));
    EXPECT_EQ(answer_to(port, 5, {11}), option_of_port(105, {11}));
    EXPECT_EQ(answer_to(port, 5, {5}), option_of_port(105, {5}));
    EXPECT_EQ(answer_to(port, 5, {3}), option_of_port(105, {3}));
    EXPECT_EQ(answer_to(port, 5, {0}), option_of_port(105, {3}));
    EXPECT_EQ(answer_to(port, 5, {18}), option_of_port(105, {14})) << "no flow control by DTR";
    EXPECT_EQ(answer_to(port, 5, {17}), answer_to(port, 5, {0})) << "none by DCD, which is of the outbound group";
    EXPECT_EQ(answer_to(port, 5, {19}), answer_to(port, 5, {0})) << "nor by DSR";
    EXPECT_TRUE(port.settings().dtr && port.settings().rts && port.settings().sends_break);
    answer_to(port, 5, {6});
    answer_to(port, 5, {9});
    EXPECT_FALSE(port.settings().dtr || port.settings().sends_break);
    answer_to(port, 8, {});
    EXPECT_TRUE(port.settings().suspended);
    answer_to(port, 9, {});
    EXPECT_FALSE(port.settings().suspended);
}

TEST(ComPortServer, TellsItsNameAndItsStates) {
    ComPortServer port = begun();
    EXPECT_EQ(answer_to(port, 0, {}), option_of_port(100, to_bytes("a name")));
    EXPECT_EQ(answer_to(port, 0, to_bytes("the client's")), Bytes());
    EXPECT_EQ(answer_to(port, 7, {}), option_of_port(107, {0xB0}));
    EXPECT_EQ(answer_to(port, 11, {1}), option_of_port(111, {1}));
    EXPECT_EQ(answer_to(port, 200, {1}), Bytes()) << "unknown";
}

TEST(ComPortServer, PurgeForgetsWhatTheDeviceHasNotHeard) {
    ComPortServer port = begun();
    port.receive(to_bytes("stale"));
    EXPECT_EQ(answer_to(port, 12, {1}), option_of_port(112, {1}));
    EXPECT_EQ(port.data_waiting(), 5U);
    EXPECT_EQ(answer_to(port, 12, {3}), option_of_port(112, {3}));
    EXPECT_EQ(port.data_waiting(), 0U);
    EXPECT_EQ(answer_to(port, 12, {4}), Bytes());
}

TEST(ComPortServer, DataBeforeANewSpeedIsTakenAtTheOldOne) {
    ComPortServer port = begun();
    Bytes stream = to_bytes("at the old");
    const Bytes change = option_of_port(1, {0, 0, 0x25, 0x80});
    stream.insert(stream.end(), change.begin(), change.end());
    const std::size_t before = stream.size();
    const Bytes after = to_bytes("at the new");
    stream.insert(stream.end(), after.begin(), after.end());
    ASSERT_EQ(port.receive(stream), before);
    EXPECT_EQ(port.settings().baud, std::nullopt);
    EXPECT_EQ(port.receive(after), 0U) << "the data has not been taken yet";
    EXPECT_EQ(to_string(port.take_data()), "at the old");
    EXPECT_EQ(port.receive(after), after.size());
    EXPECT_EQ(port.settings().baud, 9600U);
    EXPECT_EQ(to_string(port.take_data()), "at the new");
}

TEST(ComPortServer, HostileBytesChangeNothing) {
    ComPortServer port = begun();
    Bytes endless{255, 250, 44, 1};
    endless.resize(100000, 7);
    endless.insert(endless.end(), {255, 240});
    port.receive(endless);
    port.receive(Bytes{255, 250, 255, 240, 255, 250, 44, 255, 240, 255, 250, 7, 1, 255, 240, 255, 241, 255, 0});
    EXPECT_TRUE(port.take_answers().empty());
    EXPECT_EQ(port.settings(), ComPortSettings{});
    port.receive(Bytes{255, 250, 44, 2, 7, 255, 251, 24});
    EXPECT_EQ(port.take_answers(), (Bytes{255, 254, 24})) << "a command inside a subnegotiation ends it";
    port.receive(to_bytes("data"));
    EXPECT_EQ(to_string(port.take_data()), "data");
    Bytes asking;
    for (int i = 0; i < 100000; ++i)
        asking.insert(asking.end(), {255, 253, 99});
    port.receive(asking);
    EXPECT_LE(port.take_answers().size(), 65536U) << "of a client that asks and never reads";
}

}  // namespace
}  // namespace skyloop
