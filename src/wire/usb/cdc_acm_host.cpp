#include "detail/cdc_acm_host.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "base/core/threads.hpp"

namespace skyloop::inline wire {
namespace {

constexpr std::int64_t ms = 1'000'000, s = 1'000'000'000;  // ns
// PSTN 1.2, tables 13, 17 and 18.
constexpr std::uint8_t set_line_coding = 0x20, set_control_line_state = 0x22;
constexpr std::uint16_t dtr = 1, rts = 2;
constexpr std::size_t line_coding_size = 7;
constexpr std::uint8_t class_request = 0x21;  // to an interface (USB 2.0, table 9-2)

constexpr std::size_t in_size = 4096;   // bytes; whole packets of every speed, so that none is too long for it
constexpr std::size_t out_size = 4096;  // some 3.5 ms at full speed
constexpr unsigned answer_ms = 1000;    // for a request, and for data before it is said that none is taken
constexpr std::int64_t last_bytes = 200 * ms;
constexpr std::int64_t rest_after_error = 10 * ms;
constexpr int most_errors = 50;  // in a row: half a second in which the device did not answer
// What the device may hold beyond the count of bytes: a frame of USB full speed and one more where two clocks meet.
constexpr std::int64_t unknown_fifo = 2 * ms;

// PSTN 1.2, table 17: speed, stop bits (0: 1, 2: 2), parity (1: odd, 2: even), data bits.
std::array<std::uint8_t, line_coding_size> line_coding(const BridgeLine& line) {
    const auto byte = [&](int shift) { return static_cast<std::uint8_t>(line.baud >> shift & 0xff); };
    const std::uint8_t stop = line.format.stop_bits == 2 ? 2 : 0;
    const std::uint8_t parity = line.format.parity == Parity::none ? 0 : line.format.parity == Parity::odd ? 1 : 2;
    return {byte(0), byte(8), byte(16), byte(24), stop, parity, static_cast<std::uint8_t>(line.format.data_bits)};
}

}  // namespace

Result<std::unique_ptr<SerialBridge>> open_cdc_acm(const UsbAddress& address, const BridgeLine& line) {
    // A new session sees what is plugged in now, whether or not a udevd tells of changes.
    const auto context = open_usb();
    if (!context) return fail(context.error());
    const auto device = find_usb_device(*context, address);
    if (!device) return fail(device.error());
    auto host = CdcAcmHost::open(*context, *device, line);
    if (!host) return fail(host.error());
    return std::unique_ptr<SerialBridge>(std::move(*host));
}

Result<std::unique_ptr<CdcAcmHost>> CdcAcmHost::open(const UsbContext& context, const UsbDevice& device,
                                                     const BridgeLine& line) {
    const auto shape = cdc_acm_shape(device);
    if (!shape) return fail(shape.error());
    const auto handle = open_usb_device(context, device);
    if (!handle) return fail(handle.error());
    std::unique_ptr<CdcAcmHost> host(new CdcAcmHost(context, *handle, *shape, line));
    host->info_ = describe(device);
    host->name_ = fmt::format("USB device {} at {}", to_string(host->info_.ids), host->info_.port_path);
    if (const auto ready = host->set_up(); !ready) return fail(ready.error());
    with_signals_held_back([&host] { host->thread_ = std::thread([h = host.get()] { h->work(); }); });
    return host;
}

CdcAcmHost::CdcAcmHost(UsbContext context, UsbHandle handle, const CdcAcmShape& shape, const BridgeLine& line)
    : context_(std::move(context)), handle_(std::move(handle)), shape_(shape), line_(line), buffers_(line.baud) {
    const auto prepare = [this](Transfer& transfer, std::size_t size) {
        transfer.host = this;
        transfer.buffer.resize(size);
        transfer.transfer = libusb_alloc_transfer(0);
    };
    for (Transfer& transfer : in_)
        prepare(transfer, in_size);
    prepare(out_, out_size);
    prepare(coding_, LIBUSB_CONTROL_SETUP_SIZE + line_coding_size);
}

CdcAcmHost::~CdcAcmHost() {
    if (thread_.joinable()) {
        stop_ = true;
        wake();
        thread_.join();
    }
    if (!buffers_.gone() && shape_.control_interface && !claimed_.empty())
        (void)libusb_control_transfer(handle_.get(), class_request, set_control_line_state, 0,
                                      *shape_.control_interface, nullptr, 0, answer_ms);
    // The data interface first: the driver that takes the control interface back wants both.
    for (auto interface = claimed_.rbegin(); interface != claimed_.rend(); ++interface)
        (void)libusb_release_interface(handle_.get(), *interface);
    handle_.reset();  // forgets any transfer that never came back
    for (Transfer& transfer : in_)
        libusb_free_transfer(transfer.transfer);
    libusb_free_transfer(out_.transfer);
    libusb_free_transfer(coding_.transfer);
}

Result<void> CdcAcmHost::take(int interface) {
    const int result = libusb_claim_interface(handle_.get(), interface);
    if (result != LIBUSB_SUCCESS)
        return fail(ErrorCode::outside,
                    fmt::format("cannot take interface {} of {}: {}", interface, name_, usb_error_text(result)));
    claimed_.push_back(interface);
    return {};
}

Result<void> CdcAcmHost::set_up() {
    (void)libusb_set_auto_detach_kernel_driver(handle_.get(), 1);  // every Linux can
    if (shape_.control_interface)
        if (const auto taken = take(*shape_.control_interface); !taken) return taken;
    if (shape_.control_interface != shape_.data_interface)
        if (const auto taken = take(shape_.data_interface); !taken) return taken;
    if (!shape_.control_interface) {
        buffers_.tell(name_ + " has no CDC-ACM control interface; it is used as it is, and its speed cannot be set");
        return {};
    }
    auto coding = line_coding(line_);
    const auto ask = [this](std::uint8_t request, std::uint16_t value, std::uint8_t* data, std::size_t size) {
        return libusb_control_transfer(handle_.get(), class_request, request, value, *shape_.control_interface, data,
                                       static_cast<std::uint16_t>(size), answer_ms);
    };
    const int coded = ask(set_line_coding, 0, coding.data(), coding.size());
    if (coded == LIBUSB_ERROR_NO_DEVICE) return fail(ErrorCode::outside, name_ + ": " + usb_error_text(coded));
    if (coded < 0)
        buffers_.tell(fmt::format("{} does not take {} bit/s: {}", name_, line_.baud, usb_error_text(coded)));
    if (const int raised = ask(set_control_line_state, dtr | rts, nullptr, 0); raised < 0)
        buffers_.tell(fmt::format("{} does not take DTR and RTS: {}", name_, usb_error_text(raised)));
    return {};
}

void CdcAcmHost::wake() { libusb_interrupt_event_handler(context_.get()); }

std::size_t CdcAcmHost::write(ByteSpan bytes) {
    const std::size_t taken = buffers_.offer(bytes);
    if (taken > 0) wake();
    return taken;
}

Bytes CdcAcmHost::read() {
    Bytes bytes = buffers_.take_input();
    if (bytes.size() >= BridgeBuffers::most_input) wake();  // the device was held up
    return bytes;
}

void CdcAcmHost::set_baud(std::uint32_t baud) {
    buffers_.ask_speed(baud);
    wake();
}

void CdcAcmHost::work() {
    while (!buffers_.gone() && has_more_to_do()) {
        if (steady_clock_ns() >= rest_until_) {
            clear_stalls();
            ask_for_data();
            send_output();
        }
        handle_events();
    }
    end_transfers();
}

bool CdcAcmHost::has_more_to_do() {
    if (!stop_) return true;
    if (stop_asked_ == 0) stop_asked_ = steady_clock_ns();
    const bool waits = piece_ || out_.flying || coding_.flying || buffers_.output_waits();
    return waits && steady_clock_ns() < stop_asked_ + last_bytes;
}

void CdcAcmHost::ask_for_data() {
    if (in_stalled_) return;
    for (Transfer& transfer : in_) {
        if (transfer.flying || buffers_.input_full() || buffers_.gone()) continue;
        libusb_fill_bulk_transfer(transfer.transfer, handle_.get(), shape_.bulk_in, transfer.buffer.data(),
                                  static_cast<int>(transfer.buffer.size()), data_came, &transfer, 0);
        submit(transfer);
        if (!transfer.flying) return;
    }
}

void CdcAcmHost::send_output() {
    if (out_stalled_ || out_.flying || coding_.flying || buffers_.gone()) return;
    if (!piece_) piece_ = buffers_.next_output(out_size);
    if (!piece_) return;
    if (piece_->baud != line_.baud) {
        // The bytes of the old speed must have left the device's UART, which cannot be asked.
        if (steady_clock_ns() < busy_until_) return;
        line_.baud = piece_->baud;
        if (shape_.control_interface) return send_line_coding();
    }
    if (piece_->bytes.empty())
        piece_.reset();
    else
        send_piece();
}

void CdcAcmHost::send_piece() {
    std::copy(piece_->bytes.begin(), piece_->bytes.end(), out_.buffer.begin());
    libusb_fill_bulk_transfer(out_.transfer, handle_.get(), shape_.bulk_out, out_.buffer.data(),
                              static_cast<int>(piece_->bytes.size()), data_left, &out_, answer_ms);
    // A transfer of whole packets does not end by itself (USB 2.0, section 5.8.3).
    const bool whole_packets = piece_->bytes.size() % shape_.out_packet == 0;
    out_.transfer->flags = whole_packets ? static_cast<std::uint8_t>(LIBUSB_TRANSFER_ADD_ZERO_PACKET) : std::uint8_t{0};
    submit(out_);
}

void CdcAcmHost::send_line_coding() {
    const auto coding = line_coding(line_);
    libusb_fill_control_setup(coding_.buffer.data(), class_request, set_line_coding, 0, *shape_.control_interface,
                              line_coding_size);
    std::copy(coding.begin(), coding.end(), coding_.buffer.begin() + LIBUSB_CONTROL_SETUP_SIZE);
    libusb_fill_control_transfer(coding_.transfer, handle_.get(), coding_.buffer.data(), coding_done, &coding_,
                                 answer_ms);
    submit(coding_);
}

void CdcAcmHost::submit(Transfer& transfer) {
    const int result = libusb_submit_transfer(transfer.transfer);
    transfer.flying = result == LIBUSB_SUCCESS;
    if (result == LIBUSB_ERROR_NO_DEVICE) return lose();
    if (!transfer.flying) count_error(LIBUSB_TRANSFER_ERROR);
}

// A call to the kernel that waits for the device; this thread has the time.
void CdcAcmHost::clear_stalls() {
    const auto clear = [this](bool& stalled, std::uint8_t endpoint) {
        if (!std::exchange(stalled, false)) return;
        if (!std::exchange(told_stall_, true))
            buffers_.tell(fmt::format("{} stalled (endpoint {:#04x}); the stall was cleared", name_, endpoint));
        const int result = libusb_clear_halt(handle_.get(), endpoint);
        if (result == LIBUSB_ERROR_NO_DEVICE) return lose();
        count_error(LIBUSB_TRANSFER_STALL);  // one that stalls for ever is given up
    };
    const auto flying = [](const Transfer& transfer) { return transfer.flying; };
    // What is queued behind the one that met the stall must be gone first.
    for (const Transfer& transfer : in_)
        if (in_stalled_ && transfer.flying) (void)libusb_cancel_transfer(transfer.transfer);
    if (in_stalled_ && std::none_of(in_.begin(), in_.end(), flying)) clear(in_stalled_, shape_.bulk_in);
    if (out_stalled_ && !out_.flying) clear(out_stalled_, shape_.bulk_out);
}

void CdcAcmHost::handle_events() {
    const bool waits_for_line = piece_ && !out_.flying && !coding_.flying;
    const bool soon = rest_until_ > 0 || waits_for_line || stop_ || in_stalled_ || out_stalled_;
    timeval wait{0, soon ? 1000 : 200'000};
    if (rest_until_ > 0 && steady_clock_ns() >= rest_until_) rest_until_ = 0;
    (void)libusb_handle_events_timeout_completed(context_.get(), &wait, nullptr);
}

bool CdcAcmHost::any_flying() const {
    return out_.flying || coding_.flying ||
           std::any_of(in_.begin(), in_.end(), [](const Transfer& transfer) { return transfer.flying; });
}

void CdcAcmHost::end_transfers() {
    for (const Transfer& transfer : in_)
        if (transfer.flying) (void)libusb_cancel_transfer(transfer.transfer);
    if (out_.flying) (void)libusb_cancel_transfer(out_.transfer);
    if (coding_.flying) (void)libusb_cancel_transfer(coding_.transfer);
    const std::int64_t end = steady_clock_ns() + s;  // a kernel that does not give them back must not hold us
    while (any_flying() && steady_clock_ns() < end) {
        timeval wait{0, 10'000};
        (void)libusb_handle_events_timeout_completed(context_.get(), &wait, nullptr);
    }
}

void CdcAcmHost::count_error(int status) {
    rest_until_ = steady_clock_ns() + rest_after_error;
    if (++errors_ < most_errors) return;
    buffers_.tell(fmt::format("{} answers no more ({})", name_,
                              status == LIBUSB_TRANSFER_STALL ? "it stalls" : "transfers fail"));
    lose();
}

void CdcAcmHost::lose() { buffers_.set_gone(); }

void CdcAcmHost::data_came(libusb_transfer* transfer) {
    auto& self = *static_cast<Transfer*>(transfer->user_data);
    CdcAcmHost& host = *self.host;
    self.flying = false;
    if (transfer->actual_length > 0)
        host.buffers_.put_input(ByteSpan(self.buffer).first(static_cast<std::size_t>(transfer->actual_length)));
    switch (transfer->status) {
        case LIBUSB_TRANSFER_COMPLETED:
            host.errors_ = 0;
            if (!host.stop_) host.ask_for_data();
            break;
        case LIBUSB_TRANSFER_NO_DEVICE:
            host.lose();
            break;
        case LIBUSB_TRANSFER_STALL:
            host.in_stalled_ = true;
            break;
        case LIBUSB_TRANSFER_CANCELLED:
            break;
        default:
            host.count_error(transfer->status);
    }
}

void CdcAcmHost::data_left(libusb_transfer* transfer) {
    auto& self = *static_cast<Transfer*>(transfer->user_data);
    CdcAcmHost& host = *self.host;
    self.flying = false;
    const auto count = std::min(static_cast<std::size_t>(transfer->actual_length), host.piece_->bytes.size());
    host.piece_->bytes.erase(host.piece_->bytes.begin(),
                             host.piece_->bytes.begin() + static_cast<std::ptrdiff_t>(count));
    if (host.piece_->bytes.empty()) host.piece_.reset();
    const std::int64_t now = steady_clock_ns();
    if (count > 0) {
        host.errors_ = 0;
        host.told_no_data_ = false;
        host.busy_until_ =
            std::max(host.busy_until_, now + unknown_fifo) + static_cast<std::int64_t>(count) * host.line_.byte_ns();
    }
    if (transfer->status == LIBUSB_TRANSFER_NO_DEVICE) return host.lose();
    if (transfer->status == LIBUSB_TRANSFER_STALL) host.out_stalled_ = true;
    if (transfer->status == LIBUSB_TRANSFER_TIMED_OUT && !std::exchange(host.told_no_data_, true))
        host.buffers_.tell(
            fmt::format("{} has taken no data for {} ms; what does not fit is lost", host.name_, answer_ms));
    if (transfer->status == LIBUSB_TRANSFER_ERROR || transfer->status == LIBUSB_TRANSFER_OVERFLOW)
        host.count_error(transfer->status);
}

void CdcAcmHost::coding_done(libusb_transfer* transfer) {
    auto& self = *static_cast<Transfer*>(transfer->user_data);
    CdcAcmHost& host = *self.host;
    self.flying = false;
    if (transfer->status == LIBUSB_TRANSFER_NO_DEVICE) return host.lose();
    if (transfer->status == LIBUSB_TRANSFER_COMPLETED || transfer->status == LIBUSB_TRANSFER_CANCELLED) return;
    host.buffers_.tell(
        fmt::format("{} does not take {} bit/s: {}", host.name_, host.line_.baud,
                    transfer->status == LIBUSB_TRANSFER_STALL ? "the device refused (stall)" : "no answer in time"));
}

}  // namespace skyloop::inline wire
