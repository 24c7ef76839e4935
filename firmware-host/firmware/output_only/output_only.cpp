#include "firmware/output_only/output_only.hpp"

namespace skyloop::firmware {

DueMessages FrameMaker::due(PortId port, EpochMessages& made, const FirmwareFaults& faults) {
    DueMessages sentences = SentenceMaker::due(port, made, faults);
    if (port != PortId::uart1) return sentences;
    DueMessages due;
    due.add(make_(made.state(), sent_));
    due.frames.insert(due.frames.end(), sentences.frames.begin(), sentences.frames.end());
    return due;
}

void FrameMaker::restart(bool keeps_ram) {
    SentenceMaker::restart(keeps_ram);
    sent_ = {};
}

std::unique_ptr<Maker> make_sentences(const BoardProfile& board, const ReceiverOptions& options) {
    return std::make_unique<SentenceMaker>(board, options);
}

std::unique_ptr<Maker> make_msp(const BoardProfile& board, const ReceiverOptions& options) {
    return std::make_unique<FrameMaker>(board, options, [](const NavigationState& state, MavlinkSent&) {
        return std::vector<Bytes>{encode_msp(msp_sensor_gps(state))};
    });
}

std::unique_ptr<Maker> make_msp_v1(const BoardProfile& board, const ReceiverOptions& options) {
    return std::make_unique<FrameMaker>(board, options, [](const NavigationState& state, MavlinkSent&) {
        return std::vector<Bytes>{encode_msp(msp_set_raw_gps(state))};
    });
}

std::unique_ptr<Maker> make_mavlink(const BoardProfile& board, const ReceiverOptions& options) {
    return std::make_unique<FrameMaker>(board, options, mavlink_messages);
}

Abilities sentence_abilities(const BoardProfile&) { return {.time = true, .calendar = true}; }

Abilities msp_abilities(const BoardProfile&) {
    return {.heading = true,
            .accuracies = true,
            .weeks = true,
            .time = true,
            .calendar = true,
            .dead_reckoning = false,
            .more = {"MSP"}};
}

Abilities msp_v1_abilities(const BoardProfile&) { return {.dead_reckoning = false, .more = {"MSP"}}; }

Abilities mavlink_abilities(const BoardProfile&) {
    return {
        .heading = true, .accuracies = true, .weeks = true, .time = true, .dead_reckoning = false, .more = {"MAVLink"}};
}

}  // namespace skyloop::firmware
