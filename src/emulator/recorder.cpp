#include "skyloop/emulator/recorder.hpp"

#include <fmt/format.h>

#include <system_error>

#include "trace_rows.hpp"

namespace skyloop {

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

void Recorder::record(const Trace& trace) {
    fixes_.write(fix_row(trace));
    satellites_.write(satellite_rows(trace));
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
}

std::optional<Error> Recorder::failure() const {
    for (const OutputFile* file : {&fixes_, &satellites_, &bytes_out_, &bytes_in_, &times_})
        if (file->failure()) return file->failure();
    return summary_failure_;
}

}  // namespace skyloop
