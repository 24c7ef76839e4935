#include "wire/ntrip/ntrip_client.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <thread>

#include "base/core/random.hpp"
#include "base/core/threads.hpp"
#include "base/core/words.hpp"
#include "detail/client_connection.hpp"
#include "detail/client_inbox.hpp"
#include "wire/ntrip/ntrip_messages.hpp"
#include "wire/ntrip/source_table.hpp"

namespace skyloop::inline wire {
namespace {

using Kind = NtripVerdict::Kind;

constexpr double first_pause_s = 1, longest_pause_s = 60, pause_spread = 0.5;

std::string nearest_mount(const std::string& table, const std::string& mount) {
    const std::vector<std::string> mounts = mounts_of(table);
    const std::vector<std::string_view> names(mounts.begin(), mounts.end());
    return on_a_terminal(did_you_mean(mount, names));
}

// May be one that knows version 1 alone.
bool may_be_old(const ClientOutcome& outcome) {
    if (!outcome.connected || outcome.streamed) return false;
    return !outcome.verdict || outcome.verdict->kind == Kind::refused;
}

}  // namespace

class NtripClient::Impl {
public:
    explicit Impl(NtripClientSettings settings)
        : settings_(std::move(settings)), pauses_(settings_.seed, "ntrip.pauses") {}
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;
    ~Impl() {
        line_.stop();
        if (thread_.joinable()) thread_.join();
    }

    void start() {
        with_signals_held_back([this] { thread_ = std::thread([this] { work(); }); });
    }

    NtripClientSettings settings_;
    ClientInbox inbox_;

private:
    void work() {
        double pause_s = first_pause_s;
        while (!line_.stopped()) {
            ClientOutcome outcome = ask(settings_.address.mount, 2);
            if (may_be_old(outcome) && !line_.stopped()) outcome = old_or(std::move(outcome));
            inbox_.disconnect();
            if (line_.stopped()) return;
            inbox_.tell_problem(shown_uri(settings_.address), problem_of(outcome));
            if (outcome.brought) pause_s = first_pause_s;
            line_.rest(pause_s * (1 + pause_spread * (pauses_.uniform() - 0.5)));
            pause_s = std::min(2 * pause_s, longest_pause_s);
        }
    }

    ClientOutcome ask(const std::string& mount, int version) {
        return line_.converse({settings_.address, mount, version, settings_.position_every}, inbox_);
    }

    // What version 1 brings, if it brings more.
    ClientOutcome old_or(ClientOutcome outcome) {
        ClientOutcome old = ask(settings_.address.mount, 1);
        return old.verdict && old.verdict->kind != Kind::foreign ? std::move(old) : std::move(outcome);
    }

    std::string problem_of(ClientOutcome& outcome) {
        if (!outcome.verdict || outcome.streamed) return outcome.problem;
        const std::string line = outcome.verdict->line;
        switch (outcome.verdict->kind) {
            case Kind::bad_password:
                return settings_.address.user.empty() ? "a user and a password are needed (" + line + ")"
                                                      : "user or password are refused (" + line + ")";
            case Kind::no_such_mount:
                outcome.table = ask("", outcome.verdict->version).table;
                [[fallthrough]];
            case Kind::table:
                return fmt::format("no such mount point{}", nearest_mount(outcome.table, settings_.address.mount));
            case Kind::refused:
                return fmt::format("refused: {}", line);
            case Kind::foreign:
                return fmt::format("does not speak NTRIP: it says '{}'", line);
            case Kind::stream:
                break;
        }
        return outcome.problem;
    }

    ClientLine line_;
    RandomStream pauses_;
    std::thread thread_;  // last: it uses all of them
};

NtripClient::NtripClient(NtripClientSettings settings) : impl_(std::make_unique<Impl>(std::move(settings))) {}
NtripClient::~NtripClient() = default;

void NtripClient::start() { impl_->start(); }
Bytes NtripClient::take() { return impl_->inbox_.take(); }
void NtripClient::tell_position(std::string gga) { impl_->inbox_.set_position(std::move(gga)); }
bool NtripClient::wants_position() const { return impl_->settings_.position_every.count() > 0; }
bool NtripClient::connected() const { return impl_->inbox_.connected(); }
NtripClientCounts NtripClient::counts() const { return impl_->inbox_.counts(); }
std::vector<std::string> NtripClient::take_news() { return impl_->inbox_.take_news(); }

}  // namespace skyloop::inline wire
