// Galileo's authentication gone wrong, in the pages that satellites send (Galileo OSNMA SIS ICD 1.1, section 3.3).
#include <algorithm>
#include <chrono>

#include "detail/fault_catalogue.hpp"
#include "detail/signal_selector.hpp"
#include "world/gnss/broadcast_galileo.hpp"

namespace skyloop::inline run {
namespace {

// Of the 480 bits of a subframe's MACK: six tags of 40 bits, each with 16 more, then the key.
constexpr std::int64_t tag_and_info_bits = 56, tags_end = 6 * tag_and_info_bits, key_end = tags_end + 128;

// Changes the bits of MACK that a page has, each by its place in the 480 of the subframe.
template <class Change>
void change_pages(Epoch& epoch, const std::vector<SatelliteId>& satellites, Change change) {
    constexpr std::chrono::seconds pair{2}, subframe{30};
    constexpr std::int64_t page_bits = 32;
    for (Subframe& message : epoch.subframes) {
        InavWords pages{};
        const bool chosen = satellites.empty() || std::ranges::count(satellites, message.satellite) > 0;
        if (message.satellite.constellation != Constellation::galileo || message.signal != Signal::l1 || !chosen ||
            message.words.size() != pages.size())
            continue;
        std::copy(message.words.begin(), message.words.end(), pages.begin());
        const std::int64_t page = (message.end - pair).time_since_epoch() % subframe / pair;
        std::uint64_t told = inav_authentication(pages);
        for (std::int64_t i = 0; i < page_bits; ++i)
            told = change(told, page * page_bits + i, std::uint64_t{1} << (page_bits - 1 - i));
        pages = with_authentication(pages, told);
        message.words.assign(pages.begin(), pages.end());
    }
}

template <class Change>
Result<Fault> make_changed(const Parameters& parameters, Change change) {
    auto selector = read_selector(parameters);
    if (!selector) return fail(selector.error());
    return fault_of<&Fault::epoch>([satellites = selector->satellites, change](Epoch& epoch, const FaultMoment&) {
        change_pages(epoch, satellites, change);
    });
}

Result<Fault> make_wrong_tags(const Parameters& parameters, const FaultContext&) {
    return make_changed(parameters, [](std::uint64_t told, std::int64_t place, std::uint64_t bit) {
        return place < tags_end && place % tag_and_info_bits == 0 ? told ^ bit : told;
    });
}

Result<Fault> make_stopped_chain(const Parameters& parameters, const FaultContext&) {
    return make_changed(parameters, [](std::uint64_t told, std::int64_t place, std::uint64_t bit) {
        return place >= tags_end && place < key_end ? told & ~bit : told;
    });
}

constexpr auto authentication_kinds = without_strength(std::to_array<FaultKind>({
    {"osnma_wrong_tags",
     "The first bit of each tag that authenticates Galileo's navigation data is another one, with a right checksum.",
     "A spoofer that forges pages, or data that was tampered with on its way.", ParameterList{satellites_parameter},
     make_wrong_tags, of_measurements},
    {"osnma_stopped_chain",
     "No key of OSNMA's chain is disclosed any more: zeros stand in its place, and nothing that was sent from half a "
     "minute before on can be authenticated.",
     "Galileo's authentication service fails, or a spoofer knows no keys.", ParameterList{satellites_parameter},
     make_stopped_chain, of_measurements},
}));

}  // namespace

std::vector<FaultKind> authentication_fault_kinds() {
    return all_kinds_of(FaultLayer::signals, {authentication_kinds});
}

}  // namespace skyloop::inline run
