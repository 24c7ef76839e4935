#include "skyloop/emulator/recorder.hpp"

#include <fmt/format.h>

#include <system_error>

#include "rinex_recording.hpp"
#include "trace_rows.hpp"

namespace skyloop {

Recorder::Recorder() = default;
Recorder::~Recorder() = default;
Recorder::Recorder(Recorder&&) noexcept = default;
Recorder& Recorder::operator=(Recorder&&) noexcept = default;

Result<Recorder> Recorder::create(const std::filesystem::path& folder) {
    std::error_code reason;
    std::filesystem::create_directories(folder, reason);
    if (reason)
        return fail(ErrorCode::outside,
                    fmt::format("{}: cannot be made a folder: {}", folder.string(), reason.message()));
    Recorder recorder;
    recorder.folder_ = folder;
    // Written at the end: a run that is killed must not leave the summary of the run before.
    std::filesystem::remove(folder / "run.json", reason);
    // Nor the observations of a receiver that measured, when this one does not.
    std::filesystem::remove(folder / "observations.rnx", reason);
    std::filesystem::remove(folder / "navigation.rnx", reason);
    const std::pair<OutputFile*, const char*> files[] = {{&recorder.fixes_, "fixes.csv"},
                                                         {&recorder.satellites_, "satellites.csv"},
                                                         {&recorder.bytes_out_, "port0.out"},
                                                         {&recorder.bytes_in_, "port0.in"},
                                                         {&recorder.times_, "port0.times"}};
    for (const auto& [file, name] : files) {
        auto created = OutputFile::create(folder / name);
        if (!created) return fail(created.error());
        *file = std::move(*created);
    }
    recorder.fixes_.write(fixes_header);
    recorder.satellites_.write(satellites_header);
    return recorder;
}

Result<void> Recorder::add_rinex(const RinexRecordingSetup& setup) {
    auto rinex = RinexRecording::create(folder_, setup);
    if (!rinex) return fail(rinex.error());
    rinex_ = std::make_unique<RinexRecording>(std::move(*rinex));
    return {};
}

void Recorder::record(const Trace& trace, const NavigationSource& broadcast) {
    fixes_.write(fix_row(trace));
    satellites_.write(satellite_rows(trace));
    if (rinex_) rinex_->record(trace, broadcast);
}

void Recorder::record_output(ByteSpan bytes, GpsTime now, std::int64_t monotonic_ns) {
    if (bytes.empty()) return;
    times_.write(fmt::format("{} {} {} {}\n", monotonic_ns, now.time_since_epoch().count(), offset_, bytes.size()));
    bytes_out_.write(bytes);
    offset_ += bytes.size();
}

void Recorder::record_input(ByteSpan bytes) { bytes_in_.write(bytes); }

void Recorder::record_summary(const std::string& content) {
    auto file = OutputFile::create(folder_ / "run.json");
    if (file) {
        file->write(content);
        file->flush();
        summary_failure_ = file->failure();
    } else {
        summary_failure_ = file.error();
    }
}

void Recorder::flush() {
    for (OutputFile* file : {&fixes_, &satellites_, &bytes_out_, &bytes_in_, &times_})
        file->flush();
    if (!rinex_) return;
    rinex_->observations().flush();
    rinex_->navigation().flush();
}

std::optional<Error> Recorder::failure() const {
    for (const OutputFile* file : {&fixes_, &satellites_, &bytes_out_, &bytes_in_, &times_})
        if (file->failure()) return file->failure();
    if (rinex_ && rinex_->observations().failure()) return rinex_->observations().failure();
    if (rinex_ && rinex_->navigation().failure()) return rinex_->navigation().failure();
    return summary_failure_;
}

}  // namespace skyloop
