#include "wire/transport/pty.hpp"

#include <asm/termbits.h>
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <fstream>

#include "temporary_folder.hpp"

namespace skyloop {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::StartsWith;

// A client: what gpsd or an autopilot's simulator does with a serial port.
class Client {
public:
    explicit Client(const fs::path& path) : file_(::open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC)) {}

    [[nodiscard]] bool open() const { return file_.open(); }
    // What has arrived; waits up to two seconds until it is `least` bytes.
    std::string read(std::size_t least = 0) {
        std::string all;
        std::array<char, 4096> piece{};
        for (;;) {
            const ssize_t count = ::read(file_.value(), piece.data(), piece.size());
            if (count > 0) all.append(piece.data(), static_cast<std::size_t>(count));
            if (count > 0 || all.size() >= least) {
                if (count <= 0) return all;
                continue;
            }
            pollfd ready{file_.value(), POLLIN, 0};
            if (::poll(&ready, 1, 2000) <= 0) return all;
        }
    }
    void write(std::string_view text) {
        EXPECT_EQ(::write(file_.value(), text.data(), text.size()), static_cast<ssize_t>(text.size()));
    }
    termios2 settings() {
        termios2 t{};
        EXPECT_EQ(::ioctl(file_.value(), TCGETS2, &t), 0);
        return t;
    }
    void set_speed(std::uint32_t baud, tcflag_t code = BOTHER) {
        termios2 t = settings();
        t.c_cflag = (t.c_cflag & ~static_cast<tcflag_t>(CBAUD | (CBAUD << IBSHIFT))) | code;
        t.c_ispeed = t.c_ospeed = baud;
        EXPECT_EQ(::ioctl(file_.value(), TCSETS2, &t), 0);
    }

private:
    FileDescriptor file_;
};

std::unique_ptr<PtyTransport> open_pty() {
    auto pty = PtyTransport::open();
    EXPECT_TRUE(pty) << pty.error().message;
    return std::move(*pty);
}

// What a client wrote reaches the master through the kernel's own work queue: look until it is there.
std::string read_from(PtyTransport& pty, std::size_t least) {
    std::string all;
    for (int i = 0; i < 2000 && all.size() < least; ++i) {
        all += to_string(pty.read());
        if (all.size() < least) ::usleep(1000);
    }
    return all;
}

TEST(PtyTransport, SeesOpenCloseAndReopen) {
    const auto pty = open_pty();
    EXPECT_FALSE(pty->line().connected);
    for (int round = 0; round < 3; ++round) {
        {
            Client client(pty->terminal());
            ASSERT_TRUE(client.open());
            EXPECT_TRUE(pty->line().connected);
            EXPECT_EQ(pty->write(to_bytes("hello")), 5U);
            EXPECT_EQ(client.read(5), "hello");
            client.write("back");
            EXPECT_EQ(read_from(*pty, 4), "back");
        }
        EXPECT_FALSE(pty->line().connected);
    }
}

TEST(PtyTransport, CountsSeveralClients) {
    const auto pty = open_pty();
    EXPECT_EQ(pty->clients(), 0);
    {
        Client first(pty->terminal());
        EXPECT_EQ(pty->clients(), 1);
        {
            Client second(pty->terminal());
            EXPECT_EQ(pty->clients(), 2);
        }
        EXPECT_EQ(pty->clients(), 1);
        EXPECT_EQ(pty->write(to_bytes("x")), 1U);
        EXPECT_EQ(first.read(1), "x");
    }
    EXPECT_EQ(pty->clients(), 0);
}

TEST(PtyTransport, IsRawBothWays) {
    const auto pty = open_pty();
    Client client(pty->terminal());
    const std::string bytes("\x00\x03\x04\x0d\x0a\x11\x13\x1a\x7f\xff\n", 11);
    EXPECT_EQ(pty->write(to_bytes(bytes)), bytes.size());
    EXPECT_EQ(client.read(bytes.size()), bytes);
    client.write(bytes);
    EXPECT_EQ(read_from(*pty, bytes.size()), bytes);
    EXPECT_TRUE(pty->read().empty()) << "no echo";
}

TEST(PtyTransport, LosesWhatIsWrittenWhileNobodyListens) {
    const auto pty = open_pty();
    EXPECT_EQ(pty->write(Bytes(100'000, 'x')), 100'000U);
    Client client(pty->terminal());
    EXPECT_EQ(pty->write(to_bytes("fresh")), 5U);
    EXPECT_EQ(client.read(5), "fresh");
}

TEST(PtyTransport, ForgetsWhatAClientLeftUnread) {
    const auto pty = open_pty();
    for (const bool look_between : {true, false}) {
        {
            Client lazy(pty->terminal());
            EXPECT_GT(pty->write(Bytes(10'000, 'x')), 4096U);
        }
        if (look_between) {
            EXPECT_FALSE(pty->line().connected);
        }
        Client next(pty->terminal());
        EXPECT_TRUE(pty->line().connected);
        EXPECT_EQ(pty->write(to_bytes("fresh")), 5U);
        EXPECT_EQ(next.read(5), "fresh") << "looked between: " << look_between;
    }
}

TEST(PtyTransport, KeepsTheBytesOfAClientWhenASecondOneComes) {
    const auto pty = open_pty();
    Client first(pty->terminal());
    EXPECT_EQ(pty->write(to_bytes("unread ")), 7U);
    Client second(pty->terminal());
    EXPECT_EQ(pty->write(to_bytes("and more")), 8U);
    EXPECT_EQ(first.read(15), "unread and more");
}

TEST(PtyTransport, NeverWaitsForASlowClient) {
    const auto pty = open_pty();
    Client client(pty->terminal());
    std::size_t taken = 0;
    for (int i = 0; i < 100; ++i)
        taken += pty->write(Bytes(1000, 'x'));
    EXPECT_GT(taken, 4000U);
    EXPECT_LT(taken, 60'000U);
    EXPECT_EQ(pty->write(Bytes(1000, 'x')), 0U);
    EXPECT_TRUE(pty->line().connected);
    EXPECT_EQ(client.read(taken).size(), taken);
    EXPECT_EQ(pty->write(to_bytes("again")), 5U);
    EXPECT_EQ(client.read(5), "again");
}

TEST(PtyTransport, ReportsTheClientsSpeed) {
    const auto pty = open_pty();
    pty->set_receiver_baud(38400);
    EXPECT_EQ(pty->line().baud, 38400U);
    Client client(pty->terminal());
    EXPECT_EQ(client.settings().c_cflag & CBAUD, static_cast<tcflag_t>(B38400)) << "old clients must know the code";
    client.set_speed(100'000);
    EXPECT_EQ(pty->line().baud, 100'000U);
    client.set_speed(0, B57600);
    EXPECT_EQ(pty->line().baud, 57600U);
    pty->set_receiver_baud(9600);
    EXPECT_EQ(pty->line().baud, 57600U) << "the speed is the client's after the first time";
}

TEST(PtyTransport, OffersUnusualReceiverSpeeds) {
    const auto pty = open_pty();
    pty->set_receiver_baud(123'456);
    Client client(pty->terminal());
    EXPECT_EQ(client.settings().c_ospeed, 123'456U);
    EXPECT_EQ(pty->line().baud, 123'456U);
}

TEST(PtyTransport, LetsEveryUserOpenIt) {
    const auto pty = open_pty();
    struct stat node {};
    ASSERT_EQ(::stat(pty->terminal().c_str(), &node), 0);
    EXPECT_EQ(node.st_mode & 0777U, 0666U);
}

TEST(PtyLink, LeadsToTheTerminalAndGoesWithIt) {
    const test::TemporaryFolder folder;
    {
        auto pty = PtyTransport::open(folder / "gps0");
        ASSERT_TRUE(pty) << pty.error().message;
        EXPECT_EQ(fs::read_symlink(folder / "gps0"), (*pty)->terminal());
        EXPECT_EQ((*pty)->description(), (folder / "gps0").string() + " (pty)");
        Client client(folder / "gps0");
        EXPECT_TRUE((*pty)->line().connected);
    }
    EXPECT_FALSE(fs::is_symlink(folder / "gps0"));
    EXPECT_TRUE(fs::is_empty(folder / ""));
}

TEST(PtyLink, ReplacesALinkLeftBehindAndLeavesAForeignOne) {
    const test::TemporaryFolder folder;
    fs::create_symlink("/dev/pts/no-longer-there", folder / "gps0");
    auto pty = PtyTransport::open(folder / "gps0");
    ASSERT_TRUE(pty) << pty.error().message;
    EXPECT_EQ(fs::read_symlink(folder / "gps0"), (*pty)->terminal());
    fs::remove(folder / "gps0");
    fs::create_symlink("/dev/pts/of-another-program", folder / "gps0");
    pty->reset();
    EXPECT_EQ(fs::read_symlink(folder / "gps0"), "/dev/pts/of-another-program");
}

TEST(PtyLink, IsNotTakenFromATerminalThatLives) {
    const test::TemporaryFolder folder;
    auto first = PtyTransport::open(folder / "gps0");
    ASSERT_TRUE(first) << first.error().message;
    fs::create_directory_symlink(folder / "", folder / "alias");
    for (const char* name : {"gps0", "alias/gps0"}) {
        const auto second = PtyTransport::open(folder / name);
        ASSERT_FALSE(second) << name;
        EXPECT_EQ(second.error().code, ErrorCode::outside);
        EXPECT_THAT(second.error().message, HasSubstr("gps0: a terminal of another run is published there"));
    }
    EXPECT_EQ(fs::read_symlink(folder / "gps0"), (*first)->terminal());
    EXPECT_TRUE(PtyTransport::open(folder / "gps1"));
    first->reset();
    EXPECT_TRUE(PtyTransport::open(folder / "gps0"));
}

TEST(PtyLink, IsTakenFromAProgramThatDied) {
    const test::TemporaryFolder folder;
    const pid_t child = ::fork();
    if (child == 0) {
        static_cast<void>(PtyTransport::open(folder / "gps0")->release());
        ::_exit(0);
    }
    ASSERT_EQ(::waitpid(child, nullptr, 0), child);
    ASSERT_TRUE(fs::is_symlink(folder / "gps0"));
    auto pty = PtyTransport::open(folder / "gps0");
    ASSERT_TRUE(pty) << pty.error().message;
    EXPECT_EQ(fs::read_symlink(folder / "gps0"), (*pty)->terminal());
}

TEST(PtyLink, RefusesOtherFilesAndMissingFolders) {
    const test::TemporaryFolder folder;
    std::ofstream(folder / "precious") << "data";
    const auto file = PtyTransport::open(folder / "precious");
    ASSERT_FALSE(file);
    EXPECT_EQ(file.error().code, ErrorCode::outside);
    EXPECT_THAT(file.error().message, HasSubstr("precious: is there already and is not a symbolic link"));
    EXPECT_EQ(fs::file_size(folder / "precious"), 4U);
    for (const char* target : {"precious", "/dev/ttyUSB7", "/no/such/file"}) {
        fs::create_symlink(target, folder / "kept");
        const auto link = PtyTransport::open(folder / "kept");
        ASSERT_FALSE(link) << target;
        EXPECT_EQ(link.error().code, ErrorCode::outside);
        EXPECT_THAT(link.error().message,
                    HasSubstr(std::string("kept: is a link to ") + target + ", which is no pseudo"));
        EXPECT_EQ(fs::read_symlink(folder / "kept"), target);
        fs::remove(folder / "kept");
    }
    const auto directory = PtyTransport::open(folder / "");
    EXPECT_FALSE(directory);
    const auto missing = PtyTransport::open(folder / "none/gps0");
    ASSERT_FALSE(missing);
    EXPECT_THAT(missing.error().message, HasSubstr("/none does not exist"));
    const auto unwritable = PtyTransport::open("/proc/gps0");
    ASSERT_FALSE(unwritable);
    EXPECT_THAT(unwritable.error().message, StartsWith("/proc/gps0: the link cannot be made: "));
    EXPECT_EQ(std::distance(fs::directory_iterator(folder / ""), {}), 1);
}

}  // namespace
}  // namespace skyloop
