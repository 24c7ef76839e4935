/// One led run: what stands behind a handle of skyloop.h.
/// How a call of the C interface fails.
#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/core/result.hpp"
#include "base/geo/local_frame.hpp"
#include "led_port.hpp"
#include "motion/trajectory/live_path.hpp"
#include "run/emulator/assembly.hpp"
#include "run/emulator/command_queue.hpp"
#include "run_watcher.hpp"
#include "skyloop.h"
#include "world/propagation/told_obstacles.hpp"

namespace skyloop::inline run {

/// A status of skyloop.h, never SKY_OK, and a sentence for sky_last_error().
struct Refusal {
    sky_status status = SKY_E_INTERNAL;
    std::string sentence;
};

template <class T>
using Answer = tl::expected<T, Refusal>;

inline tl::unexpected<Refusal> refuse(sky_status status, std::string sentence) {
    return tl::make_unexpected(Refusal{status, std::move(sentence)});
}
/// What the program's own functions could not do.
inline tl::unexpected<Refusal> refuse(const Error& error) {
    return refuse(error.code == ErrorCode::outside ? SKY_E_IO : SKY_E_PARSE, error.message);
}
inline tl::unexpected<Refusal> refuse(Refusal refusal) { return tl::make_unexpected(std::move(refusal)); }

/// A run that its caller leads. The functions are those of skyloop.h; each may fail as it says there. Not for several
/// threads at once. State: the run, what the caller has said of vehicles and obstacles, and the bytes on their way.
class Session {
public:
    /// @param info of the version of this library
    static Answer<std::unique_ptr<Session>> create(const sky_create_info& info);
    ~Session();
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;

    /// Fails with SKY_E_STATE once a command has ended the run.
    [[nodiscard]] Answer<void> check_running() const;
    [[nodiscard]] Answer<void> check_receiver(std::uint32_t receiver) const;
    Answer<void> set_truth(const sky_truth& truth);
    Answer<void> advance(std::int64_t sim_time_ns);
    [[nodiscard]] sky_progress progress() const;

    Answer<LedPort*> port(std::uint32_t number);
    [[nodiscard]] GpsTime now() const { return assembly_.emulator->now(); }

    Answer<sky_fix> fix(std::uint32_t receiver) const;
    Answer<std::vector<sky_sat>> satellites(std::uint32_t receiver) const;
    Answer<void> tell_path(std::uint32_t receiver, const sky_los& los);
    Answer<void> command(std::string_view json);
    Answer<std::string> query(std::string_view what);

private:
    /// Where a wire of the scenario ends: at a port of the caller's, which the wire owns.
    struct Port {
        std::size_t receiver = 0;
        firmware::PortId id = firmware::PortId::uart1;
        LedPort* led = nullptr;
    };
    /// A vehicle that the caller has said something of.
    struct Vehicle {
        std::shared_ptr<LivePath> path;
        std::uint64_t holds = 0;  ///< of its path, that have been told
        std::uint64_t moves = 0;  ///< RunWatcher::moves() when its receivers were put on that path
    };

    explicit Session(const sky_create_info& info) : log_(info.log), log_user_(info.log_user) {}
    Answer<void> read_scenario_of(const sky_create_info& info);
    Answer<void> assemble_run(const sky_create_info& info);
    Embedding embedding();
    void log(std::int32_t level, const std::string& sentence) const;
    Answer<void> check_target(const Command& command) const;
    Answer<GpsTime> run_time(std::int64_t sim_time_ns) const;
    [[nodiscard]] std::int64_t sim_time(GpsTime time) const;
    [[nodiscard]] std::uint32_t vehicle_of(std::size_t receiver) const;
    [[nodiscard]] std::vector<std::size_t> riders(std::uint32_t vehicle) const;
    Answer<std::shared_ptr<LivePath>> path_of(const sky_truth& truth, const TruthSample& first) const;
    void put_on(const std::vector<std::size_t>& receivers, const std::shared_ptr<LivePath>& path);
    [[nodiscard]] SkyView sky_now(std::uint32_t receiver) const;
    void tell_news();
    void summarise(SummaryOf what);
    [[nodiscard]] Answer<void> check_recordings() const;
    [[nodiscard]] std::string config_text() const;
    [[nodiscard]] std::string ports_text() const;

    sky_log_fn log_ = nullptr;
    void* log_user_ = nullptr;
    Scenario scenario_;
    std::int64_t start_sim_ns_ = 0;
    CommandQueue commands_;
    std::vector<Port> ports_;
    std::vector<std::shared_ptr<ToldPaths>> obstacles_;  // one a receiver
    Assembly assembly_;
    std::unique_ptr<LocalFrame> local_;
    std::unique_ptr<RunWatcher> watcher_;
    std::map<std::uint32_t, Vehicle> vehicles_;
    std::set<std::string> started_;  // names of faults that were asked for
    std::set<std::size_t> noticed_;  // receivers whose surroundings have been told of
    bool begun_ = false;             // create() has not refused it
    std::atomic<bool> never_{false};
};

}  // namespace skyloop::inline run
