#include "world/osnma/osnma_keys.hpp"

#include <algorithm>
#include <string>

#include "detail/secrets.hpp"

namespace skyloop::inline world {
namespace {

constexpr std::size_t leaves = 16, levels = 4;
constexpr std::chrono::minutes step{15};
constexpr std::int64_t blocks_of_root = 8, blocks_of_key = 13;
constexpr int alert_leaf = 16;  // among the leaves, counted from 1 on

std::string hexadecimal(ByteSpan bytes) {
    constexpr std::string_view digits = "0123456789ABCDEF";
    std::string text;
    for (const std::uint8_t byte : bytes) {
        text += digits[byte >> 4];
        text += digits[byte & 15];
    }
    return text;
}

void put_bytes(BitWriter& bits, ByteSpan bytes) {
    for (const std::uint8_t byte : bytes)
        bits.put(byte, 8);
}

// Type, number and point of a key (section 3.2.2.2): P-256; the last leaf is the alert message, which has none and
// fills its DSM to the end (tables 5 and 6).
Bytes leaf_of(std::size_t index, const Bytes& point) {
    constexpr std::uint64_t curve_p256 = 1, alert = 4;
    constexpr std::size_t before_key = 1040;  // bits
    const bool last = index + 1 == alert_leaf;
    BitWriter bits;
    bits.put(last ? alert : curve_p256, 4);
    bits.put(last ? 0 : index + 1, 4);
    put_bytes(bits, last ? Bytes((blocks_of_key * osnma_block_bits - before_key) / 8) : point);
    return bits.bytes();
}

GpsTime whole_hour(GpsTime time) { return std::chrono::floor<std::chrono::hours>(time); }

// Another one for each chain.
std::uint64_t seed_of_chain(std::uint64_t seed, int number) {
    if (number == 1) return seed;
    const Sha256Digest secret = osnma_secret(seed, "chain " + std::to_string(number));
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < sizeof value; ++i)
        value = value << 8 | secret[i];
    return value;
}

}  // namespace

struct OsnmaKeys::Secrets {
    std::vector<SigningKey> keys;
    std::vector<Bytes> told;                                 // leaves as they are told
    std::array<std::vector<Sha256Digest>, levels + 1> tree;  // level 0: the leaves' digests

    explicit Secrets(std::uint64_t seed) {
        for (std::size_t i = 0; i < leaves; ++i) {
            keys.emplace_back(osnma_secret(seed, "public key " + std::to_string(i + 1)));
            told.push_back(leaf_of(i, keys.back().public_point()));
            tree[0].push_back(sha256_of(told.back()));
        }
        for (std::size_t level = 1; level <= levels; ++level)
            for (std::size_t i = 0; i + 1 < tree[level - 1].size(); i += 2) {
                Bytes both(tree[level - 1][i].begin(), tree[level - 1][i].end());
                both.insert(both.end(), tree[level - 1][i + 1].begin(), tree[level - 1][i + 1].end());
                tree[level].push_back(sha256_of(both));
            }
    }
    [[nodiscard]] const Sha256Digest& root() const { return tree[levels].front(); }
};

// What is told over a time.
struct OsnmaKeys::Part {
    // Status of chain and public key (table 4).
    enum class KeyStatus : std::uint8_t {
        nominal = 1,
        end_of_chain = 2,
        chain_revoked = 3,
        new_public_key = 4,
        public_key_revoked = 5,
        alert = 7,
    };

    std::chrono::minutes from{0};  // after the change
    OsnmaStatus status = OsnmaStatus::operational;
    int chain = 1;  // in force
    KeyStatus keys = KeyStatus::nominal;
    int root_chain = 1, signer = 1, told = 1;  // DSM-KROOT: whose root, and who signs; DSM-PKR: of which leaf
    bool by_turns = false;                     // both messages, all the time

    [[nodiscard]] std::uint8_t header() const {
        return static_cast<std::uint8_t>(static_cast<int>(status) << 6 | chain << 4 | static_cast<int>(keys) << 1);
    }
};

std::vector<OsnmaKeys::Part> OsnmaKeys::parts_of(OsnmaChange change) {
    using enum OsnmaStatus;
    using enum Part::KeyStatus;
    switch (change) {
        case OsnmaChange::new_key:
            return {{},
                    {-step, operational, 1, new_public_key, 1, 1, 2, true},
                    {{}, operational, 1, new_public_key, 1, 2, 2, true},
                    {step, operational, 1, nominal, 1, 2, 2}};
        case OsnmaChange::new_chain:
            return {{}, {-step, operational, 1, end_of_chain, 2}, {{}, operational, 2, nominal, 2}};
        case OsnmaChange::revoked_chain:
            return {{},
                    {{}, do_not_use, 1, chain_revoked, 2},
                    {step, operational, 2, chain_revoked, 2},
                    {2 * step, operational, 2, nominal, 2}};
        case OsnmaChange::revoked_key:
            return {{},
                    {{}, do_not_use, 1, public_key_revoked, 2, 2, 2, true},
                    {step, operational, 2, public_key_revoked, 2, 2, 2, true},
                    {2 * step, operational, 2, nominal, 2, 2, 2}};
        case OsnmaChange::alert:
            return {{}, {{}, do_not_use, 1, alert, 1, 1, alert_leaf}};
        case OsnmaChange::none:
            break;
    }
    return {{}};
}

OsnmaKeys::OsnmaKeys(const OsnmaSettings& settings)
    : settings_(settings), secrets_(std::make_unique<Secrets>(settings.seed)), parts_(parts_of(settings.change)) {
    constexpr std::chrono::hours before{1};
    chains_.emplace_back(seed_of_chain(settings.seed, 1), whole_hour(settings.start) - before);
    if (parts_.back().chain == 2)
        chains_.emplace_back(seed_of_chain(settings.seed, 2), whole_hour(settings.at) - before);
    for (const Part& part : parts_) {
        roots_.push_back(root_message(part, static_cast<int>(roots_.size())));
        keys_.push_back(key_message(part));
    }
}

OsnmaKeys::~OsnmaKeys() = default;

// DSM-KROOT (section 3.2.3, tables 7 to 12): SHA-256, HMAC-SHA-256, keys of 128 bits, tags of 40 bits, tags in the
// order
// 34. Signed is the header with all from the number of the chain to the key (6.2).
OsnmaMessage OsnmaKeys::root_message(const Part& part, int id) const {
    constexpr std::uint64_t eight_blocks = 2, key_of_128 = 4, tag_of_40 = 9, tag_order = 34;
    const TeslaChain& chain = this->chain(part.root_chain);
    const WeekAndTow first = gst_week_and_tow(chain.first());
    OsnmaMessage message{part.header(), id};
    BitWriter is_signed;
    is_signed.put(message.header, 8);
    is_signed.put_signed(part.root_chain, 2);
    is_signed.put(0, 2 + 2 + 2);
    is_signed.put(key_of_128, 4);
    is_signed.put(tag_of_40, 4);
    is_signed.put(tag_order, 8);
    is_signed.put(0, 4);
    is_signed.put_signed(first.week, 12);
    is_signed.put_signed(first.tow / std::chrono::hours(1), 8);
    is_signed.put(chain.alpha(), 48);
    put_bytes(is_signed, chain.root());
    Bytes padded = is_signed.bytes();
    const Bytes signature = secrets_->keys[static_cast<std::size_t>(part.signer - 1)].sign(padded);
    padded.insert(padded.end(), signature.begin(), signature.end());
    const Sha256Digest padding = sha256_of(padded);

    BitWriter& bits = message.bits;
    bits.put(eight_blocks, 4);
    bits.put_signed(part.signer, 4);
    put_bytes(bits, ByteSpan(padded).subspan(1));
    for (std::size_t i = 0; bits.size() < blocks_of_root * osnma_block_bits; ++i)
        bits.put(padding[i], 8);
    return message;
}

// DSM-PKR (section 3.2.2.2, table 5): the key, and the nodes by which its leaf leads to the root of the tree (6.1).
// The alert message leaves no room for padding.
OsnmaMessage OsnmaKeys::key_message(const Part& part) const {
    constexpr std::uint64_t thirteen_blocks = 7;
    constexpr int first_of_keys = 12, last_of_keys = 15;
    const auto leaf = static_cast<std::size_t>(part.told - 1);
    OsnmaMessage message{part.header(), std::min(first_of_keys + part.told - 1, last_of_keys)};
    BitWriter& bits = message.bits;
    bits.put(thirteen_blocks, 4);
    bits.put(leaf, 4);
    for (std::size_t level = 0; level < levels; ++level)
        put_bytes(bits, secrets_->tree[level][leaf >> level ^ 1]);
    put_bytes(bits, secrets_->told[leaf]);
    Bytes padded(secrets_->root().begin(), secrets_->root().end());
    padded.insert(padded.end(), secrets_->told[leaf].begin(), secrets_->told[leaf].end());
    const Sha256Digest padding = sha256_of(padded);
    for (std::size_t i = 0; bits.size() < blocks_of_key * osnma_block_bits; ++i)
        bits.put(padding[i], 8);
    return message;
}

std::size_t OsnmaKeys::part_at(GpsTime subframe) const {
    std::size_t part = parts_.size() - 1;
    while (part > 0 && subframe < settings_.at + parts_[part].from)
        --part;
    return part;
}

OsnmaStatus OsnmaKeys::status(GpsTime subframe) const { return parts_[part_at(subframe)].status; }

std::optional<TeslaKey> OsnmaKeys::key(GpsTime subframe) const {
    return chain(parts_[part_at(subframe)].chain).key(subframe);
}

const OsnmaMessage& OsnmaKeys::message(GpsTime subframe) const {
    const std::size_t number = part_at(subframe);
    const Part& part = parts_[number];
    if (part.told == alert_leaf) return keys_[number];
    // How many subframes ago both messages began to come by turns.
    const std::int64_t since =
        part.by_turns ? (subframe - (settings_.at + parts_[1].from)) / osnma_subframe % (blocks_of_key + blocks_of_root)
                      : (subframe - whole_hour(subframe)) / osnma_subframe;
    return since < blocks_of_key ? keys_[number] : roots_[number];
}

int OsnmaKeys::public_keys() const { return parts_.back().signer; }

std::string OsnmaKeys::public_pem(int number) const {
    return secrets_->keys[static_cast<std::size_t>(number - 1)].public_pem();
}

std::string OsnmaKeys::tree_xml() const {
    std::string text =
        "<?xml version=\"1.0\" encoding=\"UTF-8\" standalone=\"no\"?>\n<signalData>\n<body>\n<MerkleTree>\n<N>16</N>\n"
        "<HashFunction>SHA-256</HashFunction>\n";
    for (int number = 1; number <= public_keys(); ++number) {
        const std::string point = hexadecimal(secrets_->keys[static_cast<std::size_t>(number - 1)].public_point());
        text += "<PublicKey><i>" + std::to_string(number - 1) + "</i><PKID>" + std::to_string(number) +
                "</PKID><lengthInBits>264</lengthInBits><point>" + point +
                "</point><PKType>ECDSA P-256/SHA-256</PKType></PublicKey>\n";
    }
    for (std::size_t level = 0; level <= levels; ++level)
        for (std::size_t i = 0; i < secrets_->tree[level].size(); ++i)
            text += "<TreeNode><j>" + std::to_string(level) + "</j><i>" + std::to_string(i) +
                    "</i><lengthInBits>256</lengthInBits><x_ji>" + hexadecimal(secrets_->tree[level][i]) +
                    "</x_ji></TreeNode>\n";
    return text + "</MerkleTree>\n</body>\n</signalData>\n";
}

}  // namespace skyloop::inline world
