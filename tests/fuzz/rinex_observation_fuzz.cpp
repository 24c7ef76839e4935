// Any bytes as an observation file: a clear error or usable epochs, never a crash or a hang; and what was read, written
// anew, reads the same.
#include <cmath>
#include <cstdint>
#include <string_view>

#include "require.hpp"
#include "world/rinex/observation_reader.hpp"
#include "world/rinex/rinex_writer.hpp"

namespace {

using namespace skyloop;

void check_observation(const Observation& o) {
    require(o.pseudorange || o.carrier_phase || o.doppler);
    require(!o.pseudorange || std::isfinite(o.pseudorange->value()));
    require(!o.carrier_phase || std::isfinite(*o.carrier_phase));
    require(!o.doppler || std::isfinite(o.doppler->value()));
    require(std::isfinite(o.cn0.value()) && o.carrier.value() > 1e9 && o.lock_time.value() >= 0);
}

// The header that declares what the file holds.
ObservationHeader header_of(const ObservationFile& file) {
    ObservationHeader header;
    header.first_epoch = file.epochs.front().receive_time;
    header.glonass_channels = file.glonass_channels;
    header.marker = file.marker;
    header.receiver = file.receiver;
    for (const Observations& epoch : file.epochs)
        for (const Observation& o : epoch.signals)
            header.signals.try_emplace(o.satellite.constellation, emulated_signals(o.satellite.constellation).begin(),
                                       emulated_signals(o.satellite.constellation).end());
    return header;
}

void write_and_read(const ObservationFile& file) {
    const ObservationHeader header = header_of(file);
    if (header.signals.empty()) return;
    const ObservationWriter writer(header);
    std::string text = writer.header();
    for (const Observations& epoch : file.epochs)
        text += writer.epoch(epoch);
    const auto again = read_observations(text, "written.rnx");
    require(again.has_value());
    require(again->skipped.fields == 0 && again->skipped.satellites == 0 && again->skipped.incomplete == 0);
    // Epochs nearer than the format's 100 ns become one.
    require(again->epochs.size() + static_cast<std::size_t>(again->skipped.unordered) == file.epochs.size());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const Result<ObservationFile> file = read_observations(text, "fuzz.obs");
    if (!file) {
        require(file.error().code == ErrorCode::input && is_one_line(file.error().message));
        return 0;
    }
    require(!file->epochs.empty());
    for (const std::string& warning : file->warnings)
        require(is_one_line(warning));
    const Observations* before = nullptr;
    for (const Observations& epoch : file->epochs) {
        require(!before || before->receive_time < epoch.receive_time);
        before = &epoch;
        for (std::size_t i = 0; i < epoch.signals.size(); ++i) {
            check_observation(epoch.signals[i]);
            if (i > 0)
                require(std::pair(epoch.signals[i - 1].satellite, epoch.signals[i - 1].signal) <
                        std::pair(epoch.signals[i].satellite, epoch.signals[i].signal));
        }
    }
    write_and_read(*file);
    return 0;
}
