// CFG-NMEA in its three forms (RECEIVER.md 3.3).
#include <algorithm>
#include <optional>

#include "firmware/config/legacy_keys.hpp"
#include "firmware/config/legacy_support.hpp"
#include "receiver/protocol/ubx_cfg_output.hpp"

namespace skyloop::firmware {
namespace {

constexpr BitKey nmea_filter[] = {{0, key::nmea_out_invfix},  {1, key::nmea_out_mskfix},  {2, key::nmea_out_invtime},
                                  {3, key::nmea_out_invdate}, {4, key::nmea_out_onlygps}, {5, key::nmea_out_frozencog}};
constexpr BitKey nmea_flags[] = {
    {0, key::nmea_compat}, {1, key::nmea_consider}, {2, key::nmea_limit82}, {3, key::nmea_highprec}};
constexpr BitKey nmea_gnss_filter[] = {{0, key::nmea_filt_gps},  {1, key::nmea_filt_sbas}, {2, key::nmea_filt_gal},
                                       {4, key::nmea_filt_qzss}, {5, key::nmea_filt_glo},  {6, key::nmea_filt_bds}};

/// Versions as CFG-NMEA-PROTVER and as CFG-NMEA numbers them.
struct NumberedVersion {
    std::uint8_t item, wire;
};
constexpr NumberedVersion numbered_versions[] = {{21, 0x21}, {23, 0x23}, {40, 0x40}, {41, 0x41}, {42, 0x4B}};

CfgNmeaCore describe_core(const LegacyContext& context) {
    CfgNmeaCore core;
    core.filter = static_cast<std::uint8_t>(bits_in_force(context, nmea_filter));
    const auto* const version =
        std::ranges::find(numbered_versions, context.store.value(key::nmea_protver), &NumberedVersion::item);
    if (version != std::end(numbered_versions)) core.nmea_version = version->wire;
    core.num_sv = in_force<std::uint8_t>(context, key::nmea_maxsvs);
    core.flags = static_cast<std::uint8_t>(bits_in_force(context, nmea_flags));
    return core;
}

CfgNmeaExtension describe_extension(const LegacyContext& context, std::uint8_t version) {
    CfgNmeaExtension extension;
    extension.gnss_to_filter = bits_in_force(context, nmea_gnss_filter);
    extension.sv_numbering = in_force<std::uint8_t>(context, key::nmea_svnumbering);
    extension.main_talker_id = in_force<std::uint8_t>(context, key::nmea_main_talker);
    extension.gsv_talker_id = in_force<std::uint8_t>(context, key::nmea_gsv_talker);
    extension.version = version;
    return extension;
}

/// Each generation answers in the longest form that it knows.
ConfigOutcome poll_nmea(const LegacyContext& context) {
    const int generation = context.board.identity.generation;
    const CfgNmeaCore core = describe_core(context);
    if (generation <= 6) return legacy_answered(CfgNmeaShort{core});
    if (generation == 7) return legacy_answered(CfgNmeaV0{core, describe_extension(context, 0)});
    CfgNmea answer{core, describe_extension(context, 1), {}, {}};
    const auto talker = in_force<std::uint16_t>(context, key::nmea_bds_talker);
    answer.bds_talker_id = {static_cast<std::uint8_t>(talker & 0xFF), static_cast<std::uint8_t>(talker >> 8)};
    return legacy_answered(answer);
}

/// False for a version of NMEA that no receiver has.
bool put_core(LegacyChanges& changes, const CfgNmeaCore& core) {
    const auto* const version = std::ranges::find(numbered_versions, core.nmea_version, &NumberedVersion::wire);
    if (version == std::end(numbered_versions)) return false;
    changes.put_bits(nmea_filter, core.filter);
    changes.put(key::nmea_protver, version->item);
    changes.put(key::nmea_maxsvs, core.num_sv);
    changes.put_bits(nmea_flags, core.flags);
    return true;
}

void put_extension(LegacyChanges& changes, const CfgNmeaExtension& extension) {
    changes.put_bits(nmea_gnss_filter, extension.gnss_to_filter);
    changes.put(key::nmea_svnumbering, extension.sv_numbering);
    changes.put(key::nmea_main_talker, extension.main_talker_id);
    changes.put(key::nmea_gsv_talker, extension.gsv_talker_id);
}

}  // namespace

ConfigOutcome legacy_nmea(const LegacyContext& context, ByteSpan payload) {
    if (payload.empty()) return poll_nmea(context);
    const int generation = context.board.identity.generation;
    LegacyChanges changes(context);
    if (const auto shortest = decode_payload<CfgNmeaShort>(payload)) {
        return put_core(changes, shortest->core) ? changes.apply() : legacy_refused();
    }
    if (const auto v0 = decode_payload<CfgNmeaV0>(payload); v0 && generation >= 7 && v0->extension.version == 0) {
        if (!put_core(changes, v0->core)) return legacy_refused();
        put_extension(changes, v0->extension);
        return changes.apply();
    }
    const auto v1 = decode_payload<CfgNmea>(payload);
    if (!v1 || generation < 8 || v1->extension.version != 1 || !put_core(changes, v1->core)) return legacy_refused();
    put_extension(changes, v1->extension);
    changes.put(key::nmea_bds_talker, static_cast<std::uint16_t>(v1->bds_talker_id[0] | v1->bds_talker_id[1] << 8));
    return changes.apply();
}

}  // namespace skyloop::firmware
