#include "detail/navigation_record.hpp"

#include "detail/kepler_record.hpp"
#include "detail/state_vector_record.hpp"

namespace skyloop::rinex {

bool begins_record(std::string_view line, int major) { return !is_blank(columns(line, 0, major == 2 ? 2 : 1)); }

std::optional<SatelliteId> record_satellite(std::string_view line, int major, Constellation system) {
    if (major != 2) return parse_satellite(columns(line, 0, 3));
    const std::optional<int> number = whole_field(columns(line, 0, 2));
    if (!number || *number < 1) return std::nullopt;
    return SatelliteId{system, *number};
}

tl::expected<Ephemeris, Defect> read_record(const RecordKind& kind, std::span<const Line> lines) {
    RecordFields fields(lines, kind.major);
    switch (kind.satellite.constellation) {
        case Constellation::glonass:
            return read_glonass_record(kind, std::move(fields));
        case Constellation::sbas:
            return read_sbas_record(kind, std::move(fields));
        default:
            return read_kepler_record(kind, std::move(fields));
    }
}

}  // namespace skyloop::rinex
