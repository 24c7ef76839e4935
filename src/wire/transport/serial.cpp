#include "wire/transport/serial.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "detail/line_settings.hpp"
#include "detail/serial_line.hpp"

namespace skyloop::inline wire {
namespace {

constexpr std::int64_t drain_patience_ns = 1'000'000'000;
constexpr std::uint32_t speed_of_no_speed = 115200;  // for a port that has none, such as a receiver's USB
// As a terminal's driver holds. Speed changes take milliseconds, in which a fast line sends some hundred bytes.
constexpr std::size_t most_waiting = 4096;

struct AddressText {
    std::string_view device;
    std::optional<std::string_view> baud;
    std::optional<std::string_view> options;
};

// A comma or an "@" in a folder's name belongs to the path.
AddressText split_address(std::string_view text) {
    AddressText parts{text, std::nullopt, std::nullopt};
    const std::size_t slash = text.rfind('/');
    const std::size_t name = slash == std::string_view::npos ? 0 : slash + 1;
    if (const std::size_t comma = text.find(',', name); comma != std::string_view::npos) {
        parts.options = text.substr(comma + 1);
        parts.device = text.substr(0, comma);
    }
    if (const std::size_t at = parts.device.rfind('@'); at != std::string_view::npos && at >= name) {
        parts.baud = parts.device.substr(at + 1);
        parts.device = parts.device.substr(0, at);
    }
    return parts;
}

}  // namespace

Result<SerialAddress> parse_serial_address(std::string_view text) {
    const auto refused = [&](const std::string& what) {
        return fail(ErrorCode::usage, fmt::format("line '{}': {}; expected DEVICE[@BAUD][,8N1][,rtscts], BAUD {} to "
                                                  "{}, the format 7 or 8, N, E or O, 1 or 2",
                                                  text, what, lowest_baud, highest_baud));
    };
    const AddressText parts = split_address(text);
    SerialAddress address;
    address.device = parts.device;
    if (address.device.filename().empty()) return refused("the device is missing");
    if (parts.baud) {
        address.baud = read_baud(*parts.baud);
        if (!address.baud) return refused(fmt::format("the speed '{}' is not understood", *parts.baud));
    }
    if (parts.options)
        if (const std::string wrong = read_line_options(*parts.options, address.format); !wrong.empty())
            return refused(wrong);
    return address;
}

std::filesystem::path place_of_device(const std::filesystem::path& device) {
    std::error_code unknown;
    std::filesystem::path place = std::filesystem::weakly_canonical(device, unknown);
    return unknown ? device : place;
}

SerialTransport::SerialTransport(SerialAddress address, std::shared_ptr<SerialSystem> system)
    : address_(std::move(address)), system_(std::move(system)), baud_(address_.baud.value_or(speed_of_no_speed)) {}

SerialTransport::~SerialTransport() = default;

Result<std::unique_ptr<SerialTransport>> SerialTransport::open(const SerialAddress& address,
                                                               std::shared_ptr<SerialSystem> system) {
    std::unique_ptr<SerialTransport> serial(new SerialTransport(address, std::move(system)));
    auto line = SerialLine::open(serial->system_, address.device, address.format, serial->baud_);
    if (!line) return fail(line.error());
    serial->adopt(std::move(*line));
    return serial;
}

void SerialTransport::adopt(std::unique_ptr<SerialLine> line) {
    line_ = std::move(line);
    if (line_->usb()) identity_ = line_->usb();
    if (!line_->remark().empty()) news_.push_back(fmt::format("{}: {}", line_->device().string(), line_->remark()));
}

void SerialTransport::follow() {
    if (!line_) return search();
    if (line_->gone()) return lose();
    send_waiting();
}

// What waited is lost as on any wire without its end. A close may take its time, and so is none of the loop's.
void SerialTransport::lose() {
    news_.push_back(fmt::format("{} is gone; it is looked for every 0.5 s", line_->device().string()));
    if (!waiting_.empty()) baud_ = waiting_.back().baud;
    waiting_.clear();
    waiting_bytes_ = 0;
    search_.begin(std::move(line_), system_->now_ns(), [system = system_, identity = identity_] {
        return identity ? ports_beside(*system, *identity) : Search::Ports{};
    });
}

void SerialTransport::search() {
    auto found = search_.look(system_->now_ns(), [this](const Search::Ports& beside) {
        return [system = system_, address = address_, identity = identity_, beside, baud = baud_] {
            Search::Attempt attempt;
            for (const std::filesystem::path& place : places_to_look(*system, address.device, identity, beside)) {
                auto line = SerialLine::open(system, place, address.format, baud);
                if (line) return Search::Attempt{std::move(*line), baud, {}};
                attempt.trouble = line.error().message;
            }
            return attempt;
        };
    });
    if (!found) return;
    if (!found->end) return news_.push_back(std::move(found->trouble));
    news_.push_back(fmt::format("{} is back, as {}", address_.device.string(), found->end->device().string()));
    adopt(std::move(found->end));
    // The receiver's speed may have changed while the line was opened.
    ask_speed(std::exchange(baud_, found->baud));
}

void SerialTransport::set_receiver_baud(std::uint32_t baud) {
    const std::optional<std::uint32_t> before = std::exchange(told_baud_, baud);
    // Until the receiver's speed changes the line has the one that was asked for.
    if (address_.baud && (!before || *before == baud)) return;
    ask_speed(baud);
}

void SerialTransport::ask_speed(std::uint32_t baud) {
    const std::uint32_t last = waiting_.empty() ? baud_ : waiting_.back().baud;
    if (baud == last) return;
    if (!line_) {
        baud_ = baud;
        return;
    }
    if (waiting_.empty()) change_asked_ns_ = system_->now_ns();
    if (!waiting_.empty() && waiting_.back().bytes.empty())
        waiting_.back().baud = baud;
    else
        waiting_.push_back({baud, {}});
    send_waiting();
}

// Sends segment by segment; before each change of speed the line must have carried all that came before.
void SerialTransport::send_waiting() {
    while (line_ && !waiting_.empty()) {
        Segment& segment = waiting_.front();
        if (segment.baud != baud_) {
            if (!change_speed(segment.baud)) return;
        }
        const std::size_t taken = line_->write(segment.bytes);
        waiting_bytes_ -= taken;
        segment.bytes.erase(segment.bytes.begin(), segment.bytes.begin() + static_cast<std::ptrdiff_t>(taken));
        if (!segment.bytes.empty()) return;
        waiting_.pop_front();
        change_asked_ns_ = system_->now_ns();
    }
}

// False while the line still carries bytes of the old speed.
bool SerialTransport::change_speed(std::uint32_t baud) {
    if (!line_->drained()) {
        if (system_->now_ns() - change_asked_ns_ < drain_patience_ns) return false;
        line_->drop_output();
        news_.push_back(fmt::format("{} did not send its last bytes at {} bit/s within 1 s; they are lost",
                                    line_->device().string(), baud_));
    }
    // A speed that the device does not have is told of once; the receiver has it nevertheless.
    if (const auto changed = line_->set_speed(baud); !changed && !line_->gone())
        news_.push_back(changed.error().message);
    baud_ = baud;
    return true;
}

std::size_t SerialTransport::put(ByteSpan bytes) {
    const std::size_t taken = line_->write(bytes);
    if (line_->gone()) return bytes.size();  // and with it the bytes
    if (taken < bytes.size() && address_.format.rtscts)
        if (const auto lines = line_->modem_lines(); lines && !lines->cts) held_back_ += bytes.size() - taken;
    return taken;
}

std::size_t SerialTransport::write(ByteSpan bytes) {
    follow();
    if (!line_) return bytes.size();
    if (waiting_.empty()) return put(bytes);
    const std::size_t taken = std::min(bytes.size(), most_waiting - std::min(most_waiting, waiting_bytes_));
    const ByteSpan accepted = bytes.first(taken);
    Bytes& last = waiting_.back().bytes;
    last.insert(last.end(), accepted.begin(), accepted.end());
    waiting_bytes_ += taken;
    return taken;
}

Bytes SerialTransport::read() {
    follow();
    return line_ ? line_->read() : Bytes{};
}

LineState SerialTransport::line() {
    follow();
    return {line_ != nullptr, std::nullopt};
}

std::optional<ModemLines> SerialTransport::modem_lines() { return line_ ? line_->modem_lines() : std::nullopt; }

std::vector<std::string> SerialTransport::take_news() { return std::exchange(news_, {}); }

std::string SerialTransport::notice() const {
    if (held_back_ == 0) return {};
    return fmt::format("{}: {} bytes were lost while the other end held CTS low", description(), held_back_);
}

std::string SerialTransport::description() const { return address_.device.string() + " (serial)"; }

}  // namespace skyloop::inline wire
