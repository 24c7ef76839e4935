#include "world/osnma/osnma_keys.hpp"

#include <algorithm>
#include <string>

#include "detail/secrets.hpp"

namespace skyloop::inline world {
namespace {

constexpr std::size_t leaves = 16, levels = 4;
constexpr std::chrono::minutes announced_for{15};
constexpr std::uint64_t nominal = 1, new_public_key = 4;  // status of chain and public key (table 4)
constexpr std::uint64_t chain_number = 1;
constexpr std::int64_t blocks_of_root = 8, blocks_of_key = 13;

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

// Type, number and point of a key (section 3.2.2.2): P-256; the last leaf stands for the alert message, which has none.
Bytes leaf_of(std::size_t index, const Bytes& point) {
    constexpr std::uint64_t curve_p256 = 1, alert = 4;
    const bool last = index + 1 == leaves;
    BitWriter bits;
    bits.put(last ? alert : curve_p256, 4);
    bits.put(last ? 0 : index + 1, 4);
    put_bytes(bits, last ? Bytes(point.size()) : point);
    return bits.bytes();
}

GpsTime whole_hour(GpsTime time) { return std::chrono::floor<std::chrono::hours>(time); }

std::uint8_t header_of(std::uint64_t key_status) {
    return static_cast<std::uint8_t>(OsnmaKeys::status << 6 | chain_number << 4 | key_status << 1);
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

OsnmaKeys::OsnmaKeys(const OsnmaSettings& settings)
    : settings_(settings),
      chain_(settings.seed, whole_hour(settings.start) - std::chrono::hours(1)),
      secrets_(std::make_unique<Secrets>(settings.seed)) {
    constexpr int first_of_keys = 12;
    struct Part {
        std::uint64_t key_status;
        int signer, told;
    };
    // Before, announced, changed, after.
    constexpr std::array<Part, 4> parts{
        {{nominal, 1, 1}, {new_public_key, 1, 2}, {new_public_key, 2, 2}, {nominal, 2, 2}}};
    const std::size_t count = settings.new_key ? parts.size() : 1;
    for (std::size_t i = 0; i < count; ++i) {
        const auto key_status = static_cast<int>(parts[i].key_status);
        roots_.push_back(root_message(key_status, parts[i].signer, static_cast<int>(i)));
        keys_.push_back(key_message(key_status, parts[i].told, first_of_keys + parts[i].told - 1));
    }
}

OsnmaKeys::~OsnmaKeys() = default;

// DSM-KROOT (section 3.2.3, tables 7 to 12): SHA-256, HMAC-SHA-256, keys of 128 bits, tags of 40 bits, tags in the
// order
// 34. Signed is the header with all from the number of the chain to the key (6.2).
OsnmaMessage OsnmaKeys::root_message(int key_status, int number, int id) const {
    constexpr std::uint64_t eight_blocks = 2, key_of_128 = 4, tag_of_40 = 9, tag_order = 34;
    const WeekAndTow first = gst_week_and_tow(chain_.first());
    OsnmaMessage message{header_of(static_cast<std::uint64_t>(key_status)), id};
    BitWriter is_signed;
    is_signed.put(message.header, 8);
    is_signed.put(chain_number, 2);
    is_signed.put(0, 2 + 2 + 2);
    is_signed.put(key_of_128, 4);
    is_signed.put(tag_of_40, 4);
    is_signed.put(tag_order, 8);
    is_signed.put(0, 4);
    is_signed.put_signed(first.week, 12);
    is_signed.put_signed(first.tow / std::chrono::hours(1), 8);
    is_signed.put(chain_.alpha(), 48);
    put_bytes(is_signed, chain_.root());
    Bytes padded = is_signed.bytes();
    const Bytes signature = secrets_->keys[static_cast<std::size_t>(number - 1)].sign(padded);
    padded.insert(padded.end(), signature.begin(), signature.end());
    const Sha256Digest padding = sha256_of(padded);

    BitWriter& bits = message.bits;
    bits.put(eight_blocks, 4);
    bits.put_signed(number, 4);
    put_bytes(bits, ByteSpan(padded).subspan(1));
    for (std::size_t i = 0; bits.size() < blocks_of_root * osnma_block_bits; ++i)
        bits.put(padding[i], 8);
    return message;
}

// DSM-PKR (section 3.2.2.2, table 5): the key, and the nodes by which its leaf leads to the root of the tree (6.1).
OsnmaMessage OsnmaKeys::key_message(int key_status, int number, int id) const {
    constexpr std::uint64_t thirteen_blocks = 7;
    const auto leaf = static_cast<std::size_t>(number - 1);
    OsnmaMessage message{header_of(static_cast<std::uint64_t>(key_status)), id};
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

const OsnmaMessage& OsnmaKeys::message(GpsTime subframe) const {
    std::size_t part = 0;
    // How many subframes ago both messages began to come by turns.
    std::int64_t since = (subframe - whole_hour(subframe)) / osnma_subframe;
    if (settings_.new_key && subframe >= *settings_.new_key - announced_for) {
        part = subframe < *settings_.new_key ? 1 : subframe < *settings_.new_key + announced_for ? 2 : 3;
        if (part < 3)
            since =
                (subframe - (*settings_.new_key - announced_for)) / osnma_subframe % (blocks_of_key + blocks_of_root);
    }
    return since < blocks_of_key ? keys_[part] : roots_[part];
}

int OsnmaKeys::public_keys() const { return settings_.new_key ? 2 : 1; }

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
