/// What receivers report, told to another program while the run goes on.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/core/result.hpp"
#include "run/fault/run_observer.hpp"
#include "run/output/epoch_messages.hpp"
#include "run/output/output_settings.hpp"
#include "wire/transport/message_sink.hpp"

namespace skyloop::inline run {

/// What an output needs of the run.
struct OutputParts {
    std::vector<std::string> receivers;  ///< their names, by station
    /// The steady clock's reading, ns, at which an instant is due; nothing, or empty: time does not wait, and an
    /// instant has come when an epoch of it or later has.
    std::function<std::optional<std::int64_t>(GpsTime)> due_ns{};
    /// Nothing comes late: the loop may wait for a reader rather than lose messages.
    bool waits_for_readers = false;
    WriterSources sources{};
};

/// What became of an output's messages.
struct OutputCounts {
    SinkCounts sent;
    std::uint64_t left_out = 0;  ///< epochs that found the queue full
};

/// Watches the run and tells each epoch of its receivers in one format, on a thread of its own. The messages, and their
/// order, depend on the run alone.
///
/// At most 4096 epochs wait to be told; of more, the first are left out. With waits_for_readers the loop waits for the
/// thread instead, which waits at most 2 s for an other end that does not read, and then never again for this one.
class RunOutput : public RunObserver {
public:
    /// Connected, listening or opened when it returns. Fails with `usage` for a receiver that there is not, and as the
    /// ways themselves fail.
    static Result<std::unique_ptr<RunOutput>> open(const OutputSettings& settings, OutputParts parts);

    /// Nothing refuses the run any more: a file that was there is emptied. An epoch begins it, too.
    virtual void begin() = 0;
    void on_epoch(const EpochSeen& seen) override = 0;
    /// The run is over: what still waits is told now. May wait for slow readers, for 0.2 s; with waits_for_readers for
    /// 2 s.
    virtual void finish() = 0;

    [[nodiscard]] virtual OutputCounts counts() const = 0;
    /// Sentences for the user; each is given once in a run.
    virtual std::vector<std::string> take_news() = 0;
    /// What has broken for good, in one sentence; empty: nothing.
    [[nodiscard]] virtual std::string failure() const = 0;
    /// "gps-input: 127.0.0.1:14550 (udp)"
    [[nodiscard]] virtual std::string description() const = 0;
};

}  // namespace skyloop::inline run
