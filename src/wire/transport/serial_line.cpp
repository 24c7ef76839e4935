#include "detail/serial_line.hpp"

#include <asm/ioctls.h>
#include <fmt/format.h>
#include <linux/serial.h>
#include <linux/tty_flags.h>
#include <sys/ioctl.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <ctime>
#include <fstream>

namespace skyloop::inline wire {
namespace {

constexpr std::int64_t ms_in_ns = 1'000'000;
constexpr std::int64_t last_bytes_patience_ns = 200 * ms_in_ns;
// An adapter that cannot be asked holds a packet for a frame of USB 2.0 full speed (section 5.2.1, 1 ms) on its way,
// and another where the two clocks meet.
constexpr std::int64_t unknown_fifo_ns = 2 * ms_in_ns;
constexpr int low_latency = ASYNC_LOW_LATENCY;
constexpr double speed_tolerance = 0.03;  // bytes arrive whole from 96 to 105 % (WIRES.md section 1)

// The device is not there any more, as reads and writes tell.
bool says_gone(int error) { return error == EIO || error == ENODEV || error == ENXIO || error == EBADF; }

}  // namespace

tl::unexpected<Error> SerialLine::refused(const std::string& what) const {
    return fail(ErrorCode::outside, fmt::format("serial {}: {}", device_.string(), what));
}

Result<std::unique_ptr<SerialLine>> SerialLine::open(std::shared_ptr<SerialSystem> system,
                                                     const std::filesystem::path& device, const SerialFormat& format,
                                                     std::uint32_t baud) {
    std::unique_ptr<SerialLine> line(new SerialLine(std::move(system), device, format));
    if (const auto taken = line->take(); !taken) return fail(taken.error());
    if (const auto ready = line->set_up(baud); !ready) return fail(ready.error());
    line->usb_ = usb_identity(*line->system_, device);
    return line;
}

Result<void> SerialLine::take() {
    file_ = FileDescriptor(system_->open(device_));
    if (!file_.open()) {
        if (errno == EBUSY) return refused("another program holds it (TIOCEXCL)");
        const std::string_view hint =
            errno == EACCES ? "; expected a user of the device's group, mostly dialout or uucp" : "";
        return refused(fmt::format("cannot be opened: {}{}", std::strerror(errno), hint));
    }
    termios2 present{};
    if (system_->control(file_.value(), TCGETS2, &present) != 0)
        return refused(fmt::format("is no serial line: {}", std::strerror(errno)));
    // The superuser opens what is held exclusively, too.
    int exclusive = 0;
    if (system_->control(file_.value(), TIOCGEXCL, &exclusive) == 0 && exclusive != 0)
        return refused("another program holds it (TIOCEXCL)");
    if (system_->lock(file_.value()) != 0)
        return refused(errno == EWOULDBLOCK ? "another program holds it (flock)"
                                            : fmt::format("cannot be locked: {}", std::strerror(errno)));
    before_ = present;
    (void)system_->control(file_.value(), TIOCEXCL, 0);
    return {};
}

Result<void> SerialLine::set_up(std::uint32_t baud) {
    termios2 settings = *before_;
    make_raw(settings);
    put_format(settings, format_);
    put_speed(settings, baud);
    if (system_->control(file_.value(), TCSETS2, &settings) != 0)
        return refused(fmt::format("does not take its settings: {}", std::strerror(errno)));
    if (const auto fast = set_speed(baud); !fast) return fast;
    // Nothing is under way yet: a driver that says otherwise says it always (ftdi_sio on adapters that answer with the
    // modem lines alone).
    unsigned status = 0;
    tells_empty_ = system_->control(file_.value(), TIOCSERGETLSR, &status) == 0 && (status & TIOCSER_TEMT) != 0;
    termios2 actual{};
    if (system_->control(file_.value(), TCGETS2, &actual) == 0 && !has_format(actual, format_))
        remark_ = "the driver has not taken the data bits, parity, stop bits or flow control that were asked for";
    // What came before is nobody's now.
    (void)system_->control(file_.value(), TCFLSH, TCIOFLUSH);
    int lines = format_.rtscts ? TIOCM_DTR : TIOCM_DTR | TIOCM_RTS;  // with RTS/CTS the driver moves RTS
    (void)system_->control(file_.value(), TIOCMBIS, &lines);         // a pseudo-terminal has none
    lower_latency();
    return {};
}

void SerialLine::lower_latency() {
    serial_struct uart{};
    if (system_->control(file_.value(), TIOCGSERIAL, &uart) == 0 && (uart.flags & low_latency) == 0) {
        const int before = uart.flags;
        uart.flags |= low_latency;
        if (system_->control(file_.value(), TIOCSSERIAL, &uart) == 0) flags_before_ = before;
    }
    lower_ftdi_timer();
}

// The adapter hands on what it hears when 62 bytes are there or its timer ends, 16 ms as delivered. ftdi_sio takes
// ASYNC_LOW_LATENCY for 1 ms; a kernel that did not leaves the file.
void SerialLine::lower_ftdi_timer() {
    const auto file = system_->sysfs() / "class" / "tty" / tty_name(*system_, device_) / "device" / "latency_timer";
    std::string before, after;
    if (std::ifstream in(file); !std::getline(in, before)) return;
    if (before != "1") {
        std::ofstream out(file);
        out << "1" << std::flush;
        if (std::ifstream in(file); std::getline(in, after) && after == "1") {
            timer_before_ = before;
            timer_file_ = file;
            return;
        }
        if (!remark_.empty()) remark_ += "; ";
        remark_ += fmt::format(
            "its latency timer stays at {} ms, as {} cannot be written: bytes from the client come "
            "up to so much late",
            before, file.string());
    }
}

void SerialLine::put_back() {
    const std::int64_t end = system_->now_ns() + last_bytes_patience_ns;
    while (!gone() && !drained() && system_->now_ns() < end) {
        constexpr timespec nap{0, ms_in_ns};
        ::nanosleep(&nap, nullptr);
    }
    if (gone()) return;
    // A close waits for bytes that cannot leave, for up to 30 s.
    if (!drained()) drop_output();
    if (serial_struct uart{}; flags_before_ && system_->control(file_.value(), TIOCGSERIAL, &uart) == 0) {
        uart.flags = *flags_before_;
        (void)system_->control(file_.value(), TIOCSSERIAL, &uart);
    }
    if (!timer_before_.empty()) std::ofstream(timer_file_) << timer_before_ << std::flush;
    (void)system_->control(file_.value(), TCSETS2, &*before_);
    (void)system_->control(file_.value(), TIOCNXCL, 0);
}

SerialLine::~SerialLine() {
    if (before_ && !gone_) put_back();
}

std::size_t SerialLine::write(ByteSpan bytes) {
    std::size_t taken = 0;
    while (taken < bytes.size()) {
        const std::ptrdiff_t count = system_->write(file_.value(), bytes.subspan(taken));
        if (count > 0) {
            taken += static_cast<std::size_t>(count);
        } else if (count == 0 || errno != EINTR) {
            gone_ = gone_ || (count < 0 && says_gone(errno));
            break;
        }
    }
    if (taken > 0) {
        empty_since_ns_.reset();
        busy_until_ns_ =
            std::max(busy_until_ns_, system_->now_ns()) + static_cast<std::int64_t>(taken) * character_ns();
    }
    return taken;
}

Bytes SerialLine::read() {
    constexpr std::size_t most = 65536;  // a client that writes without end must not hold us here
    Bytes all;
    std::array<std::uint8_t, 4096> piece;
    while (all.size() < most) {
        const std::ptrdiff_t count = system_->read(file_.value(), piece.data(), piece.size());
        if (count < 0 && errno == EINTR) continue;
        // None there is EAGAIN; an end of file is a hang-up.
        if (count <= 0) gone_ = gone_ || count == 0 || says_gone(errno);
        if (count <= 0) break;
        all.insert(all.end(), piece.begin(), piece.begin() + count);
    }
    return all;
}

bool SerialLine::gone() {
    gone_ = gone_ || system_->gone(file_.value());
    return gone_;
}

std::int64_t SerialLine::character_ns() const { return format_.byte_ns(baud_); }

bool SerialLine::drained() {
    const std::int64_t now = system_->now_ns();
    int queued = 0;
    unsigned status = 0;
    const bool in_buffer = system_->control(file_.value(), TIOCOUTQ, &queued) == 0 && queued > 0;
    const bool tells = tells_empty_ && system_->control(file_.value(), TIOCSERGETLSR, &status) == 0;
    if (in_buffer || now < busy_until_ns_ || (tells && (status & TIOCSER_TEMT) == 0)) {
        empty_since_ns_.reset();
        return false;
    }
    if (!empty_since_ns_) empty_since_ns_ = now;
    return now - *empty_since_ns_ >= character_ns() + (tells ? 0 : unknown_fifo_ns);
}

void SerialLine::drop_output() {
    (void)system_->control(file_.value(), TCFLSH, TCOFLUSH);
    busy_until_ns_ = 0;
}

Result<void> SerialLine::set_speed(std::uint32_t baud) {
    termios2 settings{};
    if (system_->control(file_.value(), TCGETS2, &settings) != 0)
        return refused(fmt::format("does not tell its settings: {}", std::strerror(errno)));
    put_speed(settings, baud);
    if (system_->control(file_.value(), TCSETS2, &settings) != 0 ||
        system_->control(file_.value(), TCGETS2, &settings) != 0)
        return refused(fmt::format("does not take {} bit/s: {}", baud, std::strerror(errno)));
    baud_ = settings.c_ospeed;
    // The driver writes back what its clock can do.
    if (std::abs(static_cast<double>(settings.c_ospeed) - baud) > speed_tolerance * baud)
        return refused(fmt::format("does not do {} bit/s: its nearest is {}", baud, settings.c_ospeed));
    return {};
}

std::optional<ModemLines> SerialLine::modem_lines() {
    int bits = 0;
    if (system_->control(file_.value(), TIOCMGET, &bits) != 0) return std::nullopt;
    return ModemLines{(bits & TIOCM_CTS) != 0, (bits & TIOCM_DSR) != 0, (bits & TIOCM_CAR) != 0,
                      (bits & TIOCM_RNG) != 0};
}

}  // namespace skyloop::inline wire
