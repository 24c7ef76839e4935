/// The caster of a run: RTCM of its receivers for clients of NTRIP.
/// RTCM of one port as a mount point has it.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "base/geo/geodetic.hpp"
#include "receiver/protocol/rtcm3.hpp"
#include "receiver/protocol/stream_splitter.hpp"
#include "run/emulator/assembly.hpp"
#include "run/emulator/virtual_stations.hpp"
#include "run/scenario/scenario.hpp"
#include "wire/ntrip/ntrip_caster.hpp"
#include "wire/ntrip/source_table.hpp"

namespace skyloop::inline run {

/// A port's RTCM 3 frames, one after the other, for any number of clients; all hear the same, wherever they are.
///
/// State: the newest frames, at most 256 kB of them, and what the source table says of those that were.
class PortCorrections : public CorrectionsSource, public std::enable_shared_from_this<PortCorrections> {
public:
    /// @param about name and identifier of the record
    /// @param place where the receiver is, until it tells so itself (1005, 1006)
    /// @param sbf the port sends SBF, too
    PortCorrections(SourceRecord about, const Geodetic& place, bool sbf);

    /// What has left the port. By the thread of the loop. @return whether there is something new
    bool hear(ByteSpan bytes, GpsTime now);

    [[nodiscard]] std::string table_line(bool needs_password) const override;
    [[nodiscard]] std::unique_ptr<CorrectionsStream> open() override;

private:
    class Stream;
    struct Heard {
        std::uint64_t count = 0;
        GpsTime first{}, last{};
    };
    void note(const Rtcm3Message& message, GpsTime now);
    Bytes frames_since(std::uint64_t& next) const;

    StreamSplitter splitter_;  // of the loop alone, as what follows is not
    mutable std::mutex mutex_;
    SourceRecord about_;
    std::deque<Bytes> frames_;
    std::size_t frame_bytes_ = 0;
    std::uint64_t first_frame_ = 0;  // the number of the oldest that is kept
    std::map<int, Heard> heard_;     // by number of message
    std::set<std::string> systems_;
    std::uint64_t bytes_ = 0;
};

/// What the caster of a run has of the program.
struct CasterHost {
    DataFolders data;     ///< for virtual stations
    std::string version;  ///< of skyloop, as their firmware
};

class RunCaster {
public:
    /// What start() would refuse before it asks the system.
    static Result<void> check(const Scenario& scenario, const Assembly& assembly, const CasterHost& host);
    /// Listens when it returns, and hears the receivers from here on. Fails with `usage` for an address, a port or a
    /// name that cannot be, where no receiver can send RTCM, and for virtual stations of a sensor model; with `input`
    /// where what these need of files is not there; with `outside` when the system refuses.
    /// @param assembly outlives it
    static Result<RunCaster> start(const Scenario& scenario, Assembly& assembly, const CasterHost& host);
    /// "127.0.0.1:2101 (BASE, ROVER)"
    [[nodiscard]] const std::string& description() const { return description_; }
    [[nodiscard]] NtripCasterCounts counts() const { return caster_->counts(); }
    /// What its user should be told; empty: nothing.
    [[nodiscard]] std::string warning() const;

private:
    RunCaster(std::shared_ptr<NtripCaster> caster, std::string description, bool open_to_all)
        : caster_(std::move(caster)), description_(std::move(description)), open_to_all_(open_to_all) {}

    std::shared_ptr<NtripCaster> caster_;
    std::string description_;
    bool open_to_all_ = false;
};

}  // namespace skyloop::inline run
