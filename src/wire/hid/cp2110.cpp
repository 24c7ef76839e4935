#include "wire/hid/cp2110.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <optional>
#include <thread>
#include <utility>

#include "base/core/threads.hpp"
#include "wire/usb/serial_bridge.hpp"

namespace skyloop::inline wire {
namespace {

// AN434: the reports and what they hold.
constexpr std::uint8_t uart_enable = 0x41, uart_status = 0x42, purge_fifos = 0x43, uart_config = 0x50;
constexpr std::uint8_t enabled = 1, both_fifos = 3;
constexpr std::size_t uart_enable_size = 2, uart_status_size = 7, uart_config_size = 9;
constexpr std::size_t most_data = 63;                        // of a report, whose id is the number of bytes
constexpr std::uint32_t slowest = 300, fastest = 1'000'000;  // bit/s
// Of the 480 bytes of its FIFO; with more it holds up the report after them, and the thread with it.
constexpr std::int64_t most_in_fifo = 256;
constexpr int reports_a_turn = 8;  // to the device before it is listened to again
constexpr std::int64_t cp2110_last_bytes_ns = 200'000'000;
constexpr auto turn = std::chrono::milliseconds(1);

class Cp2110 : public SerialBridge {
public:
    Cp2110(HidDevice device, const BridgeLine& line) : device_(std::move(device)), line_(line), buffers_(line.baud) {
        name_ = fmt::format("HID device {} at {}", to_string(device_.info().ids), device_.info().port_path);
    }
    ~Cp2110() override {
        stop_ = true;
        if (thread_.joinable()) thread_.join();
        if (!buffers_.gone()) put_back();
    }
    Cp2110(const Cp2110&) = delete;
    Cp2110& operator=(const Cp2110&) = delete;

    Result<void> start();
    std::size_t write(ByteSpan bytes) override { return buffers_.offer(bytes); }
    Bytes read() override { return buffers_.take_input(); }
    void set_baud(std::uint32_t baud) override { buffers_.ask_speed(baud); }
    [[nodiscard]] bool gone() const override { return buffers_.gone(); }
    std::vector<std::string> take_news() override { return buffers_.take_news(); }
    [[nodiscard]] const UsbDeviceInfo& info() const override { return device_.info(); }

private:
    void work();
    bool has_more_to_do();
    void send_output();
    void send_report();
    void change_speed();
    void warn_of_speed();
    bool line_is_empty();
    void listen();
    void put_back();
    bool answers() { return device_.get_feature(uart_enable, uart_enable_size).has_value(); }

    HidDevice device_;
    BridgeLine line_;
    std::string name_{};
    BridgeBuffers buffers_;
    Bytes config_before_{}, enable_before_{};
    std::optional<BridgeBuffers::Piece> piece_{};
    std::int64_t busy_until_ = 0;  // the line, by the count of bytes
    std::int64_t stop_asked_ = 0;  // 0: not
    bool told_no_data_ = false;
    std::atomic<bool> stop_{false};
    std::thread thread_{};
};

Result<void> Cp2110::start() {
    if (auto before = device_.get_feature(uart_config, uart_config_size)) config_before_ = std::move(*before);
    if (auto before = device_.get_feature(uart_enable, uart_enable_size)) enable_before_ = std::move(*before);
    warn_of_speed();
    for (const Bytes& report : {cp2110_uart_config(line_), Bytes{uart_enable, enabled}, Bytes{purge_fifos, both_fifos}})
        if (auto sent = device_.send_feature(report); !sent) return fail(std::move(sent.error()));
    with_signals_held_back([this] { thread_ = std::thread([this] { work(); }); });
    return {};
}

void Cp2110::put_back() {
    if (config_before_.size() == uart_config_size) (void)device_.send_feature(config_before_);
    if (enable_before_.size() == uart_enable_size) (void)device_.send_feature(enable_before_);
}

void Cp2110::work() {
    while (!buffers_.gone() && has_more_to_do()) {
        send_output();
        listen();
    }
}

bool Cp2110::has_more_to_do() {
    if (!stop_) return true;
    if (stop_asked_ == 0) stop_asked_ = steady_clock_ns();
    const bool waits = piece_ || buffers_.output_waits() || !line_is_empty();
    return waits && steady_clock_ns() < stop_asked_ + cp2110_last_bytes_ns;
}

void Cp2110::send_output() {
    for (int i = 0; i < reports_a_turn && !buffers_.gone(); ++i) {
        if (!piece_) piece_ = buffers_.next_output(most_data);
        if (!piece_) return;
        if (piece_->baud != line_.baud) {
            if (!line_is_empty()) return;
            change_speed();
        }
        if (busy_until_ - steady_clock_ns() > most_in_fifo * line_.byte_ns()) return;
        send_report();
    }
}

void Cp2110::send_report() {
    if (piece_->bytes.empty()) return piece_.reset();
    Bytes report{static_cast<std::uint8_t>(piece_->bytes.size())};
    report.insert(report.end(), piece_->bytes.begin(), piece_->bytes.end());
    if (!device_.write(report)) {
        if (!answers()) return buffers_.set_gone();
        // Its FIFO is full for as long as the other end holds CTS low.
        if (!std::exchange(told_no_data_, true)) buffers_.tell(name_ + " takes no data; what does not fit is lost");
        return;
    }
    told_no_data_ = false;
    busy_until_ =
        std::max(busy_until_, steady_clock_ns()) + static_cast<std::int64_t>(piece_->bytes.size()) * line_.byte_ns();
    piece_.reset();
}

void Cp2110::change_speed() {
    line_.baud = piece_->baud;
    warn_of_speed();
    const auto sent = device_.send_feature(cp2110_uart_config(line_));
    if (sent) return;
    if (!answers()) return buffers_.set_gone();
    buffers_.tell(fmt::format("{} does not take {} bit/s", name_, line_.baud));
}

void Cp2110::warn_of_speed() {
    if (line_.baud < slowest || line_.baud > fastest)
        buffers_.tell(fmt::format("{} does not do {} bit/s; expected {} to {}", name_, line_.baud, slowest, fastest));
}

// By the count of bytes, then by its own word, then a character later: the FIFO is empty before the UART is.
bool Cp2110::line_is_empty() {
    if (steady_clock_ns() < busy_until_ + line_.byte_ns()) return false;
    const auto status = device_.get_feature(uart_status, uart_status_size);
    const bool holds = status && status->size() >= 3 && status->front() == uart_status &&
                       ((*status)[1] != 0 || (*status)[2] != 0);  // bytes in the transmit FIFO
    if (holds) busy_until_ = steady_clock_ns();
    return !holds;
}

void Cp2110::listen() {
    auto wait = turn;
    for (int i = 0; i < reports_a_turn && !buffers_.input_full(); ++i) {
        const auto report = device_.read(std::exchange(wait, std::chrono::milliseconds(0)));
        if (!report) return buffers_.set_gone();
        if (report->empty()) return;
        const std::size_t count = std::min<std::size_t>(report->front(), report->size() - 1);
        if (report->front() <= most_data) buffers_.put_input(ByteSpan(*report).subspan(1, count));
    }
    // Nobody reads: the device keeps what does not fit, as long as it can.
    if (buffers_.input_full()) std::this_thread::sleep_for(turn);
}

}  // namespace

Bytes cp2110_uart_config(const BridgeLine& line) {
    const auto byte = [&](int shift) { return static_cast<std::uint8_t>(line.baud >> shift & 0xff); };
    const std::uint8_t parity = line.format.parity == Parity::none ? 0 : line.format.parity == Parity::odd ? 1 : 2;
    const std::uint8_t flow = line.format.rtscts ? 1 : 0;
    const std::uint8_t stop = line.format.stop_bits == 2 ? 1 : 0;
    return {uart_config, byte(24), byte(16), byte(8),
            byte(0),     parity,   flow,     static_cast<std::uint8_t>(line.format.data_bits - 5),
            stop};
}

Result<std::unique_ptr<SerialBridge>> open_cp2110(HidDevice device, const BridgeLine& line) {
    auto bridge = std::make_unique<Cp2110>(std::move(device), line);
    if (auto started = bridge->start(); !started) return fail(std::move(started.error()));
    return std::unique_ptr<SerialBridge>(std::move(bridge));
}

Result<std::unique_ptr<SerialBridge>> open_cp2110(const UsbAddress& address, const BridgeLine& line) {
    auto device = HidDevice::open(address);
    if (!device) return fail(std::move(device.error()));
    return open_cp2110(std::move(*device), line);
}

}  // namespace skyloop::inline wire
