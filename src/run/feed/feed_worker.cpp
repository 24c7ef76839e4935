#include "detail/feed_worker.hpp"

#include <sys/eventfd.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <tuple>

#include "base/core/signals_held_back.hpp"
#include "base/core/steady_clock.hpp"

namespace skyloop {
namespace {

FeedContext told_of_wire(FeedContext context, FeedWire wire) {
    context.datagrams = wire == FeedWire::udp_listen || wire == FeedWire::udp_connect ||
                        wire == FeedWire::udp_request || wire == FeedWire::udp_relay;
    return context;
}

}  // namespace

FeedWorker::FeedWorker(FeedAddress address, FeedContext context, bool gathers, FeedDesk& desk)
    : address_(std::move(address)),
      gathers_(gathers),
      hearer_(address_.dialect, told_of_wire(std::move(context), address_.wire), desk) {}

FeedWorker::~FeedWorker() {
    stop_ = true;
    const std::uint64_t one = 1;
    if (wake_.open()) std::ignore = ::write(wake_.value(), &one, sizeof one);
    if (thread_.joinable()) thread_.join();
}

Result<void> FeedWorker::open() {
    const auto opened = [&]() -> Result<std::unique_ptr<FeedLink>> {
        switch (address_.wire) {
            case FeedWire::udp_listen:
            case FeedWire::udp_connect:
            case FeedWire::udp_request:
                return open_datagram_link(address_, hearer_);
            case FeedWire::tcp_listen:
            case FeedWire::tcp_connect:
                return open_stream_link(address_, hearer_);
            case FeedWire::serial:
                return open_serial_link(address_, hearer_);
            case FeedWire::udp_relay:
                return open_datagram_relay(address_, hearer_);
            case FeedWire::tcp_relay:
                break;
        }
        return open_stream_relay(address_, hearer_);
    };
    auto link = opened();
    if (!link) return fail(link.error().code, address_.text + ": " + link.error().message);
    link_ = std::move(*link);
    port_ = link_->port();
    wake_ = FileDescriptor(::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC));
    if (!wake_.open()) return fail(ErrorCode::outside, address_.text + ": " + std::strerror(errno));
    return {};
}

void FeedWorker::start(const std::function<std::thread(std::function<void()>)>& thread) {
    const auto work = [this] { run(); };
    with_signals_held_back([&] { thread_ = thread ? thread(work) : std::thread(work); });
}

void FeedWorker::run() {
    constexpr std::int64_t second_ns = 1'000'000'000;
    constexpr std::chrono::milliseconds distance{1};
    std::int64_t speak_ns = steady_clock_ns();
    while (!stop_) {
        const std::int64_t now_ns = steady_clock_ns();
        const bool any = link_->serve(now_ns);
        hearer_.flush();
        answer_steps();
        if (now_ns >= speak_ns) {
            link_->speak(now_ns);
            speak_ns = now_ns + second_ns;
        }
        // Times of arrival are the kernel's, so gathering costs no truth, only a millisecond of its age.
        if (any && gathers_ && !link_->in_haste()) std::this_thread::sleep_for(distance);
        wait();
    }
}

void FeedWorker::wait() {
    std::vector<pollfd> waits{{wake_.value(), POLLIN, 0}};
    link_->add_waits(waits);
    ::poll(waits.data(), waits.size(), link_->longest_wait_ms());
    std::uint64_t count = 0;
    if (waits[0].revents != 0) std::ignore = ::read(wake_.value(), &count, sizeof count);
}

void FeedWorker::post(const FeedStep& step, std::uint64_t bytes) {
    {
        const std::lock_guard lock(mutex_);
        done_.emplace_back(step, bytes);
    }
    const std::uint64_t one = 1;
    std::ignore = ::write(wake_.value(), &one, sizeof one);
}

void FeedWorker::answer_steps() {
    std::vector<std::pair<FeedStep, std::uint64_t>> done;
    {
        const std::lock_guard lock(mutex_);
        done.swap(done_);
    }
    for (const auto& [step, bytes] : done)
        link_->answer(step.speaker, hearer_.stepped(step.speaker, step.until, bytes));
}

std::string FeedWorker::description() const {
    if (address_.wire == FeedWire::serial) return address_.text;
    const std::string scheme = address_.text.substr(0, address_.text.find(':'));
    if (address_.wire == FeedWire::udp_request)
        return scheme + ":" + shown_address({address_.host, address_.port}) + " (own port " + std::to_string(port_) +
               ")";
    const std::string here = shown_address({address_.host, port_ != 0 ? port_ : address_.port});
    if (address_.to_host.empty()) return scheme + ":" + here;
    return scheme + ":" + here + "," + shown_address({address_.to_host, address_.to_port});
}

}  // namespace skyloop
