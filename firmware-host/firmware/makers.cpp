#include "firmware/makers.hpp"

#include <array>

#include "firmware/airoha/airoha.hpp"
#include "firmware/mediatek/mediatek.hpp"
#include "firmware/output_only/output_only.hpp"
#include "firmware/septentrio/septentrio.hpp"
#include "firmware/ublox/ublox.hpp"

namespace skyloop::firmware {
namespace {

// In the order of MakerKind.
constexpr auto makers = std::to_array<MakerRow>({
    {"mute", make_sentences},
    {"ublox", make_ublox, ublox_refuses},
    {"mtk", make_mediatek},
    {"airoha", make_airoha},
    {"msp", make_msp},
    {"msp-v1", make_msp_v1},
    {"mavlink", make_mavlink},
    {"sbf", make_septentrio},
});

}  // namespace

std::span<const MakerRow> maker_rows() { return makers; }

const MakerRow& maker_row(MakerKind kind) { return makers.at(static_cast<std::size_t>(kind)); }

std::optional<RefusedOptions> refused_options(const BoardProfile& board, const ReceiverOptions& options) {
    const MakerRow& row = maker_row(board.maker);
    return row.refuses == nullptr ? std::nullopt : row.refuses(board, options);
}

}  // namespace skyloop::firmware
