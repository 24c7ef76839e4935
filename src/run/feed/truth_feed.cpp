// A feed of truth, and its thread.
#include "run/feed/truth_feed.hpp"

#include <fmt/format.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <tuple>
#include <utility>
#include <vector>

#include "base/core/threads.hpp"
#include "detail/feed_link.hpp"
#include "detail/feed_paths.hpp"

namespace skyloop::inline run {

namespace {

/// Waits for a source, lets it be heard, hands over what it says and answers it.
class FeedWorker {
public:
    /// @param gathers looks are a millisecond apart: a hundred senders then cost no more than one
    FeedWorker(FeedAddress address, FeedContext context, bool gathers, FeedDesk& desk);
    ~FeedWorker();
    FeedWorker(const FeedWorker&) = delete;
    FeedWorker& operator=(const FeedWorker&) = delete;

    Result<void> open();
    void start(const std::function<std::thread(std::function<void()>)>& thread);

    /// A step is done; from the loop. Waits only for another such call or for the thread to take a list.
    void post(const FeedStep& step, std::uint64_t bytes);
    [[nodiscard]] std::uint16_t port() const { return port_; }
    [[nodiscard]] std::string description() const;

private:
    void run();
    void wait();
    void answer_steps();

    FeedAddress address_;
    bool gathers_;
    FeedHearer hearer_;  // of the thread, once it runs
    std::unique_ptr<FeedLink> link_;
    std::uint16_t port_ = 0;
    FileDescriptor wake_;
    std::mutex mutex_;
    std::vector<std::pair<FeedStep, std::uint64_t>> done_;
    std::atomic<bool> stop_{false};
    std::thread thread_;
};

FeedContext told_of_wire(FeedContext context, FeedWire wire) {
    context.datagrams = wire == FeedWire::udp_listen || wire == FeedWire::udp_connect ||
                        wire == FeedWire::udp_request || wire == FeedWire::udp_relay;
    return context;
}

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

// The loop's side; the thread's is FeedWorker.
class ThreadedFeed final : public TruthFeed {
public:
    ThreadedFeed(FeedAddress address, const FeedSettings& settings)
        : paths_(settings, desk_),
          worker_(std::move(address), settings.context, settings.clock == ClockMode::realtime, desk_) {}

    Result<void> start(const std::function<std::thread(std::function<void()>)>& thread) {
        if (const auto opened = worker_.open(); !opened) return fail(opened.error());
        worker_.start(thread);
        return {};
    }

    std::shared_ptr<LivePath> path(const std::string& vehicle) override { return paths_.path(vehicle); }
    std::shared_ptr<LivePath> path(const std::string& vehicle, const LivePathSettings& settings) override {
        return paths_.path(vehicle, settings);
    }
    void wait_for_all() override { paths_.wait_for_all(); }
    void begin(GpsTime start, std::int64_t steady_ns) override { paths_.begin(start, steady_ns); }
    void set_run(GpsTime now, std::int64_t steady_ns) override { paths_.set_run(now, steady_ns); }

    std::vector<Command> pump() override {
        std::vector<Command> commands = paths_.take(steady_clock_ns());
        for (const FeedStep& step : paths_.steps_done_before())
            worker_.post(step, 0);
        return commands;
    }
    bool wait(std::chrono::nanoseconds longest) override { return paths_.any_left() || desk_.inbox.wait(longest); }
    [[nodiscard]] std::optional<GpsTime> horizon() const override { return paths_.horizon(); }
    void stepped(std::uint64_t bytes) override {
        std::vector<FeedStep> steps = paths_.steps_done();
        for (std::size_t i = 0; i < steps.size(); ++i)
            worker_.post(steps[i], i + 1 == steps.size() ? bytes : 0);
    }
    void skip_steps() override {
        for (const FeedStep& step : paths_.skip_steps())
            worker_.post(step, 0);
    }
    [[nodiscard]] bool is_waited_on() const override { return paths_.any_step(); }
    [[nodiscard]] bool ended() const override { return paths_.ended(); }
    [[nodiscard]] bool paused() const override { return paths_.paused(); }

    [[nodiscard]] FeedCounts counts() const override {
        const FeedTallies& t = desk_.tallies;
        return {t.messages,  t.bytes,      t.samples,           t.statements, t.refused,
                t.strangers, t.overflowed, t.dropped_by_kernel, t.restarts,   t.lost};
    }
    [[nodiscard]] const SourceClock& clock() const override { return paths_.clock(); }
    std::vector<std::string> take_news() override {
        std::vector<std::string> news = desk_.news.take();
        for (std::string& sentence : news)
            sentence.insert(0, description() + ": ");
        return news;
    }
    [[nodiscard]] std::string description() const override { return worker_.description(); }
    [[nodiscard]] std::uint16_t port() const override { return worker_.port(); }

private:
    FeedDesk desk_;
    FeedPaths paths_;
    FeedWorker worker_;  // last: its thread uses the others
};

}  // namespace

Result<std::unique_ptr<TruthFeed>> TruthFeed::open(const FeedAddress& address, const FeedSettings& settings) {
    if (!make_dialect(address.dialect, settings.context))
        return fail(ErrorCode::usage, fmt::format("{}: this version does not speak {}", address.text, address.dialect));
    auto feed = std::make_unique<ThreadedFeed>(address, settings);
    if (const auto started = feed->start(settings.thread); !started) return fail(started.error());
    return feed;
}

}  // namespace skyloop::inline run
