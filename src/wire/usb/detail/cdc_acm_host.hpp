/// One CDC-ACM device that is open, and the thread that talks to it.
#pragma once

#include <libusb-1.0/libusb.h>

#include <array>
#include <atomic>
#include <optional>
#include <thread>

#include "wire/usb/cdc_acm.hpp"
#include "wire/usb/serial_bridge.hpp"

namespace skyloop::inline wire {

/// All calls of libusb come from its thread, once it runs; the loop's side reaches the buffers alone.
///
/// Several transfers ask for data at a time, so that none is missed between two. One at a time brings data to the
/// device: after a stall or a timeout the rest goes out again, and no later bytes may have overtaken it. What waits
/// meanwhile is sent in one piece.
class CdcAcmHost : public SerialBridge {
public:
    static Result<std::unique_ptr<CdcAcmHost>> open(const UsbContext& context, const UsbDevice& device,
                                                    const BridgeLine& line);
    ~CdcAcmHost() override;
    CdcAcmHost(const CdcAcmHost&) = delete;
    CdcAcmHost& operator=(const CdcAcmHost&) = delete;

    std::size_t write(ByteSpan bytes) override;
    Bytes read() override;
    void set_baud(std::uint32_t baud) override;
    [[nodiscard]] bool gone() const override { return buffers_.gone(); }
    std::vector<std::string> take_news() override { return buffers_.take_news(); }
    [[nodiscard]] const UsbDeviceInfo& info() const override { return info_; }

private:
    using Nanoseconds = std::int64_t;
    struct Transfer {
        CdcAcmHost* host = nullptr;
        libusb_transfer* transfer = nullptr;
        Bytes buffer{};
        bool flying = false;
    };

    CdcAcmHost(UsbContext context, UsbHandle handle, const CdcAcmShape& shape, const BridgeLine& line);
    Result<void> take(int interface);
    Result<void> set_up();
    void wake();

    void work();
    bool has_more_to_do();
    void ask_for_data();
    void send_output();
    void send_piece();
    void send_line_coding();
    void submit(Transfer& transfer);
    void clear_stalls();
    void handle_events();
    void end_transfers();
    [[nodiscard]] bool any_flying() const;
    void count_error(int status);
    void lose();

    static void data_came(libusb_transfer* transfer);
    static void data_left(libusb_transfer* transfer);
    static void coding_done(libusb_transfer* transfer);

    UsbContext context_;
    UsbHandle handle_;
    CdcAcmShape shape_;
    BridgeLine line_;  // as the device has it
    UsbDeviceInfo info_{};
    std::string name_{};
    BridgeBuffers buffers_;
    std::vector<int> claimed_{};

    static constexpr std::size_t transfers_in = 4;
    std::array<Transfer, transfers_in> in_{};
    Transfer out_{};
    Transfer coding_{};
    std::optional<BridgeBuffers::Piece> piece_{};  // what leaves now, without what has left
    bool in_stalled_ = false, out_stalled_ = false;
    bool told_no_data_ = false, told_stall_ = false;
    int errors_ = 0;              // in a row
    Nanoseconds rest_until_ = 0;  // after an error
    Nanoseconds busy_until_ = 0;  // the line, by the count of bytes
    Nanoseconds stop_asked_ = 0;  // 0: not
    std::atomic<bool> stop_{false};
    std::thread thread_{};
};

}  // namespace skyloop::inline wire
