/// Serial lines without a machine that has them: pseudo-terminals, played drivers, played folders of devices.
#pragma once

#include <asm/ioctls.h>
#include <asm/termbits.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <linux/serial.h>
#include <poll.h>
#include <stdlib.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>

#include "base/core/file_descriptor.hpp"
#include "temporary_folder.hpp"
#include "wire/transport/serial.hpp"

namespace skyloop::test {

namespace fs = std::filesystem;

constexpr std::int64_t ms = 1'000'000;

/// The other end of a line: the master side of a pseudo-terminal, whose other side is a terminal line like any other.
class FarEnd {
public:
    FarEnd() : master_(::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC)) {
        std::array<char, 64> name{};
        EXPECT_EQ(::grantpt(master_.value()) | ::unlockpt(master_.value()), 0);
        EXPECT_EQ(::ptsname_r(master_.value(), name.data(), name.size()), 0);
        device_ = name.data();
    }
    [[nodiscard]] const fs::path& device() const { return device_; }
    [[nodiscard]] termios2 settings() const {
        termios2 settings{};
        EXPECT_EQ(::ioctl(master_.value(), TCGETS2, &settings), 0);
        return settings;
    }
    [[nodiscard]] std::uint32_t speed() const { return settings().c_ospeed; }
    void write(std::string_view text) {
        EXPECT_EQ(::write(master_.value(), text.data(), text.size()), static_cast<ssize_t>(text.size()));
    }
    // All that has arrived; waits up to two seconds until it is `least` bytes.
    std::string read(std::size_t least = 0) {
        std::string all;
        std::array<char, 4096> piece{};
        for (;;) {
            const ssize_t count = ::read(master_.value(), piece.data(), piece.size());
            if (count > 0) all.append(piece.data(), static_cast<std::size_t>(count));
            if (count > 0) continue;
            pollfd ready{master_.value(), POLLIN, 0};
            if (all.size() >= least || ::poll(&ready, 1, 2000) <= 0) return all;
        }
    }

private:
    FileDescriptor master_;
    fs::path device_;
};

/// Where a played system has its folders.
struct Roots {
    fs::path devices = "/dev", sysfs = "/sys";
};

/// What no pseudo-terminal can play: a UART with a FIFO, modem lines, drivers that refuse, a clock that a test moves.
class PlayedSystem : public SerialSystem {
public:
    explicit PlayedSystem(Roots roots = {}) : roots_(std::move(roots)) {}
    std::atomic<std::int64_t> now{1'000'000'000};
    std::atomic<std::int64_t> step{0};  // by which each look at the clock moves it
    std::atomic<bool> fifo_empty{true};
    bool tells_fifo = false;
    std::atomic<int> queued{0};
    int modem = TIOCM_CTS;
    bool has_modem_lines = false;
    int uart_flags = 0;
    bool full = false;                   // takes no bytes
    std::uint32_t fastest = 12'000'000;  // what its clock can do
    bool exclusive = false;              // for another program
    int flushed = 0;
    mutable std::atomic<int> asked_for_sysfs{0};
    termios2 asked{};  // the first time

    using SerialSystem::control;
    int control(int descriptor, unsigned long request, void* argument) override {
        if (request == TIOCOUTQ) return give(argument, queued.load());
        if (request == TIOCGEXCL) return give(argument, exclusive ? 1 : 0);
        if (request == TIOCSERGETLSR && tells_fifo) return give(argument, fifo_empty ? TIOCSER_TEMT : 0);
        if (request == TIOCMGET && has_modem_lines) return give(argument, modem);
        if (request == TIOCMBIS && has_modem_lines) {
            modem |= *static_cast<int*>(argument);
            return 0;
        }
        if (request == TIOCGSERIAL) {
            *static_cast<serial_struct*>(argument) = {};
            static_cast<serial_struct*>(argument)->flags = uart_flags;
            return 0;
        }
        if (request == TIOCSSERIAL) {
            uart_flags = static_cast<serial_struct*>(argument)->flags;
            return 0;
        }
        if (request == TCSETS2) {
            auto& settings = *static_cast<termios2*>(argument);
            if (asked.c_cflag == 0) asked = settings;
            if (settings.c_ospeed > fastest)
                settings.c_cflag = (settings.c_cflag & ~static_cast<tcflag_t>(CBAUD)) | BOTHER;
            settings.c_ospeed = settings.c_ispeed = std::min(settings.c_ospeed, fastest);
        }
        return SerialSystem::control(descriptor, request, argument);
    }
    int control(int descriptor, unsigned long request, int argument) override {
        if (request == TCFLSH && argument == TCOFLUSH) ++flushed, queued = 0;
        return SerialSystem::control(descriptor, request, argument);
    }
    std::ptrdiff_t write(int descriptor, ByteSpan bytes) override {
        if (!full) return SerialSystem::write(descriptor, bytes);
        errno = EAGAIN;
        return -1;
    }
    std::int64_t now_ns() override { return now += step; }
    [[nodiscard]] fs::path devices() const override { return roots_.devices; }
    [[nodiscard]] fs::path sysfs() const override {
        ++asked_for_sysfs;
        return roots_.sysfs;
    }

private:
    static int give(void* where, int value) {
        *static_cast<int*>(where) = value;
        return 0;
    }
    Roots roots_;
};

/// A line over a played system; time runs again at its end, since a close waits for the last bytes.
class Bench {
public:
    explicit Bench(const std::string& options = "", std::shared_ptr<PlayedSystem> played = nullptr,
                   const fs::path& device = {})
        : system(played ? std::move(played) : std::make_shared<PlayedSystem>()) {
        const std::string name = device.empty() ? far.device().string() : device.string();
        auto opened = SerialTransport::open(parse_serial_address(name + options).value(), system);
        EXPECT_TRUE(opened) << opened.error().message;
        if (opened) wire = std::move(*opened);
    }
    ~Bench() { system->step = ms; }
    Bench(const Bench&) = delete;
    Bench& operator=(const Bench&) = delete;
    void pass(std::int64_t ns) {
        system->now += ns;
        wire->line();
    }
    // Looks, as the loop does, until the search in its other thread has come to an end.
    bool connected_within_looks() {
        for (int i = 0; i < 2000; ++i) {
            if (wire->line().connected) return true;
            system->now += 10 * ms;
            ::usleep(1000);
        }
        return false;
    }
    // Until the search in its other thread has looked several times, and so long since noted what was there at the
    // loss.
    void look_for_a_while() {
        constexpr int of_several_looks = 100;
        const int before = system->asked_for_sysfs;
        for (int i = 0; i < 5000 && system->asked_for_sysfs < before + of_several_looks; ++i, ::usleep(1000))
            pass(600 * ms);
    }

    FarEnd far;
    std::shared_ptr<PlayedSystem> system;
    std::unique_ptr<SerialTransport> wire;
};

/// The folders of devices as the kernel shows them, with USB adapters whose lines are pseudo-terminals.
class UsbTree {
public:
    UsbTree() {
        fs::create_directories(roots.devices);
        fs::create_directories(roots.sysfs / "class" / "tty");
    }
    void plug_in(const std::string& tty, const std::string& port, const std::string& serial, const FarEnd& far) {
        const fs::path device = roots.sysfs / "devices" / "usb1" / port;
        const fs::path line = device / (port + ":1.0") / tty;
        fs::create_directories(line / "tty" / tty);
        write(device / "idVendor", "0403");
        write(device / "idProduct", "6001");
        if (!serial.empty()) write(device / "serial", serial);
        fs::create_symlink(line, line / "tty" / tty / "device");
        fs::create_symlink(line / "tty" / tty, roots.sysfs / "class" / "tty" / tty);
        fs::create_symlink(far.device(), roots.devices / tty);
        latency_timer = line / "latency_timer";
    }
    void unplug(const std::string& tty, const std::string& port) {
        fs::remove(roots.devices / tty);
        fs::remove(roots.sysfs / "class" / "tty" / tty);
        fs::remove_all(roots.sysfs / "devices" / "usb1" / port);
    }
    static void write(const fs::path& file, const std::string& text) { std::ofstream(file) << text << "\n"; }

    TemporaryFolder folder;
    Roots roots{folder / "dev", folder / "sys"};
    fs::path latency_timer;
};

}  // namespace skyloop::test
