#include "firmware/core/maker.hpp"

namespace skyloop::firmware {

void DueMessages::add(std::vector<Bytes> messages) {
    for (Bytes& message : messages) {
        own.push_back(std::move(message));
        frames.emplace_back(own.back());  // whose bytes stay where they are when the list moves
    }
}

std::vector<StreamPiece> Maker::cut(PortUnit& unit, ByteSpan bytes, GpsTime now) {
    return unit.splitter.feed(bytes, now);
}

std::optional<std::vector<PortMessage>> Maker::correction_reports(const CorrectionAnswer&,
                                                                  const FirmwareFaults&) const {
    return std::nullopt;
}

void Maker::restrict(NavigationState&) const {}
void Maker::follow(const NavigationState&, GpsTime) {}
void Maker::begin(GpsTime) {}
std::vector<PortMessage> Maker::act(GpsTime, const FirmwareFaults&) { return {}; }
std::string_view Maker::navigation_text(bool) const { return {}; }
std::vector<Bytes> Maker::greeting(PortId) const { return {}; }
void Maker::navigation_restarts(const Forgotten&) {}

Result<void> Maker::configure(const std::map<std::uint32_t, std::uint64_t>& items) {
    if (items.empty()) return {};
    return fail(ErrorCode::usage, board_.name + " is no u-blox receiver and has no configuration items");
}

}  // namespace skyloop::firmware
