/// A device that was lost, looked for until it is back.
#pragma once

#include <chrono>
#include <cstdint>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/core/threads.hpp"

namespace skyloop::inline wire {

/// Looks for a lost device every 0.5 s, in another thread: to close, to find and to open one may take its time, and no
/// loop waits for it. `End` is what an opened device is.
template <class End>
class DeviceSearch {
public:
    /// What a search has found.
    struct Attempt {
        std::unique_ptr<End> end{};  ///< null: the device is not there, or cannot be had
        std::uint32_t baud = 0;      ///< that it was opened with, bit/s
        std::string trouble{};       ///< why a device that is there cannot be had; empty when none is there
    };

    /// Port paths of USB devices, "1-1.2".
    using Ports = std::vector<std::string>;

    /// The device has gone; what is left of it is closed. @param now_ns of a clock that never jumps
    /// @param list_beside gives, in another thread and before anything else, the ports of devices like the lost one
    /// that are there: none of them is it
    template <class ListBeside>
    void begin(std::unique_ptr<End> lost, std::int64_t now_ns, ListBeside list_beside) {
        trouble_.clear();
        same_trouble_ = 0;
        next_ns_ = now_ns + every_ns;
        beside_ = std::make_shared<Ports>();
        start([old = std::move(lost), beside = beside_, list_beside = std::move(list_beside)]() mutable {
            *beside = list_beside();  // to close may take long enough for somebody to plug one in
            old.reset();
            return Attempt{};
        });
    }

    /// Gives the device once it is back, or, without it, a trouble that has lasted; else nothing. To be called at each
    /// look while the device is away. @param make_job is given the ports noted at the loss and makes what looks once,
    /// and gives an Attempt in another thread
    template <class MakeJob>
    std::optional<Attempt> look(std::int64_t now_ns, const MakeJob& make_job) {
        if (running_.valid()) {
            if (running_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return std::nullopt;
            return finished(running_.get());
        }
        if (now_ns < next_ns_) return std::nullopt;
        next_ns_ = now_ns + every_ns;
        start(make_job(std::as_const(*beside_)));
        return std::nullopt;
    }

private:
    static constexpr std::int64_t every_ns = 500'000'000;
    static constexpr int lasting = 4;  // attempts: a node is often there before its rights are

    template <class Job>
    void start(Job job) {
        with_signals_held_back([&] { running_ = std::async(std::launch::async, std::move(job)); });
    }

    std::optional<Attempt> finished(Attempt attempt) {
        if (attempt.end) return attempt;
        same_trouble_ = !attempt.trouble.empty() && attempt.trouble == trouble_ ? same_trouble_ + 1 : 1;
        trouble_ = attempt.trouble;
        if (trouble_.empty() || same_trouble_ != lasting) return std::nullopt;
        return attempt;
    }

    std::future<Attempt> running_;
    std::shared_ptr<Ports> beside_ = std::make_shared<Ports>();  // shared with the thread that fills it
    std::int64_t next_ns_ = 0;
    std::string trouble_;
    int same_trouble_ = 0;  // attempts in a row
};

}  // namespace skyloop::inline wire
