/// The one loop that joins world, receiver and wires.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "firmware/receiver.hpp"
#include "skyloop/emulator/lateness.hpp"
#include "skyloop/emulator/link.hpp"
#include "skyloop/emulator/pacer.hpp"
#include "skyloop/emulator/recorder.hpp"
#include "skyloop/emulator/simulation.hpp"

namespace skyloop {

/// The state of a run after an epoch, for progress displays.
struct Status {
    GpsTime now;
    const Trace* trace = nullptr;  ///< valid during the call
    Nanoseconds lateness{0};
};

/// What a run counted.
struct RunCounts {
    std::uint64_t epochs = 0;
    std::uint64_t epochs_with_fix = 0;
    LatenessHistogram lateness;
};

/// A receiver on its trajectory, streaming to its wires.
class Emulator {
public:
    struct Parts {
        Simulation simulation;
        firmware::Receiver receiver;
        std::vector<Link> links;
        std::unique_ptr<Pacer> pacer;
        std::optional<Recorder> recorder;
    };
    Emulator(Parts parts, GpsTime start);

    /// Called after each epoch.
    void on_status(std::function<void(const Status&)> callback) { status_ = std::move(callback); }
    /// Runs to `end`, or until `stop` is true, or until a recording fails.
    void run_until(GpsTime end, const std::atomic<bool>& stop);

    [[nodiscard]] const RunCounts& counts() const { return counts_; }
    [[nodiscard]] const firmware::Receiver& receiver() const { return parts_.receiver; }
    [[nodiscard]] const std::vector<Link>& links() const { return parts_.links; }
    [[nodiscard]] const Simulation& simulation() const { return parts_.simulation; }
    [[nodiscard]] Recorder* recorder() { return parts_.recorder ? &*parts_.recorder : nullptr; }
    [[nodiscard]] GpsTime now() const { return now_; }

private:
    [[nodiscard]] GpsTime next_instant(GpsTime end) const;
    void exchange_bytes();
    void run_epoch(Nanoseconds lateness);

    Parts parts_;
    GpsTime now_;
    GpsTime next_epoch_;
    RunCounts counts_;
    std::function<void(const Status&)> status_;
};

}  // namespace skyloop
