/// One serial line that is open: taken for this program alone, set up, and given back as it was.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "base/core/file_descriptor.hpp"
#include "line_settings.hpp"

namespace skyloop::inline wire {

class SerialLine {
public:
    /// Locks the device (TIOCEXCL, flock), makes it raw with this format and speed, drops what it had heard before,
    /// asserts DTR and RTS, and asks the driver for low latency. Fails with `outside`; the sentence names the device.
    static Result<std::unique_ptr<SerialLine>> open(std::shared_ptr<SerialSystem> system,
                                                    const std::filesystem::path& device, const SerialFormat& format,
                                                    std::uint32_t baud);
    /// Waits up to 0.2 s for the last bytes, drops what is left and puts the old settings back.
    ~SerialLine();
    SerialLine(const SerialLine&) = delete;
    SerialLine& operator=(const SerialLine&) = delete;

    /// How many bytes the driver took. What tells that the device is gone sets gone().
    std::size_t write(ByteSpan bytes);
    Bytes read();
    /// Also asks the device.
    bool gone();
    /// Every byte has left the UART and the line has rested for a character: drivers report an empty buffer while the
    /// UART's FIFO still holds bytes (PL011, WIRES.md section 6). To be asked until it is so.
    bool drained();
    void drop_output();
    /// Fails with what was asked for and what the device has.
    Result<void> set_speed(std::uint32_t baud);
    std::optional<ModemLines> modem_lines();
    /// What is not as asked for, in sentences; empty: nothing.
    [[nodiscard]] const std::string& remark() const { return remark_; }
    [[nodiscard]] const std::filesystem::path& device() const { return device_; }
    /// As it was when the line was opened; nothing for what is not on USB.
    [[nodiscard]] const std::optional<UsbIdentity>& usb() const { return usb_; }

private:
    SerialLine(std::shared_ptr<SerialSystem> system, std::filesystem::path device, SerialFormat format)
        : system_(std::move(system)), device_(std::move(device)), format_(format) {}

    Result<void> take();
    Result<void> set_up(std::uint32_t baud);
    void lower_latency();
    void lower_ftdi_timer();
    void put_back();
    [[nodiscard]] std::int64_t character_ns() const;
    [[nodiscard]] tl::unexpected<Error> refused(const std::string& what) const;

    std::shared_ptr<SerialSystem> system_;
    std::filesystem::path device_;
    std::optional<UsbIdentity> usb_;
    SerialFormat format_;
    FileDescriptor file_;
    std::uint32_t baud_ = 0;
    std::optional<termios2> before_;
    std::optional<int> flags_before_;  // of serial_struct
    std::string timer_before_;         // of an FTDI adapter, as sysfs had it
    std::filesystem::path timer_file_;
    std::string remark_;
    bool gone_ = false;
    bool tells_empty_ = false;        // the driver knows when the last byte has left
    std::int64_t busy_until_ns_ = 0;  // by the count of bytes and the speed
    std::optional<std::int64_t> empty_since_ns_;
};

}  // namespace skyloop::inline wire
