/// What a run leaves behind.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "skyloop/base/result.hpp"
#include "skyloop/emulator/output_file.hpp"
#include "skyloop/flow/trace.hpp"
#include "skyloop/gnss/navigation_source.hpp"

namespace skyloop {

class RinexRecording;
struct RinexRecordingSetup;

/// Writes fixes.csv, satellites.csv and the bytes of each port into one folder (INTERFACE.md section 3).
class Recorder {
public:
    ~Recorder();
    Recorder(Recorder&&) noexcept;
    Recorder& operator=(Recorder&&) noexcept;
    /// Makes the folder and its files; old files of a former run are replaced.
    static Result<Recorder> create(const std::filesystem::path& folder);

    /// Adds observations.rnx and navigation.rnx, for a receiver that measures.
    Result<void> add_rinex(const RinexRecordingSetup& setup);

    /// @param broadcast the records that the satellites send
    void record(const Trace& trace, const NavigationSource& broadcast);
    /// Bytes that left the receiver. @param monotonic_ns when, on the pacer's clock
    void record_output(ByteSpan bytes, GpsTime now, std::int64_t monotonic_ns);
    /// Bytes that reached the receiver.
    void record_input(ByteSpan bytes);
    /// Writes run.json; `content` is its text.
    void record_summary(const std::string& content);
    /// Hands everything to the operating system, so that a killed run keeps it.
    void flush();
    /// The first failure to write, a sentence that names the file; after it that file stays as it is.
    [[nodiscard]] std::optional<Error> failure() const;
    [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }

private:
    Recorder();
    std::filesystem::path folder_;
    OutputFile fixes_, satellites_, bytes_out_, bytes_in_, times_;
    std::unique_ptr<RinexRecording> rinex_;
    std::uint64_t offset_ = 0;
    std::optional<Error> summary_failure_;
};

}  // namespace skyloop
