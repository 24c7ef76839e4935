#include "wire/transport/serial.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "serial_bench.hpp"

namespace skyloop {
namespace {

namespace fs = std::filesystem;
using test::Bench;
using test::FarEnd;
using test::ms;
using test::PlayedSystem;
using test::UsbTree;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

Error refused_line(const std::string& text, std::shared_ptr<SerialSystem> system = std::make_shared<SerialSystem>()) {
    const auto wire = SerialTransport::open(parse_serial_address(text).value(), std::move(system));
    EXPECT_FALSE(wire) << text;
    return wire ? Error{} : wire.error();
}

TEST(SerialAddress, HasSpeedAndFormat) {
    const auto plain = parse_serial_address("/dev/ttyUSB0").value();
    EXPECT_EQ(plain.device, "/dev/ttyUSB0");
    EXPECT_FALSE(plain.baud);
    EXPECT_EQ(plain.format.data_bits, 8);
    EXPECT_EQ(plain.format.parity, Parity::none);
    EXPECT_EQ(plain.format.stop_bits, 1);
    EXPECT_FALSE(plain.format.rtscts);
    const auto all = parse_serial_address("/dev/a@b,c/tty@x@123456,rtscts,7e2").value();
    EXPECT_EQ(all.device, "/dev/a@b,c/tty@x") << "of the name only the last @ counts, of the folders none";
    EXPECT_EQ(all.baud, 123456U);
    EXPECT_EQ(all.format.data_bits, 7);
    EXPECT_EQ(all.format.parity, Parity::even);
    EXPECT_EQ(all.format.stop_bits, 2);
    EXPECT_TRUE(all.format.rtscts);
    EXPECT_EQ(parse_serial_address("ttyS0,8O1").value().format.parity, Parity::odd);
    EXPECT_EQ(parse_serial_address("/dev/serial/by-path/pci-0000:00:14.0-usb-0:2:1.0-port0").value().device.filename(),
              "pci-0000:00:14.0-usb-0:2:1.0-port0");
}

TEST(SerialAddress, BadInputIsQuoted) {
    const auto message = [](std::string_view text) {
        const auto address = parse_serial_address(text);
        EXPECT_FALSE(address) << text;
        EXPECT_EQ(address ? ErrorCode::outside : address.error().code, ErrorCode::usage);
        return address ? std::string() : address.error().message;
    };
    EXPECT_EQ(message("/dev/ttyS0@fast"),
              "line '/dev/ttyS0@fast': the speed 'fast' is not understood; expected DEVICE[@BAUD][,8N1][,rtscts], BAUD "
              "50 to 12000000, the format 7 or 8, N, E or O, 1 or 2");
    for (const std::string speed : {"", "0", "49", "12000001", "-9600", "9600 ", "9600.0", "99999999999", "0x10"})
        EXPECT_THAT(message("/dev/ttyS0@" + speed), HasSubstr("the speed '" + speed + "' is not understood"));
    for (const std::string option : {"", "8", "9N1", "8X1", "8N3", "8N1 ", "RTSCTS", "8N15", "xonxoff"})
        EXPECT_THAT(message("/dev/ttyS0," + option), HasSubstr("option '" + option + "' is not understood"));
    EXPECT_THAT(message("/dev/ttyS0,8N1,"), HasSubstr("option '' is not understood"));
    EXPECT_THAT(message("/dev/ttyS0,8N1,8E1"), HasSubstr("'8E1' is a second format"));
    EXPECT_THAT(message("/dev/ttyS0,rtscts,8N1,rtscts"), HasSubstr("'rtscts' is there twice"));
    for (const std::string none : {"", "/dev/", "@9600", ",8N1", "/dev/@9600"})
        EXPECT_THAT(message(none), HasSubstr("the device is missing"));
}

TEST(SerialTransport, CarriesBytesAndGivesTheLineBack) {
    FarEnd far;
    const termios2 before = far.settings();
    {
        auto wire = SerialTransport::open({far.device(), std::nullopt, {}}).value();
        EXPECT_EQ(wire->description(), far.device().string() + " (serial)");
        EXPECT_TRUE(wire->line().connected);
        EXPECT_FALSE(wire->line().baud) << "the other end's speed is its own affair";
        std::string all;
        for (int i = 0; i < 256; ++i)
            all.push_back(static_cast<char>(i));
        EXPECT_EQ(wire->write(to_bytes(all)), 256U);
        EXPECT_EQ(far.read(256), all) << "raw";
        far.write(all);
        std::string heard;
        for (int i = 0; i < 2000 && heard.size() < 256; ++i, ::usleep(1000))
            heard += to_string(wire->read());
        EXPECT_EQ(heard, all);
        EXPECT_EQ(far.settings().c_lflag & ICANON, 0U);
        EXPECT_THAT(wire->take_news(), IsEmpty());
        EXPECT_FALSE(wire->modem_lines()) << "a pseudo-terminal has none";
    }
    const termios2 after = far.settings();
    EXPECT_EQ(after.c_lflag, before.c_lflag);
    EXPECT_EQ(after.c_iflag, before.c_iflag);
    EXPECT_EQ(after.c_oflag, before.c_oflag);
    EXPECT_EQ(after.c_cflag, before.c_cflag);
    EXPECT_EQ(after.c_ospeed, before.c_ospeed);
}

TEST(SerialTransport, FollowsTheReceiversSpeed) {
    Bench bench;
    EXPECT_EQ(bench.far.speed(), 115200U) << "no receiver has told a speed: a port without one";
    for (const std::uint32_t baud : {9600U, 123'456U, 38400U}) {
        bench.wire->set_receiver_baud(baud);
        bench.pass(0);
        bench.pass(10 * ms);
        EXPECT_EQ(bench.far.speed(), baud);
        EXPECT_EQ(bench.wire->baud(), baud);
    }
}

TEST(SerialTransport, HasTheSpeedOfItsAddressUntilTheReceiverChanges) {
    Bench bench("@57600");
    for (int i = 0; i < 2; ++i) {
        bench.wire->set_receiver_baud(9600);
        bench.pass(100 * ms);
        bench.pass(100 * ms);
        EXPECT_EQ(bench.far.speed(), 57600U);
    }
    for (const std::uint32_t baud : {115200U, 9600U}) {
        bench.wire->set_receiver_baud(baud);
        bench.pass(100 * ms);
        bench.pass(100 * ms);
        EXPECT_EQ(bench.far.speed(), baud);
    }
}

TEST(SerialTransport, AsksForTheFormatAndSaysWhatWasNotTaken) {
    Bench bench("@9600,7E2,rtscts");
    const tcflag_t bits = bench.system->asked.c_cflag;
    EXPECT_EQ(bits & CSIZE, static_cast<tcflag_t>(CS7));
    EXPECT_EQ(bits & (PARENB | PARODD | CSTOPB), static_cast<tcflag_t>(PARENB | CSTOPB));
    EXPECT_EQ(bits & CRTSCTS, CRTSCTS);
    EXPECT_THAT(bench.wire->take_news(), ElementsAre(HasSubstr("has not taken the data bits, parity")))
        << "a pseudo-terminal has no parity";
    EXPECT_THAT(bench.wire->take_news(), IsEmpty()) << "told once";
}

// The PL011 of a Raspberry Pi: the driver's buffer is empty while the FIFO still sends.
TEST(SerialTransport, ChangesTheSpeedAfterTheLastByteHasLeft) {
    auto played = std::make_shared<PlayedSystem>();
    played->tells_fifo = true;
    Bench bench("@9600", played);
    bench.wire->set_receiver_baud(9600);
    bench.system->queued = 5;
    bench.system->fifo_empty = false;
    bench.wire->write(to_bytes("old"));
    bench.wire->set_receiver_baud(115200);
    EXPECT_EQ(bench.wire->write(to_bytes("new")), 3U);
    bench.pass(100 * ms);
    EXPECT_EQ(bench.far.speed(), 9600U) << "the buffer is not empty";
    bench.system->queued = 0;
    bench.pass(100 * ms);
    EXPECT_EQ(bench.far.speed(), 9600U) << "the FIFO is not empty";
    bench.system->fifo_empty = true;
    bench.pass(0);
    bench.pass(1 * ms);
    EXPECT_EQ(bench.far.speed(), 9600U) << "a character at 9600 baud takes 1.04 ms";
    EXPECT_EQ(bench.far.read(3), "old");
    bench.pass(1 * ms);
    EXPECT_EQ(bench.far.speed(), 115200U);
    EXPECT_EQ(bench.far.read(3), "new");
    EXPECT_THAT(bench.wire->take_news(), IsEmpty());
}

// ftdi_sio on an adapter that answers with one byte, as QEMU's does: the driver takes the transmitter for never empty.
TEST(SerialTransport, ADriverThatIsNeverEmptyIsNotAsked) {
    auto played = std::make_shared<PlayedSystem>();
    played->tells_fifo = true;
    played->fifo_empty = false;
    Bench bench("", played);
    bench.wire->set_receiver_baud(9600);
    bench.pass(200 * ms);
    EXPECT_EQ(bench.far.speed(), 9600U);
    EXPECT_THAT(bench.wire->take_news(), IsEmpty());
}

TEST(SerialTransport, WhereNoFifoCanBeAskedTheLineTimeCounts) {
    Bench bench("@9600");
    bench.wire->set_receiver_baud(9600);
    bench.wire->write(Bytes(96));  // 100 ms
    bench.wire->set_receiver_baud(19200);
    bench.wire->write(to_bytes("a"));
    bench.wire->set_receiver_baud(38400);
    bench.wire->write(to_bytes("b"));
    bench.pass(99 * ms);
    bench.pass(0);
    EXPECT_EQ(bench.far.speed(), 9600U);
    bench.pass(2 * ms);
    bench.pass(4 * ms);
    EXPECT_EQ(bench.far.speed(), 19200U) << "one change after the other";
    EXPECT_EQ(bench.far.read(97), std::string(96, '\0') + "a");
    bench.pass(1 * ms);
    bench.pass(4 * ms);
    EXPECT_EQ(bench.far.speed(), 38400U);
    EXPECT_EQ(bench.far.read(1), "b");
}

TEST(SerialTransport, GivesUpBytesThatCannotLeaveBeforeAChange) {
    Bench bench("@9600");
    bench.wire->set_receiver_baud(9600);
    bench.system->queued = 5;  // the other end holds CTS low for ever
    bench.wire->set_receiver_baud(115200);
    bench.pass(900 * ms);
    EXPECT_EQ(bench.far.speed(), 9600U);
    const std::size_t taken = bench.wire->write(Bytes(10'000));
    EXPECT_GE(taken, 2000U);
    EXPECT_LT(taken, 10'000U) << "what waits is bounded";
    const int flushed = bench.system->flushed;
    bench.pass(200 * ms);
    EXPECT_EQ(bench.far.speed(), 115200U);
    EXPECT_EQ(bench.system->flushed, flushed + 1);
    EXPECT_THAT(bench.wire->take_news(),
                ElementsAre(HasSubstr("did not send its last bytes at 9600 bit/s within 1 s; they are lost")));
}

TEST(SerialTransport, SaysWhichSpeedADeviceDoesNotDo) {
    const auto slow = std::make_shared<PlayedSystem>();
    slow->fastest = 230'400;
    FarEnd far;
    slow->step = ms;
    EXPECT_THAT(refused_line(far.device().string() + "@921600", slow).message,
                HasSubstr("does not do 921600 bit/s: its nearest is 230400"));
    slow->step = 0;
    Bench bench("", slow);
    bench.wire->set_receiver_baud(460'800);
    bench.pass(0);
    bench.pass(10 * ms);
    EXPECT_THAT(bench.wire->take_news(), ElementsAre(HasSubstr("does not do 460800 bit/s")));
    EXPECT_TRUE(bench.wire->line().connected);
}

TEST(SerialTransport, RefusesWhatItCannotHaveAlone) {
    EXPECT_THAT(refused_line("/dev/no-such-tty").message, HasSubstr("No such file or directory"));
    EXPECT_THAT(refused_line("/dev/null@9600").message, HasSubstr("serial /dev/null: is no serial line"));
    EXPECT_EQ(refused_line("/dev/null").code, ErrorCode::outside);
    Bench bench;
    EXPECT_THAT(refused_line(bench.far.device()).message, HasSubstr("another program holds it (TIOCEXCL)"));
    const auto played = std::make_shared<PlayedSystem>();  // sees no TIOCEXCL, as if set by nobody
    if (::geteuid() == 0) {                                // others are refused by TIOCEXCL before
        EXPECT_THAT(refused_line(bench.far.device(), played).message, HasSubstr("another program holds it (flock)"));
    }
    FarEnd other;
    played->exclusive = true;
    EXPECT_THAT(refused_line(other.device(), played).message, HasSubstr("(TIOCEXCL)"));
    EXPECT_TRUE(bench.wire->line().connected) << "the first one is undisturbed";
}

TEST(SerialTransport, AssertsModemLinesAndAsksForLowLatency) {
    const auto played = std::make_shared<PlayedSystem>();
    played->has_modem_lines = true;
    {
        Bench bench("", played);
        EXPECT_EQ(played->modem & (TIOCM_DTR | TIOCM_RTS), TIOCM_DTR | TIOCM_RTS);
        EXPECT_TRUE(bench.wire->modem_lines()->cts);
        EXPECT_FALSE(bench.wire->modem_lines()->dcd);
        EXPECT_NE(static_cast<unsigned>(played->uart_flags) & ASYNC_LOW_LATENCY, 0U);
    }
    EXPECT_EQ(played->uart_flags, 0) << "put back";
    played->modem = 0;
    played->step = 0;
    Bench bench("@9600,rtscts", played);
    EXPECT_EQ(played->modem & (TIOCM_DTR | TIOCM_RTS), TIOCM_DTR) << "RTS is the driver's";
    played->full = true;
    EXPECT_EQ(bench.wire->write(Bytes(7)), 0U);
    EXPECT_THAT(bench.wire->notice(), HasSubstr("7 bytes were lost while the other end held CTS low"));
}

TEST(SerialTransport, LowersTheLatencyTimerOfAnFtdiAdapter) {
    UsbTree usb;
    FarEnd far;
    usb.plug_in("ttyUSB0", "1-1", "A1", far);
    UsbTree::write(usb.latency_timer, "16");
    const auto timer = [&] {
        std::string text;
        std::ifstream(usb.latency_timer) >> text;
        return text;
    };
    const auto played = std::make_shared<PlayedSystem>(usb.roots);
    {
        Bench bench("", played, usb.roots.devices / "ttyUSB0");
        EXPECT_EQ(timer(), "1");
        EXPECT_THAT(bench.wire->take_news(), IsEmpty());
    }
    EXPECT_EQ(timer(), "16") << "put back";
    fs::remove(usb.latency_timer);
    fs::create_symlink("/proc/sys/kernel/random/poolsize", usb.latency_timer);  // nobody may write it
    played->step = 0;
    Bench bench("", played, usb.roots.devices / "ttyUSB0");
    EXPECT_THAT(bench.wire->take_news(), ElementsAre(HasSubstr("its latency timer stays at " + timer() + " ms")));
}

TEST(SerialTransport, ResumesAfterAnUnplugUnderTheSameName) {
    const test::TemporaryFolder folder;
    const fs::path name = folder / "autopilot";
    auto far = std::make_unique<FarEnd>();
    fs::create_symlink(far->device(), name);
    Bench bench("", nullptr, name);
    bench.wire->set_receiver_baud(38400);
    bench.pass(10 * ms);
    bench.pass(10 * ms);
    for (int round = 0; round < 3; ++round) {
        far.reset();
        fs::remove(name);
        EXPECT_FALSE(bench.wire->line().connected);
        EXPECT_EQ(bench.wire->write(to_bytes("lost")), 4U);
        EXPECT_TRUE(bench.wire->read().empty());
        EXPECT_THAT(bench.wire->take_news(), ElementsAre(HasSubstr(name.string() + " is gone; it is looked for")));
        const std::uint32_t speed = round == 1 ? 9600 : 38400;
        bench.wire->set_receiver_baud(speed);
        far = std::make_unique<FarEnd>();
        fs::create_symlink(far->device(), name);
        ASSERT_TRUE(bench.connected_within_looks());
        EXPECT_THAT(bench.wire->take_news(), ElementsAre(HasSubstr(name.string() + " is back, as " + name.string())));
        EXPECT_EQ(far->speed(), speed) << "what the receiver has by now";
        EXPECT_EQ(bench.wire->write(to_bytes("fresh")), 5U);
        EXPECT_EQ(far->read(5), "fresh") << "and nothing from before";
    }
}

TEST(SerialTransport, SaysOnceWhyADeviceThatIsBackCannotBeHad) {
    const test::TemporaryFolder folder;
    const fs::path name = folder / "autopilot";
    auto far = std::make_unique<FarEnd>();
    fs::create_symlink(far->device(), name);
    Bench bench("", nullptr, name);
    far.reset();
    fs::remove(name);
    EXPECT_FALSE(bench.wire->line().connected);
    bench.wire->take_news();
    fs::create_symlink("/dev/null", name);
    std::vector<std::string> news;
    for (int i = 0; i < 1000 && news.empty(); ++i, ::usleep(1000)) {
        bench.pass(600 * ms);
        news = bench.wire->take_news();
    }
    EXPECT_THAT(news, ElementsAre(HasSubstr("is no serial line")));
    for (int i = 0; i < 50; ++i, ::usleep(1000))
        bench.pass(600 * ms);
    EXPECT_THAT(bench.wire->take_news(), IsEmpty());
}

TEST(SerialTransport, FindsAnAdapterByItsSerialNumber) {
    UsbTree usb;
    auto mine = std::make_unique<FarEnd>();
    FarEnd other;
    usb.plug_in("ttyUSB0", "1-1", "A1", *mine);
    Bench bench("@9600", std::make_shared<PlayedSystem>(usb.roots), usb.roots.devices / "ttyUSB0");
    usb.unplug("ttyUSB0", "1-1");
    mine = std::make_unique<FarEnd>();
    EXPECT_FALSE(bench.wire->line().connected);
    bench.wire->take_news();
    bench.look_for_a_while();
    usb.plug_in("ttyUSB0", "1-1", "B2", other);
    usb.plug_in("ttyUSB1", "1-2", "A1", *mine);
    ASSERT_TRUE(bench.connected_within_looks());
    EXPECT_THAT(bench.wire->take_news(), ElementsAre(HasSubstr("ttyUSB0 is back, as")));
    bench.wire->write(to_bytes("here"));
    EXPECT_EQ(mine->read(4), "here");
}

TEST(SerialTransport, LeavesAnAdapterAloneThatSharesItsSerialNumber) {
    UsbTree usb;
    auto mine = std::make_unique<FarEnd>();
    FarEnd other;
    usb.plug_in("ttyUSB0", "1-1", "0001", *mine);
    usb.plug_in("ttyUSB1", "1-2", "0001", other);
    Bench bench("@9600", std::make_shared<PlayedSystem>(usb.roots), usb.roots.devices / "ttyUSB0");
    const auto pull_and_plug_in = [&](const std::string& from, const std::string& to) {
        usb.unplug("ttyUSB0", from);
        mine = std::make_unique<FarEnd>();
        EXPECT_FALSE(bench.wire->line().connected);
        bench.look_for_a_while();
        EXPECT_FALSE(bench.wire->line().connected) << "the one at 1-2 was there beside it";
        usb.plug_in("ttyUSB0", to, "0001", *mine);
        ASSERT_TRUE(bench.connected_within_looks());
        bench.wire->write(to_bytes("here"));
        EXPECT_EQ(mine->read(4), "here");
    };
    pull_and_plug_in("1-1", "1-3");
    FarEnd third;
    usb.plug_in("ttyUSB2", "1-1", "0001", third);
    pull_and_plug_in("1-3", "1-3");
    EXPECT_EQ(other.read() + third.read(), "");
}

}  // namespace
}  // namespace skyloop
