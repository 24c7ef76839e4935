#include "firmware/dronecan/dronecan.hpp"

#include <algorithm>
#include <chrono>
#include <string_view>

#include "base/core/words.hpp"
#include "firmware/dronecan/gnss_messages.hpp"
#include "firmware/dronecan/node_parameters.hpp"

namespace skyloop::firmware {
namespace {

constexpr std::chrono::seconds status_period{1};
constexpr std::uint8_t longest_padding = 0xFF;
// The node that shares an id has been on for so much longer, s.
constexpr std::uint64_t uptime_of_double = 1000;

void put_number(NodeUniqueId& id, std::size_t at, std::uint64_t number, std::size_t bytes) {
    for (std::size_t i = 0; i < bytes; ++i)
        id[at + i] = static_cast<std::uint8_t>(number >> (8 * (bytes - 1 - i)));
}

// The same in every run, whatever its seed: a server of ids knows the node again.
NodeUniqueId unique_id_of(const BoardProfile& board, std::size_t number) {
    NodeUniqueId id{'s', 'k', 'y'};
    id[3] = static_cast<std::uint8_t>(board.identity.unique_id.size());
    if (board.identity.unique_id.empty())
        put_number(id, 4, fnv1a_64(board.name), 8);
    else
        std::ranges::copy(board.identity.unique_id, id.begin() + 4);
    put_number(id, 12, number + 1, 4);
    return id;
}

// Bytes of RTCM 3 among what a message has of it.
template <class Message>
void take_rtcm(const DronecanTransfer& transfer, PortUnit& unit, GpsTime now, std::vector<StreamPiece>& pieces) {
    const auto message = decode_bits<Message>(transfer.payload);
    if (!message) return;
    for (StreamPiece& piece : unit.splitter.feed(message->data, now))
        if (piece.kind == StreamKind::rtcm3) pieces.push_back(std::move(piece));
}

bool is_type(const DronecanTransfer& transfer, const DronecanType& type) {
    return transfer.kind == type.kind && transfer.type_id == type.id;
}

}  // namespace

Bytes NodeOutput::lines(const DronecanTransfer& transfer, std::uint64_t signature) {
    std::string text;
    for (const CanFrame& frame : dronecan_frames(transfer, signature))
        text += slcan_line(frame);
    return to_bytes(text);
}

Bytes NodeOutput::send(DronecanTransfer transfer, std::uint64_t signature) {
    constexpr std::uint8_t most_transfer_id = 31;
    std::uint8_t& next = next_ids_[transfer.type_id];
    transfer.transfer_id = next;
    next = static_cast<std::uint8_t>(next == most_transfer_id ? 0 : next + 1);
    return lines(transfer, signature);
}

DronecanMaker::DronecanMaker(const BoardProfile& board, const ReceiverOptions& options)
    : SentenceMaker(board, options, false, node_settings(board, options)),
      unique_id_(unique_id_of(board, options.number)),
      ids_(unique_id_, options.seed) {}

const ReceiverConfig& DronecanMaker::config() const {
    const ReceiverConfig& common = SentenceMaker::config();
    if (config_revision_ == revision()) return config_;
    config_ = common;
    for (PortConfig& port : config_.ports)
        port.in.rtcm3 = true;
    config_revision_ = revision();
    return config_;
}

void DronecanMaker::begin(GpsTime awake) {
    began_ = awake;
    ids_.begin(awake, static_cast<std::uint8_t>(settings().value(NodeSettings::node_id)));
    status_at_ = ids_.id() == 0 ? std::nullopt : std::optional(awake);
    transfers_ = {};
}

std::optional<GpsTime> DronecanMaker::acts_at() const { return status_at_ ? status_at_ : ids_.asks_at(); }

std::vector<PortMessage> DronecanMaker::act(GpsTime now, const FirmwareFaults& faults) {
    Bytes bytes;
    if (!status_at_) {
        bytes = output_.broadcast(0, ids_.request(now));
    } else {
        *status_at_ += status_period;
        const std::uint8_t id = ids_.id();
        if (!faults.no_node_status) bytes = output_.broadcast(id, status(now));
        if (faults.shares_node_id) {
            DronecanNodeStatus other = status(now);
            other.uptime = other.uptime + uptime_of_double;
            const Bytes more = double_output_.broadcast(id, other);
            bytes.insert(bytes.end(), more.begin(), more.end());
        }
    }
    std::vector<PortMessage> messages;
    for (const PortId port : board().ports)
        if (!bytes.empty()) messages.push_back({port, bytes});
    return messages;
}

DronecanNodeStatus DronecanMaker::status(GpsTime now) const {
    DronecanNodeStatus status;
    status.uptime = static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::seconds>(now - began_).count());
    return status;
}

DronecanGetNodeInfoResponse DronecanMaker::info(GpsTime now) const {
    DronecanGetNodeInfoResponse info;
    info.status = status(now);
    info.software_major = info.hardware_major = 1;
    std::ranges::copy(unique_id_, info.unique_id.begin());
    info.name.assign(board().can.name.begin(), board().can.name.end());
    return info;
}

std::vector<StreamPiece> DronecanMaker::cut(PortUnit& unit, ByteSpan bytes, GpsTime now) {
    std::vector<StreamPiece> pieces;
    for (const std::string& line : lines_[unit.id].feed(bytes)) {
        const auto frame = parse_slcan_line(line);
        if (!frame) {
            pieces.push_back({StreamKind::noise, to_bytes(line)});
            continue;
        }
        const auto transfer = transfers_.take(*frame, now);
        if (!transfer || (transfer->destination != 0 && transfer->destination != ids_.id())) continue;
        if (is_type(*transfer, DronecanRtcmStream::type))
            take_rtcm<DronecanRtcmStream>(*transfer, unit, now, pieces);
        else if (is_type(*transfer, DronecanMovingBaselineData::type))
            take_rtcm<DronecanMovingBaselineData>(*transfer, unit, now, pieces);
        else
            pieces.push_back(
                {StreamKind::command,
                 NodeOutput::lines(*transfer, find_dronecan_type(transfer->kind, transfer->type_id)->signature)});
    }
    return pieces;
}

CommandOutcome DronecanMaker::receive(const StreamPiece& piece, const Situation& asked) {
    TransferReceiver whole;
    std::optional<DronecanTransfer> transfer;
    for (const std::string& line : SlcanLines().feed(piece.bytes))
        if (const auto frame = parse_slcan_line(line)) transfer = whole.take(*frame, asked.now);
    if (!transfer) return {};
    if (transfer->kind == DronecanKind::request) return answer(*transfer, asked);
    // Those that ask without an id send two bits of the type alone.
    const bool allocation = transfer->type_id == DronecanAllocation::type.id;
    const auto message = allocation ? decode_bits<DronecanAllocation>(transfer->payload) : std::nullopt;
    if (!message) return {};
    ids_.receive(*message, transfer->source, asked.now);
    if (ids_.id() != 0 && !status_at_) status_at_ = asked.now;
    return {};
}

CommandOutcome DronecanMaker::answer(const DronecanTransfer& request, const Situation& asked) {
    CommandOutcome outcome;
    if (is_type(request, DronecanGetNodeInfoRequest::type)) answer_info(request, asked, outcome);
    if (is_type(request, DronecanExecuteOpcodeRequest::type)) answer_opcode(request, outcome);
    if (is_type(request, DronecanRestartNodeRequest::type)) answer_restart(request, outcome);
    if (is_type(request, DronecanGetSetRequest::type))
        if (const auto asks = decode_bits<DronecanGetSetRequest>(request.payload))
            outcome.answers.push_back(output_.respond(request, get_or_set(*asks, settings())));
    if (is_type(request, DronecanBeginFirmwareUpdateRequest::type)) {
        constexpr std::string_view why = "this node has no firmware to update";
        DronecanBeginFirmwareUpdateResponse refusal;
        refusal.error = DronecanBeginFirmwareUpdateResponse::invalid_mode;
        refusal.message.assign(why.begin(), why.end());
        outcome.answers.push_back(output_.respond(request, refusal));
    }
    return outcome;
}

void DronecanMaker::answer_info(const DronecanTransfer& request, const Situation& asked, CommandOutcome& outcome) {
    DronecanGetNodeInfoResponse told = info(asked.now);
    outcome.answers.push_back(output_.respond(request, told));
    if (!asked.faults.shares_node_id) return;
    told.status.uptime = told.status.uptime + uptime_of_double;
    told.unique_id[0] = longest_padding;
    outcome.answers.push_back(output_.respond(request, told));
}

void DronecanMaker::answer_opcode(const DronecanTransfer& request, CommandOutcome& outcome) {
    const auto asks = decode_bits<DronecanExecuteOpcodeRequest>(request.payload);
    if (!asks) return;
    DronecanExecuteOpcodeResponse answer;
    answer.ok = 1;
    if (asks->opcode == DronecanExecuteOpcodeRequest::save)
        save_parameters(settings());
    else if (asks->opcode == DronecanExecuteOpcodeRequest::erase)
        erase_parameters(settings());
    else
        answer.ok = 0;
    if (answer.ok != 0) outcome.work = board().timing.flash_write;
    outcome.answers.push_back(output_.respond(request, answer));
}

void DronecanMaker::answer_restart(const DronecanTransfer& request, CommandOutcome& outcome) {
    const auto asks = decode_bits<DronecanRestartNodeRequest>(request.payload);
    if (!asks) return;
    DronecanRestartNodeResponse answer;
    answer.ok = asks->magic_number == DronecanRestartNodeRequest::magic ? 1 : 0;
    if (answer.ok != 0) outcome.reset = Reset{Reset::Kind::software, Forgotten::of(StartKind::hot)};
    outcome.answers.push_back(output_.respond(request, answer));
}

DueMessages DronecanMaker::due(PortId port, EpochMessages& made, const FirmwareFaults&) {
    DueMessages due;
    const std::uint8_t id = ids_.id();
    if (id == 0 || port != board().ports.front()) return due;
    const NavigationState& state = made.state();
    std::vector<Bytes> messages{output_.broadcast(id, dronecan_fix(state, leaves_at_)),
                                output_.broadcast(id, dronecan_auxiliary(state))};
    if (board().can.two_antennas) {
        if (const auto heading = dronecan_heading(state)) messages.push_back(output_.broadcast(id, *heading));
    } else if (const auto heading = dronecan_relative_heading(state)) {
        messages.push_back(output_.broadcast(id, *heading));
    }
    due.add(std::move(messages));
    return due;
}

std::unique_ptr<Maker> make_dronecan(const BoardProfile& board, const ReceiverOptions& options) {
    return std::make_unique<DronecanMaker>(board, options);
}

Abilities dronecan_abilities(const BoardProfile&) {
    return {.choice = Abilities::MessageChoice::rates,
            .heading = true,
            .accuracies = true,
            .time = true,
            .dead_reckoning = false,
            .corrections = true,
            .more = {"DroneCAN"}};
}

}  // namespace skyloop::firmware
