// Any text as the times of a recording: one line of refusal, or writes that follow each other in time and in the bytes.
#include <cstdint>
#include <string>
#include <string_view>

#include "require.hpp"
#include "run/emulator/read_recording.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace skyloop;
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    constexpr std::size_t recorded_bytes = 1000;
    auto port = read_recorded_times(text, Bytes(recorded_bytes, 'x'), "fuzz");
    if (!port) {
        require(port.error().code == ErrorCode::input && port.error().message.starts_with("fuzz:"));
        require(port.error().message.find('\n') == std::string::npos);
        return 0;
    }
    RecordedWrite last;
    for (const RecordedWrite& write : port->writes) {
        require(write.at >= last.at && write.offset == last.offset + last.length && write.length > 0);
        last = write;
    }
    require(last.offset + last.length <= recorded_bytes);
    require((last.offset + last.length < recorded_bytes) <= !port->warning.empty());
    const auto part = part_of({std::move(*port)}, Nanoseconds(1'000'000), Nanoseconds(2'000'000'000));
    for (std::size_t i = 0; part && i < part->front().writes.size(); ++i)
        require(part->front().writes[i].at >= Nanoseconds(0) &&
                part->front().writes[i].at < Nanoseconds(2'000'000'000));
    return 0;
}
