#include <algorithm>
#include <charconv>

#include "base/core/number_in.hpp"
#include "firmware/nmea_commands.hpp"
#include "firmware/septentrio/output.hpp"

namespace skyloop::firmware {
namespace {

// Texts keep the quotation marks that they were given with; what is too long is cut.
template <std::size_t N>
std::array<char, N> characters(std::string_view text) {
    if (text.size() >= 2 && text.front() == '"' && text.back() == '"') text = text.substr(1, text.size() - 2);
    std::array<char, N> result{};
    std::copy_n(text.begin(), std::min(text.size(), N), result.begin());
    return result;
}

float metres(const std::string& text) {
    float value = 0;
    std::from_chars(text.data(), text.data() + text.size(), value);
    return value;
}

std::uint8_t index(const std::string& text) {
    return static_cast<std::uint8_t>(std::clamp(number_in<int>(text).value_or(0), 0, 255));
}

}  // namespace

SbfReceiverSetup sbf_receiver_setup(const SeptentrioSettings& settings, const BoardProfile& board) {
    const std::vector<std::string>& marker = settings.values("MarkerParameters");
    const std::vector<std::string>& observer = settings.values("ObserverParameters");
    const std::vector<std::string>& antenna = settings.values("AntennaOffset", "Main");
    SbfReceiverSetup block;
    block.marker_name = characters<60>(marker[0]);
    block.marker_number = characters<20>(marker[1]);
    block.marker_type = characters<20>(marker[2]);
    block.station_code = characters<10>(marker[3]);
    block.monument_index = index(marker[4]);
    block.receiver_index = index(marker[5]);
    block.country_code = characters<3>(marker[6]);
    block.observer = characters<20>(observer[0]);
    block.agency = characters<40>(observer[1]);
    block.delta_e = metres(antenna[0]);
    block.delta_n = metres(antenna[1]);
    block.delta_h = metres(antenna[2]);
    block.antenna_type = characters<20>(antenna[3]);
    block.antenna_serial_number = characters<20>(antenna[4]);
    block.rx_serial_number = characters<20>(board.usb ? board.usb->serial : "");
    block.rx_name = characters<20>(board.identity.hardware);
    block.rx_version = characters<20>(board.identity.software);
    block.gnss_fw_version = characters<40>(board.identity.software);
    block.product_name = characters<40>(board.identity.hardware);
    return block;
}

}  // namespace skyloop::firmware
