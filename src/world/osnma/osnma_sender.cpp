#include "world/osnma/osnma_sender.hpp"

#include <algorithm>
#include <array>

#include "detail/cryptography.hpp"
#include "world/gnss/broadcast_galileo.hpp"

namespace skyloop::inline world {
namespace {

constexpr int tag_bits = 40, sequence_bits = 12, root_bits = 120, tags_bits = 480;
constexpr int time_data = 255;  // PRN_D of ADKD 4
constexpr int longest_cop = 15;
constexpr std::int64_t slow_delay = 10;  // subframes more of ADKD 12 (section 5.2)

// What the six tags of a subframe are about, by MACLT 34 (annex C): in the first half of a minute, and in the second.
enum class About { itself, other, slow_itself, slow_other, time };
struct Slot {
    About about;
    bool flexible;
};
constexpr std::array<std::array<Slot, 6>, 2> tag_order_34{{
    {{{About::itself, false},
      {About::other, true},
      {About::time, false},
      {About::other, true},
      {About::slow_itself, false},
      {About::other, false}}},
    {{{About::itself, false},
      {About::other, true},
      {About::other, false},
      {About::slow_itself, false},
      {About::other, false},
      {About::slow_other, false}}},
}};

std::uint64_t adkd_of(About about) {
    if (about == About::time) return 4;
    return about == About::slow_itself || about == About::slow_other ? 12 : 0;
}

void append(BitWriter& to, const BitWriter& from, std::size_t first, std::size_t count) {
    for (std::size_t i = first; i < first + count; ++i)
        to.put(from.bit(i) ? 1 : 0, 1);
}

}  // namespace

struct OsnmaSender::Context {
    const NavigationSource& sent;
    const LeapSeconds& leap_seconds;
    GpsTime subframe;

    [[nodiscard]] std::int64_t count() const { return subframe.time_since_epoch() / osnma_subframe; }
    // The record of the first word of a subframe.
    [[nodiscard]] std::optional<KeplerEphemeris> record(int number, GpsTime of) const {
        constexpr std::chrono::seconds first_word{3};
        const auto found = sent.ephemeris({Constellation::galileo, number}, of + first_word);
        const auto* record = found ? std::get_if<KeplerEphemeris>(&*found) : nullptr;
        if (record == nullptr || record->message == NavigationMessage::almanac) return std::nullopt;
        return *record;
    }
    // Of words 1 to 5 without their types, 549 bits (table 18); nothing of a satellite that sends none.
    [[nodiscard]] BitWriter ephemeris(int number, GpsTime of) const {
        constexpr std::array<std::size_t, 5> ends{126, 126, 128, 126, 73};
        BitWriter bits;
        const auto told = record(number, of);
        for (int word = 1; told && word <= 5; ++word) {
            const BitWriter whole = inav_word({*told, sent.ionosphere(), leap_seconds}, word, of);
            append(bits, whole, 6, ends[static_cast<std::size_t>(word - 1)] - 6);
        }
        return bits;
    }
    // Of words 6 and 10, 141 bits (table 19): word 6 comes in each subframe, 10 in the second one of a minute.
    [[nodiscard]] BitWriter time(GpsTime of) const {
        constexpr std::chrono::seconds word_6{5}, word_10{9}, minute{60};
        const bool second = of.time_since_epoch() % minute != Nanoseconds(0);
        const KeplerEphemeris nobody;
        const InavData told{nobody, sent.ionosphere(), leap_seconds};
        BitWriter bits;
        append(bits, inav_word(told, 6, of + word_6), 6, 99);
        append(bits, inav_word(told, 10, (second ? of : of - osnma_subframe) + word_10), 86, 42);
        return bits;
    }
};

const BitWriter& OsnmaSender::data(const Context& context, const Data& which) {
    const auto known = data_.find(which);
    if (known != data_.end()) return known->second;
    return data_[which] =
               which.of == time_data ? context.time(which.subframe) : context.ephemeris(which.of, which.subframe);
}

// In how many subframes before this one the same data was sent, the cut-off point: 0 … 15.
int OsnmaSender::unchanged(const Context& context, int of) {
    const BitWriter last = data(context, {of, context.subframe - osnma_subframe});
    if (last.size() == 0) return 0;
    int count = 1;
    while (count < longest_cop &&
           data(context, {of, context.subframe - (count + 1) * osnma_subframe}).bytes() == last.bytes())
        ++count;
    return count;
}

// Who else is authenticated, beginning with another one in each subframe.
std::vector<int> OsnmaSender::others(const Context& context, int sender) {
    std::vector<int> result;
    for (const SatelliteId id : context.sent.satellites())
        if (id.constellation == Constellation::galileo && id.number != sender &&
            data(context, {id.number, context.subframe - osnma_subframe}).size() > 0)
            result.push_back(id.number);
    if (!result.empty())
        std::rotate(result.begin(),
                    result.begin() + (context.count() * 3 + sender) % static_cast<std::int64_t>(result.size()),
                    result.end());
    return result;
}

// A tag and what it is about (sections 3.3 and 5.3, tables 14 and 15); the first one is of the sender itself and does
// not say so.
OsnmaSender::Tag OsnmaSender::tag(const Context& context, int sender, const TagPlace& place, const TeslaKey& key) {
    BitWriter message;
    if (place.number > 1) message.put_signed(place.of, 8);
    message.put_signed(sender, 8);
    message.put(osnma_time(context.subframe), 32);
    message.put_signed(place.number, 8);
    message.put(static_cast<std::uint64_t>(keys_->status(context.subframe)), 2);
    const BitWriter& authenticated = data(context, {place.of, context.subframe - osnma_subframe});
    append(message, authenticated, 0, authenticated.size());
    const Sha256Digest mac = hmac_sha256(key, message.bytes());
    Tag result;
    for (std::size_t byte = 0; byte < tag_bits / 8; ++byte)
        result.value = result.value << 8 | mac[byte];
    result.info = static_cast<std::uint64_t>(place.of) << 8 | place.adkd << 4 |
                  static_cast<std::uint64_t>(unchanged(context, place.of));
    return result;
}

// MACK (section 3.3): the first tag, the code of what the flexible ones are about, the other tags, and the key of the
// subframe before.
BitWriter OsnmaSender::tags(const Context& context, int sender) {
    // Tags are made with the key that will be disclosed, also where another chain is in force by then.
    const auto key_of = [&](std::int64_t later) { return keys_->key(context.subframe + later * osnma_subframe); };
    const auto key = key_of(0), next = key_of(1), slow = key_of(1 + slow_delay);
    BitWriter bits, flexible;
    if (!key || !next || !slow) {
        bits.put(0, tags_bits);
        return bits;
    }
    const std::vector<int> known = others(context, sender);
    flexible.put_signed(sender, 8);
    flexible.put(osnma_time(context.subframe), 32);
    std::size_t turn = 0;
    std::vector<Tag> made;
    for (const Slot slot : tag_order_34[static_cast<std::size_t>(context.count() % 2)]) {
        const bool foreign = (slot.about == About::other || slot.about == About::slow_other) && !known.empty();
        const std::uint64_t adkd = adkd_of(slot.about);
        const int of = slot.about == About::time ? time_data : foreign ? known[turn++ % known.size()] : sender;
        const TagPlace place{static_cast<int>(made.size()) + 1, of, adkd};
        made.push_back(tag(context, sender, place, adkd == 12 ? *slow : *next));
        if (slot.flexible) flexible.put(made.back().info, 16);
    }
    const Sha256Digest sequence = hmac_sha256(*next, flexible.bytes());
    bits.put(made[0].value, tag_bits);
    bits.put(static_cast<std::uint64_t>(sequence[0]) << 4 | sequence[1] >> 4, sequence_bits);
    bits.put(made[0].info, 4);
    for (std::size_t i = 1; i < made.size(); ++i) {
        bits.put(made[i].value, tag_bits);
        bits.put(made[i].info, 16);
    }
    for (const std::uint8_t byte : *key)
        bits.put(byte, 8);
    bits.put(0, tags_bits - static_cast<int>(bits.size()));
    return bits;
}

// HKROOT (section 3.2): headers and a block; satellites begin with different ones, so that who hears many is soon done.
BitWriter OsnmaSender::root_block(const Context& context, int sender) const {
    const OsnmaMessage& message = keys_->message(context.subframe);
    const auto blocks = static_cast<std::int64_t>(message.bits.size()) / osnma_block_bits;
    const std::int64_t block = (context.count() + sender) % blocks;
    BitWriter bits;
    bits.put(message.header, 8);
    bits.put_signed(message.id, 4);
    bits.put_signed(block, 4);
    append(bits, message.bits, static_cast<std::size_t>(block) * osnma_block_bits, osnma_block_bits);
    return bits;
}

std::uint64_t OsnmaSender::field(SatelliteId sender, const NavigationSource& sent, const LeapSeconds& leap_seconds,
                                 GpsTime start) {
    constexpr std::int64_t pages = 15;
    constexpr std::chrono::seconds pair{2};
    const Nanoseconds into = start.time_since_epoch() % osnma_subframe;
    const GpsTime subframe = start - into;
    const Context context{sent, leap_seconds, subframe};
    if (subframe_ != subframe) {
        subframe_ = subframe;
        messages_.clear();
        std::erase_if(data_, [&](const auto& one) {
            return one.first.subframe < subframe - (longest_cop + 1) * osnma_subframe || one.first.subframe >= subframe;
        });
    }
    auto message = messages_.find(sender.number);
    if (message == messages_.end()) {
        BitWriter whole = root_block(context, sender.number);
        const BitWriter mack = tags(context, sender.number);
        append(whole, mack, 0, mack.size());
        message = messages_.emplace(sender.number, std::move(whole)).first;
    }
    const auto page = static_cast<std::size_t>(into / pair % pages);
    return message->second.field(8 * page, 8) << 32 | message->second.field(root_bits + 32 * page, 32);
}

}  // namespace skyloop::inline world
