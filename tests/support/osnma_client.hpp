/// A client of OSNMA, written from the interface document (Galileo OSNMA SIS ICD 1.1) and the steps of the receiver
/// guidelines 1.3, without a line of the sender. It collects all pages first and judges then.
#pragma once

#include <openssl/evp.h>
#include <openssl/hmac.h>
#include <openssl/x509.h>

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "support/page_bits.hpp"

namespace skyloop::test {

using Octets = std::vector<std::uint8_t>;

inline Octets octets_of(const std::string& hexadecimal) {
    Octets result;
    for (std::size_t i = 0; i + 1 < hexadecimal.size(); i += 2)
        result.push_back(static_cast<std::uint8_t>(std::stoi(hexadecimal.substr(i, 2), nullptr, 16)));
    return result;
}

/// A string of bits that grows at its end.
class BitString {
public:
    BitString& add(std::uint64_t value, int width) {
        for (int bit = width - 1; bit >= 0; --bit)
            bits_.push_back(value >> bit & 1);
        return *this;
    }
    BitString& add(const BitString& other, std::size_t first, std::size_t count) {
        for (std::size_t i = first; i < first + count; ++i)
            bits_.push_back(other.bits_.at(i));
        return *this;
    }
    BitString& add(const Octets& octets) {
        for (const std::uint8_t octet : octets)
            add(octet, 8);
        return *this;
    }
    [[nodiscard]] std::size_t size() const { return bits_.size(); }
    [[nodiscard]] std::uint64_t field(std::size_t at, int width) const {
        std::uint64_t value = 0;
        for (std::size_t i = at; i < at + static_cast<std::size_t>(width); ++i)
            value = value << 1 | bits_.at(i);
        return value;
    }
    [[nodiscard]] Octets octets(std::size_t at, std::size_t count) const {
        Octets result;
        for (std::size_t i = 0; i < count; ++i)
            result.push_back(static_cast<std::uint8_t>(field(at + 8 * i, 8)));
        return result;
    }
    /// Filled up with 0 to whole octets.
    [[nodiscard]] Octets octets() const {
        BitString filled = *this;
        filled.add(0, static_cast<int>((8 - size() % 8) % 8));
        return filled.octets(0, filled.size() / 8);
    }

private:
    std::vector<std::uint8_t> bits_;
};

inline Octets digest_of(const Octets& message) {
    Octets digest(32);
    EVP_Digest(message.data(), message.size(), digest.data(), nullptr, EVP_sha256(), nullptr);
    return digest;
}

inline Octets first_of(Octets octets, std::size_t count) {
    octets.resize(count);
    return octets;
}

/// Whether r and s sign a message with the key of a compressed point of P-256.
inline bool signature_holds(const Octets& point, const Octets& signature, const Octets& message) {
    // SubjectPublicKeyInfo with a compressed point.
    Octets key = octets_of("3039301306072a8648ce3d020106082a8648ce3d030107032200");
    key.insert(key.end(), point.begin(), point.end());
    const unsigned char* at = key.data();
    const std::unique_ptr<EVP_PKEY, decltype(&EVP_PKEY_free)> pkey(
        d2i_PUBKEY(nullptr, &at, static_cast<long>(key.size())), EVP_PKEY_free);
    if (!pkey) return false;
    const auto integer = [&signature](std::size_t from) {
        Octets value(signature.begin() + static_cast<std::ptrdiff_t>(from),
                     signature.begin() + static_cast<std::ptrdiff_t>(from + 32));
        while (value.size() > 1 && value.front() == 0)
            value.erase(value.begin());
        if ((value.front() & 0x80) != 0) value.insert(value.begin(), 0);
        value.insert(value.begin(), {0x02, static_cast<std::uint8_t>(value.size())});
        return value;
    };
    Octets der = integer(0);
    const Octets s = integer(32);
    der.insert(der.end(), s.begin(), s.end());
    der.insert(der.begin(), {0x30, static_cast<std::uint8_t>(der.size())});
    const std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context(EVP_MD_CTX_new(), EVP_MD_CTX_free);
    return EVP_DigestVerifyInit(context.get(), nullptr, EVP_sha256(), nullptr, pkey.get()) == 1 &&
           EVP_DigestVerify(context.get(), der.data(), der.size(), message.data(), message.size()) == 1;
}

/// What came of the judgement.
struct OsnmaVerdict {
    int roots = 0, wrong_roots = 0;  ///< whole DSM-KROOT
    int public_keys = 0, wrong_public_keys = 0;
    int keys = 0, wrong_keys = 0;                   ///< disclosed, of each satellite and subframe
    std::map<std::uint64_t, int> tags, wrong_tags;  ///< by ADKD
    int sequences = 0, wrong_sequences = 0;         ///< MACSEQ
    std::set<std::uint64_t> signers, key_statuses;  ///< PKID of the roots, CPKS
    std::set<std::uint64_t> told_keys;              ///< PKID of DSM-PKR
    int alerts = 0;                                 ///< alert messages that the tree vouches for
    std::set<std::uint64_t> statuses, chains;       ///< NMAS, CID in force
    std::map<std::uint64_t, int> keys_by_chain;
};

class OsnmaClient {
public:
    /// Public keys by their PKID; with a root of the Merkle tree those that are told are learnt, too.
    std::map<std::uint64_t, Octets> public_keys;
    Octets merkle_root;

    /// @param week, tow of GST, at the start of the pair of pages
    void take(int satellite, std::int64_t week, std::int64_t tow, const std::vector<std::uint32_t>& pages) {
        const PageBits all{pages};
        const std::int64_t seconds = week * 604800 + tow, subframe = seconds / 30 * 30;
        Subframe& s = heard_[{satellite, subframe}];
        const auto page = static_cast<std::size_t>((seconds - subframe) / 2);
        s.root[page] = all.field(128 + 2 + 16, 8);
        s.mack[page] = all.field(128 + 2 + 16 + 8, 32);
        s.pages.insert(page);
        BitString word;
        word.add(all.field(2, 56), 56).add(all.field(58, 56), 56).add(all.field(130, 16), 16);
        s.words[static_cast<int>(word.field(0, 6))] = word;
    }

    OsnmaVerdict judge() {
        assemble();
        for (const auto& [when, s] : heard_)
            if (s.pages.size() == 15) judge_key(when, s);
        for (const auto& [when, s] : heard_)
            if (s.pages.size() == 15 && chain_of(s) != nullptr) judge_tags(when, s);
        return verdict_;
    }

private:
    using When = std::pair<int, std::int64_t>;
    struct Subframe {
        std::array<std::uint64_t, 15> root{}, mack{};
        std::set<std::size_t> pages;
        std::map<int, BitString> words;
    };
    struct Chain {
        Octets root;
        std::int64_t first = 0;  // GST_0, s
        std::uint64_t alpha = 0, order = 0;
        std::size_t key_octets = 16;
        int tag_bits = 40;
    };

    static std::uint64_t gst(std::int64_t seconds) {
        return static_cast<std::uint64_t>(seconds / 604800 % 4096) << 20 | static_cast<std::uint64_t>(seconds % 604800);
    }

    // That in force in a subframe, by its header; null: its root is not known.
    [[nodiscard]] const Chain* chain_of(const Subframe& s) const {
        const auto found = chains_.find(s.root[0] >> 4 & 3);
        return found == chains_.end() ? nullptr : &found->second;
    }

    // Blocks of a DSM by its number, until one with another content begins.
    void assemble() {
        struct Blocks {
            std::uint64_t header = 0;
            std::map<std::uint64_t, BitString> got;
        };
        std::map<std::uint64_t, Blocks> messages;
        std::map<std::int64_t, std::vector<const Subframe*>> by_time;
        for (const auto& [when, s] : heard_)
            if (s.pages.size() == 15) by_time[when.second].push_back(&s);
        for (const auto& [time, all] : by_time)
            for (const Subframe* s : all) {
                BitString hkroot;
                for (const std::uint64_t octet : s->root)
                    hkroot.add(octet, 8);
                const std::uint64_t header = hkroot.field(0, 8), id = hkroot.field(8, 4);
                if (header == 0) continue;  // a satellite without OSNMA
                verdict_.key_statuses.insert(header >> 1 & 7);
                verdict_.statuses.insert(header >> 6);
                verdict_.chains.insert(header >> 4 & 3);
                Blocks& blocks = messages[id];
                if (blocks.header != header) blocks = {header, {}};
                BitString block;
                block.add(hkroot, 16, 104);
                blocks.got[hkroot.field(12, 4)] = block;
                finish(id, header, blocks.got);
            }
    }

    void finish(std::uint64_t id, std::uint64_t header, std::map<std::uint64_t, BitString>& got) {
        if (!got.contains(0)) return;
        const std::uint64_t code = got[0].field(0, 4);
        const std::size_t count = static_cast<std::size_t>(code) + 6;  // tables 5 and 7, within their ranges
        if (got.size() < count) return;
        BitString whole;
        for (std::uint64_t i = 0; i < count; ++i)
            if (!got.contains(i))
                return;
            else
                whole.add(got[i], 0, 104);
        if (id < 12)
            judge_root(header, whole);
        else
            judge_public_key(whole);
        got.clear();
    }

    // Section 6.2: the padding and the signature over the header and all that stands before the signature.
    void judge_root(std::uint64_t header, const BitString& dsm) {
        Chain chain;
        static const std::array<std::size_t, 9> key_bits{96, 104, 112, 120, 128, 160, 192, 224, 256};
        static const std::array<int, 10> tag_lengths{10, 12, 14, 16, 18, 20, 24, 28, 32, 40};
        const std::uint64_t signer = dsm.field(4, 4);
        chain.key_octets = key_bits.at(dsm.field(16, 4)) / 8;
        chain.tag_bits = tag_lengths.at(dsm.field(20, 4));
        chain.order = dsm.field(24, 8);
        chain.first =
            static_cast<std::int64_t>(dsm.field(36, 12)) * 604800 + static_cast<std::int64_t>(dsm.field(48, 8)) * 3600;
        chain.alpha = dsm.field(56, 48);
        chain.root = dsm.octets(104, chain.key_octets);
        const std::size_t before = 104 + 8 * chain.key_octets;
        BitString message;
        message.add(header, 8).add(dsm, 8, before - 8);
        const Octets signature = dsm.octets(before, 64);
        Octets padded = message.octets();
        padded.insert(padded.end(), signature.begin(), signature.end());
        const std::size_t padding = (dsm.size() - before - 512) / 8;
        const bool sound = dsm.field(10, 6) == 0 || dsm.field(12, 4) == 0;  // SHA-256 and HMAC-SHA-256
        const bool filled = dsm.octets(before + 512, padding) == first_of(digest_of(padded), padding);
        const auto key = public_keys.find(signer);
        if (sound && filled && key != public_keys.end() && signature_holds(key->second, signature, message.octets())) {
            ++verdict_.roots;
            verdict_.signers.insert(signer);
            chains_.emplace(dsm.field(8, 2), chain);
        } else {
            ++verdict_.wrong_roots;
        }
    }

    // Section 6.1: four nodes lead from the leaf to the root of the tree.
    void judge_public_key(const BitString& dsm) {
        constexpr std::uint64_t p256 = 1, alert = 4;
        const std::uint64_t type = dsm.field(4 + 4 + 1024, 4);
        // Table 6: an alert message reaches to the end, and has no padding.
        const std::size_t key_bits = type == alert ? dsm.size() - 1040 : 264;
        BitString leaf;
        leaf.add(dsm, 4 + 4 + 1024, 4 + 4 + key_bits);
        Octets node = digest_of(leaf.octets());
        std::uint64_t place = dsm.field(4, 4);
        for (std::size_t level = 0; level < 4; ++level, place /= 2) {
            const Octets other = dsm.octets(8 + 256 * level, 32);
            Octets both = place % 2 == 0 ? node : other;
            const Octets& right = place % 2 == 0 ? other : node;
            both.insert(both.end(), right.begin(), right.end());
            node = digest_of(both);
        }
        Octets padded = merkle_root;
        const Octets told = leaf.octets();
        padded.insert(padded.end(), told.begin(), told.end());
        const std::size_t padding = (dsm.size() - 1040 - key_bits) / 8;
        const bool filled = dsm.octets(1040 + key_bits, padding) == first_of(digest_of(padded), padding);
        if (node == merkle_root && type == alert && leaf.field(4, 4) == 0) {
            ++verdict_.alerts;
        } else if (node == merkle_root && filled && type == p256) {
            ++verdict_.public_keys;
            verdict_.told_keys.insert(leaf.field(4, 4));
            public_keys[leaf.field(4, 4)] = leaf.octets(8, 33);
        } else {
            ++verdict_.wrong_public_keys;
        }
    }

    [[nodiscard]] BitString mack_of(const Subframe& s) const {
        BitString mack;
        for (const std::uint64_t word : s.mack)
            mack.add(word, 32);
        return mack;
    }

    // Section 6.3: hashed down to one that is known, or to the root.
    void judge_key(const When& when, const Subframe& s) {
        const Chain* chain = chain_of(s);
        if (chain == nullptr) return;
        const std::uint64_t number = s.root[0] >> 4 & 3;
        const BitString mack = mack_of(s);
        const std::size_t tags = tags_of(*chain, when.second).size();
        const std::size_t at = tags * (static_cast<std::size_t>(chain->tag_bits) + 16);
        const Octets key = mack.octets(at, chain->key_octets);
        if (key == Octets(chain->key_octets)) return;  // a satellite without OSNMA
        Octets node = key;
        std::int64_t time = when.second;
        while (time > chain->first - 30 && !keys_.contains({number, time})) {
            time -= 30;
            BitString message;
            message.add(node).add(gst(time), 32).add(chain->alpha, 48);
            node = first_of(digest_of(message.octets()), chain->key_octets);
        }
        const Octets& known = time > chain->first - 30 ? keys_[{number, time}] : chain->root;
        if (node == known) {
            keys_[{number, when.second}] = disclosed_[when.second] = key;
            ++verdict_.keys_by_chain[number];
            ++verdict_.keys;
        } else {
            ++verdict_.wrong_keys;
        }
    }

    struct Slot {
        std::uint64_t adkd;
        bool self, flexible;
    };
    // Annex C, MACLT 34: 00S FLX 04S FLX 12S 00E, then 00S FLX 00E 12S 00E 12E.
    [[nodiscard]] static std::vector<Slot> tags_of(const Chain& chain, std::int64_t subframe) {
        if (chain.order != 34) return {};
        if (subframe % 60 == 0)
            return {{0, true, false}, {0, false, true},  {4, true, false},
                    {0, false, true}, {12, true, false}, {0, false, false}};
        return {{0, true, false},  {0, false, true},  {0, false, false},
                {12, true, false}, {0, false, false}, {12, false, false}};
    }

    // Tables 18 and 19; nothing where a word was not received. Words that were sent in the subframe, or one before it
    // as far as the cut-off point allows.
    [[nodiscard]] std::optional<BitString> data_of(int satellite, std::uint64_t adkd, std::int64_t subframe,
                                                   std::int64_t cop) const {
        struct Part {
            int word;
            std::size_t from, to;
        };
        static const std::vector<Part> orbit{{1, 6, 126}, {2, 6, 126}, {3, 6, 128}, {4, 6, 126}, {5, 6, 73}};
        static const std::vector<Part> time{{6, 6, 105}, {10, 86, 128}};
        BitString result;
        for (const Part& part : adkd == 4 ? time : orbit) {
            const BitString* found = nullptr;
            for (std::int64_t back = 1; back <= cop && found == nullptr; ++back) {
                const auto heard = heard_.find({satellite, subframe - 30 * back});
                if (heard == heard_.end()) continue;
                const auto word = heard->second.words.find(part.word);
                if (word != heard->second.words.end()) found = &word->second;
            }
            if (found == nullptr) return std::nullopt;
            result.add(*found, part.from, part.to - part.from);
        }
        return result;
    }

    [[nodiscard]] Octets mac(const Octets& key, const BitString& message) const {
        Octets result(32);
        const Octets octets = message.octets();
        HMAC(EVP_sha256(), key.data(), static_cast<int>(key.size()), octets.data(), octets.size(), result.data(),
             nullptr);
        return result;
    }

    void judge_tags(const When& when, const Subframe& s) {
        const Chain& chain = *chain_of(s);
        const BitString mack = mack_of(s);
        const std::vector<Slot> slots = tags_of(chain, when.second);
        const auto prn = static_cast<std::uint64_t>(when.first);
        const int bits = chain.tag_bits;
        BitString hkroot;
        hkroot.add(s.root[0], 8);
        if (slots.empty() || hkroot.field(0, 8) == 0) return;
        BitString flexible;
        flexible.add(prn, 8).add(gst(when.second), 32);
        for (std::size_t i = 0; i < slots.size(); ++i) {
            // The first tag is followed by MACSEQ and its cut-off point, the others by what they are about.
            const std::size_t at = i * (static_cast<std::size_t>(bits) + 16) + static_cast<std::size_t>(bits);
            const std::uint64_t info = mack.field(at, 16), cop = info & 15;
            if (slots[i].flexible) flexible.add(info, 16);
            const std::uint64_t about = i == 0 ? prn : info >> 8, adkd = i == 0 ? 0 : info >> 4 & 15;
            const std::int64_t later = adkd == 12 ? 330 : 30;
            if (cop == 0 || !disclosed_.contains(when.second + later)) continue;
            const bool as_ordered =
                slots[i].flexible || (adkd == slots[i].adkd && (!slots[i].self || adkd == 4 || about == prn));
            const int sender = adkd == 4 ? when.first : static_cast<int>(about);
            const auto data = data_of(sender, adkd, when.second, static_cast<std::int64_t>(cop));
            if (!data) continue;
            BitString message;
            if (i > 0) message.add(about, 8);
            message.add(prn, 8).add(gst(when.second), 32).add(i + 1, 8).add(hkroot.field(0, 2), 2);
            message.add(*data, 0, data->size());
            BitString wanted;
            wanted.add(mac(disclosed_[when.second + later], message));
            const bool right =
                as_ordered && wanted.field(0, bits) == mack.field(at - static_cast<std::size_t>(bits), bits);
            ++(right ? verdict_.tags : verdict_.wrong_tags)[adkd];
        }
        if (!disclosed_.contains(when.second + 30)) return;
        BitString wanted;
        wanted.add(mac(disclosed_[when.second + 30], flexible));
        const bool same = wanted.field(0, 12) == mack.field(static_cast<std::size_t>(bits), 12);
        ++(same ? verdict_.sequences : verdict_.wrong_sequences);
    }

    std::map<When, Subframe> heard_;
    std::map<std::uint64_t, Chain> chains_;                          // by CID
    std::map<std::pair<std::uint64_t, std::int64_t>, Octets> keys_;  // by chain and the subframe that discloses them
    std::map<std::int64_t, Octets> disclosed_;                       // by the subframe alone
    OsnmaVerdict verdict_;
};

}  // namespace skyloop::test
