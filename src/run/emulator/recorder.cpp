#include "run/emulator/recorder.hpp"

#include <fmt/compile.h>
#include <fmt/format.h>

#include <initializer_list>
#include <iterator>
#include <system_error>

#include "base/core/files.hpp"
#include "detail/recording_formats.hpp"

namespace skyloop::inline run {

Recorder::Recorder() = default;
Recorder::~Recorder() = default;
Recorder::Recorder(Recorder&&) noexcept = default;
Recorder& Recorder::operator=(Recorder&&) noexcept = default;

Result<Recorder> Recorder::claim(const std::filesystem::path& folder) {
    auto claimed = ClaimedFolder::claim(folder);
    if (!claimed) return fail(claimed.error());
    Recorder recorder;
    recorder.folder_ = std::move(*claimed);
    return recorder;
}

void Recorder::add_rinex(const RinexRecordingSetup& setup) {
    rinex_setup_ = std::make_unique<RinexRecordingSetup>(setup);
}

Result<void> Recorder::begin(const Beginning& beginning) {
    std::error_code reason;
    // Whatever becomes of this run, it must not leave the summary of the run before.
    std::filesystem::remove(folder() / "run.json", reason);
    // Nor its verdicts, which a run leaves at its end, or its observations. What no run has left is the user's.
    for (const char* name : {"junit.xml", "verdicts.json", "commands.jsonl", "observations.rnx", "navigation.rnx",
                             "osnma_keys.xml", "osnma_public_key_1.pem", "osnma_public_key_2.pem"})
        if (beginning.former) std::filesystem::remove(folder() / name, reason);
    if (const auto tables = create_tables(beginning.precise); !tables) return tables;
    if (const auto ports = create_ports(beginning.wires); !ports) return ports;
    if (beginning.former) remove_ports_from(beginning.wires);
    for (const auto& [name, text] : files_)
        if (const auto written = replace_file(folder() / name, text); !written) return written;
    if (!rinex_setup_) return {};
    auto rinex = RinexRecording::create(folder(), *rinex_setup_);
    if (!rinex) return fail(rinex.error());
    rinex_ = std::make_unique<RinexRecording>(std::move(*rinex));
    return {};
}

Result<void> Recorder::create_tables(bool precise) {
    const auto created = create_files(folder(), {{&fixes_, "fixes.csv"}, {&satellites_, "satellites.csv"}});
    if (!created) return created;
    fixes_.write(fixes_header);
    precise_ = precise;
    satellites_.write(precise ? satellites_header.substr(0, satellites_header.size() - 1) : satellites_header);
    if (precise) satellites_.write(precise_satellites_header);
    return {};
}

std::string Recorder::port_file(std::size_t wire, std::string_view extension) {
    return fmt::format("port{}.{}", wire, extension);
}

Result<void> Recorder::create_ports(std::size_t wires) {
    for (std::size_t wire = 0; wire < wires; ++wire) {
        PortFiles port;
        const auto created = create_files(folder(), {{&port.out, port_file(wire, "out")},
                                                     {&port.in, port_file(wire, "in")},
                                                     {&port.times, port_file(wire, "times")},
                                                     {&port.in_times, port_file(wire, "in_times")}});
        if (!created) return created;
        ports_.push_back(std::move(port));
    }
    return {};
}

void Recorder::remove_ports_from(std::size_t wire) {
    std::error_code reason;
    for (; std::filesystem::remove(folder() / port_file(wire, "out"), reason); ++wire)
        for (const char* extension : {"in", "times", "in_times"})
            std::filesystem::remove(folder() / port_file(wire, extension), reason);
}

void Recorder::record(const Trace& trace, const NavigationSource& broadcast) {
    fixes_.write(fix_row(trace));
    satellites_.write(satellite_rows(trace, precise_));
    if (rinex_) rinex_->record(trace, broadcast);
}

void Recorder::record_output(ByteSpan bytes, const LoopTime& time, std::size_t wire) {
    if (bytes.empty()) return;
    PortFiles& port = ports_.at(wire);
    fmt::memory_buffer line;
    fmt::format_to(std::back_inserter(line), FMT_COMPILE("{} {} {} {}\n"), time.monotonic_ns,
                   time.now.time_since_epoch().count(), port.offset, bytes.size());
    port.times.write(std::string_view(line.data(), line.size()));
    port.out.write(bytes);
    port.offset += bytes.size();
}

// Bytes of one instant come one by one; they make one line.
void Recorder::record_input(ByteSpan bytes, GpsTime now, std::size_t wire) {
    PortFiles& port = ports_.at(wire);
    if (port.heard_at != now) port.write_heard();
    port.heard_at = now;
    port.heard_bytes += bytes.size();
    port.in.write(bytes);
}

void Recorder::PortFiles::write_heard() {
    if (heard_bytes == 0) return;
    in_times.write(fmt::format("{} {} {}\n", heard_at.time_since_epoch().count(), in_offset, heard_bytes));
    in_offset += heard_bytes;
    heard_bytes = 0;
}

void Recorder::record_summary(const std::string& content) {
    const auto replaced = replace_file(folder() / "run.json", content);
    summary_failure_ = replaced ? std::nullopt : std::optional(replaced.error());
}

void Recorder::flush() {
    fixes_.flush();
    satellites_.flush();
    for (PortFiles& port : ports_) {
        port.write_heard();
        for (OutputFile* file : {&port.out, &port.in, &port.times, &port.in_times})
            file->flush();
    }
    if (!rinex_) return;
    rinex_->observations().flush();
    rinex_->navigation().flush();
}

std::optional<Error> Recorder::failure() const {
    // Asked for at each instant of a run: nothing is collected first.
    const auto first_of = [](std::initializer_list<const OutputFile*> files) -> const std::optional<Error>* {
        for (const OutputFile* file : files)
            if (file->failure()) return &file->failure();
        return nullptr;
    };
    if (const auto* failure = first_of({&fixes_, &satellites_})) return *failure;
    for (const PortFiles& port : ports_)
        if (const auto* failure = first_of({&port.out, &port.in, &port.times, &port.in_times})) return *failure;
    if (rinex_)
        if (const auto* failure = first_of({&rinex_->observations(), &rinex_->navigation()})) return *failure;
    return summary_failure_;
}

}  // namespace skyloop::inline run
