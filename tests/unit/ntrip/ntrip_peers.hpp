/// Two ends of NTRIP in one test.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "wire/ntrip/ntrip_caster.hpp"
#include "wire/ntrip/source_table.hpp"

namespace skyloop::test {

inline constexpr std::string_view here = "$GPGGA,092725.00,4717.11399,N,00833.91590,E,1,08,1.01,499.6,M,48.0,M,,*5B";

/// Bytes that a test hands in; keeps what clients say of where they are.
class TestSource : public CorrectionsSource, public std::enable_shared_from_this<TestSource> {
public:
    void put(std::string_view text) {
        const std::lock_guard lock(mutex_);
        all_ += text;
    }
    void fill() {
        const std::lock_guard lock(mutex_);
        full_ = true;
    }
    std::vector<std::string> positions() const {
        const std::lock_guard lock(mutex_);
        return positions_;
    }

    std::string table_line(bool needs_password) const override {
        SourceRecord record;
        record.mount = "BASE";
        record.needs_password = needs_password;
        return source_line(record);
    }
    std::unique_ptr<CorrectionsStream> open() override {
        const std::lock_guard lock(mutex_);
        if (full_) return nullptr;
        return std::make_unique<Stream>(shared_from_this(), all_.size());
    }

private:
    class Stream : public CorrectionsStream {
    public:
        Stream(std::shared_ptr<TestSource> source, std::size_t next) : source_(std::move(source)), next_(next) {}
        Bytes take() override {
            const std::lock_guard lock(source_->mutex_);
            const std::string rest = source_->all_.substr(next_);
            next_ = source_->all_.size();
            return to_bytes(rest);
        }
        void hear_position(std::string_view gga) override {
            const std::lock_guard lock(source_->mutex_);
            source_->positions_.emplace_back(gga);
        }

    private:
        std::shared_ptr<TestSource> source_;
        std::size_t next_;
    };

    mutable std::mutex mutex_;
    std::string all_;
    std::vector<std::string> positions_;
    bool full_ = false;
};

/// Looks until it is so, for 10 s.
inline bool comes_true(const std::function<bool()>& condition) {
    for (int i = 0; i < 1000; ++i) {
        if (condition()) return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
}

struct CasterBench {
    explicit CasterBench(std::map<std::string, std::string> users = {}, std::uint16_t port = 0) {
        NtripCasterSettings settings;
        settings.address.port = port;
        settings.users = std::move(users);
        settings.mounts["BASE"] = source;
        caster = NtripCaster::start(std::move(settings)).value();
    }
    void send(std::string_view text) const {
        source->put(text);
        caster->wake();
    }
    [[nodiscard]] std::string uri(const std::string& rest) const {
        return "ntrip://" + rest.substr(0, rest.find('/')) + "127.0.0.1:" + std::to_string(caster->address().port) +
               rest.substr(rest.find('/'));
    }

    std::shared_ptr<TestSource> source = std::make_shared<TestSource>();
    std::unique_ptr<NtripCaster> caster;
};

}  // namespace skyloop::test
