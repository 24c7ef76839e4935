/// The thread of a feed.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "feed_link.hpp"

namespace skyloop {

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

}  // namespace skyloop
