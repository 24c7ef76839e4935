// Logs of autopilots from bytes made here by the published layouts.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "base/core/bytes.hpp"

namespace skyloop::test {

// Little-endian bytes, one value after the other.
class ByteWriter {
public:
    template <class Number>
    ByteWriter& put(Number value) {
        const auto* raw = reinterpret_cast<const std::uint8_t*>(&value);
        bytes.insert(bytes.end(), raw, raw + sizeof(Number));
        return *this;
    }
    ByteWriter& text(std::string_view value, std::size_t size = 0) {
        bytes.insert(bytes.end(), value.begin(), value.end());
        if (size > value.size()) bytes.resize(bytes.size() + size - value.size());
        return *this;
    }
    Bytes bytes;
};

inline void append(Bytes& to, const Bytes& more) { to.insert(to.end(), more.begin(), more.end()); }

inline ByteWriter& ulog_message(ByteWriter& log, char type, const Bytes& payload) {
    log.put(static_cast<std::uint16_t>(payload.size())).put(type);
    append(log.bytes, payload);
    return log;
}

inline ByteWriter ulog_head(std::uint8_t incompatible = 0) {
    ByteWriter log;
    log.text("ULog").put(std::uint8_t{0x01}).put(std::uint8_t{0x12}).put(std::uint8_t{0x35}).put(std::uint8_t{1});
    log.put(std::uint64_t{1000});
    ByteWriter flags;
    flags.bytes.resize(40);
    flags.bytes[8] = incompatible;
    ulog_message(log, 'B', flags.bytes);
    return log;
}

// Records of one topic, as PX4 1.13 names its fields, with a nested format and trailing padding.
inline ByteWriter ulog_of(unsigned records, std::uint8_t instance) {
    ByteWriter log = ulog_head();
    ulog_message(log, 'F', to_bytes("inner:float a;uint8_t[2] b;"));
    ulog_message(log, 'F',
                 to_bytes("sensor_gps:uint64_t timestamp;uint64_t time_utc_usec;int32_t lat;int32_t lon;int32_t alt;"
                          "int32_t alt_ellipsoid;inner[2] more;float vel_n_m_s;float vel_e_m_s;float vel_d_m_s;"
                          "uint8_t fix_type;uint8_t satellites_used;uint8_t[2] _padding0;"));
    ulog_message(log, 'A', ByteWriter().put(instance).put(std::uint16_t{5}).text("sensor_gps").bytes);
    for (unsigned i = 0; i < records; ++i) {
        ByteWriter record;
        record.put(std::uint16_t{5}).put(std::uint64_t{2'000'000 + i * 200'000u});
        record.put(i == 0 ? std::uint64_t{0} : std::uint64_t{1'709'640'000'000'000} + i * 200'000u);
        record.put(std::int32_t{470000000}).put(std::int32_t{80000000}).put(std::int32_t{450000});
        record.put(std::int32_t{500000});
        record.bytes.resize(record.bytes.size() + 12);
        record.put(1.0F).put(2.0F).put(-3.0F).put(std::uint8_t{3}).put(std::uint8_t{11});
        ulog_message(log, 'D', record.bytes);
    }
    ulog_message(log, 'O', ByteWriter().put(std::uint16_t{35}).bytes);
    return log;
}

// The length of a record follows from its letters.
inline void dataflash_format(ByteWriter& log, std::uint8_t type, std::string_view name, std::string_view letters,
                             std::string_view columns) {
    std::uint8_t length = 3;
    for (const char letter : letters)
        length = static_cast<std::uint8_t>(length + (letter == 'Q'                    ? 8
                                                     : letter == 'B'                  ? 1
                                                     : letter == 'H' || letter == 'C' ? 2
                                                                                      : 4));
    log.put(std::uint8_t{0xA3}).put(std::uint8_t{0x95}).put(std::uint8_t{128}).put(type).put(length);
    log.text(name, 4).text(letters, 16).text(columns, 64);
}

inline void dataflash_gps(ByteWriter& log, std::uint8_t instance, std::uint32_t ms, std::uint8_t status) {
    log.put(std::uint8_t{0xA3}).put(std::uint8_t{0x95}).put(std::uint8_t{130}).put(std::uint64_t{ms} * 1000);
    log.put(instance).put(status).put(ms).put(std::uint16_t{2304}).put(std::uint8_t{12}).put(std::int32_t{470000000});
    log.put(std::int32_t{80000000}).put(std::int32_t{45000}).put(10.0F).put(90.0F).put(-1.0F);
}

// @param receivers one or two; the third epoch of the first one has no fix
inline ByteWriter dataflash_log(bool with_undulation, std::uint8_t receivers = 2, std::uint32_t epochs = 5) {
    ByteWriter log;
    dataflash_format(log, 130, "GPS", "QBBIHBLLefff", "TimeUS,I,Status,GMS,GWk,NSats,Lat,Lng,Alt,Spd,GCrs,VZ");
    dataflash_format(log, 131, "GPA", "QBCCf", "TimeUS,I,HAcc,VAcc,Und");
    for (std::uint32_t i = 0; i < epochs; ++i) {
        dataflash_gps(log, 0, 216'018'000 + i * 200, i == 2 ? 1 : 6);
        if (receivers > 1) dataflash_gps(log, 1, 216'018'000 + i * 200, 3);
        for (std::uint8_t instance = 0; instance < receivers; ++instance) {
            log.put(std::uint8_t{0xA3}).put(std::uint8_t{0x95}).put(std::uint8_t{131}).put(std::uint64_t{0});
            log.put(instance).put(std::uint16_t{150}).put(std::uint16_t{250}).put(with_undulation ? -50.0F : 0.0F);
        }
    }
    return log;
}

}  // namespace skyloop::test
