/// What a run leaves behind.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/result.hpp"
#include "run/emulator/run_files.hpp"
#include "run/emulator/timing.hpp"
#include "world/flow/trace.hpp"
#include "world/gnss/ephemeris.hpp"

namespace skyloop::inline run {

class RinexRecording;
struct RinexRecordingSetup;

/// Writes fixes.csv, satellites.csv and the bytes of each wire's port into one folder (INTERFACE.md section 3).
class Recorder {
public:
    ~Recorder();
    Recorder(Recorder&&) noexcept;
    Recorder& operator=(Recorder&&) noexcept;
    /// Holds the folder against other runs and leaves what is in it as it is, so that the run can still be refused.
    static Result<Recorder> claim(const std::filesystem::path& folder);
    /// There will be observations.rnx and navigation.rnx, for a receiver that measures. Before begin().
    void add_rinex(const RinexRecordingSetup& setup);
    /// Files that begin() makes besides, by their names, as they are.
    void add_files(std::map<std::string, std::string> files) { files_ = std::move(files); }
    /// Makes the files, in the place of those of a former run. Comes before anything is recorded.
    struct Beginning {
        std::size_t wires = 1;  ///< how many sets of port files there are to be: port0, port1, …
        bool former = false;    ///< a run has been recorded there: what is not replaced of it goes, too
        bool precise = false;   ///< satellites.csv tells what only counts beside precise products
    };
    Result<void> begin(const Beginning& beginning);

    /// @param broadcast the records that the satellites send
    void record(const Trace& trace, const NavigationSource& broadcast);
    /// Bytes that left the receiver by a wire's port.
    void record_output(ByteSpan bytes, const LoopTime& time, std::size_t wire = 0);
    /// Bytes that reached the receiver over a wire.
    void record_input(ByteSpan bytes, GpsTime now, std::size_t wire = 0);
    /// Writes run.json, whole or not at all; `content` is its text.
    void record_summary(const std::string& content);
    /// Hands everything to the operating system, so that a killed run keeps it.
    void flush();
    /// The first failure to write, a sentence that names the file; after it that file stays as it is.
    [[nodiscard]] std::optional<Error> failure() const;
    [[nodiscard]] const std::filesystem::path& folder() const { return folder_.path(); }

private:
    struct PortFiles {
        OutputFile out, in, times, in_times;
        std::uint64_t offset = 0, in_offset = 0;
        GpsTime heard_at{};             // of input whose line is not written yet
        std::uint64_t heard_bytes = 0;  // of it
        void write_heard();
    };
    Recorder();
    Result<void> create_tables(bool precise);
    static std::string port_file(std::size_t wire, std::string_view extension);
    Result<void> create_ports(std::size_t wires);
    void remove_ports_from(std::size_t wire);  // of a former run with more wires

    ClaimedFolder folder_;
    OutputFile fixes_, satellites_;
    bool precise_ = false;
    std::vector<PortFiles> ports_;
    std::map<std::string, std::string> files_;
    std::unique_ptr<RinexRecordingSetup> rinex_setup_;  // null: it measures nothing
    std::unique_ptr<RinexRecording> rinex_;
    std::optional<Error> summary_failure_;
};

}  // namespace skyloop::inline run
