#include "run/feed/truth_feed.hpp"

#include <fmt/format.h>

#include <utility>

#include "base/core/steady_clock.hpp"
#include "detail/feed_paths.hpp"
#include "detail/feed_worker.hpp"

namespace skyloop {

// The loop's side; the thread's is FeedWorker.
class TruthFeed::Impl {
public:
    Impl(FeedAddress address, const FeedSettings& settings)
        : paths_(settings, desk_),
          worker_(std::move(address), settings.context, settings.clock == ClockMode::realtime, desk_) {}

    FeedDesk desk_;
    FeedPaths paths_;
    FeedWorker worker_;  // last: its thread uses the others
};

TruthFeed::TruthFeed(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
TruthFeed::~TruthFeed() = default;

Result<std::unique_ptr<TruthFeed>> TruthFeed::open(const FeedAddress& address, const FeedSettings& settings) {
    if (!make_dialect(address.dialect, settings.context))
        return fail(ErrorCode::usage, fmt::format("{}: this version does not speak {}", address.text, address.dialect));
    auto impl = std::make_unique<Impl>(address, settings);
    if (const auto opened = impl->worker_.open(); !opened) return fail(opened.error());
    impl->worker_.start(settings.thread);
    return std::unique_ptr<TruthFeed>(new TruthFeed(std::move(impl)));
}

std::shared_ptr<LivePath> TruthFeed::path(const std::string& vehicle) { return impl_->paths_.path(vehicle); }

std::shared_ptr<LivePath> TruthFeed::path(const std::string& vehicle, const LivePathSettings& settings) {
    return impl_->paths_.path(vehicle, settings);
}

void TruthFeed::wait_for_all() { impl_->paths_.wait_for_all(); }

void TruthFeed::begin(GpsTime start, std::int64_t steady_ns) { impl_->paths_.begin(start, steady_ns); }

void TruthFeed::set_run(GpsTime now, std::int64_t steady_ns) { impl_->paths_.set_run(now, steady_ns); }

std::vector<Command> TruthFeed::pump() {
    std::vector<Command> commands = impl_->paths_.take(steady_clock_ns());
    for (const FeedStep& step : impl_->paths_.steps_done_before())
        impl_->worker_.post(step, 0);
    return commands;
}

bool TruthFeed::wait(std::chrono::nanoseconds longest) {
    return impl_->paths_.any_left() || impl_->desk_.inbox.wait(longest);
}

std::optional<GpsTime> TruthFeed::horizon() const { return impl_->paths_.horizon(); }

void TruthFeed::stepped(std::uint64_t bytes) {
    std::vector<FeedStep> steps = impl_->paths_.steps_done();
    for (std::size_t i = 0; i < steps.size(); ++i)
        impl_->worker_.post(steps[i], i + 1 == steps.size() ? bytes : 0);
}

void TruthFeed::skip_steps() {
    for (const FeedStep& step : impl_->paths_.skip_steps())
        impl_->worker_.post(step, 0);
}

bool TruthFeed::is_waited_on() const { return impl_->paths_.any_step(); }

bool TruthFeed::ended() const { return impl_->paths_.ended(); }

bool TruthFeed::paused() const { return impl_->paths_.paused(); }

FeedCounts TruthFeed::counts() const {
    const FeedTallies& t = impl_->desk_.tallies;
    return {t.messages,  t.bytes,      t.samples,           t.statements, t.refused,
            t.strangers, t.overflowed, t.dropped_by_kernel, t.restarts,   t.lost};
}

const SourceClock& TruthFeed::clock() const { return impl_->paths_.clock(); }

std::vector<std::string> TruthFeed::take_news() {
    std::vector<std::string> news = impl_->desk_.news.take();
    for (std::string& sentence : news)
        sentence.insert(0, description() + ": ");
    return news;
}

std::string TruthFeed::description() const { return impl_->worker_.description(); }

std::uint16_t TruthFeed::port() const { return impl_->worker_.port(); }

}  // namespace skyloop
