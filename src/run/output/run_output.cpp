#include "run/output/run_output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <iterator>
#include <map>
#include <mutex>
#include <set>
#include <thread>
#include <utility>

#include "base/core/threads.hpp"
#include "run/output/epoch_messages.hpp"
#include "wire/transport/file.hpp"
#include "wire/transport/tcp_client.hpp"

namespace skyloop::inline run {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr std::size_t most_waiting = 4096, most_news = 100;
constexpr std::chrono::microseconds longest_lock{100};
constexpr milliseconds look_every{20}, patience_of_live{200}, patience_of_virtual{2000};

Result<std::unique_ptr<MessageSink>> open_file_sink(const std::string& path) {
    if (path == "-") return make_wire_sink(FileTransport::standard_output());
    auto file = FileTransport::open(path);
    if (!file) return fail(file.error());
    return make_wire_sink(std::move(*file));
}

Result<std::unique_ptr<MessageSink>> open_sink(const OutputSettings& settings) {
    switch (settings.way) {
        case OutputWay::udp:
            return open_udp_sink(settings.address);
        case OutputWay::tcp_server:
            return open_tcp_server_sink(settings.address);
        case OutputWay::file:
            return open_file_sink(settings.path);
        default:
            break;
    }
    auto connection = TcpClientTransport::open(settings.address);
    if (!connection) return fail(connection.error());
    return make_wire_sink(std::move(*connection));
}

class QueuedOutput final : public RunOutput {
public:
    QueuedOutput(const OutputSettings& settings, OutputParts parts, std::vector<bool> told,
                 std::unique_ptr<MessageSink> sink)
        : settings_(settings),
          parts_(std::move(parts)),
          told_(std::move(told)),
          numbers_(told_.size(), 0),
          writer_(make_epoch_writer(settings, parts_.sources)),
          sink_(std::move(sink)),
          description_(fmt::format("{}: {}", output_format_names[static_cast<std::size_t>(settings.format)],
                                   sink_->description())) {
        with_signals_held_back([this] { thread_ = std::thread([this] { work(); }); });
    }
    ~QueuedOutput() override { finish(); }

    void begin() override {
        {
            const std::scoped_lock lock(mutex_);
            begun_ = true;
        }
        changed_.notify_one();
    }

    void on_epoch(const EpochSeen& seen) override {
        if (seen.station >= told_.size() || !told_[seen.station]) return;
        const bool at_report = settings_.when == OutputMoment::report && seen.leaves.has_value();
        Waiting waiting;
        waiting.leaves = at_report ? *seen.leaves : seen.now;
        waiting.due_ns = parts_.due_ns ? parts_.due_ns(waiting.leaves) : std::nullopt;
        // A fault may make a receiver report an epoch several times.
        if (settings_.format != OutputFormat::json) waiting.times = std::max(1, seen.reported.reports);
        waiting.job = writer_(seen, parts_.receivers[seen.station], numbers_[seen.station]++);
        push(std::move(waiting), seen.now);
    }

    void finish() override {
        {
            const std::scoped_lock lock(mutex_);
            for (Waiting& one : handed_)
                add(std::move(one));
            handed_.clear();
            ends_ = true;
        }
        changed_.notify_one();
        if (thread_.joinable()) thread_.join();
    }

    [[nodiscard]] OutputCounts counts() const override {
        const std::scoped_lock lock(mutex_);
        return {sent_, left_out_};
    }
    std::vector<std::string> take_news() override {
        const std::unique_lock lock(mutex_, std::try_to_lock);
        return lock ? std::exchange(news_, {}) : std::vector<std::string>{};
    }
    [[nodiscard]] std::string failure() const override {
        const std::scoped_lock lock(mutex_);
        return failure_;
    }
    [[nodiscard]] std::string description() const override { return description_; }

private:
    struct Waiting {
        GpsTime leaves;
        std::optional<std::int64_t> due_ns;
        int times = 1;
        EpochJob job;
    };
    // A report that is delayed may be overtaken by a later one, as on a wire.
    using Queue = std::map<std::pair<GpsTime, std::uint64_t>, Waiting>;

    void push(Waiting waiting, GpsTime now) {
        handed_.push_back(std::move(waiting));
        std::unique_lock lock(mutex_, std::defer_lock);
        if (!lock_for_the_loop(lock)) return;  // with the next epoch, then
        now_ = std::max(now_, now);
        for (Waiting& one : handed_) {
            if (parts_.waits_for_readers)
                room_.wait(lock, [this] { return queue_.size() < most_waiting || !first_is_due(); });
            add(std::move(one));
        }
        handed_.clear();
        lock.unlock();
        changed_.notify_one();
    }

    // With deadlines to keep, the loop does not wait for a thread of ordinary priority that the system has put aside.
    bool lock_for_the_loop(std::unique_lock<std::mutex>& lock) const {
        if (parts_.waits_for_readers) {
            lock.lock();
            return true;
        }
        const auto end = steady_clock::now() + longest_lock;
        while (!lock.try_lock())
            if (steady_clock::now() >= end) return false;
        return true;
    }

    void add(Waiting waiting) {
        if (queue_.size() >= most_waiting) {
            queue_.erase(queue_.begin());
            ++left_out_;
        }
        const GpsTime leaves = waiting.leaves;
        queue_.emplace(std::pair(leaves, pushed_++), std::move(waiting));
    }

    [[nodiscard]] bool first_is_due() const {
        if (queue_.empty()) return false;
        const Waiting& first = queue_.begin()->second;
        return first.due_ns ? steady_clock::now() >= instant(*first.due_ns) : first.leaves <= now_;
    }

    static steady_clock::time_point instant(std::int64_t ns) { return steady_clock::time_point(Nanoseconds(ns)); }

    void work() {
        if (parts_.waits_for_readers) sink_->wait_for_readers(patience_of_virtual);
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [this] { return begun_ || ends_ || !queue_.empty(); });
        if (begun_) sink_->begin();
        while (!ends_ || !queue_.empty()) {
            if (ends_ || first_is_due())
                tell_first(lock);
            else
                rest(lock);
        }
        lock.unlock();
        sink_->finish(parts_.waits_for_readers ? patience_of_virtual : patience_of_live);
        publish(lock);
    }

    void tell_first(std::unique_lock<std::mutex>& lock) {
        const Waiting waiting = std::move(queue_.begin()->second);
        queue_.erase(queue_.begin());
        lock.unlock();
        room_.notify_one();
        for (int i = 0; i < waiting.times; ++i)
            for (const Bytes& message : waiting.job())
                sink_->send(message);
        publish(lock);
    }

    void rest(std::unique_lock<std::mutex>& lock) {
        auto until = steady_clock::now() + look_every;
        if (!queue_.empty())
            if (const auto due = queue_.begin()->second.due_ns) until = std::min(until, instant(*due));
        changed_.wait_until(lock, until);
        if (ends_ || first_is_due()) return;
        lock.unlock();
        sink_->look();
        publish(lock);
    }

    // Shows the others how the sink stands, and leaves the lock locked.
    void publish(std::unique_lock<std::mutex>& lock) {
        std::vector<std::string> news = sink_->take_news();
        std::erase_if(news, [this](const std::string& sentence) {
            return said_.size() >= most_news || !said_.insert(sentence).second;
        });
        const SinkCounts counts = sink_->counts();
        std::string failure = sink_->failure();
        lock.lock();
        sent_ = counts;
        failure_.swap(failure);
        std::move(news.begin(), news.end(), std::back_inserter(news_));
    }

    const OutputSettings settings_;
    const OutputParts parts_;
    const std::vector<bool> told_;
    std::vector<std::uint64_t> numbers_;  // of the loop's thread
    std::vector<Waiting> handed_;         // of the loop's thread: not in the queue yet
    EpochWriter writer_;
    std::unique_ptr<MessageSink> sink_;  // of the output's thread, once it runs
    std::set<std::string> said_;         // of the output's thread
    const std::string description_;

    mutable std::mutex mutex_;
    std::condition_variable changed_, room_;
    Queue queue_;
    bool begun_ = false;
    std::uint64_t pushed_ = 0, left_out_ = 0;
    GpsTime now_{};
    SinkCounts sent_;
    std::vector<std::string> news_;
    std::string failure_;
    bool ends_ = false;
    std::thread thread_;  // last: it uses all of them
};

}  // namespace

Result<std::unique_ptr<RunOutput>> RunOutput::open(const OutputSettings& settings, OutputParts parts) {
    auto told = told_receivers(settings, parts.receivers);
    if (!told) return fail(told.error());
    auto sink = open_sink(settings);
    if (!sink) return fail(sink.error());
    return std::make_unique<QueuedOutput>(settings, std::move(parts), std::move(*told), std::move(*sink));
}

}  // namespace skyloop::inline run
