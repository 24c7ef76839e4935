#include "wire/transport/usbip_session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace skyloop::inline wire {
namespace {

constexpr std::int64_t bus_bytes_per_ms = 19 * 64, ns_per_ms = 1'000'000;
// What the bus may catch up after a late look.
constexpr std::int64_t most_budget = 20 * bus_bytes_per_ms;
// Without a read; a terminal that is closed lets DTR fall.
constexpr std::int64_t silence_of_listener_ns = 5'000 * ns_per_ms, silence_with_dtr_ns = 30'000 * ns_per_ms;
constexpr std::size_t most_pending = 256;  // transfers; Linux has 16 each way and one for the line's state
// Of commands that are followed at one look: a client that floods must not hold the loop. Linux sends a dozen at most
// in the millisecond between two looks.
constexpr int most_commands = 256;
constexpr std::size_t most_received = 4096;     // as a terminal's driver holds
constexpr std::size_t most_output = 1U << 18U;  // bytes that the client leaves unread

}  // namespace

UsbipSession::UsbipSession(const UsbFace& face, UsbipDevice device) : device_(face), listed_(std::move(device)) {}

void UsbipSession::run(std::int64_t now_ns) {
    refill(now_ns);
    follow_commands();
    finish_out();
    finish_in();
    finish_notifications();
    follow_listening(now_ns);
}

bool UsbipSession::overwhelmed() const { return output_.size() >= most_output || out_bytes_ >= usbip_most_data; }

void UsbipSession::follow_commands() {
    for (int i = 0; i < most_commands && mistake_.empty() && !overwhelmed(); ++i) {
        auto parsed = parse_usbip_command(ByteSpan(heard_).subspan(parsed_));
        mistake_ = std::move(parsed.mistake);
        if (!parsed.message) break;
        parsed_ += parsed.size;
        const std::uint32_t device = std::visit([](const auto& command) { return command.device; }, *parsed.message);
        if (device != listed_.id()) {
            mistake_ = fmt::format("a command for device {:#x}; expected {:#x}", device, listed_.id());
            break;
        }
        std::visit([this](auto& command) { act(std::move(command)); }, *parsed.message);
    }
    heard_.erase(heard_.begin(), heard_.begin() + static_cast<std::ptrdiff_t>(parsed_));
    parsed_ = 0;
}

void UsbipSession::answer(const UsbipSubmit& submit, UsbipStatus status, std::uint32_t moved, ByteSpan data) {
    output_.add(usbip_submit_reply(submit, status, moved, data));
}

void UsbipSession::act(UsbipSubmit submit) {
    if (submit.endpoint == 0) return control(submit);
    const bool known = submit.to_host
                           ? submit.endpoint == CdcAcmDevice::data_in || submit.endpoint == CdcAcmDevice::notify_in
                           : submit.endpoint == CdcAcmDevice::data_out;
    if (!known || !device_.configured()) return answer(submit, UsbipStatus::stalled);
    // Waiting for room instead would keep its cancelling, and endpoint 0, from being heard.
    if (pending() >= most_pending) return answer(submit, UsbipStatus::no_memory);
    if (submit.endpoint == CdcAcmDevice::notify_in) {
        notify_.push_back(std::move(submit));
    } else if (submit.to_host) {
        listening_ = true;
        idle_since_.reset();
        in_.push_back(std::move(submit));
    } else {
        out_bytes_ += submit.data.size();
        out_.push_back(std::move(submit));
    }
}

void UsbipSession::control(const UsbipSubmit& submit) {
    if (submit.setup.to_host() != submit.to_host && submit.setup.length > 0)
        return answer(submit, UsbipStatus::stalled);
    const bool was_configured = device_.configured();
    auto reply = device_.control(submit.setup, submit.data);
    if (was_configured && !device_.configured()) stop_listening();
    if (!reply) return answer(submit, UsbipStatus::stalled);
    if (!submit.to_host) return answer(submit, UsbipStatus::success, submit.length);
    if (reply->size() > submit.length) reply->resize(submit.length);
    answer(submit, UsbipStatus::success, static_cast<std::uint32_t>(reply->size()), *reply);
}

// A transfer that has ended before is told by success; its own answer went ahead.
void UsbipSession::act(const UsbipUnlink& unlink) {
    UsbipStatus status = UsbipStatus::success;
    for (Queue* queue : {&out_, &in_, &notify_}) {
        const auto found =
            std::find_if(queue->begin(), queue->end(), [&](const auto& s) { return s.sequence == unlink.target; });
        if (found == queue->end()) continue;
        if (queue == &out_) out_bytes_ -= found->data.size();
        queue->erase(found);
        status = UsbipStatus::unlinked;
        // From now on the host counts as idle; when exactly, the next look tells.
        if (queue == &in_ && in_.empty()) idle_since_ = last_run_ns_;
        break;
    }
    output_.add(usbip_unlink_reply(unlink, status));
}

void UsbipSession::refill(std::int64_t now_ns) {
    const std::int64_t passed = now_ns - std::exchange(last_run_ns_, now_ns).value_or(now_ns);
    // Longer than it takes to fill the budget to its brim from the deepest debt counts no more.
    constexpr std::int64_t longest = 1000 * ns_per_ms;
    budget_ = std::min(most_budget, budget_ + std::min(passed, longest) * bus_bytes_per_ms / ns_per_ms);
}

// True when the queue's transfers have all stalled.
bool UsbipSession::finish_stalled(Queue& queue, std::uint8_t endpoint) {
    if (!device_.halted(endpoint) && device_.configured()) return false;
    for (const UsbipSubmit& submit : queue)
        answer(submit, UsbipStatus::stalled);
    queue.clear();
    return true;
}

void UsbipSession::finish_out() {
    if (finish_stalled(out_, CdcAcmDevice::data_out)) out_bytes_ = 0;
    while (!out_.empty() && received_.size() < most_received && budget_ >= 0) {
        const UsbipSubmit& submit = out_.front();
        received_.insert(received_.end(), submit.data.begin(), submit.data.end());
        budget_ -= static_cast<std::int64_t>(submit.data.size());
        out_bytes_ -= submit.data.size();
        answer(submit, UsbipStatus::success, submit.length);
        out_.pop_front();
    }
}

void UsbipSession::finish_in() {
    if (finish_stalled(in_, CdcAcmDevice::data_in)) return;
    while (!in_.empty() && !backlog_.empty() && budget_ > 0 && output_.size() < most_output) {
        const std::size_t count = std::min(
            {backlog_.size(), static_cast<std::size_t>(in_.front().length), static_cast<std::size_t>(budget_)});
        const auto end = backlog_.begin() + static_cast<std::ptrdiff_t>(count);
        const Bytes data(backlog_.begin(), end);
        backlog_.erase(backlog_.begin(), end);
        budget_ -= static_cast<std::int64_t>(count);
        answer(in_.front(), UsbipStatus::success, static_cast<std::uint32_t>(count), data);
        in_.pop_front();
    }
}

void UsbipSession::finish_notifications() {
    if (finish_stalled(notify_, CdcAcmDevice::notify_in) || notify_.empty()) return;
    auto notification = device_.take_notification();
    if (!notification) return;
    if (notification->size() > notify_.front().length) notification->resize(notify_.front().length);
    answer(notify_.front(), UsbipStatus::success, static_cast<std::uint32_t>(notification->size()), *notification);
    notify_.pop_front();
}

void UsbipSession::follow_listening(std::int64_t now_ns) {
    if (!listening_) return;
    const bool closing = dtr_seen_ && !device_.dtr();
    dtr_seen_ = dtr_seen_ || device_.dtr();
    if (!in_.empty()) return;
    // A reader that is slow has let its transfers end, and has yet to submit the next; one that reads now and then has
    // cancelled its last.
    const std::int64_t patience_ns = device_.dtr() ? silence_with_dtr_ns : silence_of_listener_ns;
    if (closing || (idle_since_ && now_ns - *idle_since_ >= patience_ns)) stop_listening();
}

// A next listener never reads what this one has left.
void UsbipSession::stop_listening() {
    listening_ = dtr_seen_ = false;
    idle_since_.reset();
    backlog_.clear();
}

std::size_t UsbipSession::put(ByteSpan bytes) {
    if (!listening_) return bytes.size();
    if (idle_since_) {
        // Who reads now and then wants what is new.
        backlog_.insert(backlog_.end(), bytes.begin(), bytes.end());
        if (backlog_.size() <= most_backlog) return bytes.size();
        backlog_.erase(backlog_.begin(), backlog_.end() - static_cast<std::ptrdiff_t>(most_backlog));
        device_.note_overrun();
        return bytes.size();
    }
    const std::size_t taken = std::min(bytes.size(), most_backlog - backlog_.size());
    backlog_.insert(backlog_.end(), bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(taken));
    if (taken < bytes.size()) device_.note_overrun();
    return taken;
}

}  // namespace skyloop::inline wire
