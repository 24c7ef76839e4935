#include "firmware/dronecan/node_id_client.hpp"

#include <algorithm>

namespace skyloop::firmware {
namespace {

constexpr double least_request_s = 0.6, most_request_s = 1.0, most_followup_s = 0.4;
constexpr std::size_t most_bytes = 6;  // of the unique id in one request

}  // namespace

NodeIdClient::NodeIdClient(const NodeUniqueId& unique_id, std::uint64_t seed)
    : unique_id_(unique_id), pauses_(seed, "dronecan.allocation") {}

GpsTime NodeIdClient::later(GpsTime now, double least_s, double most_s) {
    return advanced(now, Seconds(least_s + (most_s - least_s) * pauses_.uniform()));
}

void NodeIdClient::ask_anew(GpsTime now) {
    repeated_ = 0;
    asks_at_ = later(now, least_request_s, most_request_s);
}

void NodeIdClient::begin(GpsTime awake, std::uint8_t fixed) {
    id_ = fixed;
    asks_at_.reset();
    if (id_ == 0) ask_anew(awake);
}

DronecanAllocation NodeIdClient::request(GpsTime now) {
    DronecanAllocation request;
    request.first_part = repeated_ == 0 ? 1 : 0;
    const std::size_t end = std::min(repeated_ + most_bytes, unique_id_.size());
    request.unique_id.assign(unique_id_.begin() + static_cast<std::ptrdiff_t>(repeated_),
                             unique_id_.begin() + static_cast<std::ptrdiff_t>(end));
    ask_anew(now);
    return request;
}

// Whoever speaks of ids, the pause begins anew, so that those who ask do not speak at once.
void NodeIdClient::receive(const DronecanAllocation& message, std::uint8_t source, GpsTime now) {
    if (id_ != 0) return;
    ask_anew(now);
    const auto& said = message.unique_id;
    if (source == 0 || said.empty() || !std::equal(said.begin(), said.end(), unique_id_.begin())) return;
    if (said.size() == unique_id_.size()) {
        if (message.node_id == 0) return;
        id_ = static_cast<std::uint8_t>(message.node_id);
        asks_at_.reset();
        return;
    }
    repeated_ = said.size();
    asks_at_ = later(now, 0, most_followup_s);
}

}  // namespace skyloop::firmware
