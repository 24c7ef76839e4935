/// The container of PX4's logs.
///
/// Layout: PX4 user guide, "ULog File Format".
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/bytes.hpp"
#include "base/core/result.hpp"
#include "receiver/observed/observed_log.hpp"

namespace skyloop::inline receiver {

/// A field of a format, by its name; nested formats are flattened, as "esc[0].rpm".
struct UlogField {
    double (*read)(ByteSpan record, std::size_t at) = nullptr;
    std::size_t offset = 0, size = 0;
};
using UlogFields = std::map<std::string, UlogField, std::less<>>;

/// One record of a topic.
class UlogRecord {
public:
    UlogRecord(const UlogFields& fields, ByteSpan bytes) : fields_(fields), bytes_(bytes) {}
    /// The value of the first of these fields that there is, or nothing.
    [[nodiscard]] std::optional<double> value(std::initializer_list<std::string_view> names) const;
    [[nodiscard]] std::optional<double> value(std::string_view name) const { return value({name}); }
    [[nodiscard]] bool has(std::string_view name) const { return fields_.contains(name); }

private:
    const UlogFields& fields_;
    ByteSpan bytes_;
};

/// All records of one topic and instance.
struct UlogStream {
    std::string topic;
    std::size_t instance = 0;
    UlogFields fields;
    std::vector<ByteSpan> records;
};

struct Ulog {
    std::vector<UlogStream> streams;  ///< of the asked topics
    std::string hardware;             ///< information "ver_hw"
    std::size_t dropouts = 0, dropout_ms = 0, skipped_bytes = 0, cut_records = 0;
};

/// One record of a receiver.
struct UlogFix {
    std::optional<double> utc_us, boot_us;  ///< since 1970, and by the autopilot's clock
    ObservedEpoch told;                     ///< without its time
    bool above_sea = false;                 ///< the height of its place is one above the sea
    std::optional<double> undulation_m;     ///< of the receiver's geoid
};

/// The records of vehicle_gps_position or sensor_gps (PX4-Autopilot, msg/SensorGps.msg), whose fields have had two
/// kinds of names. Simulators without a geoid write both heights alike, and leave the type of fix at 0: where all
/// records do, heights are above the sea, and the places are fixes.
std::vector<UlogFix> ulog_fixes(const UlogStream& stream);

/// GPS time of a POSIX time in microseconds; nothing for a clock that was not set: before 2000, or after 2100.
std::optional<GpsTime> time_of_posix_us(double microseconds);

/// Whether the bytes begin as such a log does.
bool is_ulog(ByteSpan bytes);
/// Reads the records of some topics. Damage is passed over and counted.
/// Fails with `input` for a file that says it holds what a reader of today does not know.
Result<Ulog> parse_ulog(ByteSpan bytes, const std::string& name, const std::vector<std::string_view>& topics);

}  // namespace skyloop::inline receiver
