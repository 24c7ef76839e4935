#include "firmware/makers.hpp"

#include <array>

#include "firmware/airoha/airoha.hpp"
#include "firmware/casic/casic.hpp"
#include "firmware/dronecan/dronecan.hpp"
#include "firmware/mediatek/mediatek.hpp"
#include "firmware/output_only/output_only.hpp"
#include "firmware/quectel/quectel.hpp"
#include "firmware/septentrio/septentrio.hpp"
#include "firmware/ublox/ublox.hpp"
#include "firmware/ufirebird/ufirebird.hpp"
#include "firmware/unicore/unicore.hpp"

namespace skyloop::firmware {
namespace {

// In the order of MakerKind.
constexpr auto all_makers = std::to_array<MakerRow>({
    {"mute", make_sentences, sentence_abilities},
    {"ublox", make_ublox, ublox_abilities, ublox_refuses},
    {"mtk", make_mediatek, mediatek_abilities},
    {"airoha", make_airoha, airoha_abilities},
    {"msp", make_msp, msp_abilities},
    {"msp-v1", make_msp_v1, msp_v1_abilities},
    {"mavlink", make_mavlink, mavlink_abilities},
    {"sbf", make_septentrio, septentrio_abilities},
    {"unicore", make_unicore, unicore_abilities},
    {"dronecan", make_dronecan, dronecan_abilities},
    {"casic", make_casic, casic_abilities},
    {"quectel", make_quectel, quectel_abilities},
    {"ufirebird", make_ufirebird, ufirebird_abilities},
});

}  // namespace

std::span<const MakerRow> maker_rows() { return all_makers; }

const MakerRow& maker_row(MakerKind kind) { return all_makers.at(static_cast<std::size_t>(kind)); }

Abilities abilities(const BoardProfile& board) { return maker_row(board.maker).abilities(board); }

std::optional<RefusedOptions> refused_options(const BoardProfile& board, const ReceiverOptions& options) {
    const MakerRow& row = maker_row(board.maker);
    return row.refuses == nullptr ? std::nullopt : row.refuses(board, options);
}

}  // namespace skyloop::firmware
